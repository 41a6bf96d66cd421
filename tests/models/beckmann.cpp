#include "models/family/beckmann.hpp"
#include "models/model_test.hpp"
#include "reference/fresnel.hpp"

namespace lobe::test {
namespace {

ModelCase beckmann(const std::string& m, const std::string& f0) {
  const Real at_normal = std::stold(f0);
  return beckmann_case("beckmann:m=" + m + ",f0=" + f0, std::stold(m), correlated_attenuation,
                       [=](Real cosine) { return reference::schlick_fresnel(cosine, at_normal); });
}

}  // namespace

ModelTest beckmann_test() {
  return {.budget = {16, 3.8, 4, 1},
          .cases = {beckmann("0.01", "1"), beckmann("0.3", "0.04"), beckmann("0.1", "1"), beckmann("1", "1"),
                    beckmann("20", "1")}};
}

}  // namespace lobe::test
