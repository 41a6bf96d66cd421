#include "model/entry.hpp"
#include "model/family/trowbridge.hpp"

namespace lobe {

CatalogueEntry ggx_separable_entry() {
  return {
      .model = {.name = "ggx_separable",
                .family = "GGX",
                .formula = "D F G(N.L) G(N.V), D = a^2 / (pi (1+(a^2-1) cos^2 delta)^2), cos delta = N.H, G(x) = "
                           "1/(x + sqrt(a^2+(1-a^2) x^2)), F = f0 + (1-f0)(1-L.H)^5, a = alpha",
                .source =
                    "Walter, Marschner, Li, Torrance 2007, eq. 20, 33 and 34: the separable attenuation of Smith, "
                    "which loses more light than that of ggx; F = 1 by default, else Schlick's approximation",
                .parameters = {ggx_roughness(), normal_reflectance()},
                .traits = {}},
      .kernel = "ggx_separable",
      .typical = {0.2, 1},
      .coefficients =
          [](Values v) {
            Coefficients c = trowbridge_coefficients_with_schlick(v);
            c[0] *= 4;
            return c;
          },
      .shape = [](Values v) -> LobeShape { return {.width = v[0]}; },
      .proposal = draw::trowbridge_facets,
      .known = KnownValues{"ggx_separable:alpha=0.05,f0=0.04",
                           {0.00079577471545947689, 0.0025000000000000005, 0.040000000000000001, 0.95999999999999996},
                           {0.14263882292309651, 9.392847734043599e-05, 0.00013225810196311046, 6.6985325406925433}}};
}

}  // namespace lobe
