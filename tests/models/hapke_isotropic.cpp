#include "models/family/lommel_seeliger.hpp"
#include "models/model_test.hpp"

namespace lobe::test {

ModelTest hapke_isotropic_test() {
  return {.budget = {8, 1.9, 4, 1.2},
          .cases = {hapke("hapke_isotropic", reference::hapke_isotropic, "0.05"),
                    hapke("hapke_isotropic", reference::hapke_isotropic, "5")},
          .excess = AlbedoExcess{"hapke_isotropic:g=10", 89.99, 2.642}};
}

}  // namespace lobe::test
