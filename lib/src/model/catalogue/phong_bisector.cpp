#include "model/entry.hpp"

namespace lobe {

CatalogueEntry phong_bisector_entry() {
  return {.model =
              {.name = "phong_bisector",
               .family = "metal Phong",
               .formula = "c(n) max(0, R.V)^n / N.B, B = (R+V)/|R+V|, N.B = (N.L+N.V) / sqrt(2 (1+R.V))",
               .source =
                   "Neumann 2001, eq. 5.15 and 5.17 with the natural bisecting point of R and V on the sphere (5.2.3); "
                   "c = 1/(2 pi int_0^1 x^n sqrt((1+x)/2) dx) makes the largest albedo, at grazing incidence, 1 (5.9)",
               .parameters = {exponent()},
               .traits = {}},
          .kernel = "phong_bisector",
          .typical = {40},
          .coefficients =
              [](Values v) {
                return Coefficients{std::numbers::sqrt2 * phong_bisector_constant(v[0]), v[0]};
              },
          .shape = [](Values v) -> LobeShape {
            return {.width = mirror_lobe_width(v[0]), .common = {.mirror_cosine = v[0] < kSmoothOrder}};
          },
          .proposal = draw::mirror_power,
          .known = KnownValues{"phong_bisector:n=1",
                               {0.4944310196053589, 1},
                               {0.38370140412332832, 0.11862255709927354, 0.1042412458858907, 1.0292035119424796}}};
}

}  // namespace lobe
