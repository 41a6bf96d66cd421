#include "model/entry.hpp"

namespace lobe {

CatalogueEntry low_microfacet_entry() {
  return {
      .model = {.name = "low_microfacet",
                .family = "Low",
                .formula = "A / (pi (1 + B (1-N.H))^C) G F(ior, L.H) / (N.L N.V), G = min(1, 2 N.H N.L/L.H, 2 N.H "
                           "N.V/L.H), F Fresnel's equations for the refractive index ior",
                .source = "Low, Kronander, Ynnerman, Unger 2012, specular term of the microfacet model; A is the peak "
                          "of a distribution that is not normalised, so the albedo may have any size",
                .parameters = {{"A", "1", 0, 1e6, std::nullopt, "peak of the distribution"},
                               {"B", "1", 0, 1e8, std::nullopt, "larger is sharper"},
                               {"C", "1", 0.01, 10, std::nullopt, "larger falls off faster"},
                               {"ior", "1", 1, 100, 1.5, "refractive index"}},
                .traits = {.conserves_energy = false}},
      .kernel = "low_microfacet",
      .typical = {1, 100, 2, 1.5},
      .coefficients =
          [](Values v) {
            return Coefficients{v[0] / pi, v[1], -v[2], v[3]};
          },
      .shape = [](Values v) -> LobeShape {
        return {.width = std::min(1.0, std::sqrt(2 / v[1])), .common = {.attenuation = true}};
      },
      .proposal = [](Values v, const draw::Scene& scene) -> draw::Parts {
        return draw::long_tail(scene.light, v[1] > 0 ? std::sqrt(2 / v[1]) : 1);
      },
      .known = KnownValues{"low_microfacet:A=0.74,B=16122,C=0.217,ior=1.81",
                           {0.2355493157760051, 16122, -0.217, 1.8100000000000001},
                           {0.010570952439957652, 0.0069267392445645053, 0.0061678320783028692, 0.21081641843374832}}};
}

}  // namespace lobe
