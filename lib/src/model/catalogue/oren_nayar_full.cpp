#include "model/entry.hpp"

namespace lobe {
namespace {

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

}  // namespace

CatalogueEntry oren_nayar_full_entry() {
  return {
      .model =
          {.name = "oren_nayar_full",
           .family = "Oren-Nayar",
           .formula = "rho/pi (A + B cos psi tan beta (sin alpha - [cos psi < 0] (2 beta/pi)^3) + 0.125 s^2/(s^2+0.09) "
                      "(4 alpha beta/pi^2)^2 (1-|cos psi|) tan((alpha+beta)/2)) + 0.17 rho^2/pi s^2/(s^2+0.13) (1 - "
                      "cos psi (2 beta/pi)^2), psi = phi_V-phi_L, alpha and beta the larger and the smaller angle from "
                      "the normal, A = 1 - 0.5 s^2/(s^2+a), B = 0.45 s^2/(s^2+0.09), s = sigma",
           .source = "Neumann 2001, eq. 1.57 to 1.59 (Oren and Nayar 1994) with the signs of the publication: L.V - "
                     "N.L N.V, and rho^2 (1 - cos psi (2 beta/pi)^2) where the text prints rho cos psi (2 beta/pi)^2; "
                     "a = 0.33 as published where it prints 1/2. Albedo up to 1.05 at grazing angles; where the sum is "
                     "negative, about grazing mirror directions for sigma > 0.65 and small rho, it is 0",
           .parameters = {{"sigma", "rad", 0, pi / 2, std::nullopt, "standard deviation of the facets' slope angle"},
                          {"rho", "1", 0, 1, 1.0, "reflectance of the facets"},
                          {"a_denominator", "1", 0.01, 10, 0.33, "constant a in the denominator of A"}},
           .traits = {.conserves_energy = false}},
      .kernel = "oren_nayar_full",
      .typical = {0.2, 1, 0.33},
      .coefficients = oren_nayar_coefficients,
      .shape = [](Values v) -> LobeShape { return {.kinks = oren_nayar_kinks(v)}; },
      .proposal = draw::diffuse,
      .known = KnownValues{"oren_nayar_full:sigma=0.3,rho=0.9",
                           {0.25578472996911755, 0.064457751952217618, 0.017904931097838226, 0.017930974633980537},
                           {0.26259726880861484, 0.28860224370726445, 0.28501355948385232, 0.20084132565677837}}};
}

}  // namespace lobe
