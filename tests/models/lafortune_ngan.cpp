#include "models/family/lafortune.hpp"
#include "models/model_test.hpp"

namespace lobe::test {
namespace {

ModelCase lafortune_ngan(const std::string& c_xy, const std::string& c_z, const std::string& n) {
  return lafortune_case("lafortune_ngan", reference::lafortune_ngan, c_xy, c_z, n);
}

}  // namespace

ModelTest lafortune_ngan_test() {
  return {.budget = {8, 2.1, 4, 1.2},
          .cases = {lafortune_ngan("-0.98", "0.95", "50"), lafortune_ngan("-1.02", "0.9", "5"),
                    lafortune_ngan("-0.57", "0.56", "800"), lafortune_ngan("-1", "1", "100000")}};
}

}  // namespace lobe::test
