#include "model/entry.hpp"

namespace lobe {

CatalogueEntry phong_mean_entry() {
  return {
      .model = {.name = "phong_mean",
                .family = "metal Phong",
                .formula = "(n+2)/(2 pi) max(0, R.V)^n / mean_p(N.L, N.V), mean_p(x, y) = ((x^p + y^p)/2)^(1/p)",
                .source = "Neumann 2001, eq. 5.17; p = 0 is the geometric mean, p = -1 the harmonic one (5.18, printed "
                          "inverted). The albedo exceeds 1: for p >= 1 by at most 1/(n+1), at grazing angles for p = 0 "
                          "as (N.L)^-1/2, for p < 0 as 1/N.L, where norms are infinite",
                .parameters = {exponent(), {"p", "1", -1, 100, 1.0, "power of the mean"}},
                .traits = {.conserves_energy = false}},
      .kernel = "phong_mean",
      .typical = {40, 1},
      .coefficients =
          [](Values v) {
            return Coefficients{cosine_lobe_constant(v[0]), v[0], v[1], v[1] == 0 ? 1 : 1 / v[1]};
          },
      .shape = [](Values v) -> LobeShape {
        return {.width = mirror_lobe_width(v[0]),
                .has_infinite_norm = v[1] < 0,
                .common = {.mirror_cosine = v[0] < kSmoothOrder}};
      },
      .proposal = draw::mirror_power,
      .known = KnownValues{"phong_mean:n=1,p=1",
                           {0.47746482927568601, 1, 1, 1},
                           {0.52538555011907517, 0.20151386781241876, 0.178763972194904, 1.4062767173628206}}};
}

}  // namespace lobe
