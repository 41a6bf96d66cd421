#include "model/entry.hpp"

namespace lobe {

CatalogueEntry cook_torrance_smith_fresnel_entry() {
  return {
      .model = {.name = "cook_torrance_smith_fresnel",
                .family = "Cook-Torrance",
                .formula =
                    "exp(-tan^2 delta/m^2) / (4 pi m^2 cos^4 delta) G(N.L) G(N.V) F(ior, k, L.H) / (N.L N.V), cos "
                    "delta = N.H, G as in cook_torrance_smith, F Fresnel's equations for the refractive index ior - ik",
                .source = "Neumann 2001, eq. 1.35, 1.36 and 1.38 as in cook_torrance_smith, 1.41 to 1.43",
                .parameters = {roughness(), refractive_index(), extinction()},
                .traits = {}},
      .kernel = "cook_torrance_smith_fresnel",
      .typical = {0.15, 1.58, 0},
      .coefficients =
          [](Values v) {
            return Coefficients{1 / (4 * pi * v[0] * v[0]), -1 / (v[0] * v[0]), v[1], v[2], v[0]};
          },
      .shape = [](Values v) -> LobeShape {
        return {.width = std::min(1.0, v[0]), .kinks = critical_kinks(v[1], v[2])};
      },
      .proposal = draw::beckmann_facets,
      .known =
          KnownValues{"cook_torrance_smith_fresnel:m=0.3,ior=1.5,k=0",
                      {0.88419412828830746, -11.111111111111111, 1.5, 0, 0.29999999999999999},
                      {0.039003577985152096, 5.9951327177480382e-05, 0.00027899611727028533, 0.82956091283908417}}};
}

}  // namespace lobe
