#include "model/entry.hpp"
#include "model/family/base_plane.hpp"

namespace lobe {

CatalogueEntry retro_patch_entry() {
  return {.model = {.name = "retro_patch",
                    .family = "basic patch",
                    .formula = "1 / (pi min(1, R^2)) for |V_P-L_P| <= R, else 0",
                    .source = "Neumann 2001, eq. 4.2 with the metric of 4.29, and 4.7: the basic patch about the retro "
                              "direction; R = 2 is Lambert",
                    .parameters = {{"R", "1", 0.01, kWholeBasePlane, std::nullopt,
                                    "radius in the base plane; smaller is sharper"}},
                    .traits = {}},
          .kernel = "retro_patch",
          .typical = {0.4},
          .coefficients = basic_patch_coefficients,
          .shape = [](Values v) -> LobeShape {
            return {.retro_width = std::min(0.5, v[0] / 2), .retro_patch_radius = v[0]};
          },
          .proposal = [](Values v, const draw::Scene& scene) -> draw::Parts {
            return {draw::patch(scene.light, v[0], scene.patches)};
          },
          .known = KnownValues{"retro_patch:R=2",
                               {0.31830988618379069, 8},
                               {0.31830988618379069, 0.31830988618379069, 0.31830988618379069, 0.31830988618379069}}};
}

}  // namespace lobe
