#include "model/entry.hpp"

namespace lobe {

CatalogueEntry low_smooth_entry() {
  return {.model = {.name = "low_smooth",
                    .family = "Low",
                    .formula = "A / (1 + B |V_P-L'_P|^2)^C F(ior, cos theta'), sin theta' = |V_P-L_P|/2, F Fresnel's "
                               "equations for the refractive index ior",
                    .source = "Low, Kronander, Ynnerman, Unger 2012, eq. 12 with 10 and 14, smooth-surface model with "
                              "G = 1; A is the peak, the model is not normalised, so the albedo may have any size",
                    .parameters = {{"A", "1/sr", 0, 1e6, std::nullopt, "peak"},
                                   {"B", "1", 0, 1e8, std::nullopt, "larger is sharper"},
                                   {"C", "1", 0.01, 10, std::nullopt, "larger falls off faster"},
                                   {"ior", "1", 1, 100, 1.5, "refractive index"}},
                    .traits = {.conserves_energy = false}},
          .kernel = "low_smooth",
          .typical = {1, 100, 2, 1.5},
          .coefficients =
              [](Values v) {
                return Coefficients{v[0], v[1], -v[2], v[3]};
              },
          .shape = [](Values v) -> LobeShape { return {.width = std::min(1.0, std::sqrt(0.25 / v[1]))}; },
          .proposal = [](Values v, const draw::Scene& scene) -> draw::Parts {
            const double b = v[1];
            const double c = v[2];
            return {draw::patch_mixture(
                draw::mirror_of(scene.light), v,
                [b, c](double distance) { return std::exp(-c * std::log1p(b * distance * distance)); },
                1 / std::sqrt(1 + b))};
          },
          .known = KnownValues{"low_smooth:A=0.9966,B=7.105873,C=0.04552,ior=1.34257",
                               {0.99660000000000004, 7.1058729999999999, -0.045519999999999998, 1.34257},
                               {0.021722584165139863, 0.019483330316066496, 0.019423303578721924, 0.1367484574748398}}};
}

}  // namespace lobe
