#include "model/entry.hpp"

namespace lobe {
namespace {

std::vector<Kink> coated_metal_kinks(Values v) {
  const auto kinks = critical_kinks(v[1], v[2]);
  if (kinks.empty()) return {};
  // cos^2 theta' = (1 + L.V)/2 + (N.L - N.V)^2/4
  const auto at = [](const Kink::Numbers& ior, const KinkPair& pair) {
    const double difference = pair.cos_i - pair.cos_o;
    return (1 + pair.cos_between) / 2 + difference * difference / 4 - (1 - ior[0]) * (1 + ior[0]);
  };
  return {{at, {v[1]}, kinks.front().order}};
}

}  // namespace

CatalogueEntry coated_metal_entry() {
  return {
      .model =
          {.name = "coated_metal",
           .family = "coated metal",
           .formula = "s^2 / (2 pi (1-(1+s)e^-s)) exp(-s |V_P-L'_P|) F(ior, k, cos theta'), sin theta' = |V_P-L_P|/2, "
                      "F Fresnel's equations for the refractive index ior - ik",
           .source =
               "Neumann 2001, eq. 4.54 and 4.53 with eq. 1.41 to 1.43, the squares as |.|^2; normalised as eq. 4.46 "
               "is, which differs from s^2/(2 pi) for small s. With k = 0 the specular part of plastics (4.55)",
           .parameters = {{"s", "1", 1e-3, 1e6, std::nullopt,
                           "decay per unit of base-plane distance; larger is sharper"},
                          refractive_index(),
                          extinction()},
           .traits = {}},
      .kernel = "coated_metal",
      .typical = {10, 1.58, 0},
      .coefficients =
          [](Values v) {
            return Coefficients{exponential_patch_constant(v[0]), -v[0], v[1], v[2]};
          },
      .shape = [](Values v) -> LobeShape {
        return {.width = std::min(1.0, 1 / (2 * v[0])), .kinks = coated_metal_kinks(v)};
      },
      .proposal = draw::exponential,
      .known = KnownValues{"coated_metal:s=2,ior=1.5,k=0",
                           {1.0717610132298394, -2, 1.5},
                           {0.033167477768108973, 0.0040996499084765626, 0.004889598668994184, 0.1696385010375894}}};
}

}  // namespace lobe
