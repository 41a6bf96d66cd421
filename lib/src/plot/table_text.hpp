#pragma once

#include <Eigen/Core>
#include <span>
#include <string>
#include <string_view>

namespace lobe {

/// A square matrix as a comma-separated table: `corner` and the labels in the first row, a label at the start of each
/// further row. Numbers are the shortest that read back as the same double.
[[nodiscard]] std::string csv_matrix(std::string_view corner, std::span<const std::string> labels,
                                     const Eigen::MatrixXd& matrix);

}  // namespace lobe
