#pragma once

#include <Eigen/Core>
#include <span>
#include <string>
#include <string_view>

#include "lobe/cluster/clustering.hpp"
#include "plot/families.hpp"
#include "plot/gnuplot.hpp"

namespace lobe {

/// The tree of materials beside their distance matrix in the order of its leaves. Colours at the matrix tell families;
/// branches that hold one family only have its colour. Every material is labelled where the cells are large enough,
/// else the medoids are.
/// \param stem stem of the picture's files
/// \param unit of the distance, "" for none
/// \param materials at least two
[[nodiscard]] gnuplot::Picture dendrogram_picture(const std::string& stem, std::string_view title,
                                                  std::string_view unit, std::span<const DrawnMaterial> materials,
                                                  const Eigen::MatrixXd& distance, const Clustering& clustering);

}  // namespace lobe
