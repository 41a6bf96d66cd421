#pragma once

#include <span>
#include <string>

#include "lobe/table/table.hpp"
#include "plot/gnuplot.hpp"

namespace lobe {

/// Albedos of all tables over the polar angle, light's and, where it differs, viewer's.
[[nodiscard]] gnuplot::Picture albedo_picture(const std::string& stem, std::span<const BrdfTable> tables,
                                              PictureFormat format);

}  // namespace lobe
