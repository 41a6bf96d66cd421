#include "reference/kinked.hpp"

#include <cmath>
#include <functional>
#include <numbers>

namespace lobe::reference {
namespace {

using std::numbers::pi;

/// Integral of g over [a, b]; g gets the point and its distances from both ends.
double double_exponential(const std::function<double(double x, double from_a, double from_b)>& g, double a, double b) {
  constexpr double kStep = 1.0 / 16;
  constexpr int kNodes = 56;  // to 3.5: weights below 1e-20
  double sum = 0;
  for (int k = -kNodes; k <= kNodes; ++k) {
    const double t = k * kStep;
    const double u = pi / 2 * std::sinh(t);
    const double near = 1 / (std::exp(2 * std::abs(u)) + 1);  // share of the distance to the nearer end
    const double low = u < 0 ? near : 1 - near;
    const double high = u < 0 ? 1 - near : near;
    const double slope = pi / 2 * std::cosh(t) * 2 * near * (1 - near);
    const double length = b - a;
    const double x = u < 0 ? a + length * low : b - length * high;
    sum += kStep * slope * length * g(x, length * low, length * high);
  }
  return sum;
}

/// Integral of the lobe over both halves of the azimuth.
double around(const LafortuneLobe& lobe, double theta_in, double theta_out) {
  const double normal = lobe.c_z * std::cos(theta_in) * std::cos(theta_out);
  const double plane = lobe.c_xy * std::sin(theta_in) * std::sin(theta_out);
  const double size = std::abs(plane);
  if (size <= std::abs(normal)) {
    if (normal <= 0) return 0;
    return 2 * double_exponential(
                   [&](double phi, double, double) { return std::pow(normal + plane * std::cos(phi), lobe.n); }, 0, pi);
  }
  // The lobe is size (cos(psi) - cos(end)) for psi, from its middle, below the end where it becomes 0.
  const double end = std::acos(-normal / size);
  return 2 * double_exponential(
                 [&](double psi, double, double to_end) {
                   const double cosine = 2 * std::sin((psi + end) / 2) * std::sin(to_end / 2);
                   return std::pow(size * cosine, lobe.n);
                 },
                 0, end);
}

/// Integral over the polar angle, with a limit where the zero reaches the plane of incidence.
double over_angles(const std::function<double(double)>& g, double limit) {
  const auto plain = [&](double x, double, double) { return g(x); };
  return double_exponential(plain, 0, limit) + double_exponential(plain, limit, pi / 2);
}

double over_incidence(const std::function<double(double)>& g) {
  return over_angles([&](double theta) { return 2 * pi * std::cos(theta) * std::sin(theta) * g(theta); }, pi / 4);
}

}  // namespace

double lafortune_albedo(const LafortuneLobe& lobe, double theta) {
  const double limit = std::atan2(std::abs(lobe.c_z) * std::cos(theta), std::abs(lobe.c_xy) * std::sin(theta));
  return over_angles(
      [&](double theta_out) { return std::cos(theta_out) * std::sin(theta_out) * around(lobe, theta, theta_out); },
      limit);
}

double lafortune_daylight(const LafortuneLobe& lobe) {
  return over_incidence([&](double theta) { return std::pow(lafortune_albedo(lobe, theta), 2); });
}

double lafortune_light(const LafortuneLobe& lobe) {
  return over_incidence([&](double theta) { return lafortune_albedo(lobe, theta); });
}

double lafortune_point(const LafortuneLobe& lobe) {
  return lafortune_light({lobe.c_xy, lobe.c_z, 2 * lobe.n});
}

}  // namespace lobe::reference
