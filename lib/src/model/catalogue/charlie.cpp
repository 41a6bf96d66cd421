#include "model/entry.hpp"

namespace lobe {

CatalogueEntry charlie_entry() {
  return {
      .model = {.name = "charlie",
                .family = "sheen",
                .formula = "D / (4 (N.L + N.V - N.L N.V)), D = (2 + 1/alpha) sin^(1/alpha)(delta) / (2 pi), cos delta "
                           "= N.H",
                .source = "Estevez, Kulla 2017 (D, \"Charlie\"), with the attenuation of Neubelt, Pettineo 2013 as in "
                          "the specification of KHR_materials_sheen, where alpha is the roughness squared. Albedo up "
                          "to 4 at grazing angles for alpha = 0.01",
                .parameters = {{"alpha", "1", 1e-3, 1, std::nullopt, "roughness; smaller is nearer to grazing"}},
                .traits = {.conserves_energy = false}},
      .kernel = "charlie",
      .typical = {0.5},
      .coefficients =
          [](Values v) {
            return Coefficients{(2 + 1 / v[0]) / (8 * pi), 1 / (2 * v[0])};
          },
      .shape = [](Values v) -> LobeShape { return {.width = std::clamp(std::sqrt(v[0]), 0.05, 1.0)}; },
      .proposal = draw::limb,
      .known =
          KnownValues{"charlie:alpha=0.5",
                      {0.15915494309189535, 1},
                      {0.00093565091931929897, 0.073446066648067812, 0.058876811083976667, 0.0011132453477337152}}};
}

}  // namespace lobe
