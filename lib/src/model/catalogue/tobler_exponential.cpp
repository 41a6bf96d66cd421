#include "model/entry.hpp"

namespace lobe {

CatalogueEntry tobler_exponential_entry() {
  return {.model = {.name = "tobler_exponential",
                    .family = "Tobler",
                    .formula = "2 s / (pi (1-e^(-2s))) exp(-s (1-R_S.V_S)), X_S = 2 (N.X) X - N",
                    .source = "Neumann 2001, eq. 1.72 (Tobler, Neumann, Sbert, Purgathofer 1998), which lacks the "
                              "factor 2/pi: of albedo 1 for every direction",
                    .parameters = {{"s", "1", 1e-3, 1e6, std::nullopt, "decay; larger is sharper"}},
                    .traits = {}},
          .kernel = "tobler_exponential",
          .typical = {10},
          .coefficients =
              [](Values v) {
                return Coefficients{2 * v[0] / (-pi * std::expm1(-2 * v[0])), -v[0]};
              },
          .shape = [](Values v) -> LobeShape { return {.width = std::min(1.0, mirror_lobe_width(4 * v[0]))}; },
          .proposal = [](Values v, const draw::Scene& scene) -> draw::Parts {
            // exp(-s (1-x)) is about x^s; half of the inner sphere is beyond that.
            return {draw::with_share(0.8, draw::power(draw::inner_mirror(scene.light), v[0], true)),
                    draw::with_share(0.2, draw::cosine())};
          },
          .known = KnownValues{"tobler_exponential:s=0.01",
                               {0.32150359530443318, -0.01},
                               {0.32138316952926971, 0.31707714071538573, 0.31559368145729677, 0.32148640996050448}}};
}

}  // namespace lobe
