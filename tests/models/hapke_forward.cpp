#include "models/family/lommel_seeliger.hpp"
#include "models/model_test.hpp"

namespace lobe::test {

ModelTest hapke_forward_test() {
  return {.budget = {8, 1.9, 4, 1.3},
          .cases = {hapke("hapke_forward", reference::hapke_forward, "0.05"),
                    hapke("hapke_forward", reference::hapke_forward, "5")},
          .excess = AlbedoExcess{"hapke_forward:g=10", 89.99, 1.0857}};
}

}  // namespace lobe::test
