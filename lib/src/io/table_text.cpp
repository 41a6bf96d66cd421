#include "io/table_text.hpp"

#include "core/text.hpp"

namespace lobe {

std::string csv_field(std::string_view text) {
  if (text.find_first_of(",\"\r\n") == std::string_view::npos) return std::string(text);
  std::string quoted = "\"";
  for (const char c : text) {
    if (c == '"') quoted += '"';
    quoted += c;
  }
  return quoted + '"';
}

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
