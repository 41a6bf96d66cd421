#include "model/entry.hpp"

namespace lobe {

CatalogueEntry cook_torrance_fresnel_entry() {
  return {
      .model = {.name = "cook_torrance_fresnel",
                .family = "Cook-Torrance",
                .formula =
                    "exp(-tan^2 delta/m^2) / (4 pi m^2 cos^4 delta) G F(ior, k, L.H) / (N.L N.V), cos delta = N.H, G = "
                    "min(1, 2 N.H N.L/L.H, 2 N.H N.V/L.H), F Fresnel's equations for the refractive index ior - ik",
                .source =
                    "Neumann 2001, eq. 1.35 to 1.37 and 1.41 to 1.43 (Cook and Torrance 1982); the exponent of (1.36), "
                    "printed inverted, and its constant as in eq. 2.9, the squares of (1.41) and (1.42) as |.|^2",
                .parameters = {roughness(), refractive_index(), extinction()},
                .traits = {}},
      .kernel = "cook_torrance_fresnel",
      .typical = {0.15, 1.58, 0},
      .coefficients =
          [](Values v) {
            return Coefficients{1 / (4 * pi * v[0] * v[0]), -1 / (v[0] * v[0]), v[1], v[2]};
          },
      .shape = [](Values v) -> LobeShape {
        return {.width = std::min(1.0, v[0]), .kinks = critical_kinks(v[1], v[2]), .common = {.attenuation = true}};
      },
      .proposal = draw::beckmann_facets,
      .known = KnownValues{"cook_torrance_fresnel:m=0.5,ior=2.97,k=4.58",
                           {0.31830988618379069, -4, 2.9700000000000002, 4.5800000000000001},
                           {0.26304394362061562, 0.074024541038343813, 0.096039956128045112, 1.7155215740099516}}};
}

}  // namespace lobe
