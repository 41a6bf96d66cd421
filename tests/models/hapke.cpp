#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "models/model_test.hpp"

namespace lobe::test {
namespace {

constexpr Real kCircleHalf = std::numbers::pi_v<Real>;

struct HapkeValues {
  Real w, b, c, b0, h, theta_bar;
};

/// Angles of incidence and emission, azimuth between them and phase angle.
struct HapkeAngles {
  Real i, e, psi, g;
};

HapkeAngles angles_of(const Vector& l, const Vector& v) {
  return {std::atan2(std::hypot(l.x, l.y), l.z), std::atan2(std::hypot(v.x, v.y), v.z),
          std::abs(std::atan2(l.x * v.y - l.y * v.x, l.x * v.x + l.y * v.y)),
          2 * std::atan2(length(l - v), length(l + v))};
}

/// Effective cosines of both directions and the shadowing.
struct Roughened {
  Real mu_0, mu, shadowing;
};

/// Hapke 2012, eq. 12.45 to 12.63, each of the two cases as the text has it.
Roughened roughened(const HapkeAngles& a, Real theta_bar) {
  if (theta_bar == 0) return {std::cos(a.i), std::cos(a.e), 1};
  const Real tangent = std::tan(theta_bar);
  const Real chi = 1 / std::sqrt(1 + kCircleHalf * tangent * tangent);
  const auto e1 = [&](Real x) { return std::exp(-2 / (kCircleHalf * tangent * std::tan(x))); };
  const auto e2 = [&](Real x) {
    const Real slope = 1 / (tangent * std::tan(x));
    return std::exp(-slope * slope / kCircleHalf);
  };
  const auto eta = [&](Real x) { return chi * (std::cos(x) + std::sin(x) * tangent * e2(x) / (2 - e1(x))); };
  const Real half = std::sin(a.psi / 2) * std::sin(a.psi / 2);
  const Real f = std::exp(-2 * std::tan(a.psi / 2));
  const auto cosine = [&](Real x, Real rise) { return chi * (std::cos(x) + std::sin(x) * tangent * rise); };
  if (a.i <= a.e) {
    const Real under = 2 - e1(a.e) - a.psi / kCircleHalf * e1(a.i);
    const Real mu_0 = cosine(a.i, (std::cos(a.psi) * e2(a.e) + half * e2(a.i)) / under);
    const Real mu = cosine(a.e, (e2(a.e) - half * e2(a.i)) / under);
    return {mu_0, mu, mu / eta(a.e) * std::cos(a.i) / eta(a.i) * chi / (1 - f + f * chi * std::cos(a.i) / eta(a.i))};
  }
  const Real under = 2 - e1(a.i) - a.psi / kCircleHalf * e1(a.e);
  const Real mu_0 = cosine(a.i, (e2(a.i) - half * e2(a.e)) / under);
  const Real mu = cosine(a.e, (std::cos(a.psi) * e2(a.i) + half * e2(a.e)) / under);
  return {mu_0, mu, mu / eta(a.e) * std::cos(a.i) / eta(a.i) * chi / (1 - f + f * chi * std::cos(a.e) / eta(a.e))};
}

Real hapke_reflectance(const HapkeAngles& a, const HapkeValues& k) {
  const Roughened rough = roughened(a, k.theta_bar);
  const auto lobe = [&](Real sign) {
    return (1 - k.b * k.b) / std::pow(1 - sign * 2 * k.b * std::cos(a.g) + k.b * k.b, 1.5L);
  };
  const Real phase = (1 + k.c) / 2 * lobe(1) + (1 - k.c) / 2 * lobe(-1);
  const Real surge = k.b0 / (1 + std::tan(a.g / 2) / k.h);
  const Real root = std::sqrt(1 - k.w);
  const Real r0 = (1 - root) / (1 + root);
  const auto h = [&](Real x) { return 1 / (1 - k.w * x * (r0 + (1 - 2 * r0 * x) / 2 * std::log((1 + x) / x))); };
  // r(i, e, g) / cos i
  return k.w / (4 * kCircleHalf) * rough.mu_0 / (rough.mu_0 + rough.mu) *
         ((1 + surge) * phase + h(rough.mu_0) * h(rough.mu) - 1) * rough.shadowing / std::cos(a.i);
}

/// |d ln f| for a step of one of the angles, which stays between 0 and `most`.
Real slope_of(const HapkeAngles& at, const HapkeValues& k, Real HapkeAngles::*angle, Real step, Real most) {
  HapkeAngles low = at;
  HapkeAngles high = at;
  low.*angle = std::max(at.*angle - step, Real{0});
  high.*angle = std::min(at.*angle + step, most);
  return std::abs(std::log(hapke_reflectance(high, k) / hapke_reflectance(low, k))) / (high.*angle - low.*angle);
}

/// What ulps of the cosines and of |L_P + V_P|^2 do to the angles, and these to the reflectance.
Real hapke_condition(const HapkeAngles& a, const HapkeValues& k) {
  constexpr Real kStep = 1e-5L;
  const Real sin_i = std::max(std::sin(a.i), Real{1e-9L});
  const Real sin_e = std::max(std::sin(a.e), Real{1e-9L});
  const Real sum = sin_i + sin_e;
  const Real squares = sum * sum / (sin_i * sin_e) + 1 / (sin_i * sin_i) + 1 / (sin_e * sin_e);
  const Real sin_psi = std::max(std::sin(a.psi), 1e-8L * std::sqrt(squares));
  const auto slope = [&](Real HapkeAngles::*angle, Real step, Real most) { return slope_of(a, k, angle, step, most); };
  return 1 + slope(&HapkeAngles::psi, kStep, kCircleHalf) * squares / sin_psi +
         slope(&HapkeAngles::i, kStep * std::cos(a.i), kCircleHalf / 2) / sin_i +
         slope(&HapkeAngles::e, kStep * std::cos(a.e), kCircleHalf / 2) / sin_e +
         slope(&HapkeAngles::g, kStep, kCircleHalf) / std::max(std::sin(a.g), 1e-8L);
}

ModelCase hapke_case(const std::array<std::string, 6>& values) {
  const HapkeValues k{std::stold(values[0]), std::stold(values[1]), std::stold(values[2]),
                      std::stold(values[3]), std::stold(values[4]), std::stold(values[5])};
  return {"hapke:w=" + values[0] + ",b=" + values[1] + ",c=" + values[2] + ",b0=" + values[3] + ",h=" + values[4] +
              ",theta_bar=" + values[5],
          [=](const Vector& l, const Vector& v) { return hapke_reflectance(angles_of(l, v), k); },
          [=](const Vector& l, const Vector& v) { return hapke_condition(angles_of(l, v), k); }, 1};
}

}  // namespace

ModelTest hapke_test() {
  return {.budget = {16, 5.3, 16, 3},
          .cases = {hapke_case({"0.4", "0.25", "0.3", "0.8", "0.06", "0.35"}),
                    hapke_case({"0.9", "0.5", "-0.6", "0", "0.05", "0"}), hapke_case({"1", "0", "0", "1", "0.3", "0"}),
                    hapke_case({"0.2", "0.8", "0.5", "0.5", "0.01", "0.1"}),
                    hapke_case({"0.7", "0.1", "0", "1", "0.1", "1"})},
          .excess = AlbedoExcess{"hapke:w=1,b=0.99,c=1,b0=1,h=10", 0.192, 1.8246}};
}

}  // namespace lobe::test
