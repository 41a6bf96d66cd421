#include "model/entry.hpp"

namespace lobe {

CatalogueEntry lacquer_entry() {
  return {.model = {.name = "lacquer",
                    .family = "lacquer",
                    .formula = "1/pi exp(-s (1/N.L + 1/N.V))",
                    .source = "Neumann 2001, eq. 1.60: white paint under an absorbing layer, s >= 0 where s <= 0 is "
                              "printed; the mirror of its surface (1.61) is not in it",
                    .parameters = {{"s", "1", 0, 100, std::nullopt, "optical depth of the layer; 0 is Lambert"}},
                    .traits = {}},
          .kernel = "lacquer",
          .typical = {0.3},
          .coefficients =
              [](Values v) {
                return Coefficients{1 / pi, -v[0]};
              },
          .proposal = draw::diffuse,
          .known = KnownValues{"lacquer:s=0.1",
                               {0.31830988618379069, -0.10000000000000001},
                               {0.25480678639890803, 0.237794507324814, 0.23056459683943745, 0.17590063533065881}}};
}

}  // namespace lobe
