#include "model/entry.hpp"

namespace lobe {

CatalogueEntry cook_torrance_entry() {
  return {
      .model = {.name = "cook_torrance",
                .family = "Cook-Torrance",
                .formula = "exp(-tan^2 delta/m^2) / (4 pi m^2 cos^4 delta) G F / (N.L N.V), cos delta = N.H, G = "
                           "min(1, 2 N.H N.L/L.H, 2 N.H N.V/L.H), F = f0 + (1-f0)(1-L.H)^5",
                .source = "Neumann 2001, eq. 2.9 and 2.10 (Cook and Torrance 1982); F = 1 by default, else "
                          "Schlick's approximation. Contrary to section 2.2 of the text its albedo is bounded by 1",
                .parameters = {roughness(), normal_reflectance()},
                .traits = {}},
      .kernel = "cook_torrance",
      .typical = {0.15, 1},
      .coefficients =
          [](Values v) {
            return Coefficients{1 / (4 * pi * v[0] * v[0]), -1 / (v[0] * v[0]), v[1], 1 - v[1]};
          },
      .shape = [](Values v) -> LobeShape { return {.width = std::min(1.0, v[0]), .common = {.attenuation = true}}; },
      .proposal = draw::beckmann_facets,
      .known =
          KnownValues{"cook_torrance:m=0.5,f0=0.001",
                      {0.31830988618379069, -4, 0.001, 0.999},
                      {0.0003927228408433198, 0.00011013063891035277, 0.00014351206935767603, 0.34982981997905915}}};
}

}  // namespace lobe
