#include "model/entry.hpp"

namespace lobe {

CatalogueEntry beard_maxwell_entry() {
  return {
      .model = {.name = "beard_maxwell",
                .family = "Beard-Maxwell",
                .formula = "F(ior, k, L.H) / (4 cos delta (sigma^2+tan^2 delta) N.L N.V) (1 + delta/omega e^(-2 "
                           "beta/tau)) / (1 + delta/omega), cos delta = N.H, cos beta = L.H",
                .source = "Neumann 2001, eq. 1.55 (Maxwell et al. 1973), first-surface term; shadowing and obscuration "
                          "as in Westlund and Meyer 2002, eq. 10, and the Cauchy distribution of NEFDS at B = 1 for "
                          "f_FIRST. The albedo grows as 1/(N.L) at grazing angles, so that norms are infinite. The "
                          "diffuse terms are lambert and lommel_seeliger",
                .parameters =
                    {{"sigma", "1", 1e-3, 10, std::nullopt, "slope of the facets where their density is half"},
                     {"tau", "rad", 0.01, 100, std::nullopt, "angle over which shadowing of retro-reflection grows"},
                     {"omega", "rad", 0.01, 100, std::nullopt, "tilt of facets from which on they are shadowed"},
                     refractive_index(),
                     extinction()},
                .traits = {.conserves_energy = false}},
      .kernel = "beard_maxwell",
      .typical = {0.2, 2, 1.58, 1.58, 0},
      .coefficients = [](Values v) { return Coefficients{0.25, v[0] * v[0], v[3], v[4], 1 / v[2], -2 / v[1]}; },
      .shape = [](Values v) -> LobeShape {
        return {.width = std::min(1.0, v[0]), .has_infinite_norm = true, .kinks = critical_kinks(v[3], v[4])};
      },
      .proposal = [](Values v, const draw::Scene& scene) -> draw::Parts { return draw::long_tail(scene.light, v[0]); },
      .known = KnownValues{"beard_maxwell:sigma=0.1,tau=0.3,omega=0.2,ior=1.65,k=0.1",
                           {0.25, 0.010000000000000002, 1.6499999999999999, 0.10000000000000001, 5, -6.666666666666667},
                           {0.90051258190667671, 0.015569969298346996, 0.020527417617922518, 23.87519587838425}}};
}

}  // namespace lobe
