#include "model/entry.hpp"

namespace lobe {

CatalogueEntry cook_torrance_blinn_entry() {
  return {
      .model = {.name = "cook_torrance_blinn",
                .family = "Cook-Torrance",
                .formula = "(n+2)/(8 pi) cos^n delta G F / (N.L N.V), cos delta = N.H, G = min(1, 2 N.H N.L/L.H, 2 N.H "
                           "N.V/L.H), F = f0 + (1-f0)(1-L.H)^5",
                .source = "Neumann 2001, eq. 1.35 and 1.37 with Blinn's distribution (Blinn 1977), normalised; F = 1 "
                          "by default, else Schlick's approximation",
                .parameters = {exponent(), normal_reflectance()},
                .traits = {}},
      .kernel = "cook_torrance_blinn",
      .typical = {40, 1},
      .coefficients =
          [](Values v) {
            return Coefficients{(v[0] + 2) / (8 * pi), v[0], v[1], 1 - v[1]};
          },
      .shape = [](Values v) -> LobeShape { return {.width = half_lobe_width(v[0]), .common = {.attenuation = true}}; },
      .proposal = draw::power_facets_with_cosine,
      .known = KnownValues{"cook_torrance_blinn:n=20,f0=0.04",
                           {0.87535218700542439, 20, 0.040000000000000001, 0.95999999999999996},
                           {0.040869762186827627, 0.00031506660290284735, 0.00066435964749142061, 1.1832570580890944}}};
}

}  // namespace lobe
