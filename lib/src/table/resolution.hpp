#pragma once

#include <string>

#include "lobe/hemisphere/grid.hpp"
#include "table/lobe_tabulator.hpp"

namespace lobe {

/// How well a grid resolves the worst lobe of a material.
struct Resolution {
  double error = 0;  ///< relative error of integral(f^2 dmu(V)), mean over L by dmu
  std::size_t lobe = 0;
};

/// Measures integral(f^2 dmu(V)) of every lobe on the grid against twice its resolution. The mean over L is one of
/// relative errors, so that what a reflectance does at grazing angles counts for what they are of the hemisphere.
[[nodiscard]] Resolution measure_resolution(const LobeTabulator& tabulator, const HemisphereGrid& grid,
                                            std::size_t points);

/// A grid of the same kind (of gauss nodes for fixed grids) that resolves the lobe to the tolerance, as a text for
/// messages: "gauss:256x512", or "about gauss:..." where it is judged by the lobe's width.
[[nodiscard]] std::string resolution_needed(const LobeTabulator& tabulator, const HemisphereGrid& grid,
                                            double tolerance);

}  // namespace lobe
