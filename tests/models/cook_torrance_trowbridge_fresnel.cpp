#include "models/family/cook_torrance_variants.hpp"
#include "models/model_test.hpp"

namespace lobe::test {

ModelTest cook_torrance_trowbridge_fresnel_test() {
  return {.budget = {8, 2.1, 4, 1.1},
          .cases = {with_fresnel(trowbridge("0.3", "1"), "1.5", "0"),
                    with_fresnel(trowbridge("0.01", "1"), "0.331", "2.324")}};
}

}  // namespace lobe::test
