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

/// Directions on rays from the mirror direction of V through the base plane, up to the unit circle.
std::vector<LitNode> ray_directions(const LitNode& view, const PatternRule& rule) {
  std::vector<LitNode> nodes;
  const double x = -std::sin(view.theta) * std::cos(view.phi);
  const double y = -std::sin(view.theta) * std::sin(view.phi);
  const GaussRule gauss = gauss_legendre(rule.nodes);
  for (int a = 0; a < rule.azimuths; ++a) {
    const double angle = 2 * pi * (a + 0.5) / rule.azimuths;
    const double along = x * std::cos(angle) + y * std::sin(angle);
    const double end = -along + std::sqrt(along * along + 1 - x * x - y * y);
    // Panels grow from the mirror direction on; the last one ends smoothly at the horizon.
    std::vector<double> limits{0};
    for (double reach = rule.narrowest; reach < 0.7 * end; reach *= 2) limits.push_back(reach);
    limits.push_back(end);
    for (std::size_t panel = 0; panel + 1 < limits.size(); ++panel) {
      const double middle = (limits[panel] + limits[panel + 1]) / 2;
      const double half = (limits[panel + 1] - limits[panel]) / 2;
      for (std::size_t k = 0; k < gauss.nodes.size(); ++k) {
        const double t = middle + half * gauss.nodes[k];
        const double u = x + t * std::cos(angle);
        const double v = y + t * std::sin(angle);
        nodes.push_back({std::asin(std::min(std::hypot(u, v), 1 - 1e-14)), std::atan2(v, u),
                         gauss.weights[k] * half * t * 2 * pi / rule.azimuths});
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
