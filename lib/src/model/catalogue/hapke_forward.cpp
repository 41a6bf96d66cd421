#include "model/entry.hpp"
#include "model/family/hapke.hpp"

namespace lobe {

CatalogueEntry hapke_forward_entry() {
  return {
      .model = {.name = "hapke_forward",
                .family = "Lommel-Seeliger",
                .formula = "4/(9 pi) R (1 - cos(alpha)/2) / (N.L + N.V), R as in hapke_lommel_seeliger, alpha the "
                           "angle between L and V",
                .source = "Neumann 2001, eq. 1.52 and 1.53 (Hapke 1963), forward scattering; 1.52 with the corrections "
                          "of hapke_lommel_seeliger. Albedo above 1 at grazing angles for g > 3.3, up to 1.09",
                .parameters = {compaction()},
                .traits = {.conserves_energy = false}},
      .kernel = "hapke_forward",
      .typical = {0.447},
      .coefficients =
          [](Values v) {
            return Coefficients{4 / (9 * pi), v[0]};
          },
      .shape = [](Values v) -> LobeShape { return {.retro_width = opposition_width(v)}; },
      .proposal = draw::limb,
      .known = KnownValues{"hapke_forward:g=5",
                           {0.14147106052612921, 5},
                           {0.088343011439014921, 0.11381646089597559, 0.1109707500358291, 0.28907394886287918}}};
}

}  // namespace lobe
