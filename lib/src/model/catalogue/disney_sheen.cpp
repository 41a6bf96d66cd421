#include "model/entry.hpp"

namespace lobe {

CatalogueEntry disney_sheen_entry() {
  return {
      .model = {.name = "disney_sheen",
                .family = "sheen",
                .formula = "(1-L.H)^5",
                .source = "Burley 2012, section 5.5: sheen of the principled model at full strength, white; without "
                          "1/pi, as in the published shader",
                .parameters = {},
                .traits = {}},
      .kernel = "disney_sheen",
      .coefficients = [](Values) { return Coefficients{1}; },
      .proposal = draw::limb,
      .known =
          KnownValues{"disney_sheen",
                      {1},
                      {9.0617284642880555e-06, 5.7188798878484085e-06, 9.8996625464634707e-06, 0.12569909754513067}}};
}

}  // namespace lobe
