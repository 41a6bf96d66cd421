#include <cmath>
#include <optional>

#include "model/entry.hpp"
#include "model/family/lafortune.hpp"

namespace lobe {
namespace {

/// As kernels/models/lafortune_anisotropic.clh takes them.
Coefficients coefficients(Values v) {
  return {1, v[0], v[3], v[1], v[2], v[6], 0, v[4], v[5]};
}

/// Along a principal axis of the part of M in the base plane.
std::optional<double> mirror_plane(Values v) {
  if (v[4] != 0 || v[5] != 0) return std::nullopt;
  return std::atan2(2 * v[3], v[0] - v[1]) / 2;
}

}  // namespace

CatalogueEntry lafortune_matrix_entry() {
  const auto entry = [](std::string_view name, std::optional<double> value, std::string_view product) -> Parameter {
    return {name, "1", -1, 1, value, product};
  };
  return {.model = {.name = "lafortune_matrix",
                    .family = "Lafortune",
                    .formula = "max(0, L^T M V)^n, M symmetric",
                    .source = "Neumann 2001, eq. 1.65 (Lafortune et al. 1997) with the power and the positive part "
                              "that it lacks; a symmetric M makes it reciprocal. Factors of M beyond 1 are a scale. "
                              "With m_xz or m_yz the lobe is not that of half a turn about the normal. Peaks lie "
                              "anywhere, so that sharper ones than n = 200 would be beyond the quadratures",
                    .parameters = {entry("m_xx", std::nullopt, "coefficient of L_x V_x; negative: forward reflecting"),
                                   entry("m_yy", std::nullopt, "coefficient of L_y V_y; negative: forward reflecting"),
                                   entry("m_zz", std::nullopt, "coefficient of L_z V_z"),
                                   entry("m_xy", 0.0, "coefficient of L_x V_y + L_y V_x"),
                                   entry("m_xz", 0.0, "coefficient of L_x V_z + L_z V_x"),
                                   entry("m_yz", 0.0, "coefficient of L_y V_z + L_z V_y"),
                                   {"n", "1", 1, 200, std::nullopt, "exponent; larger is sharper"}},
                    .traits = {.isotropic = false, .conserves_energy = false}},
          .kernel = "lafortune_anisotropic",
          .typical = {-0.9, -0.6, 0.95, 0, 0, 0, 40},
          .coefficients = coefficients,
          .shape = [](Values v) -> LobeShape {
            return {.width = mirror_lobe_width(v[6]),
                    .retro_width = retro_lobe_width(v[6]),
                    .aspect = 2 + std::sqrt(v[6]),
                    .mirror_plane = mirror_plane(v),
                    .half_turn = v[4] == 0 && v[5] == 0,
                    .kinks = matrix_kinks(coefficients(v))};
          },
          .proposal = [](Values v, const draw::Scene& scene) { return matrix_draws(coefficients(v), scene.light); }};
}

}  // namespace lobe
