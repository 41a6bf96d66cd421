#include "model/entry.hpp"
#include "model/family/azimuths.hpp"

namespace lobe {
namespace {

/// Root mean square slopes of a clean sea along the wind and across it (Cox and Munk 1954).
struct WindSlopes {
  explicit WindSlopes(double wind) : along(std::sqrt(0.00316 * wind)), across(std::sqrt(0.003 + 0.00192 * wind)) {}
  double along, across;
};

/// Where the series of Gram and Charlier, times a power of L_z + V_z, is 0. Below the least wind it is so nowhere.
std::vector<Kink> series_kinks(double wind, double rotation) {
  constexpr double kLeastWind = 8.5;
  if (wind < kLeastWind) return {};
  const auto at = [](const Kink::Numbers& n, const KinkPair& pair) {
    const double x = pair.in_x + pair.out_x;
    const double y = pair.in_y + pair.out_y;
    const double z = pair.cos_i + pair.cos_o;
    const double u = n[0] * x + n[1] * y;
    const double u2 = u * u;
    const double v2 = std::pow(n[2] * x + n[3] * y, 2);
    const double z2 = z * z;
    const double skewness = u * z * ((0.005 - 0.0043 * n[4]) * (v2 - z2) + (0.04 - 0.033 * n[4]) / 6 * (u2 - 3 * z2));
    const double peakedness = 0.4 / 24 * (v2 * (v2 - 6 * z2) + 3 * z2 * z2) + 0.03 * (v2 - z2) * (u2 - z2) +
                              0.23 / 24 * (u2 * (u2 - 6 * z2) + 3 * z2 * z2);
    return z2 * z2 - skewness + peakedness;
  };
  const WindSlopes slope(wind);
  const Axis axis(rotation);
  return {{.at = at,
           .numbers = {axis.cosine / slope.along, axis.sine / slope.along, -axis.sine / slope.across,
                       axis.cosine / slope.across, wind},
           .order = 1,
           .is_anisotropic = true}};
}

}  // namespace

CatalogueEntry cox_munk_anisotropic_entry() {
  return {
      .model = {.name = "cox_munk_anisotropic",
                .family = "Beckmann",
                .formula =
                    "p F(ior, k, L.H) / (4 cos^4 delta N.L N.V (1 + Lambda(L) + Lambda(V))), cos delta = N.H, p = "
                    "exp(-(xi^2 + eta^2)/2) / (2 pi s_u s_c) max(0, 1 - c21/2 (xi^2 - 1) eta - c03/6 (eta^3 - 3 eta) "
                    "+ c40/24 (xi^4 - 6 xi^2 + 3) + c22/4 (xi^2 - 1)(eta^2 - 1) + c04/24 (eta^4 - 6 eta^2 + 3)), eta "
                    "and xi the slopes of the facet upwind and across, over s_u and s_c; s_u^2 = 0.00316 wind, s_c^2 "
                    "= 0.003 + 0.00192 wind, c21 = 0.01 - 0.0086 wind, c03 = 0.04 - 0.033 wind, c40 = 0.4, c22 = "
                    "0.12, c04 = 0.23; Lambda as in beckmann with m^2 = 2 (s_u^2 cos^2 + s_c^2 sin^2) in the azimuth "
                    "from the wind, F Fresnel's equations for the refractive index ior - ik",
                .source =
                    "Cox and Munk 1954: glitter of a clean sea, with its skewness and peakedness, measured in winds up "
                    "to 14 m/s; of the sum of both squares the paper has another fit, that of cox_munk. The factor of "
                    "the series, negative far out from 9 m/s on, is 0 there. Smith's "
                    "height-correlated attenuation (Heitz 2014, eq. 86 and 99) of Gaussian slopes; F of Neumann 2001, "
                    "eq. 1.41 to 1.43. Where F is nearly 1 and winds above 15 m/s, albedos are above 1 at grazing "
                    "angles. Steep facets rise upwind, so that half a turn changes the lobe. What the water "
                    "and its foam scatter is not in it",
                .parameters = {{"wind", "m/s", 0.5, 30, std::nullopt, "speed of the wind, 12.5 m above the sea"},
                               {"ior", "1", 0.01, 100, 1.34, "refractive index; of sea water 1.34 in visible light"},
                               extinction(),
                               {"rotation", "rad", -pi, pi, 0.0, "azimuth to which the wind blows, from the x axis"}},
                .traits = {.isotropic = false, .conserves_energy = false}},
      .kernel = "cox_munk_anisotropic",
      .typical = {10, 1.34, 0, 0.4},
      .coefficients =
          [](Values v) {
            const WindSlopes slope(v[0]);
            const Axis axis(v[3]);
            return Coefficients{1 / (8 * pi * slope.along * slope.across),
                                axis.cosine / slope.along,
                                axis.sine / slope.along,
                                -axis.sine / slope.across,
                                axis.cosine / slope.across,
                                std::numbers::sqrt2 * slope.along * slope.along,
                                std::numbers::sqrt2 * slope.across * slope.across,
                                v[1],
                                v[2],
                                v[0]};
          },
      .shape = [](Values v) -> LobeShape {
        const WindSlopes slope(v[0]);
        LobeShape shape{.width = std::numbers::sqrt2 * std::min(slope.along, slope.across),
                        .aspect = 2 * aspect_of(slope.along, slope.across),
                        .half_turn = false,
                        .kinks = series_kinks(v[0], v[3])};
        const auto critical = critical_kinks(v[1], v[2]);
        shape.kinks.insert(shape.kinks.end(), critical.begin(), critical.end());
        return shape;
      },
      .proposal = [](Values v, const draw::Scene&) -> draw::Parts {
        const WindSlopes slope(v[0]);
        return {draw::beckmann(std::numbers::sqrt2 * slope.along, std::numbers::sqrt2 * slope.across, v[3])};
      },
      .known = KnownValues{"cox_munk_anisotropic:wind=5,ior=1.34,k=0,rotation=0.6",
                           {2.8199819224696627, 6.566017603310498, 4.4920543266442126, -5.0302349558686732,
                            7.3526740478438359, 0.022344574285494904, 0.017819090885900998, 1.3400000000000001, 0, 5},
                           {0.064819555838461718, 2.4538166165642056e-11, 1.2217490482236137e-09, 3.11356618427186}}};
}

}  // namespace lobe
