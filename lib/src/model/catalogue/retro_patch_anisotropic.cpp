#include "model/entry.hpp"
#include "model/family/patch_norm.hpp"

namespace lobe {

CatalogueEntry retro_patch_anisotropic_entry() {
  return {
      .model =
          {.name = "retro_patch_anisotropic",
           .family = "basic patch",
           .formula =
               "C for ((B/A |z.u|)^p + |z.v|^p)^(1/p) <= R, else 0, z = V_P-L_P, u and v along the axes of the lobe",
           .source = "Neumann 2001, eq. 4.34 with the vector of 4.29 in the norms of 4.32 (p = 2) and 4.38: the "
                     "anisotropic basic patch about the retro direction; ratio = 1, p = 2 is retro_patch",
           .parameters = {{"R", "1", 0.01, kWholeBasePlane, std::nullopt,
                           "half the minor axis in the base plane; smaller is sharper"},
                          axes_ratio(),
                          norm_power(),
                          rotation()},
           .traits = {.isotropic = false}},
      .kernel = "retro_patch_anisotropic",
      .typical = {0.4, 0.4, 2, 0.4},
      .coefficients = patch_norm_coefficients,
      .shape = [](Values v) -> LobeShape {
        return {.retro_width = std::min(0.5, v[0] / 2),
                .aspect = norm_aspect(v),
                .retro_patch_edge = edge_of(v),
                .mirror_plane = v[3]};
      },
      .proposal = [](Values v, const draw::Scene& scene) -> draw::Parts {
        return {draw::patch(scene.light, reach_of_norm(v), scene.patches)};
      },
      .known = KnownValues{"retro_patch_anisotropic:R=2,ratio=0.5,p=2,rotation=0.6",
                           {0.31830988618379069, 0.10316695186370979, 0.070580309174379421, -0.14116061834875884,
                            0.20633390372741958, 2},
                           {0.31830988618379069, 0.31830988618379069, 0.31830988618379069, 0.31830988618379069}}};
}

}  // namespace lobe
