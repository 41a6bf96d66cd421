#include "table/mean_quadrature.hpp"

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <numbers>
#include <vector>

#include "hemisphere/embedded_rule.hpp"
#include "table/ring_bounds.hpp"

namespace lobe {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;
using std::numbers::pi;

// Chosen on tables of 43 measured files with 64 and with 32 rings, of which the worst was off by 0.37 of the result,
// and shown on 42 others (0.54); docs/error-estimates.md.
constexpr double kOfHalves = 1.5;    // of what changes with half of the azimuths, or with the rings of both directions
constexpr double kOfQuarters = 0.3;  // where halves agree by accident

/// Means over the azimuth between both directions, rings of L x rings of V: over all and over every second one.
struct AzimuthMeans {
  MatrixXd all, even;
};

AzimuthMeans azimuth_means(const BrdfTable& table, std::size_t channel) {
  const auto rings = table.grid.rings();
  const auto count = static_cast<Index>(rings.size());
  AzimuthMeans means{MatrixXd::Zero(count, count), MatrixXd::Zero(count, count)};
  const auto values = table.channel(channel);
  const auto add = [&](Index in, Index out, double share, bool is_even, double value) {
    means.all(in, out) += share * value;
    if (is_even) means.even(in, out) += 2 * share * value;
  };
  if (table.form == TableForm::isotropic) {
    const std::size_t half = table.grid.half_azimuths();
    const double step = 1 / static_cast<double>(rings.front().count);
    for (std::size_t at = 0; at < values.size(); ++at) {
      const std::size_t k = at % half;
      const std::size_t pair = at / half;
      // A half turn stands for a whole one.
      const double share = k == 0 || k + 1 == half ? step : 2 * step;
      add(static_cast<Index>(pair / rings.size()), static_cast<Index>(pair % rings.size()), share, k % 2 == 0,
          values[at]);
    }
    return means;
  }
  const std::size_t nodes = table.grid.nodes();
  for (std::size_t i = 0; i < nodes; ++i) {
    const std::size_t in = table.grid.ring_of(i);
    for (std::size_t j = 0; j < nodes; ++j) {
      const std::size_t out = table.grid.ring_of(j);
      const double share = 1 / static_cast<double>(rings[in].count * rings[out].count);
      const std::size_t turns = i - rings[in].first_node + j - rings[out].first_node;
      add(static_cast<Index>(in), static_cast<Index>(out), share, turns % 2 == 0, values[i * nodes + j]);
    }
  }
  return means;
}

std::vector<VectorXd> thinned_rules(const HemisphereGrid& grid, std::size_t stride) {
  std::vector<VectorXd> rules;
  for (std::size_t first = 0; first < stride; ++first) {
    const auto weights = thinned_ring_weights(grid, first, stride);
    rules.emplace_back(2 * pi * Eigen::Map<const VectorXd>(weights.data(), static_cast<Index>(weights.size())));
  }
  return rules;
}

}  // namespace

double mean_quadrature_error(const BrdfTable& table, std::size_t channel) {
  const auto rings = table.grid.rings();
  VectorXd full(static_cast<Index>(rings.size()));
  for (std::size_t r = 0; r < rings.size(); ++r) {
    full(static_cast<Index>(r)) = rings[r].weight * static_cast<double>(rings[r].count);
  }
  const AzimuthMeans means = azimuth_means(table, channel);
  const auto mean = [&](const MatrixXd& of, const VectorXd& in, const VectorXd& out) -> double {
    return in.dot(of * out) / pi;
  };
  // A lobe lies on pairs of the same rings: with half of those of one direction it is there as often as before, with
  // half of those of both it is seen twice or not at all. That is what is left beside the changes by either.
  const auto of_both = [&](std::size_t stride) {
    const auto rules = thinned_rules(table.grid, stride);
    double squares = 0;
    for (const VectorXd& in : rules) {
      for (const VectorXd& out : rules) squares += std::pow(mean(means.all, in - full, out - full), 2);
    }
    return std::sqrt(squares) / static_cast<double>(stride);
  };
  double error = kOfHalves * std::abs(mean(means.even, full, full) - mean(means.all, full, full));
  if (rings.size() >= 4) {
    double of_viewer = 0;
    for (const VectorXd& rule : thinned_rules(table.grid, 2)) {
      of_viewer = std::hypot(of_viewer, mean(means.all, full, rule - full));
    }
    error += kOfHalves * of_both(2) + kEmbeddedSafety * of_viewer;
  }
  if (rings.size() >= 8) error += kOfQuarters * of_both(4);
  return error;
}

}  // namespace lobe
