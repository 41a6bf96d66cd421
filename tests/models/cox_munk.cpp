#include <cmath>

#include "models/family/beckmann.hpp"
#include "models/model_test.hpp"
#include "reference/fresnel.hpp"

namespace lobe::test {
namespace {

ModelCase cox_munk(const std::string& wind, const std::string& n, const std::string& k) {
  const Real index = std::stold(n);
  const Real extinction = std::stold(k);
  return beckmann_case("cox_munk:wind=" + wind + ",ior=" + n + ",k=" + k,
                       std::sqrt(0.003L + 0.00512L * std::stold(wind)), correlated_attenuation,
                       [=](Real cosine) { return reference::fresnel(cosine, index, extinction); });
}

}  // namespace

ModelTest cox_munk_test() {
  return {.budget = {16, 3, 4, 0.8},
          .cases = {cox_munk("0", "1.34", "0"), cox_munk("5", "1.34", "0"), cox_munk("14", "1.2", "0.4"),
                    cox_munk("100", "1.34", "0")}};
}

}  // namespace lobe::test
