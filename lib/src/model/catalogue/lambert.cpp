#include "model/entry.hpp"

namespace lobe {

CatalogueEntry lambert_entry() {
  return {.model = {.name = "lambert",
                    .family = "Lambert",
                    .formula = "1/pi",
                    .source = "Neumann 2001, eq. 1.27 and 1.28: ideal diffuse, albedo 1",
                    .parameters = {},
                    .traits = {}},
          .kernel = "lambert",
          .coefficients = [](Values) { return Coefficients{1 / pi}; },
          .proposal = draw::diffuse,
          .known = KnownValues{"lambert",
                               {0.31830988618379069},
                               {0.31830988618379069, 0.31830988618379069, 0.31830988618379069, 0.31830988618379069}}};
}

}  // namespace lobe
