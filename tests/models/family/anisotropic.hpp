#pragma once

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>

#include "models/model_test.hpp"

namespace lobe::test {

/// 1 + n k / base: the base of the power is a sum with an absolute error of an ulp.
inline auto lafortune_condition(const Vector& c, Real n, Real turn) {
  return [=](const Vector& l, const Vector& v) {
    const Real base = reference::lafortune_anisotropic(l, v, c, 1, turn);
    const Real size = std::max(std::abs(c.x), std::abs(c.y)) + std::abs(c.z);
    return 1 + n * size / std::max(base, 1e-10L);
  };
}

/// Where the base is an ulp above or below 0.
inline auto lafortune_floor(Real constant, Real n) {
  return [=](Real eps) { return constant * std::pow(16 * eps, n); };
}

/// A patch with an edge; `distance` of a pair in its norm.
inline ModelCase patch(const std::string& model, const std::string& parameters, Real radius,
                       const reference::PatchNorm& norm, Real band) {
  const Real constant = 1 / reference::patch_norm_area(radius, norm);
  const bool is_retro = model == "retro_patch_anisotropic";
  const auto distance = [=](const Vector& l, const Vector& v) {
    return reference::patch_metric(is_retro ? reference::mirrored(l) : l, v, norm);
  };
  return {model + ":" + parameters,
          [=](const Vector& l, const Vector& v) { return distance(l, v) <= radius ? constant : 0; },
          // Any error of the geometry decides at the edge, none elsewhere; the band holds what single precision moves.
          [=](const Vector& l, const Vector& v) {
            return std::abs(distance(l, v) - radius) < band * radius ? std::numeric_limits<Real>::infinity() : 1;
          },
          static_cast<double>(radius / 3)};
}

}  // namespace lobe::test
