#pragma once

#include <span>
#include <string>
#include <string_view>

#include "lobe/cluster/embedding.hpp"
#include "plot/families.hpp"
#include "plot/gnuplot.hpp"

namespace lobe {

/// The first two axes of an embedding: materials as points, coloured by family, sweeps of one parameter joined by
/// lines, few materials labelled where there is room, and a second panel where most of them crowd in a small part of
/// the first.
/// \param stem stem of the picture's files
/// \param unit of the coordinates, "" for none
[[nodiscard]] gnuplot::Picture map_picture(const std::string& stem, std::string_view title, std::string_view unit,
                                           std::span<const DrawnMaterial> materials, const Embedding& embedding);

}  // namespace lobe
