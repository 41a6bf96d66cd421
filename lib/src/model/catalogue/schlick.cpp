#include "model/entry.hpp"

namespace lobe {

CatalogueEntry schlick_entry() {
  return {
      .model = {.name = "schlick",
                .family = "Schlick",
                .formula = "r / (4 pi (1-(1-r)(N.H)^2)^2 (r+(1-r) N.L) (r+(1-r) N.V))",
                .source =
                    "Neumann 2001, eq. 1.49 and 1.50 with A = 1 (Schlick 1994), isotropic. For r < 0.169510 the albedo "
                    "at grazing angles exceeds 1 (r = 0.01: 4.80, r = 0.001: 15.6); r = 1 is Lambert of albedo 1/4",
                .parameters = {{"r", "1", 1e-10, 1, std::nullopt, "roughness; smaller is sharper"}},
                .traits = {.conserves_energy = false}},
      .kernel = "schlick",
      .typical = {0.05},
      .coefficients =
          [](Values v) {
            return Coefficients{v[0] / (4 * pi), v[0], 1 - v[0]};
          },
      .shape = [](Values v) -> LobeShape { return {.width = std::sqrt(v[0])}; },
      .proposal = draw::schlick_facets,
      .known = KnownValues{"schlick:r=0.2",
                           {0.015915494309189534, 0.20000000000000001, 0.80000000000000004},
                           {0.44963109896550885, 0.097736147509480231, 0.11835349422146151, 1.7405769868923524}}};
}

}  // namespace lobe
