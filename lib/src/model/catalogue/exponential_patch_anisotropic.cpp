#include "model/entry.hpp"
#include "model/family/patch_norm.hpp"

namespace lobe {
namespace {

std::optional<PatchEdge> edge(Values v) {
  if (is_smooth_norm(v[2])) return std::nullopt;
  return PatchEdge{std::numeric_limits<double>::infinity(), v[1], v[2], v[3]};
}

}  // namespace

CatalogueEntry exponential_patch_anisotropic_entry() {
  return {.model = {.name = "exponential_patch_anisotropic",
                    .family = "exponential patch",
                    .formula =
                        "C exp(-s ((B/A |z.u|)^p + |z.v|^p)^(1/p)), z = V_P-L'_P, u and v along the axes of the lobe",
                    .source = "Neumann 2001, eq. 4.46 with the elliptic norm of 4.32 (p = 2) or that of the p-th power "
                              "(4.38), in which absolute values are missing. C makes the albedo at normal incidence, "
                              "the largest, 1, as 4.36 does; ratio = 1, p = 2 is exponential_patch",
                    .parameters = {{"s", "1", 1e-3, 1e6, std::nullopt,
                                    "decay per unit of base-plane distance across; larger is sharper"},
                                   axes_ratio(),
                                   norm_power(),
                                   rotation()},
                    .traits = {.isotropic = false}},
          .kernel = "exponential_patch_anisotropic",
          .typical = {10, 0.4, 2, 0.4},
          .coefficients =
              [](Values v) {
                const Axis axis(v[3]);
                return Coefficients{exponential_norm_constant(v[0], v[1], v[2]),
                                    -v[0],
                                    v[1] * axis.cosine,
                                    v[1] * axis.sine,
                                    -axis.sine,
                                    axis.cosine,
                                    v[2],
                                    1 / v[2]};
              },
          .shape = [](Values v) -> LobeShape {
            return {.width = std::min(1.0, 1 / (2 * v[0])),
                    .aspect = norm_aspect(v),
                    .patch_edge = edge(v),
                    .both_sides = false,
                    .mirror_plane = v[3]};
          },
          .proposal = [](Values v, const draw::Scene& scene) -> draw::Parts {
            // Isotropic ones that are nowhere narrower; the norm of a power p above 2 is at least 2^(1/p-1/2) of the
            // usual one.
            const UnitVector centre = draw::mirror_of(scene.light);
            return {draw::with_share(
                        0.7, draw::exponential_patch(centre, v[0] * v[1] * std::exp2(std::min(0.0, 1 / v[2] - 0.5)))),
                    draw::with_share(0.3, draw::exponential_patch(centre, v[0]))};
          },
          .known = KnownValues{"exponential_patch_anisotropic:s=2,ratio=0.5,p=10,rotation=0.6",
                               {0.75191053044375922, -2, 0.41266780745483916, 0.28232123669751769, -0.56464247339503537,
                                0.82533561490967833, 10, 0.10000000000000001},
                               {0.57737402126017989, 0.098872026388503093, 0.085893685573453962, 0.7049152175894986}}};
}

}  // namespace lobe
