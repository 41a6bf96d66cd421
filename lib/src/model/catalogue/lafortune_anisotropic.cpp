#include "model/entry.hpp"
#include "model/family/azimuths.hpp"
#include "model/family/lafortune.hpp"

namespace lobe {

CatalogueEntry lafortune_anisotropic_entry() {
  const auto along = [](std::string_view name, std::string_view product) -> Parameter {
    return {name, "1", -10, 10, std::nullopt, product};
  };
  return {.model = {.name = "lafortune_anisotropic",
                    .family = "Lafortune",
                    .formula = "max(0, c_x L_u V_u + c_y L_v V_v + c_z L_z V_z)^n, u and v along the axes of the lobe",
                    .source = "Neumann 2001, eq. 1.66 (Lafortune et al. 1997), no leading constant",
                    .parameters = {along("c_x", "coefficient of L_u V_u; negative: forward reflecting"),
                                   along("c_y", "coefficient of L_v V_v; negative: forward reflecting"),
                                   along("c_z", "coefficient of L_z V_z"), exponent(), rotation()},
                    .traits = {.isotropic = false, .conserves_energy = false}},
          .kernel = "lafortune_anisotropic",
          .typical = {-0.9, -0.6, 0.95, 40, 0.4},
          .coefficients = [](Values v) { return matrix_coefficients(1, v[0], v[1], v[2], v[3], 0, v[4]); },
          .shape = [](Values v) -> LobeShape {
            return {.width = v[0] > 0 && v[1] > 0 ? 1 : mirror_lobe_width(v[3]),
                    .retro_width = v[0] > 0 || v[1] > 0 ? retro_lobe_width(v[3]) : 1,
                    .aspect = 2.0,
                    .mirror_plane = v[4],
                    .kinks = matrix_kinks(matrix_coefficients(1, v[0], v[1], v[2], v[3], 0, v[4]))};
          },
          .proposal =
              [](Values v, const draw::Scene& scene) {
                return matrix_draws(matrix_coefficients(1, v[0], v[1], v[2], v[3], 0, v[4]), scene.light);
              }};
}

}  // namespace lobe
