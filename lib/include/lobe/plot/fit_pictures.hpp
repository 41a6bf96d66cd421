#pragma once

#include <filesystem>
#include <string>

#include "lobe/device/device.hpp"
#include "lobe/fit/fit.hpp"
#include "lobe/plot/table_pictures.hpp"
#include "lobe/table/reflectance.hpp"

namespace [[gnu::visibility("default")]] lobe {

/// Draws a target, its fit and the residual, as write_approximation_pictures() does: STEM.slices.png and
/// STEM.albedo.png.
/// \throws as write_approximation_pictures()
PictureFiles write_fit_pictures(const Device& device, const Reflectance& target, const FitResult& fit,
                                const std::filesystem::path& directory, const std::string& stem,
                                const TablePictureOptions& options = {});

}  // namespace lobe
