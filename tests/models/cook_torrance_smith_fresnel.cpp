#include "models/family/cook_torrance_variants.hpp"
#include "models/model_test.hpp"

namespace lobe::test {

ModelTest cook_torrance_smith_fresnel_test() {
  return {.budget = {16, 3.7, 4, 1},
          .cases = {with_fresnel(smith("0.3", "1"), "1.5", "0"), with_fresnel(smith("0.01", "1"), "0.331", "2.324")}};
}

}  // namespace lobe::test
