#include "model/entry.hpp"

namespace lobe {

CatalogueEntry abg_entry() {
  return {.model = {.name = "abg",
                    .family = "stray light",
                    .formula = "a / (b + |V_P-L'_P|^g)",
                    .source =
                        "Pfisterer 2011: ABg model of polished optical surfaces; |V_P-L'_P| is the distance of V from "
                        "the mirror direction in the base plane (4.1), there |beta - beta_0|. No bound on the albedo",
                    .parameters = {{"a", "sr^-1", 0, 1e6, std::nullopt, "A, scattering where |V_P-L'_P|^g is 1 - B"},
                                   {"b", "1", 1e-12, 100, std::nullopt, "B, where the peak becomes flat"},
                                   {"g", "1", 0, 6, std::nullopt, "power of the fall"}},
                    .traits = {.conserves_energy = false}},
          .kernel = "abg",
          .typical = {0.01, 0.001, 1.5},
          .coefficients =
              [](Values v) {
                return Coefficients{v[0], v[1], v[2] / 2};
              },
          .shape = [](Values v) -> LobeShape {
            return {.width = std::clamp(std::pow(v[1], 1 / std::max(v[2], 0.1)) / 2, 1e-6, 1.0)};
          },
          .proposal = [](Values v, const draw::Scene& scene) -> draw::Parts {
            const double b = v[1];
            const double g = v[2];
            return {draw::patch_mixture(
                draw::mirror_of(scene.light), v, [b, g](double distance) { return 1 / (b + std::pow(distance, g)); },
                std::clamp(std::pow(b, 1 / std::max(g, 0.1)), 1e-6, 1.0))};
          },
          .known = KnownValues{"abg:a=0.5,b=1e-5,g=1.5",
                               {0.5, 1.0000000000000001e-05, 0.75},
                               {9.7894439887170535, 0.38966533272954268, 0.43993205374869576, 56.748043272619569}}};
}

}  // namespace lobe
