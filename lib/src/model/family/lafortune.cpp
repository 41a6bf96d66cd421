#include "model/family/lafortune.hpp"

#include "model/draw.hpp"
#include "model/family/azimuths.hpp"
#include "model/family/parameters.hpp"

namespace lobe {
namespace {

/// max(0, A.V)^n for A = M L.
draw::Parts power_about(const UnitVector& axis, double n) {
  if (axis == UnitVector{}) return {draw::cosine()};  // the reflectance is 0
  return {draw::power(axis, n)};
}

}  // namespace

std::vector<Parameter> lafortune_parameters() {
  return {{"c_xy", "1", -10, 10, std::nullopt, "coefficient of L_x V_x + L_y V_y; negative: forward reflecting"},
          {"c_z", "1", -10, 10, std::nullopt, "coefficient of L_z V_z"},
          exponent()};
}

double lafortune_width(Values v) {
  return v[0] > 0 ? 1 : mirror_lobe_width(v[2]);
}

double lafortune_retro_width(Values v) {
  return v[0] > 0 ? retro_lobe_width(v[2]) : 1;
}

std::vector<Kink> lafortune_kinks(Values v) {
  if (v[0] == 0 || v[2] >= kSmoothOrder) return {};
  return {product_kink(1 - v[1] / v[0], v[2])};
}

draw::Parts lafortune_draws(Values v, const draw::Scene& scene) {
  const auto& light = scene.light;
  return power_about({v[0] * light[0], v[0] * light[1], v[1] * light[2]}, v[2]);
}

Coefficients matrix_coefficients(double constant, double c_x, double c_y, double c_z, double n, double p,
                                 double azimuth) {
  const Axis axis(azimuth);
  const double xx = c_x * axis.cosine * axis.cosine + c_y * axis.sine * axis.sine;
  const double xy = (c_x - c_y) * axis.cosine * axis.sine;
  const double yy = c_x * axis.sine * axis.sine + c_y * axis.cosine * axis.cosine;
  return {constant, xx, xy, yy, c_z, n, -p};
}

std::vector<Kink> matrix_kinks(const Coefficients& c) {
  if (c[5] >= kSmoothOrder) return {};
  const auto at = [](const Kink::Numbers& m, const KinkPair& pair) {
    const double to_x = m[0] * pair.in_x + m[1] * pair.in_y + m[4] * pair.cos_i;
    const double to_y = m[1] * pair.in_x + m[2] * pair.in_y + m[5] * pair.cos_i;
    const double to_z = m[4] * pair.in_x + m[5] * pair.in_y + m[3] * pair.cos_i;
    return pair.out_x * to_x + pair.out_y * to_y + pair.cos_o * to_z;
  };
  return {{at, {c[1], c[2], c[3], c[4], c[7], c[8]}, c[5], true}};
}

draw::Parts matrix_draws(const Coefficients& c, const UnitVector& light) {
  return power_about(
      {c[1] * light[0] + c[2] * light[1] + c[7] * light[2], c[2] * light[0] + c[3] * light[1] + c[8] * light[2],
       c[7] * light[0] + c[8] * light[1] + c[4] * light[2]},
      c[5]);
}

}  // namespace lobe
