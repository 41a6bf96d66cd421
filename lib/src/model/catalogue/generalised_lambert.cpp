#include "model/entry.hpp"

namespace lobe {

CatalogueEntry generalised_lambert_entry() {
  return {.model = {.name = "generalised_lambert",
                    .family = "generalised Lambert",
                    .formula = "C (1 - min(|V_P-L'_P|, clip)^2/4)^(-d/2)",
                    .source = "Neumann 2001, eq. 4.58 and 4.59; C makes the albedo at grazing incidence, the largest, "
                              "1 (Table 4.3, whose C_max is wrong from the fourth digit on)",
                    .parameters = {{"d", "1", 0, 1, std::nullopt, "0 is Lambert, 1 the full moon"},
                                   {"clip", "1", 0.1, 1.99, 1.9,
                                    "base-plane distance from which on the function is constant"}},
                    .traits = {}},
          .kernel = "generalised_lambert",
          .typical = {0.55, 1.9},
          .coefficients =
              [](Values v) {
                return Coefficients{generalised_lambert_constant(v[0], v[1]), -v[0] / 2, 1 - v[1] * v[1] / 4};
              },
          .shape = [](Values v) -> LobeShape { return {.patch_radius = v[1]}; },
          .proposal = draw::diffuse,
          .known = KnownValues{"generalised_lambert:d=0.3",
                               {0.28995373003758923, -0.14999999999999999, 0.097500000000000031},
                               {0.29016029074895433, 0.30920738550362653, 0.30566134713431842, 0.28997349251240445}}};
}

}  // namespace lobe
