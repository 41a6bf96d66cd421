#include "model/entry.hpp"
#include "model/family/hapke.hpp"

namespace lobe {

CatalogueEntry hapke_lommel_seeliger_entry() {
  return {
      .model = {.name = "hapke_lommel_seeliger",
                .family = "Lommel-Seeliger",
                .formula =
                    "1/pi R S / (N.L + N.V), R = 2 - tan(alpha)/(2 g) (1-e^(-g/tan alpha)) (3-e^(-g/tan alpha)) for "
                    "alpha < pi/2, else 1, S = (sin alpha + (pi-alpha) cos alpha)/pi, alpha the angle between L and V",
                .source = "Neumann 2001, eq. 1.52 and 1.54 (Hapke 1963), back scattering; the text prints (N.L)(N.V) "
                          "for N.L + N.V, alpha > pi/2, e^(-g/sin g) for e^(-g/tan alpha), and a minus in S. Albedo "
                          "above 1 at grazing angles for g > 2.5, up to 1.20",
                .parameters = {compaction()},
                .traits = {.conserves_energy = false}},
      .kernel = "hapke_lommel_seeliger",
      .typical = {0.447},
      .coefficients =
          [](Values v) {
            return Coefficients{1 / pi, v[0]};
          },
      .shape = [](Values v) -> LobeShape { return {.retro_width = opposition_width(v)}; },
      .proposal = draw::limb,
      .known = KnownValues{"hapke_lommel_seeliger:g=0.05",
                           {0.31830988618379069, 0.050000000000000003},
                           {0.12336948703681322, 0.16524813194101259, 0.15377331837103952, 0.01578963150651394}}};
}

}  // namespace lobe
