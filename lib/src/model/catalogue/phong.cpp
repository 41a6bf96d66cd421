#include "model/entry.hpp"

namespace lobe {

CatalogueEntry phong_entry() {
  return {
      .model =
          {.name = "phong",
           .family = "Phong",
           .formula = "(n+2)/(2 pi) max(0, R.V)^n",
           .source =
               "Neumann 2001, eq. 1.33: reciprocal Phong; the constant is (n+2)/(2 pi), not the printed (k+2)/(2 pi)",
           .parameters = {exponent()},
           .traits = {}},
      .kernel = "phong",
      .typical = {40},
      .coefficients =
          [](Values v) {
            return Coefficients{cosine_lobe_constant(v[0]), v[0]};
          },
      .shape = [](Values v) -> LobeShape {
        return {.width = mirror_lobe_width(v[0]), .common = {.mirror_cosine = v[0] < kSmoothOrder}};
      },
      .proposal = draw::mirror_power,
      .known = KnownValues{"phong:n=0.5",
                           {0.39788735772973838, 0.5},
                           {0.39580936389960064, 0.21521838215245537, 0.20612845136507607, 0.39748634557093721}}};
}

}  // namespace lobe
