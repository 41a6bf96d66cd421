#include "model/entry.hpp"

namespace lobe {

CatalogueEntry disney_diffuse_entry() {
  return {.model = {.name = "disney_diffuse",
                    .family = "Disney diffuse",
                    .formula = "1/pi (1 + (d-1)(1-N.L)^5) (1 + (d-1)(1-N.V)^5), d = 0.5 + 2 rough (L.H)^2",
                    .source = "Burley 2012, section 5.3: diffuse part of the principled model at base colour 1. Albedo "
                              "up to 1.56 at grazing angles",
                    .parameters = {{"rough", "1", 0, 1, std::nullopt, "roughness"}},
                    .traits = {.conserves_energy = false}},
          .kernel = "disney_diffuse",
          .typical = {0.5},
          .coefficients =
              [](Values v) {
                return Coefficients{1 / pi, 2 * v[0]};
              },
          .proposal = draw::diffuse,
          .known = KnownValues{"disney_diffuse:rough=1",
                               {0.31830988618379069, 2},
                               {0.31832084870151373, 0.32143740405811366, 0.33568462360220752, 0.29672917045150082}}};
}

}  // namespace lobe
