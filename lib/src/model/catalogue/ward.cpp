#include "model/entry.hpp"

namespace lobe {

CatalogueEntry ward_entry() {
  return {.model = {.name = "ward",
                    .family = "Ward",
                    .formula = "exp(-tan^2 delta/m^2) / (4 pi m^2 sqrt(N.L N.V)), cos delta = N.H",
                    .source = "Neumann 2001, eq. 3.35 with C_max = 1 (Ward 1992), isotropic; the albedo diverges as "
                              "(N.L)^-1/2 at grazing angles",
                    .parameters = {roughness()},
                    .traits = {.conserves_energy = false}},
          .kernel = "ward",
          .typical = {0.15},
          .coefficients =
              [](Values v) {
                return Coefficients{1 / (4 * pi * v[0] * v[0]), -1 / (v[0] * v[0])};
              },
          .shape = [](Values v) -> LobeShape { return {.width = std::min(1.0, v[0])}; },
          .proposal = draw::beckmann_facets,
          .known = KnownValues{"ward:m=0.5",
                               {0.31830988618379069, -4},
                               {0.34585078093219096, 0.025363949486730378, 0.047473265419188941, 0.92689534811030028}}};
}

}  // namespace lobe
