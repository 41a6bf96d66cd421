#include "model/entry.hpp"
#include "model/family/azimuths.hpp"
#include "model/family/lafortune.hpp"

namespace lobe {

CatalogueEntry metal_phong_anisotropic_entry() {
  const auto share = [](std::string_view name, std::string_view product) -> Parameter {
    return {name, "1", 0, 1, 1.0, product};
  };
  return {
      .model = {.name = "metal_phong_anisotropic",
                .family = "metal Phong",
                .formula = "(n+2)/(2 pi) max(0, c_x R_u V_u + c_y R_v V_v + c_z R_z V_z)^n / max(N.L, N.V)^p, u and v "
                           "along the axes of the lobe",
                .source =
                    "Neumann 2001, eq. 3.15; terms of it make up 3.16, in which a comma is missing. The coefficients "
                    "are at most 1, so that the constant of 3.6 serves; for small n the albedo may exceed 1, as that "
                    "of metal_phong and, where c_x or c_y is below c_z, by up to 1 (n near 0, c_x = 0, grazing angles)",
                .parameters = {exponent(), share("c_x", "coefficient of R_u V_u"),
                               share("c_y", "coefficient of R_v V_v"), share("c_z", "coefficient of R_z V_z"),
                               share("p", "share of the metallic correction"), rotation()},
                .traits = {.isotropic = false, .conserves_energy = false}},
      .kernel = "lafortune_anisotropic",
      .typical = {40, 1, 1, 1, 1, 0.4},
      .coefficients =
          [](Values v) {
            return matrix_coefficients(cosine_lobe_constant(v[0]), -v[1], -v[2], v[3], v[0], v[4], v[5]);
          },
      .shape = [](Values v) -> LobeShape {
        return {.width = mirror_lobe_width(v[0]),
                .aspect = 2.0,
                .mirror_plane = v[5],
                .kinks = matrix_kinks(matrix_coefficients(1, -v[1], -v[2], v[3], v[0], v[4], v[5]))};
      },
      .proposal =
          [](Values v, const draw::Scene& scene) {
            return matrix_draws(matrix_coefficients(cosine_lobe_constant(v[0]), -v[1], -v[2], v[3], v[0], v[4], v[5]),
                                scene.light);
          },
      .known =
          KnownValues{"metal_phong_anisotropic:n=5,c_x=0.5,c_y=0.9,p=0.5,rotation=-1.2",
                      {1.1140846016432675, -0.84747874310824911, -0.1350926361102302, -0.55252125689175091, 1, 5, -0.5},
                      {0.99598904804844335, 0.020256917012445842, 0.0064183326848873071, 0.30135551304103347}}};
}

}  // namespace lobe
