#include "model/family/lafortune.hpp"
#include "model/entry.hpp"

namespace lobe {

CatalogueEntry lafortune_entry() {
  return {.model = {.name = "lafortune",
                    .family = "Lafortune",
                    .formula = "max(0, c_xy (L_x V_x + L_y V_y) + c_z L_z V_z)^n",
                    .source = "Neumann 2001, eq. 1.66 (Lafortune et al. 1997), isotropic, no leading constant",
                    .parameters = lafortune_parameters(),
                    .traits = {.conserves_energy = false}},
          .kernel = "lafortune",
          .typical = {-1, 0.95, 40},
          .coefficients =
              [](Values v) {
                return Coefficients{1, v[0], v[1], v[2]};
              },
          .shape = [](Values v) -> LobeShape {
            return {.width = lafortune_width(v), .retro_width = lafortune_retro_width(v), .kinks = lafortune_kinks(v)};
          },
          .proposal = lafortune_draws};
}

}  // namespace lobe
