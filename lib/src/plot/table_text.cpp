#include "plot/table_text.hpp"

#include "core/text.hpp"

namespace lobe {

std::string csv_matrix(std::string_view corner, std::span<const std::string> labels, const Eigen::MatrixXd& matrix) {
  std::string text = csv_field(corner);
  for (const auto& label : labels) text += ',' + csv_field(label);
  text += '\n';
  for (Eigen::Index row = 0; row < matrix.rows(); ++row) {
    text += csv_field(labels[static_cast<std::size_t>(row)]);
    for (Eigen::Index column = 0; column < matrix.cols(); ++column) text += ',' + shortest(matrix(row, column));
    text += '\n';
  }
  return text;
}

}  // namespace lobe
