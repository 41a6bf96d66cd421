#include "model/entry.hpp"
#include "model/family/rough_diffuse.hpp"

namespace lobe {

CatalogueEntry fon_entry() {
  return {.model = {.name = "fon",
                    .family = "Oren-Nayar",
                    .formula = "A/pi (1 + r s/t), s = L.V - N.L N.V, t = max(N.L, N.V) for s > 0, else 1, A = "
                               "1/(1 + (1/2 - 2/(3 pi)) r)",
                    .source = "Portsmouth, Kutz, Hill 2025 (FON; Fujii 2012), at reflectance 1: the albedo is A (1 + r "
                              "G/pi), G = sin x (x - sin x cos x) + 2/3 (tan x (1 - sin^3 x) - sin x) at the angle x "
                              "from the normal, up to 1 at grazing angles",
                    .parameters = {{"r", "1", 0, 1, std::nullopt, "roughness"}},
                    .traits = {}},
          .kernel = "fon",
          .typical = {0.5},
          .coefficients =
              [](Values v) {
                return Coefficients{fujii_constant(v[0]) / pi, v[0]};
              },
          .proposal = draw::diffuse,
          .known = KnownValues{"fon:r=0.3",
                               {0.29301182460145159, 0.29999999999999999},
                               {0.27707710270326114, 0.31402771606601343, 0.30881285157787636, 0.21532919137481235}}};
}

}  // namespace lobe
