#pragma once

#include <span>
#include <string>

#include "io/gnuplot.hpp"
#include "lobe/table/table.hpp"

namespace lobe {

/// Albedos of all tables over the polar angle, light's and, where it differs, viewer's.
[[nodiscard]] gnuplot::Picture albedo_picture(const std::string& stem, std::span<const BrdfTable> tables,
                                              PictureFormat format);

}  // namespace lobe
