#include "model/entry.hpp"

namespace lobe {

CatalogueEntry ward_duer_entry() {
  return {.model = {.name = "ward_duer",
                    .family = "Ward-Duer",
                    .formula = "exp(-tan^2 delta/m^2) / (4 pi m^2 N.L N.V), cos delta = N.H",
                    .source = "Duer 2006: Ward with N.L N.V for its square root; the albedo diverges as 1/N.L at "
                              "grazing angles, so that norms are infinite",
                    .parameters = {roughness()},
                    .traits = {.conserves_energy = false}},
          .kernel = "ward_duer",
          .typical = {0.15},
          .coefficients =
              [](Values v) {
                return Coefficients{1 / (4 * pi * v[0] * v[0]), -1 / (v[0] * v[0])};
              },
          .shape = [](Values v) -> LobeShape { return {.width = std::min(1.0, v[0]), .has_infinite_norm = true}; },
          .proposal = draw::beckmann_facets,
          .known = KnownValues{"ward_duer:m=1",
                               {0.079577471545947673, -1},
                               {0.097874704883901043, 0.081036046428286629, 0.10052071820792828, 0.69371245170085483}}};
}

}  // namespace lobe
