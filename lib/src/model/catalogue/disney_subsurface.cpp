#include "model/entry.hpp"

namespace lobe {

CatalogueEntry disney_subsurface_entry() {
  return {.model = {.name = "disney_subsurface",
                    .family = "Disney diffuse",
                    .formula = "1.25/pi (S (1/(N.L + N.V) - 1/2) + 1/2), S = (1 + (d-1)(1-N.L)^5) (1 + "
                               "(d-1)(1-N.V)^5), d = rough (L.H)^2",
                    .source = "Burley 2012, section 5.3 and the published shader (subsurface = 1), after Hanrahan and "
                              "Krueger 1993, at base colour 1. Albedo up to 1.52 at grazing angles",
                    .parameters = {{"rough", "1", 0, 1, std::nullopt, "roughness"}},
                    .traits = {.conserves_energy = false}},
          .kernel = "disney_subsurface",
          .typical = {0.5},
          .coefficients =
              [](Values v) {
                return Coefficients{1.25 / pi, v[0]};
              },
          .proposal = draw::limb,
          .known = KnownValues{"disney_subsurface:rough=1",
                               {0.39788735772973838, 1},
                               {0.22121510854687818, 0.28685491034056299, 0.27680620002797957, 0.504072685483412}}};
}

}  // namespace lobe
