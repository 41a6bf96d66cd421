#include "metric/grid_products.hpp"

#include <algorithm>
#include <cmath>

namespace lobe {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;

// Share of the change between two grids, of 1.3 to 1.5 times as many rings, that is left: this one covers errors that
// fall as the inverse root of the rings. Files that grow towards the horizon come near it.
constexpr double kGridSafety = 6.5;

/// Errors of sums over the last grid by the changes up to it.
MatrixXd errors_by_change(const MatrixXd& first, const MatrixXd& before, const MatrixXd& last) {
  MatrixXd change = (last - before).cwiseAbs().cwiseMax(kEarlierShare * (before - first).cwiseAbs());
  // Products of a set that share a grid share its errors: against entries whose changes vanish by accident.
  double worst = 0;
  for (Index j = 0; j < change.cols(); ++j) {
    for (Index i = 0; i < change.rows(); ++i) {
      if (last(i, j) != 0) worst = std::max(worst, change(i, j) / std::abs(last(i, j)));
    }
  }
  change = change.cwiseMax(kCommonShare * std::min(worst, 1.0) * last.cwiseAbs());
  return kGridSafety * change;
}

/// What is left of an error for the values, with that of the sums by change; NaN stays.
MatrixXd changed_errors(const MatrixXd& all, const MatrixXd& of_sums, const MatrixXd& by_change) {
  const auto of_values = [](double a, double values) { return std::isnan(a) ? a : std::max(values, 0.0); };
  return all.binaryExpr(all - of_sums, of_values) + by_change;
}

}  // namespace

std::vector<ChannelProducts> with_grid_errors(std::span<const GridProducts> levels, double caution) {
  std::vector<ChannelProducts> result = levels.back().products;
  if (levels.size() < kLevelsKept) return result;
  const std::span<const GridProducts> last = levels.last(kLevelsKept);
  for (std::size_t c = 0; c < result.size(); ++c) {
    const auto by_change = [&](MatrixXd ChannelProducts::*what) {
      const MatrixXd errors =
          errors_by_change(last[0].products[c].*what, last[1].products[c].*what, last[2].products[c].*what);
      return MatrixXd(caution * errors);
    };
    const ChannelProducts& sums = last[2].sums[c];
    result[c].gram_error = changed_errors(result[c].gram_error, sums.gram_error, by_change(&ChannelProducts::gram));
    result[c].squared_distance_error = changed_errors(result[c].squared_distance_error, sums.squared_distance_error,
                                                      by_change(&ChannelProducts::squared_distance));
  }
  return result;
}

double worst_error(const ChannelProducts& products) {
  double worst = 0;
  for (Index j = 0; j < products.gram.cols(); ++j) {
    for (Index i = 0; i <= j; ++i) {
      const double size = std::sqrt(std::abs(products.gram(i, i) * products.gram(j, j)));
      const double error = products.gram_error(i, j);
      if (std::isnan(error) || error > worst * size) worst = error / size;
    }
  }
  return worst;
}

}  // namespace lobe
