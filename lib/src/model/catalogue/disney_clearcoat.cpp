#include "model/entry.hpp"

namespace lobe {

CatalogueEntry disney_clearcoat_entry() {
  return {.model = {.name = "disney_clearcoat",
                    .family = "Disney",
                    .formula =
                        "D F G(N.L) G(N.V) / 4, D = (a^2-1) / (2 pi ln(a) (1+(a^2-1) cos^2 delta)), cos delta = N.H, a "
                        "= 0.1 - 0.099 gloss, F = 0.04 + 0.96 (1-L.H)^5, G(x) = 1/(x + sqrt(b^2+(1-b^2) x^2)), b = 1/4",
                    .source = "Burley 2012, section 5.4: clearcoat of the principled model at full strength, gamma = "
                              "1; constants as in the published shader",
                    .parameters = {{"gloss", "1", 0, 1, std::nullopt, "larger is sharper"}},
                    .traits = {}},
          .kernel = "disney_clearcoat",
          .typical = {0.5},
          .coefficients =
              [](Values v) {
                const double a = 0.1 - 0.099 * v[0];
                return Coefficients{(a * a - 1) / (8 * pi * std::log(a)), a * a, 1.0 / 16};
              },
          .shape = [](Values v) -> LobeShape { return {.width = 0.1 - 0.099 * v[0]}; },
          .proposal = [](Values v, const draw::Scene& scene) -> draw::Parts {
            return draw::long_tail(scene.light, 0.1 - 0.099 * v[0]);
          },
          .known =
              KnownValues{"disney_clearcoat:gloss=0",
                          {0.017107228104227965, 0.010000000000000002, 0.0625},
                          {0.013329585196720693, 0.00081544693664713176, 0.00097757406690289462, 0.35113539310619779}}};
}

}  // namespace lobe
