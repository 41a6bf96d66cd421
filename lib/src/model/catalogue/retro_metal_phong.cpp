#include "model/entry.hpp"

namespace lobe {

CatalogueEntry retro_metal_phong_entry() {
  return {
      .model = {.name = "retro_metal_phong",
                .family = "retro metal Phong",
                .formula = "(n+2)/(2 pi) max(0, L.V)^n / max(N.L, N.V)",
                .source = "Neumann 2001, eq. 3.13: retro-reflecting cos-max Phong; for n < 1.62 the albedo exceeds 1 "
                          "as that of metal_phong",
                .parameters = {{"n", "1", 1e-3, 1e5, std::nullopt, "exponent; larger is sharper"}},
                .traits = {.conserves_energy = false}},
      .kernel = "retro_metal_phong",
      .typical = {40},
      .coefficients =
          [](Values v) {
            return Coefficients{cosine_lobe_constant(v[0]), v[0]};
          },
      .shape = [](Values v) -> LobeShape { return {.retro_width = retro_lobe_width(v[0])}; },
      .proposal = [](Values v, const draw::Scene& scene) -> draw::Parts { return {draw::power(scene.light, v[0])}; },
      .known = KnownValues{"retro_metal_phong:n=20",
                           {3.5014087480216975, 20},
                           {0.000335543206821105, 0.0010691344386377735, 0.00025761904397053506, 0}}};
}

}  // namespace lobe
