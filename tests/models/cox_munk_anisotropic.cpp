#include <cmath>
#include <string>

#include "models/family/beckmann.hpp"
#include "models/model_test.hpp"
#include "reference/cox_munk.hpp"
#include "reference/fresnel.hpp"

namespace lobe::test {
namespace {

/// Smith's Lambda of Gaussian slopes, with their mean square in the azimuth of the direction.
Real wind_lambda(const Vector& direction, const reference::SeaSlopes& sea) {
  const Real square = direction.x * direction.x + direction.y * direction.y;
  if (square == 0) return 0;
  const Real along = direction.x * sea.to_x + direction.y * sea.to_y;
  const Real variance = sea.crosswind + (sea.upwind - sea.crosswind) * along * along / square;
  return smith_lambda(direction, std::sqrt(2 * variance));
}

ModelCase cox_munk_anisotropic(const std::string& wind, const std::string& n, const std::string& k,
                               const std::string& rotation) {
  const Real index = std::stold(n);
  const Real extinction = std::stold(k);
  const reference::SeaSlopes sea(std::stold(wind), static_cast<Real>(std::stod(rotation)));
  const auto reflectance = [=](Real cosine) { return reference::fresnel(cosine, index, extinction); };
  const Real m = std::sqrt(2 * std::max(sea.upwind, sea.crosswind));
  return {"cox_munk_anisotropic:wind=" + wind + ",ior=" + n + ",k=" + k + ",rotation=" + rotation,
          [=](const Vector& l, const Vector& v) {
            const Vector h = reference::half_vector(l, v);
            // A facet rises where its normal does not lean to.
            return std::max(0.0L, sea.density(-h.x / h.z, -h.y / h.z)) / std::pow(h.z, 4.0L) *
                   reflectance(reference::cos_half_difference(l, v)) /
                   (4 * l.z * v.z * (1 + wind_lambda(l, sea) + wind_lambda(v, sea)));
          },
          [=](const Vector& l, const Vector& v) {
            const Vector h = reference::half_vector(l, v);
            return 1 + sea.cancellation(-h.x / h.z, -h.y / h.z) +
                   tan_squared_delta(h) * (1 / sea.upwind + 1 / sea.crosswind) + fresnel_condition(reflectance, l, v) +
                   m / sine(l) + m / sine(v);
          },
          static_cast<double>(2 * std::sqrt(2 * std::min(sea.upwind, sea.crosswind)))};
}

}  // namespace

ModelTest cox_munk_anisotropic_test() {
  return {.budget = {32, 6, 4, 0.81},
          .cases = {cox_munk_anisotropic("5", "1.34", "0", "0.6"), cox_munk_anisotropic("0.5", "1.34", "0", "-1.2"),
                    cox_munk_anisotropic("14", "1.2", "0.4", "0"), cox_munk_anisotropic("30", "1.34", "0", "2.5")},
          // Light from 170 degrees from where the wind blows to.
          .excess = AlbedoExcess{"cox_munk_anisotropic:wind=30,k=100,rotation=-2.967", 89.99, 1.046}};
}

}  // namespace lobe::test
