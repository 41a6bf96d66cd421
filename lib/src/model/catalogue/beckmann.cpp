#include "model/family/beckmann.hpp"
#include "model/entry.hpp"

namespace lobe {

CatalogueEntry beckmann_entry() {
  return {
      .model = {.name = "beckmann",
                .family = "Beckmann",
                .formula =
                    "D F / (4 N.L N.V (1 + Lambda(N.L) + Lambda(N.V))), D = exp(-tan^2 delta/m^2) / (pi m^2 cos^4 "
                    "delta), cos delta = N.H, Lambda(x) = (exp(-a^2)/(a sqrt pi) - erfc(a))/2, a = x/(m "
                    "sqrt(1-x^2)), F = f0 + (1-f0)(1-L.H)^5",
                .source = "Walter, Marschner, Li, Torrance 2007, eq. 25 and 26 in the closed form of Smith 1967, "
                          "with his height-correlated attenuation (Heitz 2014, eq. 99); m is the alpha of Walter; "
                          "F = 1 by default, else Schlick's approximation",
                .parameters = {roughness(), normal_reflectance()},
                .traits = {}},
      .kernel = "beckmann",
      .typical = {0.15, 1},
      .coefficients = beckmann_coefficients_with_schlick,
      .shape = [](Values v) -> LobeShape { return {.width = std::min(1.0, v[0])}; },
      .proposal = draw::beckmann_facets,
      .known = KnownValues{
          "beckmann:m=0.3,f0=0.04",
          {0.88419412828830746, -11.111111111111111, 0.040000000000000001, 0.95999999999999996, 0.29999999999999999},
          {0.041489538710284629, 6.9998949822982123e-05, 0.00032466244825950517, 1.1720841414276881}}};
}

}  // namespace lobe
