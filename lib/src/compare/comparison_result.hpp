#pragma once

#include <Eigen/Core>
#include <span>
#include <string>
#include <vector>

#include "compare/comparison_measure.hpp"
#include "lobe/compare/literature_metric.hpp"

namespace lobe {

/// Integrals under the roots of a channel's distances, (n + 1) x (n + 1): the last row and column are black, f = 0.
struct ComparisonIntegrals {
  Eigen::MatrixXd value;
  Eigen::MatrixXd error;
};

/// \throws ArgumentError for options that are out of range
void check(const LiteratureOptions& options);

/// Equal weights where the options give none.
/// \throws ArgumentError for weights that do not fit
[[nodiscard]] std::vector<double> comparison_weights(const LiteratureOptions& options, std::size_t channels);

/// Weighted sum over channels, errors in absolute value.
[[nodiscard]] ComparisonIntegrals combine(const std::vector<ComparisonIntegrals>& channels,
                                          const std::vector<double>& weights);

/// Distances from integrals.
/// \param names of the n reflectances, for messages
/// \throws NumericError naming two whose distance is no finite number
[[nodiscard]] LiteratureResult make_comparison_result(LiteratureMetric comparison,
                                                      const std::vector<ComparisonIntegrals>& channels,
                                                      std::span<const std::string> names,
                                                      const LiteratureOptions& options);

/// \throws Cancelled when the callback says so
void report_progress(const LiteratureOptions& options, LiteratureMetric comparison, double fraction);

}  // namespace lobe
