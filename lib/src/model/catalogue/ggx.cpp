#include "model/entry.hpp"
#include "model/family/trowbridge.hpp"

namespace lobe {

CatalogueEntry ggx_entry() {
  return {
      .model = {.name = "ggx",
                .family = "GGX",
                .formula = "D F / (2 (N.L sqrt(a^2+(1-a^2)(N.V)^2) + N.V sqrt(a^2+(1-a^2)(N.L)^2))), D = a^2 / (pi "
                           "(1+(a^2-1) cos^2 delta)^2), cos delta = N.H, F = f0 + (1-f0)(1-L.H)^5, a = alpha",
                .source = "Walter, Marschner, Li, Torrance 2007, eq. 33 and 34, with the height-correlated attenuation "
                          "of Smith (Heitz 2014, eq. 99); F = 1 by default, else Schlick's approximation",
                .parameters = {ggx_roughness(), normal_reflectance()},
                .traits = {}},
      .kernel = "ggx",
      .typical = {0.2, 1},
      .coefficients = trowbridge_coefficients_with_schlick,
      .shape = [](Values v) -> LobeShape { return {.width = v[0]}; },
      .proposal = draw::trowbridge_facets,
      .known = KnownValues{"ggx:alpha=0.05,f0=0.04",
                           {0.00019894367886486922, 0.0025000000000000005, 0.040000000000000001, 0.95999999999999996},
                           {0.14263882589381283, 9.3928518558121681e-05, 0.00013225811011843643, 6.6986863229713238}}};
}

}  // namespace lobe
