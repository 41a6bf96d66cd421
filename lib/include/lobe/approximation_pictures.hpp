#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "lobe/approximation.hpp"
#include "lobe/device.hpp"
#include "lobe/material.hpp"
#include "lobe/table_pictures.hpp"

namespace lobe {

/// What write_approximation_pictures() left, and what it could not.
struct ApproximationPictures {
  std::vector<std::filesystem::path> pictures;  ///< STEM.slices.png and STEM.albedo.png (or .svg)
  std::vector<std::filesystem::path> scripts;   ///< the gnuplot scripts and data beside the pictures
  std::string note;                             ///< why pictures are missing; empty when they are there
};

/// Draws a target, its approximation and what is left: f in the plane of incidence for light from 0, 45 and 75
/// degrees, and the albedos. Several channels are drawn as their mean. Without gnuplot the pictures are left out and
/// `note` says so.
/// \throws IoError when a file exists and overwrite is false, or cannot be written (nothing half-written stays);
///   NumericError, DeviceError as evaluate() and albedo().
ApproximationPictures write_approximation_pictures(const Device& device, const Material& target,
                                                   const Approximation& approximation,
                                                   const std::filesystem::path& directory, const std::string& stem,
                                                   const TablePictureOptions& options = {});

}  // namespace lobe
