#include "model/entry.hpp"
#include "model/family/base_plane.hpp"

namespace lobe {

CatalogueEntry basic_patch_entry() {
  return {.model = {.name = "basic_patch",
                    .family = "basic patch",
                    .formula = "1 / (pi min(1, R^2)) for |V_P-L'_P| <= R, else 0",
                    .source = "Neumann 2001, eq. 4.2 and 4.7: patch-based BRDF, constant within a base-plane distance "
                              "R of the mirror direction (4.1); R = 2 is Lambert",
                    .parameters = {{"R", "1", 1e-5, kWholeBasePlane, std::nullopt,
                                    "radius in the base plane; smaller is sharper"}},
                    .traits = {}},
          .kernel = "basic_patch",
          .typical = {0.4},
          .coefficients = basic_patch_coefficients,
          .shape = [](Values v) -> LobeShape { return {.width = std::min(1.0, v[0] / 2), .patch_radius = v[0]}; },
          .proposal = [](Values v, const draw::Scene& scene) -> draw::Parts {
            return {draw::patch(draw::mirror_of(scene.light), v[0], scene.patches)};
          },
          .known = KnownValues{"basic_patch:R=1.25",
                               {0.31830988618379069, 1.5625},
                               {0.31830988618379069, 0.31830988618379069, 0.31830988618379069, 0.31830988618379069}}};
}

}  // namespace lobe
