#pragma once

#include <string_view>

#include "lobe/device/device.hpp"
#include "lobe/table/reflectance.hpp"

namespace [[gnu::visibility("default")]] lobe {

/// Whether a format of save_measured() holds averages over cells, with delta parts, rather than samples; false for
/// unknown formats.
[[nodiscard]] bool holds_cells(std::string_view format);

/// Whether a format of save_measured() holds standard deviations, of functions with replicates; false for unknown
/// formats.
[[nodiscard]] bool holds_deviations(std::string_view format);

/// Deviation of a reflectance from another one, at pseudo-random pairs of directions up to 75 degrees.
struct Deviation {
  double median = 0;   ///< median of |difference| / |value| where the value is not 0, over all channels
  double rms = 0;      ///< root mean square of the difference, relative to that of the value
  double largest = 0;  ///< largest |difference|, relative to the largest |value|
};

/// Measures how far a reflectance that was read back from a file is from the one that was written, over the channels of
/// the latter.
/// \throws NumericError if `read` has fewer channels; as as_function()
[[nodiscard]] Deviation deviation(const Device& device, const Reflectance& original, const Reflectance& read);

}  // namespace lobe
