#include "model/entry.hpp"
#include "model/family/patch_norm.hpp"

namespace lobe {

CatalogueEntry basic_patch_anisotropic_entry() {
  return {
      .model =
          {.name = "basic_patch_anisotropic",
           .family = "basic patch",
           .formula =
               "C for ((B/A |z.u|)^p + |z.v|^p)^(1/p) <= R, else 0, z = V_P-L'_P, u and v along the axes of the lobe",
           .source = "Neumann 2001, eq. 4.34 with the elliptic norm of 4.32 (p = 2) or that of the p-th power (4.38), "
                     "in which absolute values are missing. C makes the albedo at normal incidence, the largest, 1 "
                     "(4.36); ratio = 1, p = 2 is basic_patch",
           .parameters = {{"R", "1", 1e-5, kWholeBasePlane, std::nullopt,
                           "half the minor axis in the base plane; smaller is sharper"},
                          axes_ratio(),
                          norm_power(),
                          rotation()},
           .traits = {.isotropic = false}},
      .kernel = "basic_patch_anisotropic",
      .typical = {0.4, 0.4, 2, 0.4},
      .coefficients = patch_norm_coefficients,
      .shape = [](Values v) -> LobeShape {
        return {.width = std::min(1.0, v[0] / 2),
                .aspect = norm_aspect(v),
                .patch_edge = edge_of(v),
                .both_sides = false,
                .mirror_plane = v[3]};
      },
      .proposal = [](Values v, const draw::Scene& scene) -> draw::Parts {
        return {draw::patch(draw::mirror_of(scene.light), reach_of_norm(v), scene.patches)};
      },
      .known = KnownValues{"basic_patch_anisotropic:R=2,ratio=0.5,p=2,rotation=0.6",
                           {0.31830988618379069, 0.10316695186370979, 0.070580309174379421, -0.14116061834875884,
                            0.20633390372741958, 2},
                           {0.31830988618379069, 0.31830988618379069, 0.31830988618379069, 0.31830988618379069}}};
}

}  // namespace lobe
