#pragma once

#include <filesystem>
#include <string>

#include "lobe/device/device.hpp"
#include "lobe/plot/table_pictures.hpp"
#include "lobe/table/reflectance.hpp"

namespace lobe {

/// A target and what stands for it.
struct ReflectancePair {
  const Device& device;
  Reflectance target;
  Reflectance approximation;
  std::string kind;    ///< "Approximation"
  std::string name;    ///< of the second in keys: "approximation"
  std::string result;  ///< how near they are, for the second line of the headings; the target's name is the first
  bool has_channels = false;
  bool is_isotropic = true;
};

/// STEM.slices and STEM.albedo: f in the plane of incidence for light from 0, 45 and 75 degrees with what is left
/// below, and the albedos.
/// \throws as write_pictures() and what the reflectances throw
PictureFiles write_pair_pictures(const ReflectancePair& pair, const std::filesystem::path& directory,
                                 const std::string& stem, const TablePictureOptions& options);

}  // namespace lobe
