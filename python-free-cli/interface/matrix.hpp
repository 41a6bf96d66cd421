#pragma once

#include <Eigen/Core>
#include <string_view>
#include <vector>

#include "interface/session.hpp"
#include "lobe/formats/measurement.hpp"
#include "lobe/metric/metric.hpp"

namespace lobe::cli {

// Code shared by the commands on many operands: gram, distance-matrix.

/// A symmetric matrix of a Metric, and what it is called.
struct MatrixKind {
  std::string_view command;
  std::string_view name;     ///< in JSON and CSV
  std::string_view formula;  ///< in the headings of text
  Eigen::MatrixXd Metric::*value;
  Eigen::MatrixXd Metric::*error;
  Eigen::MatrixXd ProductDeviations::*deviation;
  std::string_view (*unit)(const Lighting& lighting);
};

/// Measures MATERIAL... under every --lighting and prints a matrix for each, and for each channel where there are
/// several, as text, CSV or JSON; or writes the CSV into a file.
/// \throws as read_operands(), measured(), OutputFile.
ExitCode answer_matrix(Session& session, const MatrixKind& kind);

/// MATERIAL...
[[nodiscard]] std::vector<Positional> matrix_positionals();
[[nodiscard]] std::vector<Option> matrix_options();

}  // namespace lobe::cli
