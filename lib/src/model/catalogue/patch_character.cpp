#include "model/entry.hpp"

namespace lobe {

CatalogueEntry patch_character_entry() {
  return {
      .model = {.name = "patch_character",
                .family = "patch character",
                .formula = "s^2 / (2 pi (1-(1+s)e^-s)) exp(-s |V_P-L'_P|) (N.B)^alpha, B_P = (L'_P+V_P)/2, (N.B)^2 = 1 "
                           "- |V_P-L_P|^2/4",
                .source = "Neumann 2001, eq. 5.9 to 5.11 with the character (N.B)^alpha, projected onto the base "
                          "plane, B the bisecting point there (5.2.3): alpha = 0 is exponential_patch, alpha = -1 the "
                          "metallic class. The constant is that of 4.46, not 1/sup of 5.9: for alpha < 0 the albedo "
                          "exceeds 1 towards grazing angles, for alpha = -1 by a factor that grows as sqrt(s)",
                .parameters = {{"s", "1", 1e-3, 1e6, std::nullopt,
                                "decay per unit of base-plane distance; larger is sharper"},
                               {"alpha", "1", -2, 2, -1.0, "power of the bisector's cosine"}},
                .traits = {.conserves_energy = false}},
      .kernel = "patch_character",
      .typical = {10, -1},
      .coefficients =
          [](Values v) {
            return Coefficients{exponential_patch_constant(v[0]), -v[0], v[1] / 2};
          },
      .shape = [](Values v) -> LobeShape { return {.width = std::min(1.0, 1 / (2 * v[0]))}; },
      .proposal = draw::exponential,
      .known = KnownValues{"patch_character:s=2,alpha=-1",
                           {1.0717610132298394, -2, -0.5},
                           {0.9020578415122773, 0.11061075533402011, 0.12941719568077573, 2.8918850917387613}}};
}

}  // namespace lobe
