#include "model/entry.hpp"

namespace lobe {

CatalogueEntry patch_power_entry() {
  return {
      .model = {.name = "patch_power",
                .family = "power patch",
                .formula = "(n+1)(n+2)/(2 pi) max(0, 1-|V_P-L'_P|)^n",
                .source = "Neumann 2001, eq. 5.12: patch-based BRDF with the profile of a power",
                .parameters = {{"n", "1", 0.01, 1e6, std::nullopt, "exponent; larger is sharper"}},
                .traits = {}},
      .kernel = "patch_power",
      .typical = {40},
      .coefficients =
          [](Values v) {
            return Coefficients{(v[0] + 1) * (v[0] + 2) / (2 * pi), v[0]};
          },
      .shape = [](Values v) -> LobeShape {
        return {.width = std::min(1.0, 1 / (2 * v[0])),
                .patch_radius = 1.0,
                .has_fractional_edge = v[0] < kSmoothOrder && v[0] != std::floor(v[0])};
      },
      .proposal = [](Values v, const draw::Scene& scene) -> draw::Parts {
        const double n = v[0];
        return {draw::patch_mixture(
            draw::mirror_of(scene.light), v,
            [n](double distance) { return distance < 1 ? std::exp(n * std::log1p(-distance)) : 0; }, 1 / n)};
      },
      .known =
          KnownValues{"patch_power:n=20", {73.529583708455647, 20}, {3.8037592508390579, 0, 0, 30.767084290549722}}};
}

}  // namespace lobe
