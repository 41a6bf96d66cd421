#include "model/constants.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <vector>

#include "core/bisection.hpp"
#include "hemisphere/gauss.hpp"

namespace lobe {
namespace {

using std::numbers::pi;

/// Integral over [from, to] by panels of at most the given length.
template <typename Function>
double integral(const Function& f, double from, double to, double panel) {
  static const GaussRule gauss = gauss_rule(24);
  const double panels = std::max(1.0, std::ceil((to - from) / panel));
  const double length = (to - from) / panels;
  double sum = 0;
  for (double p = 0; p < panels; ++p) {
    for (std::size_t k = 0; k < gauss.nodes.size(); ++k) {
      sum += gauss.weights[k] * f(from + length * (p + gauss.nodes[k]));
    }
  }
  return length * sum;
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

/// The integral over a quarter of a turn of a sector's integral over its radius, which depends on the norm ((ratio
/// |x|)^p + |y|^p)^(1/p) of the unit vector along it.
/// \param kink a norm at which the sector's integral has a kink
template <typename Sector>
double quarter_integral(double ratio, double p, const Sector& sector, double kink) {
  // In angles t from each axis in which the norm is symmetric: tan t is the ratio of its shares. t = pi/4 w^4, because
  // the norm begins like t^p; near w = 1 it changes within 1/p.
  const auto from_axis = [&](double along, double across) {
    const auto radius2 = [&](double tangent) {  // of (across, along tan t)
      return across * across + along * along * tangent * tangent;
    };
    const auto tangent_at = [](double w) { return std::tan(pi / 4 * std::pow(w, 4)); };
    const auto norm = [&](double tangent) {
      return along * across * std::pow(1 + std::pow(tangent, p), 1 / p) / std::sqrt(radius2(tangent));
    };
    const auto at = [&](double w) {
      const double tangent = tangent_at(w);
      const double stretch = along * across * (1 + tangent * tangent);
      return pi * w * w * w * stretch / radius2(tangent) * sector(norm(tangent));
    };
    std::vector<double> limits{0, 1};
    for (double step = 0.3; step > 0.1 / p; step /= 3) limits.push_back(1 - step);
    // Where the norm has its extremum off the axes.
    const double extremum = std::pow(along / across, 2 / (p - 2));
    if (extremum < 1) limits.push_back(std::pow(4 / pi * std::atan(extremum), 0.25));
    std::sort(limits.begin(), limits.end());
    double sum = 0;
    for (std::size_t i = 0; i + 1 < limits.size(); ++i) {
      const double far = norm(tangent_at(limits[i + 1]));
      const auto is_near = [&](double w) { return (norm(tangent_at(w)) < kink) != (far < kink); };
      const double high = is_near(limits[i]) ? bisect({limits[i], limits[i + 1]}, 52, is_near).high : limits[i];
      sum += integral(at, limits[i], high, 0.1) + integral(at, high, limits[i + 1], 0.1);
    }
    return sum;
  };
  return from_axis(ratio, 1) + from_axis(1, ratio);
}

/// Albedo of (N.H)^n / max(N.L, N.V) for a few n: smooth but on theta_V = theta_L.
double blinn_metal_albedo(double n, double theta_in) {
  const double cos_i = std::cos(theta_in);
  const double sin_i = std::sin(theta_in);
  const auto at = [&](double theta) {
    const double cos_o = std::cos(theta);
    const double sin_o = std::sin(theta);
    const auto power = [&](double psi) {
      const double cosine = cos_i * cos_o - sin_i * sin_o * std::cos(psi);  // L.V
      return std::pow((cos_i + cos_o) * (cos_i + cos_o) / (2 + 2 * cosine), n / 2);
    };
    return 2 * integral(power, 0, pi, pi / 2) * cos_o * sin_o / std::max(cos_i, cos_o);
  };
  return integral(at, 0, theta_in, 0.5) + integral(at, theta_in, pi / 2, 0.5);
}

/// The largest value of a function with one maximum within [low, high], by golden sections.
template <typename Function>
double maximum(const Function& f, double low, double high) {
  constexpr double kPrecise = 1e-6;  // of the place; the value is flat there
  const double ratio = std::numbers::phi - 1;
  double left = high - ratio * (high - low);
  double right = low + ratio * (high - low);
  double f_left = f(left);
  double f_right = f(right);
  while (high - low > kPrecise) {
    if (f_left < f_right) {
      low = left;
      left = right;
      f_left = f_right;
      right = low + ratio * (high - low);
      f_right = f(right);
    } else {
      high = right;
      right = left;
      f_right = f_left;
      left = high - ratio * (high - low);
      f_left = f(left);
    }
  }
  return std::max(f_left, f_right);
}

}  // namespace

double blinn_constant(double n) {
  const double half = std::numbers::ln2 / 2;
  const double a = -2 / (n + 4) * std::expm1(-half * (n + 4));
  const double b = -1 / (n + 2) * std::expm1(-half * (n + 2));
  return 1 / (8 * pi * (a - b));
}

double cosine_lobe_constant(double n) {
  return (n + 2) / (2 * pi);
}

double exponential_patch_constant(double s) {
  return s * s / (2 * pi * exponential_patch_area(s));
}

double exponential_norm_constant(double s, double ratio, double p) {
  const auto sector = [&](double norm) { return exponential_patch_area(s * norm) / (s * norm * s * norm); };
  return 1 / (4 * quarter_integral(ratio, p, sector, 0));
}

double patch_norm_constant(double radius, double ratio, double p) {
  const auto sector = [&](double norm) {
    const double reach = std::min(1.0, radius / norm);
    return reach * reach / 2;
  };
  return 1 / (4 * quarter_integral(ratio, p, sector, radius));
}

double gaussian_facets_constant(double m) {
  constexpr double kNegligible = 7;  // exp(-49) is below an ulp
  const double share = integral([&](double x) { return std::exp(-x * x) * std::sin(2 * m * x) / 2; }, 0,
                                std::min(pi / (2 * m), kNegligible), 1);
  return 1 / (8 * pi * m * share);
}

double blinn_metal_constant(double n) {
  constexpr double kLargestAtNormal = 4;  // from there on the albedo falls with the angle
  if (n >= kLargestAtNormal) return blinn_constant(n);
  const double peak = maximum([&](double theta) { return blinn_metal_albedo(n, theta); }, 0, 1.5);
  return std::min(blinn_constant(n), 1 / peak);
}

double ward_metal_constant(double m) {
  constexpr double kNegligible = 40;  // e^-40 is below an ulp
  const double square = m * m;
  const auto share = [&](double x) {
    const double rise = 1 + square * x;
    return std::exp(-x) * (1 - square * x) / (rise * rise * rise);
  };
  return 1 / integral(share, 0, std::min(1 / square, kNegligible), 2);
}

double generalised_lambert_constant(double d, double clip) {
  // m = 2 cos(t): arccos(m/2) = t, and xi is a power of sin(t) up to the clip.
  const double edge = std::acos(clip / 2);
  const double bounded = integral([](double t) { return t * std::sin(2 * t); }, 0, edge, pi / 8);
  const double risen =
      integral([&](double t) { return t * std::sin(2 * t) * std::pow(std::sin(t), -d); }, edge, pi / 2, pi / 32);
  return 1 / (4 * (bounded * std::pow(std::sin(edge), -d) + risen));
}

double phong_bisector_constant(double n) {
  // x = e^-t: exp(-(n+1) t) sqrt((1 + e^-t)/2) falls by e over t = 1/(n+1).
  constexpr double kNegligible = 40;  // e^-40 is below an ulp
  const double rate = n + 1;
  const auto share = [&](double y) { return std::exp(-y) * std::sqrt((1 + std::exp(-y / rate)) / 2); };
  return rate / (2 * pi * integral(share, 0, kNegligible, 2));
}

double shifted_gamma_constant(double alpha, double p) {
  constexpr double kNegligible = 45;  // e^-45 is below an ulp
  // In u = ln(x/alpha), with e^-alpha taken out.
  const auto density = [&](double u) { return std::exp(-alpha * std::expm1(u) + (1 - p) * u); };
  return std::exp(alpha) * std::pow(alpha, p - 2) / integral(density, 0, std::log1p(kNegligible / alpha), 1);
}

int roughness_terms(double g) {
  constexpr double kNegligible = 1e-18;
  double weight = std::exp(-g);
  double sum = 0;
  int m = 0;
  do {
    ++m;
    weight *= g / m;
    sum += weight / m;
  } while (m < g || weight > kNegligible * sum);
  return m;
}

}  // namespace lobe
