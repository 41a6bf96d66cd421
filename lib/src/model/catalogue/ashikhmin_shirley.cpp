#include "model/entry.hpp"

namespace lobe {

CatalogueEntry ashikhmin_shirley_entry() {
  return {
      .model = {.name = "ashikhmin_shirley",
                .family = "Ashikhmin-Shirley",
                .formula = "(n+1)/(8 pi) (N.H)^n F / (L.H max(N.L, N.V)), F = f0 + (1-f0)(1-L.H)^5",
                .source = "Ashikhmin and Shirley 2000, specular term with equal exponents; F = 1 by default, else "
                          "Schlick's approximation.",
                .parameters = {exponent(), normal_reflectance()},
                .traits = {}},
      .kernel = "ashikhmin_shirley",
      .typical = {40, 1},
      .coefficients =
          [](Values v) {
            return Coefficients{(v[0] + 1) / (8 * pi), v[0], v[1], 1 - v[1]};
          },
      .shape = [](Values v) -> LobeShape { return {.width = half_lobe_width(v[0])}; },
      .proposal = draw::power_facets,
      .known = KnownValues{"ashikhmin_shirley:n=20,f0=0.04",
                           {0.83556345123245057, 20, 0.040000000000000001, 0.95999999999999996},
                           {0.037958029655482201, 0.00020530595706626746, 0.00039819206286855152, 1.0490067411599411}}};
}

}  // namespace lobe
