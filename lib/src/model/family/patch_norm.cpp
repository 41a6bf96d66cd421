#include "model/family/patch_norm.hpp"

#include <algorithm>
#include <cmath>

#include "model/constants.hpp"

namespace lobe {

Parameter axes_ratio() {
  return {"ratio", "1", 0.01, 1, std::nullopt, "B/A, minor over major axis"};
}

Parameter norm_power() {
  return {"p", "1", 1, 100, 2.0, "power of the norm; 2 is the ellipse, 1 a rhombus, large ones are nearly a rectangle"};
}

bool is_smooth_norm(double p) {
  return std::fmod(p, 2) == 0 && p <= 10;
}

double norm_aspect(Values v) {
  return std::max(1 / v[1], v[2] / 2);
}

PatchEdge edge_of(Values v) {
  // Within the elliptic norm R = 2, and with larger powers, all is; rounding must not cut off the farthest direction.
  const bool is_whole = v[0] == kWholeBasePlane && v[2] >= 2;
  return {is_whole ? 2 * kWholeBasePlane : v[0], v[1], v[2], v[3]};
}

Coefficients patch_norm_coefficients(Values v) {
  const Axis axis(v[3]);
  const double radius = edge_of(v).radius;
  const double share = v[1] / radius;
  return {patch_norm_constant(v[0], v[1], v[2]),
          share * axis.cosine,
          share * axis.sine,
          -axis.sine / radius,
          axis.cosine / radius,
          v[2]};
}

double reach_of_norm(Values v) {
  return v[0] / v[1] * std::exp2(std::max(0.0, 0.5 - 1 / v[2]));
}

}  // namespace lobe
