#pragma once

#include <span>
#include <vector>

namespace lobe::hdf5 {

/// The bytes of a chunk of doubles as HDF5's filters shuffle, deflate and fletcher32 leave it in the file; without
/// `compress` as fletcher32 alone does. Unlike HDF5 itself it may run on several threads at once, and takes half the
/// time: in shuffled doubles runs are all there is to find, so deflate looks for nothing else.
[[nodiscard]] std::vector<unsigned char> encode_chunk(std::span<const double> values, bool compress);

}  // namespace lobe::hdf5
