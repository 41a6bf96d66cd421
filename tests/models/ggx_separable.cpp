#include <cmath>

#include "models/family/fresnel_condition.hpp"
#include "models/model_test.hpp"
#include "reference/fresnel.hpp"
#include "reference/microfacets.hpp"

namespace lobe::test {
namespace {

/// G1 = 2 / (1 + sqrt(1 + alpha^2 tan^2)), Walter et al. 2007, eq. 34.
Real attenuation(const Vector& direction, Real alpha) {
  const Real tangent = std::hypot(direction.x, direction.y) / direction.z;
  return 2 / (1 + std::sqrt(1 + alpha * alpha * tangent * tangent));
}

ModelCase ggx_separable(const std::string& alpha, const std::string& f0) {
  const Real roughness = std::stold(alpha);
  const Real at_normal = std::stold(f0);
  const auto f = [=](const Vector& l, const Vector& v) {
    return reference::trowbridge_facets(reference::half_vector(l, v), roughness) *
           reference::schlick_fresnel(reference::cos_half_difference(l, v), at_normal) * attenuation(l, roughness) *
           attenuation(v, roughness) / (4 * l.z * v.z);
  };
  return {"ggx_separable:alpha=" + alpha + ",f0=" + f0, f,
          [=](const Vector& l, const Vector& v) { return 1 + schlick_condition(at_normal, l, v); },
          static_cast<double>(2 * roughness)};
}

}  // namespace

ModelTest ggx_separable_test() {
  return {.budget = {16, 3.2, 8, 2},
          .cases = {ggx_separable("0.01", "1"), ggx_separable("0.05", "0.04"), ggx_separable("0.3", "1"),
                    ggx_separable("1", "1")}};
}

}  // namespace lobe::test
