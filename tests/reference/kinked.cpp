#include "reference/kinked.hpp"

#include <algorithm>
#include <cmath>
#include <functional>
#include <numbers>
#include <vector>

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

/// Integral of g over [a, b] with limits where it is not smooth.
double between(const std::function<double(double)>& g, double a, double b, std::vector<double> limits) {
  constexpr double kShortest = 1e-13;
  std::ranges::sort(limits);
  double sum = 0;
  double from = a;
  limits.push_back(b);
  for (const double limit : limits) {
    const double to = std::min(limit, b);
    if (to - from < kShortest) continue;
    sum += double_exponential([&](double x, double, double) { return g(x); }, from, to);
    from = to;
  }
  return sum;
}

/// Integral of f(c + normal + plane cos(psi)) over psi in [0, pi], plane >= 0.
double kink_around(Kink kink, double normal, double plane) {
  const double end = plane > std::abs(normal) ? std::acos(-normal / plane) : normal > 0 ? pi : 0;
  const double above = normal * end + plane * std::sin(end);
  switch (kink) {
    case Kink::both_sides:
      return 2 * above - normal * pi;
    case Kink::above:
      return above;
    case Kink::below:
      return above - normal * pi;
    case Kink::jump:
      break;
  }
  return 0.2 * pi + 0.8 * end;
}

}  // namespace

double kinked_value(const KinkAt& at, double cosine) {
  switch (at.kink) {
    case Kink::both_sides:
      return std::abs(cosine - at.c);
    case Kink::above:
      return std::max(0.0, cosine - at.c);
    case Kink::below:
      return std::max(0.0, at.c - cosine);
    case Kink::jump:
      break;
  }
  return cosine > at.c ? 1 : 0.2;
}

double kinked_integral(const KinkAt& f) {
  return tilted_kink(f, 0, 0);
}

double kinked_product(const KinkAt& f, const KinkAt& g) {
  return 2 * pi * between([&](double x) { return x * kinked_value(f, x) * kinked_value(g, x); }, 0, 1, {f.c, g.c});
}

double tilted_kink(const KinkAt& f, double tilt, int power) {
  const double radius = std::acos(f.c);
  const auto ring = [&](double theta) {
    return 2 * std::pow(std::cos(theta), 1 + power) * std::sin(theta) *
           kink_around(f.kink, std::cos(theta) * std::cos(tilt) - f.c, std::sin(theta) * std::sin(tilt));
  };
  return between(ring, 0, pi / 2, {tilt - radius, tilt + radius, radius - tilt});
}

double mean_tilted_kink(const KinkAt& f) {
  const double radius = std::acos(f.c);
  const auto ring = [&](double tilt) { return 2 * std::cos(tilt) * std::sin(tilt) * tilted_kink(f, tilt, 0); };
  return between(ring, 0, pi / 2, {radius, pi / 2 - radius});
}

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
