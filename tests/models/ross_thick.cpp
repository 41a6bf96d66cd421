#include <cmath>

#include "models/family/ross_li.hpp"
#include "models/model_test.hpp"

namespace lobe::test {

ModelTest ross_thick_test() {
  return {.budget = {8, 2.8, 8, 2.3},
          .cases = {ModelCase{"ross_thick", reference::ross_thick,
                              [](const Vector& l, const Vector& v) -> Real {
                                return 1 + 1 / std::abs(kPi * reference::ross_thick(l, v));
                              }}},
          .excess = AlbedoExcess{"ross_thick", 89.99, 1.5704}};
}

}  // namespace lobe::test
