#include "models/model_test.hpp"

namespace lobe::test {
namespace {

Real no_condition(const Vector&, const Vector&) {
  return 1;
}

}  // namespace

ModelTest lambert_test() {
  return {.budget = {1, 0.3, 1, 0.4}, .cases = {ModelCase{"lambert", reference::lambert, no_condition, 1}}};
}

}  // namespace lobe::test
