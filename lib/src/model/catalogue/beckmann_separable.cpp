#include "model/entry.hpp"
#include "model/family/beckmann.hpp"

namespace lobe {

CatalogueEntry beckmann_separable_entry() {
  return {
      .model = {.name = "beckmann_separable",
                .family = "Beckmann",
                .formula =
                    "D F G(N.L) G(N.V) / (4 N.L N.V), D = exp(-tan^2 delta/m^2) / (pi m^2 cos^4 delta), cos delta = "
                    "N.H, G(x) = 1/(1 + Lambda(x)), Lambda as in beckmann, F = f0 + (1-f0)(1-L.H)^5",
                .source = "Walter, Marschner, Li, Torrance 2007, eq. 23, 25 and 26 in the closed form of Smith 1967: "
                          "the separable attenuation, which loses more light than that of beckmann; m is the alpha of "
                          "Walter; F = 1 by default, else Schlick's approximation",
                .parameters = {roughness(), normal_reflectance()},
                .traits = {}},
      .kernel = "beckmann_separable",
      .typical = {0.15, 1},
      .coefficients = beckmann_coefficients_with_schlick,
      .shape = [](Values v) -> LobeShape { return {.width = std::min(1.0, v[0])}; },
      .proposal = draw::beckmann_facets,
      .known = KnownValues{
          "beckmann_separable:m=0.3,f0=0.04",
          {0.88419412828830746, -11.111111111111111, 0.040000000000000001, 0.95999999999999996, 0.29999999999999999},
          {0.041489538710284629, 6.9998949822981988e-05, 0.00032466244825950517, 1.1719522786881915}}};
}

}  // namespace lobe
