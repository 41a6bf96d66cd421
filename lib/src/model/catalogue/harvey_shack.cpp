#include "model/entry.hpp"

namespace lobe {

CatalogueEntry harvey_shack_entry() {
  return {
      .model = {.name = "harvey_shack",
                .family = "stray light",
                .formula = "b (1 + (|V_P-L'_P|/l)^2)^(s/2)",
                .source =
                    "Harvey 1976, with the shoulder as in Pfisterer 2011: model of polished optical surfaces; "
                    "|V_P-L'_P| is the distance of V from the mirror direction in the base plane (4.1), there |beta "
                    "- beta_0|. No bound on the albedo",
                .parameters = {{"b", "sr^-1", 0, 1e12, std::nullopt, "peak"},
                               {"l", "1", 1e-5, 100, std::nullopt, "distance of the shoulder"},
                               {"s", "1", -6, 0, std::nullopt, "slope beyond the shoulder"}},
                .traits = {.conserves_energy = false}},
      .kernel = "harvey_shack",
      .typical = {1, 0.01, -1.5},
      .coefficients =
          [](Values v) {
            return Coefficients{v[0], 1 / (v[1] * v[1]), v[2] / 2};
          },
      .shape = [](Values v) -> LobeShape { return {.width = std::min(1.0, v[1] / 2)}; },
      .proposal = [](Values v, const draw::Scene& scene) -> draw::Parts {
        const double l = v[1];
        const double s = v[2];
        return {draw::patch_mixture(
            draw::mirror_of(scene.light), v,
            [l, s](double distance) { return std::exp(s / 2 * std::log1p(distance * distance / (l * l))); },
            std::min(1.0, l))};
      },
      .known =
          KnownValues{"harvey_shack:b=0.5,l=0.01,s=-1.5",
                      {0.5, 10000, -0.75},
                      {0.0097527775846846191, 0.00038964741091393023, 0.00043990810752767603, 0.054575056852719253}}};
}

}  // namespace lobe
