#include "model/entry.hpp"

namespace lobe {

CatalogueEntry ross_thick_entry() {
  return {
      .model = {.name = "ross_thick",
                .family = "Ross-Li",
                .formula = "1/pi (((pi/2-xi) cos xi + sin xi) / (N.L+N.V) - pi/4), xi the angle between L and V",
                .source =
                    "Lucht, Schaaf, Strahler 2000, eq. 38 (Ross 1981): volume-scattering kernel, a reflectance factor "
                    "there, hence 1/pi here; its mean albedo is the white-sky albedo of the kernel, 0.189186 (there "
                    "0.189184). Negative where the isotropic part is larger, albedo up to pi/2 at grazing angles",
                .parameters = {},
                .traits = {.conserves_energy = false, .non_negative = false}},
      .kernel = "ross_thick",
      .coefficients = [](Values) { return Coefficients{1 / pi}; },
      .proposal = draw::limb,
      .known = KnownValues{"ross_thick",
                           {0.31830988618379069},
                           {-0.036933189153234292, 0.031420951613213718, 0.016365886648930621, 0.36732546874975275}}};
}

}  // namespace lobe
