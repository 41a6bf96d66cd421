#include "model/entry.hpp"
#include "model/family/base_plane.hpp"

namespace lobe {
namespace {

/// Integral of min(1, t^2) from 0.
double area_integral(double radius) {
  return radius <= 1 ? radius * radius * radius / 3 : radius - 2.0 / 3;
}

/// \param v R, inner
Coefficients patch_frustum_coefficients(Values v) {
  const double width = v[0] * (1 - v[1]);
  const double inner = v[0] * v[1];
  return {width / (pi * (area_integral(v[0]) - area_integral(inner))), v[0], 1 / width};
}

}  // namespace

CatalogueEntry patch_frustum_entry() {
  return {
      .model = {.name = "patch_frustum",
                .family = "patch profile",
                .formula = "c min(1, (R-m)/(R-rR)) for m = |V_P-L'_P| <= R, else 0",
                .source =
                    "Neumann 2001, eq. 4.39 with the constant of 4.42: patch-based BRDF whose profile is constant up "
                    "to rR and falls linearly to 0 at R; the 'profile' of a study file is a sum of these",
                .parameters = {{"R", "1", 1e-5, kWholeBasePlane, std::nullopt,
                                "radius in the base plane; smaller is sharper"},
                               {"inner", "1", 0, 0.999, 0.0, "r, where the profile begins to fall, by R; 0 is a cone"}},
                .traits = {}},
      .kernel = "patch_frustum",
      .typical = {0.4, 0},
      .coefficients = patch_frustum_coefficients,
      .shape = [](Values v) -> LobeShape {
        return {.width = std::min(1.0, v[0] / 2), .patch_radius = v[0], .inner_patch_radius = inner_radius(v)};
      },
      .proposal = [](Values v, const draw::Scene& scene) -> draw::Parts {
        const double radius = v[0];
        const double inner = v[0] * v[1];
        const auto profile = [=](double m) { return std::clamp((radius - m) / (radius - inner), 0.0, 1.0); };
        const auto make = [&] { return draw::bounded_table(profile, inner, radius); };
        return {draw::patch_mixture(draw::mirror_of(scene.light), draw::known_table(v, make))};
      },
      .known = KnownValues{"patch_frustum:R=1.5,inner=0.9",
                           {0.3183098861837908, 1.5, 6.6666666666666679},
                           {0.31830988618379069, 0.31830988618379069, 0.31830988618379069, 0.31830988618379069}}};
}

}  // namespace lobe
