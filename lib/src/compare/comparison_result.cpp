#include "compare/comparison_result.hpp"

#include <algorithm>
#include <cmath>

#include "core/text.hpp"
#include "lobe/core/directions.hpp"
#include "lobe/core/error.hpp"

namespace lobe {
namespace {

constexpr double kLargestAngle = 89 * kDegree;

struct Distance {
  double value, error;
};

Distance distance_of(const ComparisonRecipe& recipe, double integral, double error) {
  if (!recipe.is_root) return {integral, error};
  const double value = std::sqrt(std::max(0.0, integral));
  if (error == 0) return {value, 0};
  const double above = std::sqrt(std::max(0.0, integral + error)) - value;
  const double below = value - std::sqrt(std::max(0.0, integral - error));
  return {value, std::max(above, below)};
}

LiteratureMatrix make_matrix(const ComparisonRecipe& recipe, const ComparisonIntegrals& integrals) {
  const Eigen::Index n = integrals.value.rows() - 1;
  LiteratureMatrix matrix{Eigen::MatrixXd::Zero(n, n), Eigen::MatrixXd::Zero(n, n), Eigen::VectorXd(n),
                          Eigen::VectorXd(n)};
  for (Eigen::Index i = 0; i < n; ++i) {
    const auto size = distance_of(recipe, integrals.value(i, n), integrals.error(i, n));
    matrix.size(i) = size.value;
    matrix.size_error(i) = size.error;
    for (Eigen::Index j = 0; j < i; ++j) {
      const auto [value, error] = distance_of(recipe, integrals.value(i, j), integrals.error(i, j));
      matrix.distance(i, j) = matrix.distance(j, i) = value;
      matrix.distance_error(i, j) = matrix.distance_error(j, i) = error;
    }
  }
  return matrix;
}

void require_finite(const ComparisonIntegrals& integrals, std::span<const std::string> names,
                    LiteratureMetric comparison) {
  if (integrals.value.allFinite()) return;
  for (Eigen::Index j = 0; j < integrals.value.cols(); ++j) {
    for (Eigen::Index i = 0; i <= j; ++i) {
      if (std::isfinite(integrals.value(i, j))) continue;
      const auto name = [&](Eigen::Index k) {
        return static_cast<std::size_t>(k) < names.size() ? "'" + names[static_cast<std::size_t>(k)] + "'"
                                                          : std::string("black");
      };
      throw NumericError("the distance of " + name(i) + " and " + name(j) + " by '" +
                         std::string(to_string(comparison)) +
                         "' is no finite number; a logarithm needs reflectances that are not negative");
    }
  }
}

std::vector<Unresolved> find_unresolved(const LiteratureMatrix& matrix, double tolerance) {
  std::vector<Unresolved> list;
  for (Eigen::Index j = 0; j < matrix.distance.cols(); ++j) {
    for (Eigen::Index i = 0; i < j; ++i) {
      const double error = matrix.distance_error(i, j);
      if (error <= tolerance * matrix.distance(i, j)) continue;
      list.push_back({static_cast<std::size_t>(i), static_cast<std::size_t>(j), error / matrix.distance(i, j)});
    }
  }
  // Errors that are unknown are NaN, which sorts as the worst.
  std::sort(list.begin(), list.end(), [](const Unresolved& a, const Unresolved& b) {
    if (std::isnan(a.relative_error) || std::isnan(b.relative_error))
      return std::isnan(a.relative_error) && !std::isnan(b.relative_error);
    return a.relative_error > b.relative_error;
  });
  return list;
}

}  // namespace

void check(const LiteratureOptions& options) {
  if (!(options.tolerance > 0 && options.tolerance < 1))
    throw ArgumentError("tolerance out of range; expected a value in (0, 1)");
  if (!(options.outliers >= 0 && options.outliers < 1))
    throw ArgumentError("share of outliers out of range; expected a value in [0, 1)");
  if (!(options.theta_max > 0 && options.theta_max <= kLargestAngle * (1 + 1e-12))) {
    throw ArgumentError("theta_max is " + shortest(options.theta_max) +
                        " rad; expected a value in (0, 89 degrees], beyond which some comparison metrics grow without "
                        "bound");
  }
  if (!(options.lobe_width > 0 && options.lobe_width <= 1)) {
    throw ArgumentError("lobe_width is " + shortest(options.lobe_width) + " rad; expected a value in (0, 1]");
  }
}

std::vector<double> comparison_weights(const LiteratureOptions& options, std::size_t channels) {
  if (options.channel_weights.empty()) return std::vector<double>(channels, 1.0 / static_cast<double>(channels));
  if (options.channel_weights.size() != channels) {
    throw ArgumentError(std::to_string(options.channel_weights.size()) + " channel weights for " +
                        std::to_string(channels) + " channels; expected one per channel");
  }
  for (const double weight : options.channel_weights) {
    if (!(weight >= 0) || !std::isfinite(weight))
      throw ArgumentError("a channel weight is negative or no finite number");
  }
  return options.channel_weights;
}

ComparisonIntegrals combine(const std::vector<ComparisonIntegrals>& channels, const std::vector<double>& weights) {
  const Eigen::MatrixXd& first = channels.front().value;
  const Eigen::MatrixXd zero = Eigen::MatrixXd::Zero(first.rows(), first.cols());
  ComparisonIntegrals sum{zero, zero};
  for (std::size_t c = 0; c < channels.size(); ++c) {
    sum.value += weights[c] * channels[c].value;
    sum.error += weights[c] * channels[c].error;
  }
  return sum;
}

LiteratureResult make_comparison_result(LiteratureMetric comparison, const std::vector<ComparisonIntegrals>& channels,
                                        std::span<const std::string> names, const LiteratureOptions& options) {
  const ComparisonRecipe recipe = recipe_of(comparison);
  for (const auto& channel : channels) require_finite(channel, names, comparison);
  LiteratureResult result;
  result.metric = comparison;
  result.combined = make_matrix(recipe, combine(channels, comparison_weights(options, channels.size())));
  if (channels.size() > 1) {
    for (const auto& channel : channels) result.channels.push_back(make_matrix(recipe, channel));
  }
  result.unresolved = find_unresolved(result.combined, options.tolerance);
  return result;
}

void report_progress(const LiteratureOptions& options, LiteratureMetric comparison, double fraction) {
  if (options.progress && !options.progress(to_string(comparison), fraction)) throw Cancelled("cancelled");
}

}  // namespace lobe
