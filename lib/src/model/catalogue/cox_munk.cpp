#include "model/entry.hpp"
#include "model/family/beckmann.hpp"

namespace lobe {
namespace {

/// Root of the mean square slope (Cox and Munk 1954, clean sea).
double slope_under(double wind) {
  return std::sqrt(0.003 + 0.00512 * wind);
}

}  // namespace

CatalogueEntry cox_munk_entry() {
  return {
      .model = {.name = "cox_munk",
                .family = "Beckmann",
                .formula = "D F(ior, k, L.H) / (4 N.L N.V (1 + Lambda(N.L) + Lambda(N.V))), D and Lambda as in "
                           "beckmann, m^2 = 0.003 + 0.00512 wind, F Fresnel's equations for the refractive index ior - "
                           "ik",
                .source = "Cox and Munk 1954: glitter of a clean sea, slopes alike in all directions of the wind and "
                          "without skewness; Smith's height-correlated attenuation (Heitz 2014, eq. 99), without which "
                          "albedos grow beyond bounds towards the horizon; F of Neumann 2001, eq. 1.41 to 1.43. What "
                          "the water and its foam scatter is not in it",
                .parameters = {{"wind", "m/s", 0, 100, std::nullopt, "speed of the wind, 12.5 m above the sea"},
                               {"ior", "1", 0.01, 100, 1.34, "refractive index; of sea water 1.34 in visible light"},
                               extinction()},
                .traits = {}},
      .kernel = "cox_munk",
      .typical = {5, 1.34, 0},
      .coefficients = [](Values v) { return beckmann_coefficients(slope_under(v[0]), v[1], v[2]); },
      .shape = [](Values v) -> LobeShape { return {.width = slope_under(v[0]), .kinks = critical_kinks(v[1], v[2])}; },
      .proposal = [](Values v, const draw::Scene&) -> draw::Parts {
        return {draw::beckmann(slope_under(v[0]), slope_under(v[0]), 0)};
      },
      .known = KnownValues{"cox_munk:wind=5,ior=1.34,k=0",
                           {2.7824290750331353, -34.96503496503496, 1.3400000000000001, 0, 0.16911534525287764},
                           {0.061434021885023213, 3.628847569421221e-12, 5.8272294887858167e-10, 2.9317299384729281}}};
}

}  // namespace lobe
