#include "models/family/ward_variants.hpp"
#include "models/model_test.hpp"

namespace lobe::test {
namespace {

ModelCase metal(const std::string& m) {
  return ward_case("ward_metal", reference::ward_metal, m);
}

}  // namespace

ModelTest ward_metal_test() {
  return {.budget = {16, 4.9, 4, 1.3}, .cases = {metal("0.005"), metal("0.1"), metal("0.5")}};
}

}  // namespace lobe::test
