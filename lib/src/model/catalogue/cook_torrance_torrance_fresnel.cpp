#include "model/entry.hpp"

namespace lobe {

CatalogueEntry cook_torrance_torrance_fresnel_entry() {
  return {
      .model = {.name = "cook_torrance_torrance_fresnel",
                .family = "Cook-Torrance",
                .formula = "C(m) exp(-delta^2/m^2) G F(ior, k, L.H) / (N.L N.V), cos delta = N.H, G and F as in "
                           "cook_torrance_fresnel",
                .source = "Neumann 2001, eq. 1.35, 1.37 and 1.41 to 1.43 with the distribution of Torrance and Sparrow "
                          "1967, s = 1/m, normalised",
                .parameters = {facet_angle(), refractive_index(), extinction()},
                .traits = {}},
      .kernel = "cook_torrance_torrance_fresnel",
      .typical = {0.15, 1.58, 0},
      .coefficients =
          [](Values v) {
            return Coefficients{gaussian_facets_constant(v[0]), -1 / (v[0] * v[0]), v[1], v[2]};
          },
      .shape = [](Values v) -> LobeShape {
        return {.width = std::min(1.0, v[0]), .kinks = critical_kinks(v[1], v[2]), .common = {.attenuation = true}};
      },
      .proposal = draw::gaussian_facets,
      .known = KnownValues{"cook_torrance_torrance_fresnel:m=0.3,ior=1.5,k=0",
                           {0.93852979448174889, -11.111111111111111, 1.5},
                           {0.044354626366066296, 0.00031805574354838533, 0.00063529669472805485, 1.3601043952216396}}};
}

}  // namespace lobe
