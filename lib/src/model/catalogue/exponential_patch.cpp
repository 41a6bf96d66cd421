#include "model/entry.hpp"

namespace lobe {

CatalogueEntry exponential_patch_entry() {
  return {.model = {.name = "exponential_patch",
                    .family = "exponential patch",
                    .formula = "s^2 / (2 pi (1-(1+s)e^-s)) exp(-s |V_P-L'_P|)",
                    .source = "Neumann 2001, eq. 4.46: patch-based BRDF with exponential profile; |V_P-L'_P| is the "
                              "distance of V from the mirror direction in the base plane (4.1)",
                    .parameters = {{"s", "1", 1e-3, 1e6, std::nullopt,
                                    "decay per unit of base-plane distance; larger is sharper"}},
                    .traits = {}},
          .kernel = "exponential_patch",
          .typical = {10},
          .coefficients =
              [](Values v) {
                return Coefficients{exponential_patch_constant(v[0]), -v[0]};
              },
          .shape = [](Values v) -> LobeShape { return {.width = std::min(1.0, 1 / (2 * v[0]))}; },
          .proposal = draw::exponential,
          .known = KnownValues{"exponential_patch:s=0.009",
                               {0.32022476576063585, -0.0089999999999999993},
                               {0.31982832367719671, 0.31683963850644925, 0.31710138812843652, 0.32010193756486838}}};
}

}  // namespace lobe
