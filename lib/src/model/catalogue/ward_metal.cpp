#include "model/entry.hpp"

namespace lobe {

CatalogueEntry ward_metal_entry() {
  return {
      .model = {.name = "ward_metal",
                .family = "metal Ward",
                .formula = "C exp(-tan^2 delta/m^2) / (4 pi m^2 max(N.L, N.V)), cos delta = N.H",
                .source = "Neumann 2001, eq. 3.36: Ward with the cos-max correction; C(m) makes the albedo at normal "
                          "incidence, the largest, 1 (Table 3.2)",
                .parameters = {{"m", "1", 1e-5, 0.5, std::nullopt, "rms slope of the microfacets; smaller is sharper"}},
                .traits = {}},
      .kernel = "ward_metal",
      .typical = {0.15},
      .coefficients =
          [](Values v) {
            return Coefficients{ward_metal_constant(v[0]) / (4 * pi * v[0] * v[0]), -1 / (v[0] * v[0])};
          },
      .shape = [](Values v) -> LobeShape { return {.width = v[0]}; },
      .proposal = draw::beckmann_facets,
      .known = KnownValues{"ward_metal:m=0.5",
                           {0.62662525506129974, -4},
                           {0.6645785576504385, 0.04501401117639383, 0.06357900823713182, 1.7021470466501039}}};
}

}  // namespace lobe
