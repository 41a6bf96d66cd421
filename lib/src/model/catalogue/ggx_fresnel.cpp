#include "model/entry.hpp"
#include "model/family/trowbridge.hpp"

namespace lobe {

CatalogueEntry ggx_fresnel_entry() {
  return {
      .model = {.name = "ggx_fresnel",
                .family = "GGX",
                .formula = "D F(ior, k, L.H) / (2 (N.L sqrt(a^2+(1-a^2)(N.V)^2) + N.V sqrt(a^2+(1-a^2)(N.L)^2))), D = "
                           "a^2 / (pi (1+(a^2-1) cos^2 delta)^2), cos delta = N.H, a = alpha, F Fresnel's equations "
                           "for the refractive index ior - ik",
                .source = "Walter, Marschner, Li, Torrance 2007, eq. 33 and 34, with the height-correlated attenuation "
                          "of Smith (Heitz 2014, eq. 99); F of Neumann 2001, eq. 1.41 to 1.43, the squares as |.|^2",
                .parameters = {ggx_roughness(), refractive_index(), extinction()},
                .traits = {}},
      .kernel = "ggx_fresnel",
      .typical = {0.2, 1.58, 0},
      .coefficients = trowbridge_coefficients_with_fresnel,
      .shape = [](Values v) -> LobeShape { return {.width = v[0], .kinks = critical_kinks(v[1], v[2])}; },
      .proposal = draw::trowbridge_facets,
      .known = KnownValues{"ggx_fresnel:alpha=0.5,ior=1.39,k=4.32",
                           {0.019894367886486918, 0.25, 1.3899999999999999, 4.3200000000000003},
                           {0.28500692393668087, 0.089104508454751999, 0.10427423700379251, 1.1602520536427334}}};
}

}  // namespace lobe
