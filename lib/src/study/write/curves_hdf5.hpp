#pragma once

#include "hdf5/hdf5.hpp"
#include "lobe/study/study.hpp"

namespace lobe {

/// Writes the group `curves`; nothing for results without.
/// \param material the axis of materials
/// \param channel the axis of channels
void write_curves(hid_t root, const StudyResult& result, const hdf5::Dataset& material, const hdf5::Dataset& channel);

}  // namespace lobe
