#include "hemisphere/patch_response.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "hemisphere/gauss.hpp"

namespace lobe {
namespace {

using std::numbers::pi;

/// Half the angle of the circular segment that a line at a given share of the radius cuts off.
double half_angle(double share) {
  return std::acos(std::clamp(share, -1.0, 1.0));
}

double segment(double half) {
  return half - 0.5 * std::sin(2 * half);
}

}  // namespace

double lens_area(double distance, double radius) {
  const double small = std::min(radius, 1.0);
  if (distance <= std::abs(1 - radius)) return pi * small * small;
  if (distance >= 1 + radius) return 0;
  const double own = half_angle((distance * distance + 1 - radius * radius) / (2 * distance));
  const double other = half_angle((distance * distance + radius * radius - 1) / (2 * distance * radius));
  return segment(own) + radius * radius * segment(other);
}

double patch_constant(double radius) {
  return 1 / (pi * std::min(1.0, radius * radius));
}

double patch_response(double distance, double radius) {
  // Over circles about the origin: the arc inside the disc about X times the albedo of eta_R there. Both have kinks.
  const double end = std::min(1.0, distance + radius);
  std::array<double, 4> edges{0, std::min(std::abs(distance - radius), end), std::min(std::abs(1 - radius), end), end};
  std::ranges::sort(edges);
  static const GaussRule gauss = gauss_rule(24);
  double sum = 0;
  for (std::size_t e = 0; e + 1 < edges.size(); ++e) {
    const double length = edges[e + 1] - edges[e];
    if (!(length > 0)) continue;
    for (std::size_t k = 0; k < gauss.nodes.size(); ++k) {
      // Nodes crowd towards both ends, where roots begin.
      const double t = gauss.nodes[k];
      const double rho = edges[e] + length * t * t * (3 - 2 * t);
      const double weight = gauss.weights[k] * length * 6 * t * (1 - t);
      const double product = 2 * distance * rho;
      const double arc = product > 0 ? half_angle((distance * distance + rho * rho - radius * radius) / product)
                                     : (std::max(distance, rho) <= radius ? pi : 0);
      sum += weight * rho * 2 * arc * lens_area(rho, radius);
    }
  }
  const double constant = patch_constant(radius);
  return constant * constant * sum;
}

}  // namespace lobe
