#pragma once

#include <filesystem>
#include <string>

#include "lobe/device/device.hpp"
#include "lobe/fit/approximation.hpp"
#include "lobe/plot/table_pictures.hpp"
#include "lobe/table/reflectance.hpp"

namespace [[gnu::visibility("default")]] lobe {

/// Draws a target, its approximation and the residual: f in the plane of incidence for light from 0, 45 and 75 degrees
/// (STEM.slices.png), and the albedos (STEM.albedo.png). Several channels are drawn as their mean. Without gnuplot the
/// pictures are left out and `note` says so.
/// \throws IoError if a file exists and overwrite is false, or if it cannot be written (nothing half-written stays);
///   NumericError, DeviceError as evaluate() and albedo()
PictureFiles write_approximation_pictures(const Device& device, const Reflectance& target,
                                          const Approximation& approximation, const std::filesystem::path& directory,
                                          const std::string& stem, const TablePictureOptions& options = {});

}  // namespace lobe
