#include "model/entry.hpp"
#include "model/family/trowbridge.hpp"

namespace lobe {

CatalogueEntry cook_torrance_trowbridge_fresnel_entry() {
  return {
      .model = {.name = "cook_torrance_trowbridge_fresnel",
                .family = "Cook-Torrance",
                .formula = "q^2 / (4 pi (1+(q^2-1) cos^2 delta)^2) G F(ior, k, L.H) / (N.L N.V), cos delta = N.H, G "
                           "and F as in cook_torrance_fresnel",
                .source = "Neumann 2001, eq. 1.35, 1.37 and 1.41 to 1.43 with the distribution of Trowbridge and Reitz "
                          "1975, normalised",
                .parameters = {axis_ratio(), refractive_index(), extinction()},
                .traits = {}},
      .kernel = "cook_torrance_trowbridge_fresnel",
      .typical = {0.2, 1.58, 0},
      .coefficients = trowbridge_coefficients_with_fresnel,
      .shape = [](Values v) -> LobeShape {
        return {.width = v[0], .kinks = critical_kinks(v[1], v[2]), .common = {.attenuation = true}};
      },
      .proposal = draw::trowbridge_facets,
      .known = KnownValues{"cook_torrance_trowbridge_fresnel:q=0.01,ior=0.331,k=2.324",
                           {7.9577471545947669e-06, 0.0001, 0.33100000000000002, 2.3239999999999998},
                           {0.22889105955510342, 7.7182633809251116e-05, 8.7435395643462808e-05, 3.5658671008943257}}};
}

}  // namespace lobe
