#include "model/entry.hpp"
#include "model/family/hapke.hpp"

namespace lobe {

CatalogueEntry hapke_isotropic_entry() {
  return {
      .model = {.name = "hapke_isotropic",
                .family = "Lommel-Seeliger",
                .formula = "1/pi R / (N.L + N.V), R as in hapke_lommel_seeliger",
                .source =
                    "Neumann 2001, eq. 1.52 with S = 1 (Hapke 1963), isotropic scattering; 1.52 with the corrections "
                    "of hapke_lommel_seeliger. Albedo at grazing angles from 2 (g = 0.01) to 2.65 (g = 10)",
                .parameters = {compaction()},
                .traits = {.conserves_energy = false}},
      .kernel = "hapke_isotropic",
      .typical = {0.447},
      .coefficients =
          [](Values v) {
            return Coefficients{1 / pi, v[0]};
          },
      .shape = [](Values v) -> LobeShape { return {.retro_width = opposition_width(v)}; },
      .proposal = draw::limb,
      .known = KnownValues{"hapke_isotropic:g=5",
                           {0.31830988618379069, 5},
                           {0.28955048471925054, 0.38173267120023679, 0.3620514618808191, 0.46970521675190308}}};
}

}  // namespace lobe
