#pragma once

#include <Eigen/Core>
#include <span>
#include <string>
#include <string_view>

#include "plot/families.hpp"
#include "plot/gnuplot.hpp"

namespace lobe {

/// The distance matrix in colours, ordered by family: every material labelled where the cells are large enough, else
/// some of each family. The colours are logarithmic when the distances span more than a factor of 30.
/// \param stem stem of the picture's files
/// \param unit of the distance, "" for none
[[nodiscard]] gnuplot::Picture distance_picture(const std::string& stem, std::string_view title, std::string_view unit,
                                                std::span<const DrawnMaterial> materials,
                                                const Eigen::MatrixXd& distance);

}  // namespace lobe
