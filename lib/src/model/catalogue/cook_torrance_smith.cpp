#include "model/entry.hpp"

namespace lobe {

CatalogueEntry cook_torrance_smith_entry() {
  return {
      .model = {.name = "cook_torrance_smith",
                .family = "Cook-Torrance",
                .formula =
                    "exp(-tan^2 delta/m^2) / (4 pi m^2 cos^4 delta) G(N.L) G(N.V) F / (N.L N.V), cos delta = N.H, G(x) "
                    "= g/(g+1), g = sqrt(pi h) (2 - erfc(sqrt h)), h = x^2 / (m^2 (1-x^2)), F = f0 + (1-f0)(1-L.H)^5",
                .source = "Neumann 2001, eq. 1.35, 1.36 and 1.38 (Smith 1967 in the form of He et al. 1991), F = 1 by "
                          "default, else Schlick's approximation. The h of the text has 2 m^2 for the rms slope in one "
                          "direction, which is m/sqrt(2) of the m of (1.36)",
                .parameters = {roughness(), normal_reflectance()},
                .traits = {}},
      .kernel = "cook_torrance_smith",
      .typical = {0.15, 1},
      .coefficients =
          [](Values v) {
            return Coefficients{1 / (4 * pi * v[0] * v[0]), -1 / (v[0] * v[0]), v[1], 1 - v[1], v[0]};
          },
      .shape = [](Values v) -> LobeShape { return {.width = std::min(1.0, v[0])}; },
      .proposal = draw::beckmann_facets,
      .known =
          KnownValues{"cook_torrance_smith:m=0.3,f0=0.04",
                      {0.88419412828830746, -11.111111111111111, 0.040000000000000001, 0.95999999999999996,
                       0.29999999999999999},
                      {0.038286233754407401, 5.9044328142926357e-05, 0.00027366852384704595, 0.77041982374809281}}};
}

}  // namespace lobe
