#include "model/entry.hpp"

namespace lobe {

CatalogueEntry rrim_entry() {
  return {.model = {.name = "rrim",
                    .family = "retro-reflecting ideal mirror",
                    .formula = "rho Delta(V = L) / N.L",
                    .source = "Neumann 2001, eq. 1.26: RRIM, all light back to where it comes from",
                    .parameters = {reflected_share()},
                    .traits = {.has_delta = true}},
          .typical = {1}};
}

}  // namespace lobe
