#include "hemisphere/square_map.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace lobe {

using std::numbers::pi;

Direction square_to_hemisphere(SquarePoint p) {
  if (p.a == 0 && p.b == 0) return {};
  const bool along_a = std::abs(p.a) > std::abs(p.b);
  const double r = along_a ? p.a : p.b;
  const double phi = along_a ? pi / 4 * (p.b / p.a) : pi / 2 - pi / 4 * (p.a / p.b);
  return {std::asin(std::min(std::abs(r), 1.0)), r < 0 ? phi + pi : phi};
}

SquarePoint hemisphere_to_square(Direction direction) {
  const double r = std::sin(direction.theta);
  const double phi = std::remainder(direction.phi, 2 * pi);  // in [-pi, pi]
  const double quarter = 4 / pi * r;
  if (std::abs(phi) <= pi / 4) return {r, quarter * phi};
  if (std::abs(phi) >= 3 * pi / 4) return {-r, -quarter * (phi > 0 ? phi - pi : phi + pi)};
  return phi > 0 ? SquarePoint{-quarter * (phi - pi / 2), r} : SquarePoint{quarter * (phi + pi / 2), -r};
}

}  // namespace lobe
