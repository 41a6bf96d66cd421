#pragma once

#include <filesystem>
#include <functional>
#include <span>
#include <string>
#include <vector>

#include "lobe/core/directions.hpp"
#include "lobe/device/device.hpp"
#include "lobe/io/table_pictures.hpp"
#include "lobe/table/reflectance.hpp"

namespace lobe {

/// What pictures ask of a reflectance, each the mean of its channels.
struct DrawnReflectance {
  std::function<std::vector<double>(std::span<const Directions>)> values;  ///< sr^-1
  std::function<std::vector<double>(std::span<const double>)> albedos;     ///< by angle of incidence, radians
};

/// The device must outlive what is returned.
[[nodiscard]] DrawnReflectance drawn(const Device& device, const Reflectance& reflectance);

/// A target and what stands for it.
struct ReflectancePair {
  DrawnReflectance target;
  DrawnReflectance approximation;
  std::string kind;   ///< "Approximation"
  std::string name;   ///< of the second in keys: "approximation"
  std::string title;  ///< first line of the headings
  bool has_channels = false;
  bool is_isotropic = true;
};

/// STEM.slices and STEM.albedo: f in the plane of incidence for light from 0, 45 and 75 degrees with what is left
/// below, and the albedos. \throws as write_pictures() and what the reflectances throw
PictureFiles write_pair_pictures(const ReflectancePair& pair, const std::filesystem::path& directory,
                                 const std::string& stem, const TablePictureOptions& options);

}  // namespace lobe
