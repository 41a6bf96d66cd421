#include "reference/pattern_product.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "reference/quadrature.hpp"

namespace lobe::reference {
namespace {

using std::numbers::pi;

/// A direction by elevation and azimuth, with its share of dmu.
struct LitNode {
  double theta, phi, weight;
};

Directions pair_between(const LitNode& in, const LitNode& out) {
  return {in.theta, out.theta, out.phi - in.phi, in.phi};
}

/// Gauss in theta in two panels, equal steps in azimuth.
std::vector<LitNode> product_nodes(int elevations, int turns, double offset) {
  std::vector<LitNode> nodes;
  const GaussRule gauss = gauss_legendre(elevations);
  for (const double middle : {pi / 8, 3 * pi / 8}) {
    for (int k = 0; k < elevations; ++k) {
      const double theta = middle + pi / 8 * gauss.nodes[static_cast<std::size_t>(k)];
      const double share = gauss.weights[static_cast<std::size_t>(k)] * pi / 8 * std::sin(theta) * std::cos(theta);
      for (int t = 0; t < turns; ++t) nodes.push_back({theta, 2 * pi * (t + offset) / turns, share * 2 * pi / turns});
    }
  }
  return nodes;
}

/// Directions on rays from the mirror direction of V through the base plane, up to the unit circle. Where that is
/// close, lengths of rays bend across the direction to it, and cos(theta_L) begins like a root at their ends.
std::vector<LitNode> ray_directions(const LitNode& view, const PatternRule& rule) {
  std::vector<LitNode> nodes;
  const double x = -std::sin(view.theta) * std::cos(view.phi);
  const double y = -std::sin(view.theta) * std::sin(view.phi);
  const GaussRule turn = gauss_legendre(rule.azimuths / 4);
  const GaussRule gauss = gauss_legendre(rule.nodes);
  for (int quarter = 0; quarter < 4; ++quarter) {
    for (std::size_t a = 0; a < turn.nodes.size(); ++a) {
      const double angle = view.phi + pi / 2 * quarter + pi / 4 * (1 + turn.nodes[a]);
      const double share = turn.weights[a] * pi / 4;
      const double along = x * std::cos(angle) + y * std::sin(angle);
      const double end = -along + std::sqrt(std::max(0.0, along * along + 1 - x * x - y * y));
      std::vector<double> limits{0};
      for (double reach = rule.narrowest; reach < 0.6 * end; reach *= 2.5) limits.push_back(reach);
      limits.push_back(end);
      for (std::size_t panel = 0; panel + 1 < limits.size(); ++panel) {
        const double length = limits[panel + 1] - limits[panel];
        const bool is_last = panel + 2 == limits.size();
        for (std::size_t k = 0; k < gauss.nodes.size(); ++k) {
          const double s = (1 - gauss.nodes[k]) / 2;  // from the end
          const double t = limits[panel + 1] - length * (is_last ? s * s : s);
          const double stretch = gauss.weights[k] / 2 * length * (is_last ? 2 * s : 1);
          const double u = x + t * std::cos(angle);
          const double v = y + t * std::sin(angle);
          nodes.push_back({std::asin(std::min(std::hypot(u, v), 1 - 1e-14)), std::atan2(v, u), stretch * t * share});
        }
      }
    }
  }
  return nodes;
}

}  // namespace

std::vector<double> pattern_products(const PairValues& eta, const PairValues& f, const PairValues& g,
                                     const PatternRule& rule) {
  const std::vector<LitNode> positions = product_nodes(rule.patterns, rule.pattern_turns, 0);
  std::vector<double> sums(3, 0.0);
  for (const LitNode& view : product_nodes(rule.views, rule.turns, 0.3)) {
    const std::vector<LitNode> lights = ray_directions(view, rule);
    std::vector<Directions> pairs;
    for (const LitNode& light : lights) pairs.push_back(pair_between(light, view));
    const std::vector<double> of_f = f(pairs);
    const std::vector<double> of_g = g(pairs);
    pairs.clear();
    for (const LitNode& position : positions) {
      for (const LitNode& light : lights) pairs.push_back(pair_between(position, light));
    }
    const std::vector<double> of_eta = eta(pairs);
    for (std::size_t p = 0; p < positions.size(); ++p) {
      double a = 0;
      double b = 0;
      for (std::size_t k = 0; k < lights.size(); ++k) {
        const double pattern = lights[k].weight * of_eta[p * lights.size() + k];
        a += pattern * of_f[k];
        b += pattern * of_g[k];
      }
      const double share = view.weight * positions[p].weight;
      sums[0] += share * a * a;
      sums[1] += share * a * b;
      sums[2] += share * b * b;
    }
  }
  return sums;
}

}  // namespace lobe::reference
