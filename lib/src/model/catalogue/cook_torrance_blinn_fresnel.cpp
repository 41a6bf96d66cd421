#include "model/entry.hpp"

namespace lobe {

CatalogueEntry cook_torrance_blinn_fresnel_entry() {
  return {
      .model = {.name = "cook_torrance_blinn_fresnel",
                .family = "Cook-Torrance",
                .formula = "(n+2)/(8 pi) cos^n delta G F(ior, k, L.H) / (N.L N.V), cos delta = N.H, G and F as in "
                           "cook_torrance_fresnel",
                .source =
                    "Neumann 2001, eq. 1.35, 1.37 and 1.41 to 1.43 with Blinn's distribution (Blinn 1977), normalised",
                .parameters = {exponent(), refractive_index(), extinction()},
                .traits = {}},
      .kernel = "cook_torrance_blinn_fresnel",
      .typical = {40, 1.58, 0},
      .coefficients =
          [](Values v) {
            return Coefficients{(v[0] + 2) / (8 * pi), v[0], v[1], v[2]};
          },
      .shape = [](Values v) -> LobeShape {
        return {.width = half_lobe_width(v[0]), .kinks = critical_kinks(v[1], v[2]), .common = {.attenuation = true}};
      },
      .proposal = draw::power_facets_with_cosine,
      .known = KnownValues{"cook_torrance_blinn_fresnel:n=20,ior=1.5,k=0",
                           {0.87535218700542439, 20, 1.5},
                           {0.041635512307476509, 0.00031990644296269794, 0.00067729295103282131, 1.2740894963687106}}};
}

}  // namespace lobe
