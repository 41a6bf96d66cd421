#include "model/entry.hpp"
#include "model/family/lafortune.hpp"

namespace lobe {

CatalogueEntry lafortune_ngan_entry() {
  return {
      .model = {.name = "lafortune_ngan",
                .family = "Lafortune",
                .formula = "(n+2)/(2 pi) (max(0, c_xy (L_x V_x + L_y V_y) + c_z L_z V_z) / max(|c_xy|, |c_z|))^n",
                .source = "Ngan, Durand, Matusik 2005: eq. 1.66 with the constant of the fits of measured materials; a "
                          "cosine lobe scaled by at most 1, of albedo at most 1",
                .parameters = lafortune_parameters(),
                .traits = {}},
      .kernel = "lafortune",
      .typical = {-1, 0.95, 40},
      .coefficients =
          [](Values v) {
            const double largest = std::max(std::abs(v[0]), std::abs(v[1]));
            const double unit = largest > 0 ? 1 / largest : 0;
            return Coefficients{cosine_lobe_constant(v[2]), v[0] * unit, v[1] * unit, v[2]};
          },
      .shape = [](Values v) -> LobeShape {
        return {.width = lafortune_width(v), .retro_width = lafortune_retro_width(v), .kinks = lafortune_kinks(v)};
      },
      .proposal = lafortune_draws,
      .known = KnownValues{"lafortune_ngan:c_xy=-1.02,c_z=0.9,n=5",
                           {1.1140846016432675, -1, 0.88235294117647056, 5},
                           {0.63795316807991287, 0.00082676416604657722, 0.00052483124652962453, 1.030603580426108}}};
}

}  // namespace lobe
