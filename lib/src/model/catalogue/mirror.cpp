#include "model/entry.hpp"

namespace lobe {

CatalogueEntry mirror_entry() {
  return {.model = {.name = "mirror",
                    .family = "ideal mirror",
                    .formula = "rho Delta(V = R) / N.V",
                    .source = "Neumann 2001, eq. 1.29 with F = rho: all light into the mirror direction R",
                    .parameters = {reflected_share()},
                    .traits = {.has_delta = true}},
          .typical = {1}};
}

}  // namespace lobe
