#include "models/family/cook_torrance_variants.hpp"
#include "models/model_test.hpp"

namespace lobe::test {

ModelTest cook_torrance_fresnel_test() {
  return {.budget = {16, 3.3, 4, 1.1},
          .cases = {fresnel("0.05", "0.331", "2.324"), fresnel("0.3", "1.5", "0"), fresnel("0.2", "0.18", "3.64"),
                    fresnel("0.5", "0.7", "0"), fresnel("0.5", "2.97", "4.58")}};
}

}  // namespace lobe::test
