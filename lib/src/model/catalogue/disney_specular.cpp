#include "model/entry.hpp"

namespace lobe {
namespace {

/// a of Burley's GTR2.
double disney_facets(double rough) {
  return std::max(0.001, rough * rough);
}

}  // namespace

CatalogueEntry disney_specular_entry() {
  return {
      .model = {.name = "disney_specular",
                .family = "Disney",
                .formula =
                    "D F G(N.L) G(N.V), D = a^2 / (pi (1+(a^2-1) cos^2 delta)^2), cos delta = N.H, a = max(0.001, "
                    "rough^2), G(x) = 1/(x + sqrt(b^2+(1-b^2) x^2)), b = (1/2+rough/2)^2, F = f0 + (1-f0)(1-L.H)^5",
                .source = "Burley 2012, section 5.4: specular part of the principled model, isotropic, gamma = 2; 1/(4 "
                          "N.L N.V) is in G; the lower bound of a is that of the published shader",
                .parameters = {{"rough", "1", 0, 1, std::nullopt, "roughness"}, normal_reflectance()},
                .traits = {}},
      .kernel = "disney_specular",
      .typical = {0.5, 1},
      .coefficients =
          [](Values v) {
            const double a = disney_facets(v[0]);
            const double b = (0.5 + v[0] / 2) * (0.5 + v[0] / 2);
            return Coefficients{a * a / pi, a * a, v[1], 1 - v[1], b * b};
          },
      .shape = [](Values v) -> LobeShape { return {.width = disney_facets(v[0])}; },
      .proposal = [](Values v, const draw::Scene& scene) -> draw::Parts {
        return {draw::visible_facets(scene.light, disney_facets(v[0]))};
      },
      .known = KnownValues{"disney_specular:rough=0.3,f0=0.04",
                           {0.0025783100780887042, 0.0080999999999999996, 0.040000000000000001, 0.95999999999999996,
                            0.17850625000000003},
                           {0.16229228855590297, 0.00027304089192217419, 0.00036580055625857403, 3.8775379368128555}}};
}

}  // namespace lobe
