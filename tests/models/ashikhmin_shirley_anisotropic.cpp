#include <algorithm>
#include <cmath>
#include <string>

#include "models/family/fresnel_condition.hpp"
#include "models/model_test.hpp"

namespace lobe::test {
namespace {

ModelCase ashikhmin_shirley(const std::string& n_u, const std::string& n_v, const std::string& f0,
                            const std::string& rotation) {
  const Real u = std::stold(n_u);
  const Real v = std::stold(n_v);
  const Real at_normal = std::stold(f0);
  const Real turn = std::stod(rotation);
  return {"ashikhmin_shirley_anisotropic:n_u=" + n_u + ",n_v=" + n_v + ",f0=" + f0 + ",rotation=" + rotation,
          [=](const Vector& l, const Vector& w) {
            return reference::ashikhmin_shirley_anisotropic(l, w, u, v, at_normal, turn);
          },
          // 1 + n |ln N.H|
          [=](const Vector& l, const Vector& w) {
            return 1 + std::max(u, v) * std::log1p(tan_squared_delta(half_vector(l, w))) / 2 +
                   schlick_condition(at_normal, l, w);
          },
          static_cast<double>(1 / std::sqrt(std::max(u, v)))};
}

}  // namespace

ModelTest ashikhmin_shirley_anisotropic_test() {
  return {.budget = {16, 4.9, 8, 2.3},
          .cases = {ashikhmin_shirley("20", "20", "1", "0"), ashikhmin_shirley("10", "1000", "0.04", "0"),
                    ashikhmin_shirley("5000", "50", "1", "0.6")}};
}

}  // namespace lobe::test
