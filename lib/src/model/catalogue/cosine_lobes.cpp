#include <algorithm>
#include <cmath>
#include <numbers>
#include <vector>

#include "model/catalogue/entries.hpp"
#include "model/constants.hpp"

namespace lobe {
namespace {

using std::numbers::pi;

/// Where the cosine passes 0.
std::vector<Kink> lafortune_kinks(Values v) {
  if (v[0] == 0 || v[2] >= kSmoothOrder) return {};
  return {product_kink(1 - v[1] / v[0], v[2])};
}

}  // namespace

void add_cosine_lobes(Entries& entries) {
  entries.push_back({{"phong",
                      "Phong",
                      "(n+2)/(2 pi) max(0, R.V)^n",
                      "Neumann 2001, eq. 1.33: reciprocal Phong; the constant is (n+2)/(2 pi), not the printed "
                      "(k+2)/(2 pi)",
                      {exponent()},
                      {}},
                     "phong",
                     [](Values v) {
                       return Coefficients{cosine_lobe_constant(v[0]), v[0]};
                     },
                     [](Values v) { return mirror_lobe_width(v[0]); }});

  entries.push_back({{"metal_phong",
                      "metal Phong",
                      "(n+2)/(2 pi) max(0, R.V)^n / max(N.L, N.V)",
                      "Neumann 2001, eq. 3.7: cos-max metallic Phong; for n < 1.62 the albedo exceeds 1, by 0.0003 for "
                      "n = 1, 0.011 for n = 0.5, 0.086 for n near 0",
                      {exponent()},
                      {.conserves_energy = false}},
                     "metal_phong",
                     [](Values v) {
                       return Coefficients{cosine_lobe_constant(v[0]), v[0]};
                     },
                     [](Values v) { return mirror_lobe_width(v[0]); }});

  entries.push_back(
      {{"blinn",
        "Blinn",
        "C(n) (N.H)^n",
        "Neumann 2001, eq. 1.34 (Blinn 1977); C(n) in closed form, so that the albedo at normal incidence is 1",
        {exponent()},
        {}},
       "blinn",
       [](Values v) {
         return Coefficients{blinn_constant(v[0]), v[0]};
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
                       return Coefficients{cosine_lobe_constant(v[0]), v[0]};
                     },
                     [](Values v) { return half_lobe_width(v[0]); }});

  const auto lafortune_width = [](Values v) { return v[0] > 0 ? 1 : mirror_lobe_width(v[2]); };
  const auto lafortune_retro_width = [](Values v) { return v[0] > 0 ? retro_lobe_width(v[2]) : 1; };
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
                     lafortune_width,
                     nullptr,
                     lafortune_retro_width});
  entries.back().kinks = lafortune_kinks;

  entries.push_back({{"lafortune_ngan",
                      "Lafortune",
                      "(n+2)/(2 pi) (max(0, c_xy (L_x V_x + L_y V_y) + c_z L_z V_z) / max(|c_xy|, |c_z|))^n",
                      "Ngan, Durand, Matusik 2005: eq. 1.66 with the constant of the fits of measured materials; "
                      "a cosine lobe scaled by at most 1, of albedo at most 1",
                      lafortune_parameters,
                      {}},
                     "lafortune",
                     [](Values v) {
                       const double largest = std::max(std::abs(v[0]), std::abs(v[1]));
                       const double unit = largest > 0 ? 1 / largest : 0;
                       return Coefficients{cosine_lobe_constant(v[2]), v[0] * unit, v[1] * unit, v[2]};
                     },
                     lafortune_width,
                     nullptr,
                     lafortune_retro_width});
  entries.back().kinks = lafortune_kinks;

  entries.push_back({{"blinn_metal",
                      "metal Blinn",
                      "C(n) (N.H)^n / max(N.L, N.V)",
                      "Neumann 2001, section 3.7.1: cos-max metallic Blinn; C(n) makes the largest albedo 1 "
                      "(Table 3.1, whose entry for n = 2 should be 0.364)",
                      {{"n", "1", 1, 1e10, std::nullopt, "exponent; larger is sharper"}},
                      {}},
                     "blinn_metal",
                     [](Values v) {
                       return Coefficients{blinn_metal_constant(v[0]), v[0]};
                     },
                     [](Values v) { return half_lobe_width(v[0]); }});

  entries.push_back({{"p_model",
                      "p-model",
                      "(n+2)/(2 pi) max(0, R.V)^n / max(N.L, N.V)^p",
                      "Neumann 2001, eq. 3.12: from Phong (p = 0) to metal Phong (p = 1); for n < 1.62 the albedo "
                      "exceeds 1 at p = 1 as that of metal_phong. That it does not for p <= 0.98 holds for n >= 1; for "
                      "n near 0 it does for p > 0.5",
                      {exponent(), {"p", "1", 0, 1, std::nullopt, "share of the metallic correction"}},
                      {.conserves_energy = false}},
                     "p_model",
                     [](Values v) {
                       return Coefficients{cosine_lobe_constant(v[0]), v[0], v[1]};
                     },
                     [](Values v) { return mirror_lobe_width(v[0]); }});

  entries.push_back({{"retro_metal_phong",
                      "retro metal Phong",
                      "(n+2)/(2 pi) max(0, L.V)^n / max(N.L, N.V)",
                      "Neumann 2001, eq. 3.13: retro-reflecting cos-max Phong; for n < 1.62 the albedo exceeds 1 "
                      "as that of metal_phong",
                      {{"n", "1", 1e-3, 1e5, std::nullopt, "exponent; larger is sharper"}},
                      {.conserves_energy = false}},
                     "retro_metal_phong",
                     [](Values v) {
                       return Coefficients{cosine_lobe_constant(v[0]), v[0]};
                     },
                     [](Values) { return 1.0; },
                     nullptr,
                     [](Values v) { return retro_lobe_width(v[0]); }});

  entries.push_back({{"metal_phong_fresnel",
                      "metal Phong",
                      "(n+2)/(2 pi) max(0, R.V)^n / M F(ior, k, M), M = max(N.L, N.V), F Fresnel's equations for "
                      "the refractive index ior - ik",
                      "Neumann 2001, eq. 3.29 with eq. 1.41 to 1.43, the squares as |.|^2; with k = 0 the "
                      "specular part of plastics (3.30). For n < 1.62 the albedo may exceed 1 as that of metal_phong",
                      {exponent(), refractive_index(), extinction()},
                      {.conserves_energy = false}},
                     "metal_phong_fresnel",
                     [](Values v) {
                       return Coefficients{cosine_lobe_constant(v[0]), v[0], v[1], v[2]};
                     },
                     [](Values v) { return mirror_lobe_width(v[0]); }});
  // F sees the larger cosine; where it is the smaller one that is critical there is nothing, at the price of a limit.
  entries.back().kinks = [](Values v) -> std::vector<Kink> {
    const auto kinks = critical_kinks(v[1], v[2]);
    return kinks.empty() ? kinks : cosine_kinks(std::sqrt((1 - v[1]) * (1 + v[1])), kinks.front().order);
  };

  entries.push_back({{"phong_bisector",
                      "metal Phong",
                      "c(n) max(0, R.V)^n / N.B, B = (R+V)/|R+V|, N.B = (N.L+N.V) / sqrt(2 (1+R.V))",
                      "Neumann 2001, eq. 5.15 and 5.17 with the natural bisecting point of R and V on the sphere "
                      "(5.2.3); c = 1/(2 pi int_0^1 x^n sqrt((1+x)/2) dx) makes the largest albedo, at grazing "
                      "incidence, 1 (5.9)",
                      {exponent()},
                      {}},
                     "phong_bisector",
                     [](Values v) {
                       return Coefficients{std::numbers::sqrt2 * phong_bisector_constant(v[0]), v[0]};
                     },
                     [](Values v) { return mirror_lobe_width(v[0]); }});

  entries.push_back({{"phong_mean",
                      "metal Phong",
                      "(n+2)/(2 pi) max(0, R.V)^n / mean_p(N.L, N.V), mean_p(x, y) = ((x^p + y^p)/2)^(1/p)",
                      "Neumann 2001, eq. 5.17; p = 0 is the geometric mean, p = -1 the harmonic one (5.18, "
                      "printed inverted). The albedo exceeds 1: for p >= 1 by at most 1/(n+1), at grazing angles "
                      "for p = 0 as (N.L)^-1/2, for p < 0 as 1/N.L, where norms are infinite",
                      {exponent(), {"p", "1", -1, 100, 1.0, "power of the mean"}},
                      {.conserves_energy = false}},
                     "phong_mean",
                     [](Values v) {
                       return Coefficients{cosine_lobe_constant(v[0]), v[0], v[1], v[1] == 0 ? 1 : 1 / v[1]};
                     },
                     [](Values v) { return mirror_lobe_width(v[0]); },
                     nullptr,
                     nullptr,
                     [](Values v) { return v[1] < 0; }});
}

}  // namespace lobe
