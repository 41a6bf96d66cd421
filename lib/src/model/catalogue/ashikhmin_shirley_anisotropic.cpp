#include "model/entry.hpp"
#include "model/family/azimuths.hpp"

namespace lobe {

CatalogueEntry ashikhmin_shirley_anisotropic_entry() {
  const auto exponent_along = [](std::string_view name, std::string_view axis) -> Parameter {
    return {name, "1", 1e-3, 1e10, std::nullopt, axis};
  };
  return {
      .model = {.name = "ashikhmin_shirley_anisotropic",
                .family = "Ashikhmin-Shirley",
                .formula = "sqrt((n_u+1)(n_v+1))/(8 pi) (N.H)^(n_u cos^2 phi+n_v sin^2 phi) F / (L.H max(N.L, N.V)), "
                           "phi the azimuth of H from the lobe's first axis, F = f0 + (1-f0)(1-L.H)^5",
                .source = "Ashikhmin and Shirley 2000, specular term; F = 1 by default, else Schlick's approximation",
                .parameters = {exponent_along("n_u", "exponent along the first axis; larger is sharper"),
                               exponent_along("n_v", "exponent across; larger is sharper"), normal_reflectance(),
                               rotation()},
                .traits = {.isotropic = false}},
      .kernel = "ashikhmin_shirley_anisotropic",
      .typical = {100, 20, 1, 0.4},
      .coefficients =
          [](Values v) {
            const Axis axis(v[3]);
            return Coefficients{
                std::sqrt((v[0] + 1) * (v[1] + 1)) / (8 * pi), axis.cosine, axis.sine, v[0], v[1], v[2], 1 - v[2]};
          },
      .shape = [](Values v) -> LobeShape {
        return {.width = half_lobe_width(std::max(v[0], v[1])),
                .aspect = std::sqrt(aspect_of(v[0], v[1])),
                .both_sides = false,
                .mirror_plane = v[3]};
      },
      .proposal = [](Values v, const draw::Scene&) -> draw::Parts { return {draw::cosine_facets(v[0], v[1], v[3])}; },
      .known = KnownValues{"ashikhmin_shirley_anisotropic:n_u=20,n_v=20,f0=1,rotation=0",
                           {0.83556345123245057, 1, 0, 20, 20, 1},
                           {0.94874440704628715, 0.0051319445512691712, 0.009952436953297325, 6.5289060789764246}}};
}

}  // namespace lobe
