#include "models/family/cook_torrance_variants.hpp"
#include "models/model_test.hpp"

namespace lobe::test {

ModelTest cook_torrance_blinn_test() {
  return {.budget = {16, 3.3, 4, 1}, .cases = {blinn("1", "1"), blinn("20", "0.04"), blinn("5000", "1")}};
}

}  // namespace lobe::test
