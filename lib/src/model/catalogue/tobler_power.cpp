#include "model/entry.hpp"

namespace lobe {
namespace {

std::vector<Kink> tobler_power_kinks(Values v) {
  if (v[0] >= kSmoothOrder) return {};
  // R_S.V_S, by the square of the distance in the base plane.
  const auto at = [](const Kink::Numbers&, const KinkPair& pair) {
    const double sum = pair.cos_i + pair.cos_o;
    const double difference = pair.cos_i - pair.cos_o;
    const double product = pair.cos_i * pair.cos_o;
    const double across2 = 2 * (1 + pair.cos_between) - sum * sum;
    return 1 - 2 * (difference * difference * (1 + product) + product * across2);
  };
  return {{at, {}, v[0]}};
}

}  // namespace

CatalogueEntry tobler_power_entry() {
  return {
      .model = {.name = "tobler_power",
                .family = "Tobler",
                .formula = "2 (n+1)/pi max(0, R_S.V_S)^n, X_S = 2 (N.X) X - N",
                .source = "Neumann 2001, eq. 1.71 (Tobler, Neumann, Sbert, Purgathofer 1998), which lacks the factor "
                          "2/pi: a cosine lobe on the sphere within the hemisphere, of albedo 1 for every direction",
                .parameters = {{"n", "1", 1e-3, 1e6, std::nullopt, "exponent; larger is sharper"}},
                .traits = {}},
      .kernel = "tobler_power",
      .typical = {40},
      .coefficients =
          [](Values v) {
            return Coefficients{2 * (v[0] + 1) / pi, v[0]};
          },
      .shape = [](Values v) -> LobeShape {
        return {.width = mirror_lobe_width(4 * v[0]),
                .has_fractional_edge = v[0] < kSmoothOrder && v[0] != std::floor(v[0]),
                .kinks = tobler_power_kinks(v)};
      },
      .proposal = [](Values v, const draw::Scene& scene) -> draw::Parts {
        return {draw::power(draw::inner_mirror(scene.light), v[0], true)};
      },
      .known = KnownValues{"tobler_power:n=0.3",
                           {0.82760570407785583, 0.29999999999999999},
                           {0.81817943668486981, 0, 0, 0.82627603685806594}}};
}

}  // namespace lobe
