#include "model/entry.hpp"
#include "model/family/hapke.hpp"

namespace lobe {

CatalogueEntry lommel_seeliger_entry() {
  return {
      .model = {.name = "lommel_seeliger",
                .family = "Lommel-Seeliger",
                .formula = "1 / (4 pi (N.L + N.V))",
                .source = "Seeliger 1888; Hapke 1981, eq. 16 without opposition effect and multiple scattering, at "
                          "single-scattering albedo 1: isotropic scatterers, densely packed",
                .parameters = {},
                .traits = {}},
      .kernel = "lommel_seeliger",
      .coefficients = [](Values) { return Coefficients{1 / (4 * pi)}; },
      .proposal = draw::limb,
      .known = KnownValues{"lommel_seeliger",
                           {0.079577471545947673},
                           {0.044243047092466979, 0.057396478650273974, 0.055506411366246691, 0.11742630418797577}}};
}

}  // namespace lobe
