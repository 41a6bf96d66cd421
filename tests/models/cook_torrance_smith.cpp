#include "models/family/cook_torrance_variants.hpp"
#include "models/model_test.hpp"

namespace lobe::test {

ModelTest cook_torrance_smith_test() {
  return {.budget = {16, 3.8, 4, 1.1}, .cases = {smith("0.01", "1"), smith("0.3", "0.04"), smith("1", "1")}};
}

}  // namespace lobe::test
