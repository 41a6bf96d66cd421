#include "models/model_test.hpp"

namespace lobe::test {

ModelTest lommel_seeliger_test() {
  return {.budget = {4, 1.2, 4, 1.4},
          .cases = {ModelCase{"lommel_seeliger", reference::lommel_seeliger,
                              [](const Vector&, const Vector&) -> Real { return 1; }}}};
}

}  // namespace lobe::test
