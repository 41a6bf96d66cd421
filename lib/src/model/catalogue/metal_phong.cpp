#include "model/entry.hpp"

namespace lobe {

CatalogueEntry metal_phong_entry() {
  return {.model = {.name = "metal_phong",
                    .family = "metal Phong",
                    .formula = "(n+2)/(2 pi) max(0, R.V)^n / max(N.L, N.V)",
                    .source = "Neumann 2001, eq. 3.7: cos-max metallic Phong; for n < 1.62 the albedo exceeds 1, by "
                              "0.0003 for n = 1, 0.011 for n = 0.5, 0.086 for n near 0",
                    .parameters = {exponent()},
                    .traits = {.conserves_energy = false}},
          .kernel = "metal_phong",
          .typical = {40},
          .coefficients =
              [](Values v) {
                return Coefficients{cosine_lobe_constant(v[0]), v[0]};
              },
          .shape = [](Values v) -> LobeShape {
            return {.width = mirror_lobe_width(v[0]), .common = {.mirror_cosine = v[0] < kSmoothOrder}};
          },
          .proposal = draw::mirror_power,
          .known = KnownValues{"metal_phong:n=5",
                               {1.1140846016432675, 5},
                               {1.1478602622783334, 0.0031227596383814615, 0.0015828530365113601, 3.0436965548456016}}};
}

}  // namespace lobe
