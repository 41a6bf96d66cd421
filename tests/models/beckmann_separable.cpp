#include "models/family/beckmann.hpp"
#include "models/model_test.hpp"
#include "reference/fresnel.hpp"

namespace lobe::test {
namespace {

ModelCase beckmann_separable(const std::string& m, const std::string& f0) {
  const Real at_normal = std::stold(f0);
  return beckmann_case("beckmann_separable:m=" + m + ",f0=" + f0, std::stold(m), separable_attenuation,
                       [=](Real cosine) { return reference::schlick_fresnel(cosine, at_normal); });
}

}  // namespace

ModelTest beckmann_separable_test() {
  return {.budget = {16, 3.8, 4, 1},
          .cases = {beckmann_separable("0.01", "1"), beckmann_separable("0.3", "0.04"), beckmann_separable("0.1", "1"),
                    beckmann_separable("1", "1"), beckmann_separable("20", "1")}};
}

}  // namespace lobe::test
