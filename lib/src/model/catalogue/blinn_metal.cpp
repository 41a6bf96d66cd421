#include "model/entry.hpp"

namespace lobe {

CatalogueEntry blinn_metal_entry() {
  return {.model = {.name = "blinn_metal",
                    .family = "metal Blinn",
                    .formula = "C(n) (N.H)^n / max(N.L, N.V)",
                    .source = "Neumann 2001, section 3.7.1: cos-max metallic Blinn; C(n) makes the largest albedo 1 "
                              "(Table 3.1, whose entry for n = 2 should be 0.364)",
                    .parameters = {{"n", "1", 1, 1e10, std::nullopt, "exponent; larger is sharper"}},
                    .traits = {}},
          .kernel = "blinn_metal",
          .typical = {40},
          .coefficients =
              [](Values v) {
                return Coefficients{blinn_metal_constant(v[0]), v[0]};
              },
          .shape = [](Values v) -> LobeShape { return {.width = half_lobe_width(v[0])}; },
          .proposal = draw::power_facets,
          .known = KnownValues{"blinn_metal:n=4",
                               {0.44937866284770439, 4},
                               {0.48222786668521317, 0.19736882907108014, 0.18435967308337661, 1.2303963642601694}}};
}

}  // namespace lobe
