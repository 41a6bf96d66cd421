#include "models/family/cook_torrance_variants.hpp"
#include "models/model_test.hpp"

namespace lobe::test {

ModelTest cook_torrance_blinn_fresnel_test() {
  return {.budget = {16, 3.3, 2, 0.69},
          .cases = {with_fresnel(blinn("20", "1"), "1.5", "0"), with_fresnel(blinn("5000", "1"), "0.331", "2.324")}};
}

}  // namespace lobe::test
