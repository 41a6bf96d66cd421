#include "model/entry.hpp"
#include "model/family/azimuths.hpp"

namespace lobe {

CatalogueEntry ggx_anisotropic_entry() {
  return {
      .model = {.name = "ggx_anisotropic",
                .family = "GGX",
                .formula = "D F / (2 (N.L root(V) + N.V root(L))), D = 1 / (pi a_x a_y "
                           "((H_u/a_x)^2+(H_v/a_y)^2+(N.H)^2)^2), root(X) = sqrt((a_x X_u)^2+(a_y X_v)^2+(N.X)^2), F = "
                           "f0 + (1-f0)(1-L.H)^5, a = alpha, u and v along the axes of the lobe",
                .source = "Walter, Marschner, Li, Torrance 2007 with two roughnesses (Burley 2012, eq. 13) and the "
                          "height-correlated attenuation of Smith (Heitz 2014, eq. 86 and 99); F = 1 by default, else "
                          "Schlick's approximation",
                .parameters = {{"alpha_x", "1", 1e-5, 1, std::nullopt,
                                "roughness along the first axis; smaller is sharper"},
                               {"alpha_y", "1", 1e-5, 1, std::nullopt, "roughness across; smaller is sharper"},
                               normal_reflectance(),
                               rotation()},
                .traits = {.isotropic = false}},
      .kernel = "ggx_anisotropic",
      .typical = {0.1, 0.3, 1, 0.4},
      .coefficients =
          [](Values v) {
            const Axis axis(v[3]);
            return Coefficients{1 / (4 * pi * v[0] * v[1]), axis.cosine / v[0], axis.sine / v[0], -axis.sine / v[1],
                                axis.cosine / v[1],         v[0] * v[0],        v[1] * v[1],      v[2]};
          },
      .shape = [](Values v) -> LobeShape {
        return {.width = std::min(v[0], v[1]), .aspect = aspect_of(v[0], v[1]), .mirror_plane = v[3]};
      },
      .proposal = [](Values v, const draw::Scene& scene) -> draw::Parts {
        return {draw::visible_facets(scene.light, v[0], v[1], v[3])};
      },
      .known = KnownValues{"ggx_anisotropic:alpha_x=0.01,alpha_y=0.04,f0=1,rotation=-1.2",
                           {198.94367886486916, 36.235775447667365, -93.203908596722627, 23.300977149180657,
                            9.0589438619168412, 0.0001, 0.0016000000000000001, 1},
                           {0.1163999042287233, 2.833451602818875e-05, 3.4666130995183406e-05, 1.6500457107760755}}};
}

}  // namespace lobe
