#include "model/entry.hpp"

namespace lobe {
namespace {

// F sees the larger cosine; where it is the smaller one that is critical there is nothing, at the price of a limit.
std::vector<Kink> metal_phong_fresnel_kinks(Values v) {
  const auto kinks = critical_kinks(v[1], v[2]);
  return kinks.empty() ? kinks : cosine_kinks(std::sqrt((1 - v[1]) * (1 + v[1])), kinks.front().order);
}

}  // namespace

CatalogueEntry metal_phong_fresnel_entry() {
  return {
      .model = {.name = "metal_phong_fresnel",
                .family = "metal Phong",
                .formula = "(n+2)/(2 pi) max(0, R.V)^n / M F(ior, k, M), M = max(N.L, N.V), F Fresnel's equations for "
                           "the refractive index ior - ik",
                .source = "Neumann 2001, eq. 3.29 with eq. 1.41 to 1.43, the squares as |.|^2; with k = 0 the specular "
                          "part of plastics (3.30). For n < 1.62 the albedo may exceed 1 as that of metal_phong",
                .parameters = {exponent(), refractive_index(), extinction()},
                .traits = {.conserves_energy = false}},
      .kernel = "metal_phong_fresnel",
      .typical = {40, 1.58, 0},
      .coefficients =
          [](Values v) {
            return Coefficients{cosine_lobe_constant(v[0]), v[0], v[1], v[2]};
          },
      .shape = [](Values v) -> LobeShape {
        return {.width = mirror_lobe_width(v[0]),
                .kinks = metal_phong_fresnel_kinks(v),
                .common = {.mirror_cosine = v[0] < kSmoothOrder}};
      },
      .proposal = draw::mirror_power,
      .known = KnownValues{"metal_phong_fresnel:n=20,ior=1.5,k=0",
                           {3.5014087480216975, 20, 1.5},
                           {0.12478394379328955, 4.4297603291686891e-12, 5.3759002323155353e-13, 1.4487977057074111}}};
}

}  // namespace lobe
