#include "models/family/cook_torrance_variants.hpp"
#include "models/model_test.hpp"

namespace lobe::test {

ModelTest cook_torrance_trowbridge_test() {
  return {.budget = {16, 3.3, 8, 1.6},
          .cases = {trowbridge("0.01", "1"), trowbridge("0.3", "0.04"), trowbridge("1", "1")}};
}

}  // namespace lobe::test
