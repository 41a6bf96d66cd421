#include <algorithm>
#include <cmath>
#include <numbers>
#include <vector>

#include "model/catalogue/entries.hpp"
#include "model/constants.hpp"

namespace lobe {
namespace {

using std::numbers::pi;

Coefficients oren_nayar_coefficients(Values v) {
  const double s2 = v[0] * v[0];
  const double b = s2 / (s2 + 0.09);
  return {v[1] / pi * (1 - 0.5 * s2 / (s2 + v[2])), v[1] / pi * 0.45 * b, v[1] / pi * 0.125 * b,
          v[1] * v[1] / pi * 0.17 * s2 / (s2 + 0.13)};
}

/// Where the sum is 0, as oren_nayar_full.clh has it.
std::vector<Kink> oren_nayar_kinks(Values v) {
  constexpr double kPositive = 0.6;  // sigma below which the sum is
  if (v[0] < kPositive || v[1] == 0) return {};
  const auto at = [](const Kink::Numbers& c, const KinkPair& pair) {
    const double cos_i = std::min(pair.cos_i, 1.0);
    const double cos_o = std::min(pair.cos_o, 1.0);
    const double sin_i = std::sqrt((1 - cos_i) * (1 + cos_i));
    const double sin_o = std::sqrt((1 - cos_o) * (1 + cos_o));
    const double product = sin_i * sin_o;
    const double ratio = product > 0 ? (pair.cos_between - cos_i * cos_o) / product : 0;
    const double cos_psi = std::clamp(ratio, -1.0, 1.0);
    const double angle_i = std::acos(cos_i) * 2 / pi;
    const double angle_o = std::acos(cos_o) * 2 / pi;
    const double smaller = std::min(angle_i, angle_o);
    const double tan_beta = std::min(sin_i, sin_o) / std::max({cos_i, cos_o, 1e-300});
    const double forward = cos_psi < 0 ? smaller * smaller * smaller : 0;
    const double both = angle_i * angle_o;
    const double tan_mean = (sin_i + sin_o) / std::max(cos_i + cos_o, 1e-300);
    return c[0] + c[1] * cos_psi * tan_beta * (std::max(sin_i, sin_o) - forward) +
           c[2] * both * both * (1 - std::abs(cos_psi)) * tan_mean + c[3] * (1 - cos_psi * smaller * smaller);
  };
  const Coefficients c = oren_nayar_coefficients(v);
  return {{at, {c[0], c[1], c[2], c[3]}, 1}};
}

/// Above 0 where crowns do not shade each other, cos t = 1 (li_sparse.clh).
double crowns_apart(const Kink::Numbers& c, const KinkPair& pair) {
  const double sin_i = std::sqrt(std::max(0.0, (1 - pair.cos_i) * (1 + pair.cos_i)));
  const double sin_o = std::sqrt(std::max(0.0, (1 - pair.cos_o) * (1 + pair.cos_o)));
  const double product = pair.cos_i * pair.cos_o;
  const double sum = pair.cos_i + pair.cos_o;
  const double difference = pair.cos_i - pair.cos_o;
  const double sines = sin_o - sin_i;
  const double apart = 1 - pair.cos_between;
  const double p = std::max(0.0, apart - (difference * difference + sines * sines) / 2);
  const double q = std::max(0.0, 1 + pair.cos_between - (sum * sum + sines * sines) / 2);
  const double secants = std::sqrt(pair.cos_i * pair.cos_i + c[1] * sin_i * sin_i) * pair.cos_o +
                         std::sqrt(pair.cos_o * pair.cos_o + c[1] * sin_o * sin_o) * pair.cos_i;
  const double distance2 = difference * difference + std::max(0.0, 2 * product * apart) + c[1] * p * q;
  return c[0] * std::sqrt(distance2) - secants;
}

}  // namespace

void add_diffuse_models(Entries& entries) {
  entries.push_back({{"lambert", "Lambert", "1/pi", "Neumann 2001, eq. 1.27 and 1.28: ideal diffuse, albedo 1", {}, {}},
                     "lambert",
                     [](Values) { return Coefficients{1 / pi}; },
                     [](Values) { return 1.0; }});

  entries.push_back({{"minnaert",
                      "Minnaert",
                      "(k+2)/(2 pi) ((N.L) (N.V))^k",
                      "Neumann 2001, eq. 1.32 (Minnaert 1941): albedo (N.L)^k; k = 0 is Lambert",
                      {{"k", "1", 0, 100, std::nullopt, "exponent; larger is darker towards grazing angles"}},
                      {}},
                     "minnaert",
                     [](Values v) {
                       return Coefficients{cosine_lobe_constant(v[0]), v[0]};
                     },
                     [](Values v) { return half_lobe_width(2 * v[0]); }});

  entries.push_back({{"oren_nayar",
                      "Oren-Nayar",
                      "1/pi (A + B max(0, L.V - N.L N.V) / max(N.L, N.V)), A = 1 - 0.5 s^2/(s^2+a), B = 0.45 "
                      "s^2/(s^2+0.09), s = sigma",
                      "Neumann 2001, eq. 1.56 (Oren and Nayar 1994), simplified model at reflectance 1; sign of N.L "
                      "N.V corrected, and "
                      "a = 0.33 as published where the text prints 1/2. Albedo up to 1.015 at grazing angles",
                      {{"sigma", "rad", 0, pi / 2, std::nullopt, "standard deviation of the facets' slope angle"},
                       {"a_denominator", "1", 0.01, 10, 0.33, "constant a in the denominator of A"}},
                      {.conserves_energy = false}},
                     "oren_nayar",
                     [](Values v) {
                       const double s2 = v[0] * v[0];
                       return Coefficients{(1 - 0.5 * s2 / (s2 + v[1])) / pi, 0.45 * s2 / (s2 + 0.09) / pi};
                     },
                     [](Values) { return 1.0; }});

  entries.push_back(
      {{"oren_nayar_full",
        "Oren-Nayar",
        "rho/pi (A + B cos psi tan beta (sin alpha - [cos psi < 0] (2 beta/pi)^3) + 0.125 "
        "s^2/(s^2+0.09) (4 alpha beta/pi^2)^2 (1-|cos psi|) tan((alpha+beta)/2)) + 0.17 rho^2/pi "
        "s^2/(s^2+0.13) (1 - cos psi (2 beta/pi)^2), psi = phi_V-phi_L, alpha and beta the larger "
        "and the smaller angle from the normal, A = 1 - 0.5 s^2/(s^2+a), B = 0.45 s^2/(s^2+0.09), s "
        "= sigma",
        "Neumann 2001, eq. 1.57 to 1.59 (Oren and Nayar 1994) with the signs of the publication: "
        "L.V - N.L N.V, and rho^2 (1 - cos psi (2 beta/pi)^2) where the text prints rho cos psi (2 "
        "beta/pi)^2; a = 0.33 as published where it prints 1/2. Albedo up to 1.05 at grazing angles; "
        "where the sum is negative, about grazing mirror directions for sigma > 0.65 and small rho, it is 0",
        {{"sigma", "rad", 0, pi / 2, std::nullopt, "standard deviation of the facets' slope angle"},
         {"rho", "1", 0, 1, 1.0, "reflectance of the facets"},
         {"a_denominator", "1", 0.01, 10, 0.33, "constant a in the denominator of A"}},
        {.conserves_energy = false}},
       "oren_nayar_full",
       oren_nayar_coefficients,
       [](Values) { return 1.0; }});
  entries.back().kinks = oren_nayar_kinks;

  entries.push_back({{"lommel_seeliger",
                      "Lommel-Seeliger",
                      "1 / (4 pi (N.L + N.V))",
                      "Seeliger 1888; Hapke 1981, eq. 16 without opposition effect and multiple scattering, at "
                      "single-scattering albedo 1: isotropic scatterers, densely packed",
                      {},
                      {}},
                     "lommel_seeliger",
                     [](Values) { return Coefficients{1 / (4 * pi)}; },
                     [](Values) { return 1.0; }});

  const Parameter compaction{"g", "1", 0.01, 10, std::nullopt, "compaction; smaller is a sharper opposition peak"};
  const auto opposition_width = [](Values v) { return std::clamp(v[0] / 20, 1e-3, 0.5); };
  entries.push_back({{"hapke_lommel_seeliger",
                      "Lommel-Seeliger",
                      "1/pi R S / (N.L + N.V), R = 2 - tan(alpha)/(2 g) (1-e^(-g/tan alpha)) (3-e^(-g/tan alpha)) "
                      "for alpha < pi/2, else 1, S = (sin alpha + (pi-alpha) cos alpha)/pi, alpha the angle "
                      "between L and V",
                      "Neumann 2001, eq. 1.52 and 1.54 (Hapke 1963), back scattering; the text prints (N.L)(N.V) "
                      "for N.L + N.V, alpha > pi/2, e^(-g/sin g) for e^(-g/tan alpha), and a minus in S. Albedo above "
                      "1 at grazing angles for g > 2.5, up to 1.20",
                      {compaction},
                      {.conserves_energy = false}},
                     "hapke_lommel_seeliger",
                     [](Values v) {
                       return Coefficients{1 / pi, v[0]};
                     },
                     [](Values) { return 1.0; },
                     nullptr,
                     opposition_width});

  entries.push_back({{"hapke_forward",
                      "Lommel-Seeliger",
                      "4/(9 pi) R (1 - cos(alpha)/2) / (N.L + N.V), R as in hapke_lommel_seeliger, alpha the angle "
                      "between L and V",
                      "Neumann 2001, eq. 1.52 and 1.53 (Hapke 1963), forward scattering; 1.52 with the corrections of "
                      "hapke_lommel_seeliger. Albedo above 1 at grazing angles for g > 3.3, up to 1.09",
                      {compaction},
                      {.conserves_energy = false}},
                     "hapke_forward",
                     [](Values v) {
                       return Coefficients{4 / (9 * pi), v[0]};
                     },
                     [](Values) { return 1.0; },
                     nullptr,
                     opposition_width});

  entries.push_back({{"hapke_isotropic",
                      "Lommel-Seeliger",
                      "1/pi R / (N.L + N.V), R as in hapke_lommel_seeliger",
                      "Neumann 2001, eq. 1.52 with S = 1 (Hapke 1963), isotropic scattering; 1.52 with the corrections "
                      "of hapke_lommel_seeliger. Albedo at grazing angles from 2 (g = 0.01) to 2.65 (g = 10)",
                      {compaction},
                      {.conserves_energy = false}},
                     "hapke_isotropic",
                     [](Values v) {
                       return Coefficients{1 / pi, v[0]};
                     },
                     [](Values) { return 1.0; },
                     nullptr,
                     opposition_width});

  entries.push_back({{"lacquer",
                      "lacquer",
                      "1/pi exp(-s (1/N.L + 1/N.V))",
                      "Neumann 2001, eq. 1.60: white paint under an absorbing layer, s >= 0 where s <= 0 is "
                      "printed; the mirror of its surface (1.61) is not in it",
                      {{"s", "1", 0, 100, std::nullopt, "optical depth of the layer; 0 is Lambert"}},
                      {}},
                     "lacquer",
                     [](Values v) {
                       return Coefficients{1 / pi, -v[0]};
                     },
                     [](Values) { return 1.0; }});

  entries.push_back({{"sandwich",
                      "sandwich",
                      "1/pi / (2 + k (1/N.L + 1/N.V))^n",
                      "Neumann 2001, eq. 1.62 and 1.63 over Lambert: infinitely many layers of lacquer and "
                      "flecks; k is the ratio of what a layer absorbs to what it reflects, the inverse of what "
                      "the text says",
                      {{"k", "1", 0, 1e4, std::nullopt, "absorbed by reflected light of a layer"},
                       {"n", "1", 0, 20, 1.0, "order: flecks that are sandwiches themselves"}},
                      {}},
                     "sandwich",
                     [](Values v) {
                       return Coefficients{1 / pi, v[0], v[1]};
                     },
                     [](Values) { return 1.0; }});

  entries.push_back({{"disney_diffuse",
                      "Disney diffuse",
                      "1/pi (1 + (d-1)(1-N.L)^5) (1 + (d-1)(1-N.V)^5), d = 0.5 + 2 rough (L.H)^2",
                      "Burley 2012, section 5.3: diffuse part of the principled model at base colour 1. Albedo up to "
                      "1.56 at grazing angles",
                      {{"rough", "1", 0, 1, std::nullopt, "roughness"}},
                      {.conserves_energy = false}},
                     "disney_diffuse",
                     [](Values v) {
                       return Coefficients{1 / pi, 2 * v[0]};
                     },
                     [](Values) { return 1.0; }});

  entries.push_back({{"ashikhmin_shirley_diffuse",
                      "Ashikhmin-Shirley",
                      "28/(23 pi) (1-f0) (1-(1-N.L/2)^5) (1-(1-N.V/2)^5)",
                      "Ashikhmin and Shirley 2000, diffuse term at R_d = 1: what ashikhmin_shirley lets through",
                      {{"f0", "1", 0, 1, 0.05, "Fresnel reflectance of the surface at normal incidence"}},
                      {}},
                     "ashikhmin_shirley_diffuse",
                     [](Values v) { return Coefficients{28 * (1 - v[0]) / (23 * pi)}; },
                     [](Values) { return 1.0; }});

  entries.push_back(
      {{"ross_thick",
        "Ross-Li",
        "1/pi (((pi/2-xi) cos xi + sin xi) / (N.L+N.V) - pi/4), xi the angle between L and V",
        "Lucht, Schaaf, Strahler 2000, eq. 38 (Ross 1981): volume-scattering kernel, a reflectance factor "
        "there, hence 1/pi here; its mean albedo is the white-sky albedo of the kernel, 0.189186 (there 0.189184). "
        "Negative where the isotropic part is larger, albedo up to pi/2 at grazing angles",
        {},
        {.conserves_energy = false, .non_negative = false}},
       "ross_thick",
       [](Values) { return Coefficients{1 / pi}; },
       [](Values) { return 1.0; }});

  entries.push_back(
      {{"li_sparse",
        "Ross-Li",
        "1/pi (O - sec L' - sec V' + (1 + cos xi') sec L' sec V'/2), O = (t - sin t cos t) (sec L' + sec "
        "V')/pi, cos t = min(1, h_b sqrt(D^2 + (tan L' tan V' sin phi)^2) / (sec L' + sec V')), tan X' = "
        "b_r tan(theta_X), D^2 = tan^2 L' + tan^2 V' - 2 tan L' tan V' cos phi, cos xi' = cos L' cos V' "
        "+ sin L' sin V' cos phi, phi = phi_V - phi_L",
        "Lucht, Schaaf, Strahler 2000, eq. 39 to 44 (Wanner, Li, Strahler 1995): reciprocal geometric "
        "kernel, a reflectance factor there, hence 1/pi here; its mean albedo is the white-sky albedo of "
        "the kernel, -1.3776579 by default, not -1.377622. Mostly negative; it grows as 1/(N.L) at grazing angles, so "
        "that norms are infinite (the albedo does not for b_r = 1, but is out of reach, too)",
        {{"h_b", "1", 0.1, 10, 2.0, "height of the crowns over their vertical radius"},
         {"b_r", "1", 0.1, 10, 1.0, "vertical over horizontal radius of the crowns"}},
        {.conserves_energy = false, .non_negative = false}},
       "li_sparse",
       [](Values v) {
         return Coefficients{1 / pi, v[0] * v[1], v[1] * v[1]};
       },
       [](Values) { return 1.0; },
       nullptr,
       [](Values v) { return std::clamp(0.25 / (v[0] * v[1]), 1e-3, 0.5); },
       [](Values) { return true; }});
  entries.back().kinks = [](Values v) { return std::vector<Kink>{{crowns_apart, {v[0] * v[1], v[1] * v[1]}, 1.5}}; };
}

}  // namespace lobe
