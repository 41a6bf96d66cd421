#include "model/catalogue.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <string>
#include <vector>

#include "core/text.hpp"
#include "lobe/error.hpp"

namespace lobe {
namespace {

using std::numbers::pi;
using Values = std::span<const double>;

constexpr std::string_view kExponentHelp = "exponent; larger is sharper";
constexpr std::string_view kRoughnessHelp = "rms slope of the microfacets; smaller is sharper";

// Bounds that keep every value and every square of a value a finite double.
constexpr double kLargestExponent = 1e10;
constexpr double kSmallestRoughness = 1e-5;

constexpr double kWholeBasePlane = 2;  // no two points of the unit disc are farther apart

Parameter exponent() {
  return {"n", "1", 1e-3, kLargestExponent, std::nullopt, kExponentHelp};
}
Parameter roughness() {
  return {"m", "1", kSmallestRoughness, 100, std::nullopt, kRoughnessHelp};
}

double cosine_lobe_constant(double n) {
  return (n + 2) / (2 * pi);
}

/// Half-vector width of (R.V)^n, where the angle between R and V is twice that of H from N.
double mirror_lobe_width(double n) {
  return std::min(1.0, 1 / std::sqrt(2 * n));
}
double half_lobe_width(double n) {
  return std::min(1.0, std::sqrt(2 / n));
}

/// 1 - (1+s) e^-s without cancellation: its series, sum over n >= 2 of (-1)^n (n-1) s^n / n!, for small s.
double exponential_patch_area(double s) {
  if (s >= 1) return 1 - (1 + s) * std::exp(-s);
  double sum = 0;
  double power = -s;  // (-s)^n / n!
  for (int n = 2; n <= 20; ++n) {
    power *= -s / n;
    sum += (n - 1) * power;
  }
  return sum;
}

/// A model without values in sr^-1: what split_delta() takes out of a material. It has no kernel.
CatalogueEntry delta_part(std::string_view name, std::string_view family, std::string_view formula,
                          std::string_view source) {
  return {
      {name, family, formula, source, {{"rho", "1", 0, 1, 1.0, "reflected share of the light"}}, {.has_delta = true}},
      {},
      [](Values) { return Coefficients{}; },
      [](Values) { return 1.0; }};
}

std::vector<CatalogueEntry> make_catalogue() {
  std::vector<CatalogueEntry> entries;

  entries.push_back({{"basic_patch",
                      "basic patch",
                      "1 / (pi min(1, R^2)) for |V_P-L'_P| <= R, else 0",
                      "Neumann 2001, eq. 4.2 and 4.7: patch-based BRDF, constant within a base-plane distance R of the "
                      "mirror direction (4.1); R = 2 is Lambert",
                      {{"R", "1", 1e-5, kWholeBasePlane, std::nullopt, "radius in the base plane; smaller is sharper"}},
                      {}},
                     "basic_patch",
                     [](Values v) {
                       const double square = v[0] * v[0];
                       // At R = 2 rounding must not cut off the retro direction at grazing angles.
                       const double limit = v[0] < kWholeBasePlane ? square : 2 * square;
                       return Coefficients{1 / (pi * std::min(1.0, square)), limit, 0, 0};
                     },
                     [](Values v) { return std::min(1.0, v[0] / 2); },
                     [](Values v) { return v[0]; }});

  entries.push_back(
      {{"blinn",
        "Blinn",
        "C(n) (N.H)^n",
        "Neumann 2001, eq. 1.34 (Blinn 1977); C(n) in closed form, so that the albedo at normal incidence is 1",
        {exponent()},
        {}},
       "blinn",
       [](Values v) {
         return Coefficients{blinn_constant(v[0]), v[0], 0, 0};
       },
       [](Values v) { return half_lobe_width(v[0]); }});

  entries.push_back({{"blinn_phong",
                      "Blinn-Phong",
                      "(n+2)/(2 pi) (N.H)^n",
                      "Ngan, Durand, Matusik 2005 (Blinn 1977): the constant of the fits of measured materials; albedo "
                      "above 1 for small n",
                      {exponent()},
                      {.conserves_energy = false}},
                     "blinn",
                     [](Values v) {
                       return Coefficients{cosine_lobe_constant(v[0]), v[0], 0, 0};
                     },
                     [](Values v) { return half_lobe_width(v[0]); }});

  entries.push_back(
      {{"cook_torrance",
        "Cook-Torrance",
        "exp(-tan^2 delta/m^2) / (4 pi m^2 cos^4 delta) G F / (N.L N.V), cos delta = N.H, "
        "G = min(1, 2 N.H N.L/L.H, 2 N.H N.V/L.H), F = f0 + (1-f0)(1-L.H)^5",
        "Neumann 2001, eq. 2.9 and 2.10 (Cook and Torrance 1982); F = 1 by default, else Schlick's approximation. "
        "Contrary to section 2.2 of the text its albedo is bounded by 1",
        {roughness(), {"f0", "1", 0, 1, 1.0, "Fresnel reflectance at normal incidence"}},
        {}},
       "cook_torrance",
       [](Values v) {
         return Coefficients{1 / (4 * pi * v[0] * v[0]), -1 / (v[0] * v[0]), v[1], 1 - v[1]};
       },
       [](Values v) { return std::min(1.0, v[0]); }});

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
         const double s = v[0];
         return Coefficients{s * s / (2 * pi * exponential_patch_area(s)), -s, 0, 0};
       },
       [](Values v) { return std::min(1.0, 1 / (2 * v[0])); }});

  const auto lafortune_width = [](Values v) { return mirror_lobe_width(v[2]); };
  const std::vector<Parameter> lafortune_parameters = {
      {"c_xy", "1", -10, 10, std::nullopt, "coefficient of L_x V_x + L_y V_y; negative: forward reflecting"},
      {"c_z", "1", -10, 10, std::nullopt, "coefficient of L_z V_z"},
      exponent()};
  entries.push_back({{"lafortune",
                      "Lafortune",
                      "max(0, c_xy (L_x V_x + L_y V_y) + c_z L_z V_z)^n",
                      "Neumann 2001, eq. 1.66 (Lafortune et al. 1997), isotropic, no leading constant",
                      lafortune_parameters,
                      {.conserves_energy = false}},
                     "lafortune",
                     [](Values v) {
                       return Coefficients{1, v[0], v[1], v[2]};
                     },
                     lafortune_width});
  entries.push_back({{"lafortune_ngan",
                      "Lafortune",
                      "(n+2)/(2 pi) (max(0, c_xy (L_x V_x + L_y V_y) + c_z L_z V_z) / max(|c_xy|, |c_z|))^n",
                      "Ngan, Durand, Matusik 2005: eq. 1.66 with the constant of the fits of measured materials",
                      lafortune_parameters,
                      {.conserves_energy = false}},
                     "lafortune",
                     [](Values v) {
                       const double largest = std::max(std::abs(v[0]), std::abs(v[1]));
                       const double unit = largest > 0 ? 1 / largest : 0;
                       return Coefficients{cosine_lobe_constant(v[2]), v[0] * unit, v[1] * unit, v[2]};
                     },
                     lafortune_width});

  entries.push_back({{"lambert", "Lambert", "1/pi", "Neumann 2001, eq. 1.27 and 1.28: ideal diffuse, albedo 1", {}, {}},
                     "lambert",
                     [](Values) {
                       return Coefficients{1 / pi, 0, 0, 0};
                     },
                     [](Values) { return 1.0; }});

  entries.push_back({{"metal_phong",
                      "metal Phong",
                      "(n+2)/(2 pi) max(0, R.V)^n / max(N.L, N.V)",
                      "Neumann 2001, eq. 3.7: cos-max metallic Phong; for n < 1.62 the albedo exceeds 1 by up to 0.011",
                      {exponent()},
                      {.conserves_energy = false}},
                     "metal_phong",
                     [](Values v) {
                       return Coefficients{cosine_lobe_constant(v[0]), v[0], 0, 0};
                     },
                     [](Values v) { return mirror_lobe_width(v[0]); }});

  entries.push_back({{"minnaert",
                      "Minnaert",
                      "(k+2)/(2 pi) ((N.L) (N.V))^k",
                      "Neumann 2001, eq. 1.32 (Minnaert 1941): albedo (N.L)^k; k = 0 is Lambert",
                      {{"k", "1", 0, 100, std::nullopt, "exponent; larger is darker towards grazing angles"}},
                      {}},
                     "minnaert",
                     [](Values v) {
                       return Coefficients{cosine_lobe_constant(v[0]), v[0], 0, 0};
                     },
                     [](Values v) { return half_lobe_width(2 * v[0]); }});

  entries.push_back(delta_part("mirror", "ideal mirror", "rho Delta(V = R) / N.V",
                               "Neumann 2001, eq. 1.29 with F = rho: all light into the mirror direction R"));

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
                       return Coefficients{(1 - 0.5 * s2 / (s2 + v[1])) / pi, 0.45 * s2 / (s2 + 0.09) / pi, 0, 0};
                     },
                     [](Values) { return 1.0; }});

  entries.push_back({{"phong",
                      "Phong",
                      "(n+2)/(2 pi) max(0, R.V)^n",
                      "Neumann 2001, eq. 1.33: reciprocal Phong; the constant is (n+2)/(2 pi), not the printed "
                      "(k+2)/(2 pi)",
                      {exponent()},
                      {}},
                     "phong",
                     [](Values v) {
                       return Coefficients{cosine_lobe_constant(v[0]), v[0], 0, 0};
                     },
                     [](Values v) { return mirror_lobe_width(v[0]); }});

  entries.push_back(delta_part("rrim", "retro-reflecting ideal mirror", "rho Delta(V = L) / N.L",
                               "Neumann 2001, eq. 1.26: RRIM, all light back to where it comes from"));

  entries.push_back({{"ward",
                      "Ward",
                      "exp(-tan^2 delta/m^2) / (4 pi m^2 sqrt(N.L N.V)), cos delta = N.H",
                      "Neumann 2001, eq. 3.35 with C_max = 1 (Ward 1992), isotropic; the albedo diverges as "
                      "(N.L)^-1/2 at grazing angles",
                      {roughness()},
                      {.conserves_energy = false}},
                     "ward",
                     [](Values v) {
                       return Coefficients{1 / (4 * pi * v[0] * v[0]), -1 / (v[0] * v[0]), 0, 0};
                     },
                     [](Values v) { return std::min(1.0, v[0]); }});
  return entries;
}

}  // namespace

double blinn_constant(double n) {
  const double half = std::numbers::ln2 / 2;
  const double a = -2 / (n + 4) * std::expm1(-half * (n + 4));
  const double b = -1 / (n + 2) * std::expm1(-half * (n + 2));
  return 1 / (8 * pi * (a - b));
}

std::span<const CatalogueEntry> catalogue_entries() {
  static const std::vector<CatalogueEntry> entries = make_catalogue();
  return entries;
}

std::span<const Model> catalogue() {
  static const std::vector<Model> models = [] {
    std::vector<Model> list;
    for (const auto& entry : catalogue_entries()) list.push_back(entry.model);
    return list;
  }();
  return models;
}

const CatalogueEntry& find_entry(std::string_view name) {
  const auto entries = catalogue_entries();
  const auto found = std::find_if(entries.begin(), entries.end(), [&](const auto& e) { return e.model.name == name; });
  if (found != entries.end()) return *found;
  std::vector<std::string_view> names;
  for (const auto& entry : entries) names.push_back(entry.model.name);
  throw ArgumentError("unknown model '" + std::string(name) + "'" + did_you_mean(name, names));
}

const Model& find_model(std::string_view name) {
  const auto index = static_cast<std::size_t>(&find_entry(name) - catalogue_entries().data());
  return catalogue()[index];
}

}  // namespace lobe
