#pragma once

#include <span>
#include <string>

#include "plot/drawn_reflectance.hpp"
#include "plot/gnuplot.hpp"

namespace lobe {

/// Albedos over the polar angle, light's and, where it differs, viewer's.
[[nodiscard]] gnuplot::Picture albedo_picture(const std::string& stem, std::span<const DrawnReflectance> drawn,
                                              PictureFormat format);

}  // namespace lobe
