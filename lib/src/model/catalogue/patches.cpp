#include <algorithm>
#include <cmath>
#include <numbers>
#include <vector>

#include "model/catalogue/entries.hpp"
#include "model/constants.hpp"

namespace lobe {
namespace {

using std::numbers::pi;
constexpr double kWholeBasePlane = 2;  // no two points of the unit disc are farther apart

Coefficients basic_patch_coefficients(Values v) {
  const double square = v[0] * v[0];
  // At R = 2 rounding must not cut off the farthest direction at grazing angles.
  const double limit = v[0] < kWholeBasePlane ? square : 2 * square;
  return {1 / (pi * std::min(1.0, square)), limit};
}

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

/// \param v R, inner, rise
Coefficients patch_band_coefficients(Values v) {
  const double inner = v[0] * v[1];
  const double width = v[0] - inner;
  const double slope = 2 * (2 * v[2] - 1) / (width * width);
  return {(2 * (1 - v[2]) / width - slope * inner) / pi, slope / pi, inner, v[0]};
}

double inner_radius(Values v) {
  return v[0] * v[1];
}

}  // namespace

void add_patch_models(Entries& entries) {
  entries.push_back({{"basic_patch",
                      "basic patch",
                      "1 / (pi min(1, R^2)) for |V_P-L'_P| <= R, else 0",
                      "Neumann 2001, eq. 4.2 and 4.7: patch-based BRDF, constant within a base-plane distance R of the "
                      "mirror direction (4.1); R = 2 is Lambert",
                      {{"R", "1", 1e-5, kWholeBasePlane, std::nullopt, "radius in the base plane; smaller is sharper"}},
                      {}},
                     "basic_patch",
                     basic_patch_coefficients,
                     [](Values v) { return std::min(1.0, v[0] / 2); },
                     [](Values v) { return v[0]; }});

  entries.push_back({{"retro_patch",
                      "basic patch",
                      "1 / (pi min(1, R^2)) for |V_P-L_P| <= R, else 0",
                      "Neumann 2001, eq. 4.2 with the metric of 4.29, and 4.7: the basic patch about the retro "
                      "direction; R = 2 is Lambert",
                      {{"R", "1", 0.01, kWholeBasePlane, std::nullopt, "radius in the base plane; smaller is sharper"}},
                      {}},
                     "retro_patch",
                     basic_patch_coefficients,
                     [](Values) { return 1.0; },
                     nullptr,
                     [](Values v) { return std::min(0.5, v[0] / 2); },
                     nullptr,
                     [](Values v) { return v[0]; }});

  entries.push_back(
      {{"patch_frustum",
        "patch profile",
        "c min(1, (R-m)/(R-rR)) for m = |V_P-L'_P| <= R, else 0",
        "Neumann 2001, eq. 4.39 with the constant of 4.42: patch-based BRDF whose profile is constant up to "
        "rR and falls linearly to 0 at R; the 'profile' of a study file is a sum of these",
        {{"R", "1", 1e-5, kWholeBasePlane, std::nullopt, "radius in the base plane; smaller is sharper"},
         {"inner", "1", 0, 0.999, 0.0, "r, where the profile begins to fall, by R; 0 is a cone"}},
        {}},
       "patch_frustum",
       patch_frustum_coefficients,
       [](Values v) { return std::min(1.0, v[0] / 2); },
       [](Values v) { return v[0]; }});
  entries.back().inner_patch_radius = inner_radius;

  entries.push_back(
      {{"patch_band",
        "patch mixture",
        "integral of p(t) / (pi min(1,t^2)) over t from max(m, rR) to R, m = |V_P-L'_P|",
        "Neumann 2001, eq. 4.20 and 4.40 with c(R) of 4.7, by which 4.40 as printed multiplies: basic patches mixed by "
        "a "
        "density p that is linear from rR to R, p(rR) : p(R) = 1-q : q; the 'mixture' of a study file is a sum of "
        "these",
        {{"R", "1", 1e-5, kWholeBasePlane, std::nullopt, "largest radius in the base plane; smaller is sharper"},
         {"inner", "1", 1e-3, 0.999, std::nullopt, "r, the smallest radius by R"},
         {"rise", "1", 0, 1, 0.5, "q, share of the density at R; 0.5 is uniform"}},
        {}},
       "patch_band",
       patch_band_coefficients,
       [](Values v) {
         return std::min({1.0, v[0] / 2, 1.5 * inner_radius(v)});
       },
       [](Values v) { return v[0]; }});
  entries.back().inner_patch_radius = inner_radius;
  // The constant of a basic patch has a kink at a radius of 1.
  entries.back().kinks = [](Values v) -> std::vector<Kink> {
    if (v[0] <= 1 || inner_radius(v) >= 1) return {};
    return {distance_kink(1, 2)};
  };

  entries.push_back(
      {{"exponential_patch",
        "exponential patch",
        "s^2 / (2 pi (1-(1+s)e^-s)) exp(-s |V_P-L'_P|)",
        "Neumann 2001, eq. 4.46: patch-based BRDF with exponential profile; |V_P-L'_P| is the distance of "
        "V from the mirror direction in the base plane (4.1)",
        {{"s", "1", 1e-3, 1e6, std::nullopt, "decay per unit of base-plane distance; larger is sharper"}},
        {}},
       "exponential_patch",
       [](Values v) {
         return Coefficients{exponential_patch_constant(v[0]), -v[0]};
       },
       [](Values v) { return std::min(1.0, 1 / (2 * v[0])); }});

  entries.push_back({{"patch_power",
                      "power patch",
                      "(n+1)(n+2)/(2 pi) max(0, 1-|V_P-L'_P|)^n",
                      "Neumann 2001, eq. 5.12: patch-based BRDF with the profile of a power",
                      {{"n", "1", 0.01, 1e6, std::nullopt, "exponent; larger is sharper"}},
                      {}},
                     "patch_power",
                     [](Values v) {
                       return Coefficients{(v[0] + 1) * (v[0] + 2) / (2 * pi), v[0]};
                     },
                     [](Values v) { return std::min(1.0, 1 / (2 * v[0])); },
                     [](Values) { return 1.0; }});

  entries.push_back(
      {{"patch_character",
        "patch character",
        "s^2 / (2 pi (1-(1+s)e^-s)) exp(-s |V_P-L'_P|) (N.B)^alpha, B_P = (L'_P+V_P)/2, (N.B)^2 = 1 - |V_P-L_P|^2/4",
        "Neumann 2001, eq. 5.9 to 5.11 with the character (N.B)^alpha, projected onto the base plane, B "
        "the bisecting point there (5.2.3): alpha = 0 is exponential_patch, alpha = -1 the metallic "
        "class. The constant is that of 4.46, not 1/sup of 5.9: for alpha < 0 the albedo exceeds 1 "
        "towards grazing angles, for alpha = -1 by a factor that grows as sqrt(s)",
        {{"s", "1", 1e-3, 1e6, std::nullopt, "decay per unit of base-plane distance; larger is sharper"},
         {"alpha", "1", -2, 2, -1.0, "power of the bisector's cosine"}},
        {.conserves_energy = false}},
       "patch_character",
       [](Values v) {
         return Coefficients{exponential_patch_constant(v[0]), -v[0], v[1] / 2};
       },
       [](Values v) { return std::min(1.0, 1 / (2 * v[0])); }});

  entries.push_back({{"generalised_lambert",
                      "generalised Lambert",
                      "C (1 - min(|V_P-L'_P|, clip)^2/4)^(-d/2)",
                      "Neumann 2001, eq. 4.58 and 4.59; C makes the albedo at grazing incidence, the largest, 1 "
                      "(Table 4.3, whose C_max is wrong from the fourth digit on)",
                      {{"d", "1", 0, 1, std::nullopt, "0 is Lambert, 1 the full moon"},
                       {"clip", "1", 0.1, 1.99, 1.9, "base-plane distance from which on the function is constant"}},
                      {}},
                     "generalised_lambert",
                     [](Values v) {
                       return Coefficients{generalised_lambert_constant(v[0], v[1]), -v[0] / 2, 1 - v[1] * v[1] / 4};
                     },
                     [](Values) { return 1.0; },
                     [](Values v) { return v[1]; }});

  entries.push_back({{"coated_metal",
                      "coated metal",
                      "s^2 / (2 pi (1-(1+s)e^-s)) exp(-s |V_P-L'_P|) F(ior, k, cos theta'), sin theta' = |V_P-"
                      "L_P|/2, F Fresnel's equations for the refractive index ior - ik",
                      "Neumann 2001, eq. 4.54 and 4.53 with eq. 1.41 to 1.43, the squares as |.|^2; normalised as "
                      "eq. 4.46 is, which differs from s^2/(2 pi) for small s. With k = 0 the specular part of "
                      "plastics (4.55)",
                      {{"s", "1", 1e-3, 1e6, std::nullopt, "decay per unit of base-plane distance; larger is sharper"},
                       refractive_index(),
                       extinction()},
                      {}},
                     "coated_metal",
                     [](Values v) {
                       return Coefficients{exponential_patch_constant(v[0]), -v[0], v[1], v[2]};
                     },
                     [](Values v) { return std::min(1.0, 1 / (2 * v[0])); }});
  entries.back().kinks = [](Values v) -> std::vector<Kink> {
    const auto kinks = critical_kinks(v[1], v[2]);
    if (kinks.empty()) return {};
    // cos^2 theta' = (1 + L.V)/2 + (N.L - N.V)^2/4
    const auto at = [](const Kink::Numbers& ior, const KinkPair& pair) {
      const double difference = pair.cos_i - pair.cos_o;
      return (1 + pair.cos_between) / 2 + difference * difference / 4 - (1 - ior[0]) * (1 + ior[0]);
    };
    return {{at, {v[1]}, kinks.front().order}};
  };

  entries.push_back({{"tobler_power",
                      "Tobler",
                      "2 (n+1)/pi max(0, R_S.V_S)^n, X_S = 2 (N.X) X - N",
                      "Neumann 2001, eq. 1.71 (Tobler, Neumann, Sbert, Purgathofer 1998), which lacks the factor "
                      "2/pi: a cosine lobe on the sphere within the hemisphere, of albedo 1 for every direction",
                      {{"n", "1", 1e-3, 1e6, std::nullopt, "exponent; larger is sharper"}},
                      {}},
                     "tobler_power",
                     [](Values v) {
                       return Coefficients{2 * (v[0] + 1) / pi, v[0]};
                     },
                     [](Values v) { return mirror_lobe_width(4 * v[0]); }});
  entries.back().kinks = [](Values v) -> std::vector<Kink> {
    if (v[0] >= kSmoothOrder) return {};
    // R_S.V_S, by the square of the distance in the base plane.
    const auto at = [](const Kink::Numbers&, const KinkPair& pair) {
      const double sum = pair.cos_i + pair.cos_o;
      const double difference = pair.cos_i - pair.cos_o;
      const double product = pair.cos_i * pair.cos_o;
      const double across2 = 2 * (1 + pair.cos_between) - sum * sum;
      return 1 - 2 * (difference * difference * (1 + product) + product * across2);
    };
    return {{at, {}, v[0]}};
  };

  entries.push_back({{"tobler_exponential",
                      "Tobler",
                      "2 s / (pi (1-e^(-2s))) exp(-s (1-R_S.V_S)), X_S = 2 (N.X) X - N",
                      "Neumann 2001, eq. 1.72 (Tobler, Neumann, Sbert, Purgathofer 1998), which lacks the factor "
                      "2/pi: of albedo 1 for every direction",
                      {{"s", "1", 1e-3, 1e6, std::nullopt, "decay; larger is sharper"}},
                      {}},
                     "tobler_exponential",
                     [](Values v) {
                       return Coefficients{2 * v[0] / (-pi * std::expm1(-2 * v[0])), -v[0]};
                     },
                     [](Values v) { return std::min(1.0, mirror_lobe_width(4 * v[0])); }});
}

}  // namespace lobe
