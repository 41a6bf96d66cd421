#include "models/family/cook_torrance_variants.hpp"
#include "models/model_test.hpp"

namespace lobe::test {

ModelTest cook_torrance_torrance_test() {
  return {.budget = {16, 4, 8, 1.8}, .cases = {torrance("0.01", "1"), torrance("0.3", "0.04"), torrance("2", "1")}};
}

}  // namespace lobe::test
