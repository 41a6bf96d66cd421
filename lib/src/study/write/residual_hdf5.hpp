#pragma once

#include "hdf5/hdf5.hpp"
#include "lobe/study/study.hpp"

namespace lobe {

/// Writes how well every family represents every material into the group of a lighting (docs/file-formats.md).
/// \param material the axis of the materials
/// \param basis_family that of the families
void write_residuals(hid_t group, FamilyFit fit, const FamilyResiduals& residuals, const hdf5::Dataset& material,
                     const hdf5::Dataset& basis_family);

}  // namespace lobe
