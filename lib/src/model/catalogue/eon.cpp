#include "model/entry.hpp"
#include "model/family/rough_diffuse.hpp"

namespace lobe {

CatalogueEntry eon_entry() {
  return {
      .model = {.name = "eon",
                .family = "Oren-Nayar",
                .formula = "rho f + m/pi (1-E(N.L)) (1-E(N.V)) / (1-E), f, E(x) and E the model fon, its albedo "
                           "and its mean albedo, m = rho^2 E / (1 - rho (1-E))",
                .source = "Portsmouth, Kutz, Hill 2025 (EON): fon with what scatters between facets more than once; "
                          "albedo rho E(x) + m (1-E(x)), 1 at all angles for rho = 1",
                .parameters = {{"r", "1", 0, 1, std::nullopt, "roughness"},
                               {"rho", "1", 0, 1, 1.0, "reflectance of the facets"}},
                .traits = {}},
      .kernel = "eon",
      .typical = {0.5, 0.8},
      .coefficients =
          [](Values v) {
            const double r = v[0];
            const double rho = v[1];
            const double first = fujii_constant(r);
            const double left = first * r * kFujiiRest;  // 1 - E
            const double multiple = rho * rho * (1 - left) / (1 - rho * left);
            return Coefficients{rho * first / pi, r, multiple * first * r / (pi * kFujiiRest)};
          },
      .proposal = draw::diffuse,
      .known = KnownValues{"eon:r=0.7,rho=0.4",
                           {0.10597476686170164, 0.69999999999999996, 0.12689708828477492},
                           {0.10230374289738459, 0.13046841245922064, 0.12505262332437975, 0.042161070741958045}}};
}

}  // namespace lobe
