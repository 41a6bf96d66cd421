#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <optional>
#include <string_view>
#include <vector>

#include "model/catalogue/entries.hpp"
#include "model/constants.hpp"

namespace lobe {
namespace {

using std::numbers::pi;

Parameter rotation() {
  return {"rotation", "rad", -pi, pi, 0.0, "azimuth of the lobe's first axis from the x axis"};
}

/// Cosine and sine of an azimuth; at quarter turns without the rounding of pi.
struct Axis {
  explicit Axis(double azimuth) : cosine(clean(std::cos(azimuth))), sine(clean(std::sin(azimuth))) {}
  static double clean(double x) { return std::abs(x) < 1e-15 ? 0 : x; }
  double cosine, sine;
};

/// How many times longer a lobe is than wide.
double aspect_of(double one, double other) {
  return std::max(one, other) / std::min(one, other);
}

/// Parameters of a norm of the base plane.
Parameter axes_ratio() {
  return {"ratio", "1", 0.01, 1, std::nullopt, "B/A, minor over major axis"};
}

Parameter norm_power() {
  return {"p", "1", 1, 100, 2.0, "power of the norm; 2 is the ellipse, 1 a rhombus, large ones are nearly a rectangle"};
}

/// The power of a norm is smooth along the axes, and its corners between them are wide enough for equal steps of
/// azimuth.
bool is_smooth_norm(double p) {
  return std::fmod(p, 2) == 0 && p <= 10;
}

/// Of a lobe with the parameters ratio and p in second and third place.
double norm_aspect(Values v) {
  return std::max(1 / v[1], v[2] / 2);
}

constexpr double kWholeBasePlane = 2;  // no two points of the unit disc are farther apart

/// Of a patch with R, ratio, p, rotation.
PatchEdge edge_of(Values v) {
  // Within the elliptic norm R = 2, and with larger powers, all is; rounding must not cut off the farthest direction.
  const bool is_whole = v[0] == kWholeBasePlane && v[2] >= 2;
  return {is_whole ? 2 * kWholeBasePlane : v[0], v[1], v[2], v[3]};
}

Coefficients patch_coefficients(Values v) {
  const Axis axis(v[3]);
  const double radius = edge_of(v).radius;
  const double share = v[1] / radius;
  return {patch_norm_constant(v[0], v[1], v[2]),
          share * axis.cosine,
          share * axis.sine,
          -axis.sine / radius,
          axis.cosine / radius,
          v[2]};
}

/// C L^T M V with coefficients along the axes of the lobe, for kernels/models/lafortune_anisotropic.clh.
Coefficients lafortune_coefficients(double constant, double c_x, double c_y, double c_z, double n, double p,
                                    double azimuth) {
  const Axis axis(azimuth);
  const double xx = c_x * axis.cosine * axis.cosine + c_y * axis.sine * axis.sine;
  const double xy = (c_x - c_y) * axis.cosine * axis.sine;
  const double yy = c_x * axis.sine * axis.sine + c_y * axis.cosine * axis.cosine;
  return {constant, xx, xy, yy, c_z, n, -p};
}

/// Where L^T M V passes 0, from what lafortune_anisotropic.clh gets.
std::vector<Kink> lafortune_kinks(const Coefficients& c) {
  if (c[5] >= kSmoothOrder) return {};
  const auto at = [](const Kink::Numbers& m, const KinkPair& pair) {
    const double to_x = m[0] * pair.in_x + m[1] * pair.in_y + m[4] * pair.cos_i;
    const double to_y = m[1] * pair.in_x + m[2] * pair.in_y + m[5] * pair.cos_i;
    const double to_z = m[4] * pair.in_x + m[5] * pair.in_y + m[3] * pair.cos_i;
    return pair.out_x * to_x + pair.out_y * to_y + pair.cos_o * to_z;
  };
  return {{at, {c[1], c[2], c[3], c[4], c[7], c[8]}, c[5], true}};
}

double larger_exponent(Values v) {
  return std::max(v[0], v[1]);
}

}  // namespace

void add_anisotropic_models(Entries& entries) {
  const auto roughness_along = [](std::string_view name, std::string_view axis) -> Parameter {
    return {name, "1", 1e-5, 100, std::nullopt, axis};
  };
  entries.push_back({.model = {"ward_anisotropic",
                               "Ward",
                               "exp(-(u/m_x)^2-(v/m_y)^2) / (4 pi m_x m_y sqrt(N.L N.V)), (u, v) the slopes H_x/H_z, "
                               "H_y/H_z along the axes of the lobe",
                               "Neumann 2001, eq. 1.46 and 1.47 (Ward 1992) with the exponent of 1.47, of which 1.48 "
                               "is an approximation; the albedo diverges as (N.L)^-1/2 at grazing angles",
                               {roughness_along("m_x", "rms slope along the first axis; smaller is sharper"),
                                roughness_along("m_y", "rms slope across; smaller is sharper"), rotation()},
                               {.isotropic = false, .conserves_energy = false}},
                     .kernel = "ward_anisotropic",
                     .coefficients =
                         [](Values v) {
                           const Axis axis(v[2]);
                           return Coefficients{1 / (4 * pi * v[0] * v[1]), axis.cosine / v[0], axis.sine / v[0],
                                               -axis.sine / v[1], axis.cosine / v[1]};
                         },
                     .width =
                         [](Values v) {
                           return std::min({1.0, v[0], v[1]});
                         },
                     .aspect = [](Values v) { return aspect_of(v[0], v[1]); }});

  entries.push_back(
      {.model = {"schlick_anisotropic",
                 "Schlick",
                 "r A / (4 pi (1-(1-r)(N.H)^2)^2 (r+(1-r) N.L) (r+(1-r) N.V)), A = sqrt(p / (p^2+(1-p^2) w^2)), w the "
                 "cosine of the azimuth of H from the lobe's first axis",
                 "Neumann 2001, eq. 1.49 and 1.50 (Schlick 1994). At H = N, where A has no limit, w is 0. The albedo "
                 "exceeds 1 at grazing angles for small r, as of schlick",
                 {{"r", "1", 1e-10, 1, std::nullopt, "roughness; smaller is sharper"},
                  {"p", "1", 1e-3, 1, std::nullopt, "isotropy; smaller is more drawn out across the first axis"},
                  rotation()},
                 {.isotropic = false, .conserves_energy = false}},
       .kernel = "schlick_anisotropic",
       .coefficients =
           [](Values v) {
             const Axis axis(v[2]);
             return Coefficients{v[0] / (4 * pi),         v[0],        1 - v[0], v[1],
                                 (1 - v[1]) * (1 + v[1]), axis.cosine, axis.sine};
           },
       .width = [](Values v) { return std::sqrt(v[0]); },
       .aspect = [](Values v) { return 1 / v[1]; }});

  entries.push_back(
      {.model = {"ggx_anisotropic",
                 "GGX",
                 "D F / (2 (N.L root(V) + N.V root(L))), D = 1 / (pi a_x a_y ((H_u/a_x)^2+(H_v/a_y)^2+(N.H)^2)^2), "
                 "root(X) = sqrt((a_x X_u)^2+(a_y X_v)^2+(N.X)^2), F = f0 + (1-f0)(1-L.H)^5, a = alpha, u and v along "
                 "the axes of the lobe",
                 "Walter, Marschner, Li, Torrance 2007 with two roughnesses (Burley 2012, eq. 13) and the "
                 "height-correlated attenuation of Smith (Heitz 2014, eq. 86 and 99); F = 1 by default, else "
                 "Schlick's approximation",
                 {{"alpha_x", "1", 1e-5, 1, std::nullopt, "roughness along the first axis; smaller is sharper"},
                  {"alpha_y", "1", 1e-5, 1, std::nullopt, "roughness across; smaller is sharper"},
                  normal_reflectance(),
                  rotation()},
                 {.isotropic = false}},
       .kernel = "ggx_anisotropic",
       .coefficients =
           [](Values v) {
             const Axis axis(v[3]);
             return Coefficients{1 / (4 * pi * v[0] * v[1]), axis.cosine / v[0], axis.sine / v[0], -axis.sine / v[1],
                                 axis.cosine / v[1],         v[0] * v[0],        v[1] * v[1],      v[2]};
           },
       .width = [](Values v) { return std::min(v[0], v[1]); },
       .aspect = [](Values v) { return aspect_of(v[0], v[1]); }});

  const auto exponent_along = [](std::string_view name, std::string_view axis) -> Parameter {
    return {name, "1", 1e-3, 1e10, std::nullopt, axis};
  };
  entries.push_back(
      {.model = {"ashikhmin_shirley_anisotropic",
                 "Ashikhmin-Shirley",
                 "sqrt((n_u+1)(n_v+1))/(8 pi) (N.H)^(n_u cos^2 phi+n_v sin^2 phi) F / (L.H max(N.L, N.V)), phi the "
                 "azimuth of H from the lobe's first axis, F = f0 + (1-f0)(1-L.H)^5",
                 "Ashikhmin and Shirley 2000, specular term; F = 1 by default, else Schlick's approximation",
                 {exponent_along("n_u", "exponent along the first axis; larger is sharper"),
                  exponent_along("n_v", "exponent across; larger is sharper"), normal_reflectance(), rotation()},
                 {.isotropic = false}},
       .kernel = "ashikhmin_shirley_anisotropic",
       .coefficients =
           [](Values v) {
             const Axis axis(v[3]);
             return Coefficients{
                 std::sqrt((v[0] + 1) * (v[1] + 1)) / (8 * pi), axis.cosine, axis.sine, v[0], v[1], v[2], 1 - v[2]};
           },
       .width = [](Values v) { return half_lobe_width(larger_exponent(v)); },
       .aspect = [](Values v) { return std::sqrt(aspect_of(v[0], v[1])); }});

  entries.push_back(
      {.model =
           {"exponential_patch_anisotropic",
            "exponential patch",
            "C exp(-s ((B/A |z.u|)^p + |z.v|^p)^(1/p)), z = V_P-L'_P, u and v along the axes of the lobe",
            "Neumann 2001, eq. 4.46 with the elliptic norm of 4.32 (p = 2) or that of the p-th power (4.38), in which "
            "absolute values are missing. C makes the albedo at normal incidence, the largest, 1, as 4.36 does; ratio "
            "= 1, p = 2 is exponential_patch",
            {{"s", "1", 1e-3, 1e6, std::nullopt, "decay per unit of base-plane distance across; larger is sharper"},
             axes_ratio(),
             norm_power(),
             rotation()},
            {.isotropic = false}},
       .kernel = "exponential_patch_anisotropic",
       .coefficients =
           [](Values v) {
             const Axis axis(v[3]);
             return Coefficients{exponential_norm_constant(v[0], v[1], v[2]),
                                 -v[0],
                                 v[1] * axis.cosine,
                                 v[1] * axis.sine,
                                 -axis.sine,
                                 axis.cosine,
                                 v[2],
                                 1 / v[2]};
           },
       .width = [](Values v) { return std::min(1.0, 1 / (2 * v[0])); },
       .aspect = norm_aspect,
       .patch_edge = [](Values v) -> std::optional<PatchEdge> {
         if (is_smooth_norm(v[2])) return std::nullopt;
         return PatchEdge{std::numeric_limits<double>::infinity(), v[1], v[2], v[3]};
       }});

  entries.push_back(
      {.model =
           {"basic_patch_anisotropic",
            "basic patch",
            "C for ((B/A |z.u|)^p + |z.v|^p)^(1/p) <= R, else 0, z = V_P-L'_P, u and v along the axes of the lobe",
            "Neumann 2001, eq. 4.34 with the elliptic norm of 4.32 (p = 2) or that of the p-th power (4.38), in which "
            "absolute values are missing. C makes the albedo at normal incidence, the largest, 1 (4.36); ratio = 1, p "
            "= 2 is basic_patch",
            {{"R", "1", 1e-5, kWholeBasePlane, std::nullopt,
              "half the minor axis in the base plane; smaller is sharper"},
             axes_ratio(),
             norm_power(),
             rotation()},
            {.isotropic = false}},
       .kernel = "basic_patch_anisotropic",
       .coefficients = patch_coefficients,
       .width = [](Values v) { return std::min(1.0, v[0] / 2); },
       .aspect = norm_aspect,
       .patch_edge = [](Values v) -> std::optional<PatchEdge> { return edge_of(v); }});

  entries.push_back(
      {.model =
           {"retro_patch_anisotropic",
            "basic patch",
            "C for ((B/A |z.u|)^p + |z.v|^p)^(1/p) <= R, else 0, z = V_P-L_P, u and v along the axes of the lobe",
            "Neumann 2001, eq. 4.34 with the vector of 4.29 in the norms of 4.32 (p = 2) and 4.38: the anisotropic "
            "basic patch about the retro direction; ratio = 1, p = 2 is retro_patch",
            {{"R", "1", 0.01, kWholeBasePlane, std::nullopt,
              "half the minor axis in the base plane; smaller is sharper"},
             axes_ratio(),
             norm_power(),
             rotation()},
            {.isotropic = false}},
       .kernel = "retro_patch_anisotropic",
       .coefficients = patch_coefficients,
       .width = [](Values) { return 1.0; },
       .retro_width = [](Values v) { return std::min(0.5, v[0] / 2); },
       .aspect = norm_aspect,
       .retro_patch_edge = [](Values v) -> std::optional<PatchEdge> { return edge_of(v); }});

  const auto along = [](std::string_view name, std::string_view product) -> Parameter {
    return {name, "1", -10, 10, std::nullopt, product};
  };
  entries.push_back(
      {.model = {"lafortune_anisotropic",
                 "Lafortune",
                 "max(0, c_x L_u V_u + c_y L_v V_v + c_z L_z V_z)^n, u and v along the axes of the lobe",
                 "Neumann 2001, eq. 1.66 (Lafortune et al. 1997), no leading constant",
                 {along("c_x", "coefficient of L_u V_u; negative: forward reflecting"),
                  along("c_y", "coefficient of L_v V_v; negative: forward reflecting"),
                  along("c_z", "coefficient of L_z V_z"), exponent(), rotation()},
                 {.isotropic = false, .conserves_energy = false}},
       .kernel = "lafortune_anisotropic",
       .coefficients = [](Values v) { return lafortune_coefficients(1, v[0], v[1], v[2], v[3], 0, v[4]); },
       .width = [](Values v) { return v[0] > 0 && v[1] > 0 ? 1 : mirror_lobe_width(v[3]); },
       .retro_width = [](Values v) { return v[0] > 0 || v[1] > 0 ? retro_lobe_width(v[3]) : 1; },
       .aspect = [](Values) { return 2.0; },
       .kinks = [](Values v) { return lafortune_kinks(lafortune_coefficients(1, v[0], v[1], v[2], v[3], 0, v[4])); }});

  const auto entry = [](std::string_view name, std::optional<double> value, std::string_view product) -> Parameter {
    return {name, "1", -1, 1, value, product};
  };
  entries.push_back(
      {.model = {"lafortune_matrix",
                 "Lafortune",
                 "max(0, L^T M V)^n, M symmetric",
                 "Neumann 2001, eq. 1.65 (Lafortune et al. 1997) with the power and the positive part that it lacks; a "
                 "symmetric M makes it reciprocal. Factors of M beyond 1 are a scale. With m_xz or m_yz the lobe is "
                 "not that of half a turn about the normal. Peaks lie anywhere, so that sharper ones than n = 200 "
                 "would be beyond the quadratures",
                 {entry("m_xx", std::nullopt, "coefficient of L_x V_x; negative: forward reflecting"),
                  entry("m_yy", std::nullopt, "coefficient of L_y V_y; negative: forward reflecting"),
                  entry("m_zz", std::nullopt, "coefficient of L_z V_z"),
                  entry("m_xy", 0.0, "coefficient of L_x V_y + L_y V_x"),
                  entry("m_xz", 0.0, "coefficient of L_x V_z + L_z V_x"),
                  entry("m_yz", 0.0, "coefficient of L_y V_z + L_z V_y"),
                  {"n", "1", 1, 200, std::nullopt, "exponent; larger is sharper"}},
                 {.isotropic = false, .conserves_energy = false}},
       .kernel = "lafortune_anisotropic",
       .coefficients = [](Values v) { return Coefficients{1, v[0], v[3], v[1], v[2], v[6], 0, v[4], v[5]}; },
       .width = [](Values v) { return mirror_lobe_width(v[6]); },
       .retro_width = [](Values v) { return retro_lobe_width(v[6]); },
       .aspect = [](Values v) { return 2 + std::sqrt(v[6]); },
       .half_turn = [](Values v) { return v[4] == 0 && v[5] == 0; },
       .kinks =
           [](Values v) {
             return lafortune_kinks({1, v[0], v[3], v[1], v[2], v[6], 0, v[4], v[5]});
           }});

  const auto share = [](std::string_view name, std::string_view product) -> Parameter {
    return {name, "1", 0, 1, 1.0, product};
  };
  entries.push_back(
      {.model = {"metal_phong_anisotropic",
                 "metal Phong",
                 "(n+2)/(2 pi) max(0, c_x R_u V_u + c_y R_v V_v + c_z R_z V_z)^n / max(N.L, N.V)^p, u and v along the "
                 "axes of the lobe",
                 "Neumann 2001, eq. 3.15; terms of it make up 3.16, in which a comma is missing. The coefficients are "
                 "at most 1, so that the constant of 3.6 serves; for small n the albedo may exceed 1, as that of "
                 "metal_phong and, where c_x or c_y is below c_z, by up to 1 (n near 0, c_x = 0, grazing angles)",
                 {exponent(), share("c_x", "coefficient of R_u V_u"), share("c_y", "coefficient of R_v V_v"),
                  share("c_z", "coefficient of R_z V_z"), share("p", "share of the metallic correction"), rotation()},
                 {.isotropic = false, .conserves_energy = false}},
       .kernel = "lafortune_anisotropic",
       .coefficients =
           [](Values v) {
             return lafortune_coefficients(cosine_lobe_constant(v[0]), -v[1], -v[2], v[3], v[0], v[4], v[5]);
           },
       .width = [](Values v) { return mirror_lobe_width(v[0]); },
       .aspect = [](Values) { return 2.0; },
       .kinks =
           [](Values v) { return lafortune_kinks(lafortune_coefficients(1, -v[1], -v[2], v[3], v[0], v[4], v[5])); }});
}

}  // namespace lobe
