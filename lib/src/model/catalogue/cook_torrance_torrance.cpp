#include "model/entry.hpp"

namespace lobe {

CatalogueEntry cook_torrance_torrance_entry() {
  return {
      .model = {.name = "cook_torrance_torrance",
                .family = "Cook-Torrance",
                .formula = "C(m) exp(-delta^2/m^2) G F / (N.L N.V), cos delta = N.H, G = min(1, 2 N.H N.L/L.H, 2 N.H "
                           "N.V/L.H), F = f0 + (1-f0)(1-L.H)^5",
                .source = "Neumann 2001, eq. 1.35 and 1.37 with the distribution of Torrance and Sparrow 1967, s = "
                          "1/m, normalised; F = 1 by default, else Schlick's approximation",
                .parameters = {facet_angle(), normal_reflectance()},
                .traits = {}},
      .kernel = "cook_torrance_torrance",
      .typical = {0.15, 1},
      .coefficients =
          [](Values v) {
            return Coefficients{gaussian_facets_constant(v[0]), -1 / (v[0] * v[0]), v[1], 1 - v[1]};
          },
      .shape = [](Values v) -> LobeShape { return {.width = std::min(1.0, v[0]), .common = {.attenuation = true}}; },
      .proposal = draw::gaussian_facets,
      .known = KnownValues{"cook_torrance_torrance:m=0.3,f0=0.04",
                           {0.93852979448174889, -11.111111111111111, 0.040000000000000001, 0.95999999999999996},
                           {0.043538866967206873, 0.00031324390257814725, 0.00062316533417094738, 1.2631397794039039}}};
}

}  // namespace lobe
