#include "model/entry.hpp"

namespace lobe {

CatalogueEntry p_model_entry() {
  return {.model = {.name = "p_model",
                    .family = "p-model",
                    .formula = "(n+2)/(2 pi) max(0, R.V)^n / max(N.L, N.V)^p",
                    .source = "Neumann 2001, eq. 3.12: from Phong (p = 0) to metal Phong (p = 1); for n < 1.62 the "
                              "albedo exceeds 1 at p = 1 as that of metal_phong. That it does not for p <= 0.98 holds "
                              "for n >= 1; for n near 0 it does for p > 0.5",
                    .parameters = {exponent(), {"p", "1", 0, 1, std::nullopt, "share of the metallic correction"}},
                    .traits = {.conserves_energy = false}},
          .kernel = "p_model",
          .typical = {40, 0.4},
          .coefficients =
              [](Values v) {
                return Coefficients{cosine_lobe_constant(v[0]), v[0], v[1]};
              },
          .shape = [](Values v) -> LobeShape {
            return {.width = mirror_lobe_width(v[0]), .common = {.mirror_cosine = v[0] < kSmoothOrder}};
          },
          .proposal = draw::mirror_power,
          .known = KnownValues{"p_model:n=1,p=0.5",
                               {0.47746482927568601, 1, 0.5},
                               {0.49232176861718374, 0.15973272956247681, 0.12944020647256968, 0.79158353937779258}}};
}

}  // namespace lobe
