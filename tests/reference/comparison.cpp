#include "reference/comparison.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <stdexcept>
#include <string>

namespace lobe::reference {
namespace {

using std::numbers::pi;
using Function = std::function<double(double)>;

/// Gauss rule on panels between [a, b] that grow threefold from a width on both sides of a point.
double graded(const Function& g, double a, double b, double point, double width, const GaussRule& rule) {
  std::vector<double> cuts{a, b, std::clamp(point, a, b)};
  for (double distance = width; distance < b - a; distance *= 3) {
    cuts.push_back(std::clamp(point - distance, a, b));
    cuts.push_back(std::clamp(point + distance, a, b));
  }
  std::sort(cuts.begin(), cuts.end());
  double sum = 0;
  for (std::size_t p = 0; p + 1 < cuts.size(); ++p) {
    const double half = (cuts[p + 1] - cuts[p]) / 2;
    if (half <= 0) continue;
    for (std::size_t k = 0; k < rule.nodes.size(); ++k)
      sum += half * rule.weights[k] * g(cuts[p] + half * (1 + rule.nodes[k]));
  }
  return sum;
}

struct Cosines {
  double ci, co, si, so;
};
using Integrand = std::function<double(double f, double g, const Cosines& at)>;

/// Integral over theta_in, theta_out in [0, theta_max] and delta_phi in [0, 2 pi].
double over_angles(const Lobe& f, const Lobe& g, double theta_max, int order, const Integrand& integrand) {
  const GaussRule rule = gauss_legendre(order);
  const double width = std::min({f.width, g.width, 0.3});
  const auto over_in = [&](double theta_in) {
    const Vector light = direction(theta_in, 0);
    const auto over_out = [&](double theta_out) {
      const Cosines at{std::cos(theta_in), std::cos(theta_out), std::sin(theta_in), std::sin(theta_out)};
      const auto over_phi = [&](double phi) {
        const Vector view = direction(theta_out, phi);
        return integrand(static_cast<double>(f.f(light, view)), static_cast<double>(g.f(light, view)), at);
      };
      return 2 * graded(over_phi, 0, pi, pi, std::min(1.0, width * at.ci / std::max(at.si, 1e-3)), rule);
    };
    return graded(over_out, 0, theta_max, theta_in, width * std::cos(theta_in), rule);
  };
  // The first panels end at the normal and, towards the horizon, grow from there too.
  const double middle = theta_max / 2;
  return graded(over_in, 0, middle, 0, width, rule) + graded(over_in, middle, theta_max, theta_max, 0.03, rule);
}

/// The directions of a half-vector at theta_h, azimuth 0, and a difference vector.
struct Pair {
  Vector light, view;
};
Pair of_half_difference(double theta_h, double theta_d, double phi_d) {
  // d rotated by theta_h about the y axis; V is the light mirrored at H.
  const Vector d = direction(theta_d, phi_d);
  const Real c = std::cos(static_cast<Real>(theta_h));
  const Real s = std::sin(static_cast<Real>(theta_h));
  const Vector light{c * d.x + s * d.z, d.y, -s * d.x + c * d.z};
  const Vector half = direction(theta_h, 0);
  return {light, 2 * dot(light, half) * half - light};
}

/// Mean over the cells of MERL: equal steps of sqrt(theta_h), theta_d, phi_d with both directions above the horizon.
double mean_over_half_difference(const Lobe& f, const Lobe& g, int order, const Integrand& integrand) {
  const GaussRule rule = gauss_legendre(order);
  const double width = std::min({f.width, g.width, 0.3});
  const auto total = [&](const Integrand& part) {
    const auto over_t = [&](double t) {  // theta_h = t^2
      const double theta_h = t * t;
      const auto over_phi = [&](double phi_d) {
        double low = 0;
        double high = pi / 2;
        const auto is_above = [&](double theta_d) {
          const Pair pair = of_half_difference(theta_h, theta_d, phi_d);
          return pair.light.z > 0 && pair.view.z > 0;
        };
        for (int step = 0; step < 60; ++step) {
          const double middle = (low + high) / 2;
          (is_above(middle) ? low : high) = middle;
        }
        const auto over_d = [&](double theta_d) {
          const Pair pair = of_half_difference(theta_h, theta_d, phi_d);
          const auto ci = static_cast<double>(pair.light.z);
          const auto co = static_cast<double>(pair.view.z);
          return part(static_cast<double>(f.f(pair.light, pair.view)), static_cast<double>(g.f(pair.light, pair.view)),
                      {ci, co, std::sqrt(1 - ci * ci), std::sqrt(1 - co * co)});
        };
        return graded(over_d, 0, low, low, 0.02, rule);
      };
      return graded(over_phi, 0, pi / 2, 0, 0.1, rule) + graded(over_phi, pi / 2, pi, pi, 0.1, rule);
    };
    return graded(over_t, 0, std::sqrt(pi / 2), 0, std::sqrt(width), rule);
  };
  return total(integrand) / total([](double, double, const Cosines&) { return 1.0; });
}

constexpr double kEpsilon = 1e-3;  // of log-relative and cube-root-log

double square(double x) {
  return x * x;
}

}  // namespace

double comparison(std::string_view name, const Lobe& f, const Lobe& g, double theta_max, int order) {
  const auto root_of = [&](const Integrand& integrand) {
    return std::sqrt(over_angles(f, g, theta_max, order, integrand));
  };
  const auto log_difference = [](double a, double b, const Cosines& at) {
    return std::log(1 + a * at.ci) - std::log(1 + b * at.ci);
  };
  if (name == "ngan-l2")
    return root_of([](double a, double b, const Cosines& at) { return square((a - b) * at.ci) * at.si * at.so; });
  if (name == "low-l2")
    return root_of([](double a, double b, const Cosines& at) { return square((a - b) * at.ci) * at.si; });
  if (name == "bieron-l2") {
    return root_of(
        [](double a, double b, const Cosines& at) { return square((a - b) * at.ci) * at.co * at.si * at.so; });
  }
  if (name == "low-log")
    return root_of([&](double a, double b, const Cosines& at) { return square(log_difference(a, b, at)) * at.si; });
  if (name == "bieron-log") {
    return root_of([&](double a, double b, const Cosines& at) {
      return square(log_difference(a, b, at)) * at.co * at.si * at.so;
    });
  }
  if (name == "standard-log") {
    return root_of(
        [&](double a, double b, const Cosines& at) { return square(log_difference(a, b, at)) * at.si * at.so; });
  }
  if (name == "cube-root") {
    const double samples = 2 * pi * theta_max * theta_max;
    const auto third = [](double a, double b, const Cosines& at) { return std::pow(std::abs(a - b) * at.ci, 2.0 / 3); };
    return root_of(third) / std::sqrt(samples);
  }
  if (name == "log-relative") {
    return std::sqrt(mean_over_half_difference(f, g, order, [](double a, double b, const Cosines& at) {
      const double w = std::max(at.ci * at.co, kEpsilon);
      return square(std::log((a * w + kEpsilon) / (b * w + kEpsilon)));
    }));
  }
  if (name == "albedo-of-difference") {
    return 2 * pi * over_angles(f, g, pi / 2, order, [](double a, double b, const Cosines& at) {
             return std::abs(a - b) * at.ci * at.si * at.co * at.so;
           });
  }
  if (name == "cube-root-l2") {
    const double samples = 2 * pi * theta_max * theta_max;
    return std::sqrt(over_angles(f, g, theta_max, order,
                                 [](double a, double b, const Cosines&) {
                                   return square(std::pow(a, 1.0 / 3) - std::pow(b, 1.0 / 3));
                                 }) /
                     samples);
  }
  if (name == "cube-root-log") {
    const double samples = 2 * pi * theta_max * theta_max;
    return over_angles(f, g, theta_max, order,
                       [](double a, double b, const Cosines& at) {
                         const double w = std::max(at.ci * at.co, kEpsilon);
                         return std::abs(
                             std::log((std::pow(a, 1.0 / 3) * w + kEpsilon) / (std::pow(b, 1.0 / 3) * w + kEpsilon)));
                       }) /
           samples;
  }
  throw std::out_of_range("no reference of comparison " + std::string(name));
}

}  // namespace lobe::reference
