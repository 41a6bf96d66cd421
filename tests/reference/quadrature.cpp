#include "reference/quadrature.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <numbers>

namespace lobe::reference {

using std::numbers::pi;

GaussRule gauss_legendre(int order) {
  GaussRule rule;
  for (int i = 0; i < order; ++i) {
    // Newton's method on P_n, started at the Chebyshev node.
    long double x = -std::cos(kPi * (static_cast<long double>(i) + 0.75L) / (static_cast<long double>(order) + 0.5L));
    long double derivative = 0;
    for (int step = 0; step < 50; ++step) {
      long double previous = 1;
      long double value = x;
      for (int k = 2; k <= order; ++k) {
        const long double next = ((2 * k - 1) * x * value - (k - 1) * previous) / k;
        previous = value;
        value = next;
      }
      derivative = order * (x * value - previous) / (x * x - 1);
      const long double change = value / derivative;
      x -= change;
      if (std::abs(change) < 1e-19L) break;
    }
    rule.nodes.push_back(static_cast<double>(x));
    rule.weights.push_back(static_cast<double>(2 / ((1 - x * x) * derivative * derivative)));
  }
  return rule;
}

namespace {

double apply(const GaussRule& rule, const std::function<double(double)>& g, double a, double b) {
  const double centre = 0.5 * (a + b);
  const double half = 0.5 * (b - a);
  double sum = 0;
  for (std::size_t i = 0; i < rule.nodes.size(); ++i) sum += rule.weights[i] * g(centre + half * rule.nodes[i]);
  return half * sum;
}

double refine(const std::function<double(double)>& g, double a, double b, double tolerance, int depth) {
  static const GaussRule coarse = gauss_legendre(7);
  static const GaussRule fine = gauss_legendre(15);
  const double value = apply(fine, g, a, b);
  const double difference = std::abs(value - apply(coarse, g, a, b));
  // The fine rule has about twice the correct digits of the coarse one, of which the difference speaks; half of that
  // gain is claimed. Below 1e-13 of the value it is rounding.
  const double error = difference * std::sqrt(std::min(1.0, difference / std::max(std::abs(value), 1e-300)));
  if (depth == 0 || error <= tolerance + 1e-13 * std::abs(value)) return value;
  const double centre = 0.5 * (a + b);
  return refine(g, a, centre, tolerance, depth - 1) + refine(g, centre, b, tolerance, depth - 1);
}

/// Cuts [a, b] at a peak and at distances from it that grow fourfold, starting with a width.
std::vector<double> graded_cuts(double a, double b, double peak, double width) {
  std::vector<double> cuts{a, b, peak};
  for (double distance = width; distance < b - a; distance *= 4) {
    cuts.push_back(peak - distance);
    cuts.push_back(peak + distance);
  }
  for (auto& cut : cuts) cut = std::clamp(cut, a, b);
  std::sort(cuts.begin(), cuts.end());
  cuts.erase(std::unique(cuts.begin(), cuts.end()), cuts.end());
  return cuts;
}

double integrate_panels(const std::function<double(double)>& g, const std::vector<double>& cuts, double tolerance) {
  double sum = 0;
  const double share = tolerance / static_cast<double>(cuts.size());
  for (std::size_t i = 0; i + 1 < cuts.size(); ++i) sum += integrate(g, cuts[i], cuts[i + 1], share);
  return sum;
}

/// Integral of h(theta) dmu = 2 pi * integral of h cos(theta) d cos(theta), on panels of cos(theta) that shrink to 0.
double over_hemisphere(const std::function<double(double theta)>& h) {
  static const GaussRule rule = gauss_legendre(8);
  constexpr double kRatio = 0.2;
  constexpr int kPanels = 8;
  double sum = 0;
  double upper = 1;
  for (int panel = 0; panel < kPanels; ++panel) {
    const double lower = panel == kPanels - 1 ? 0 : upper * kRatio;
    sum += apply(
        rule, [&](double c) { return h(std::acos(c)) * c; }, lower, upper);
    upper = lower;
  }
  return 2 * pi * sum;
}

}  // namespace

Real smooth_integral(const std::function<Real(Real)>& g, Real a, Real b) {
  static const GaussRule rule = gauss_legendre(80);
  Real sum = 0;
  for (std::size_t k = 0; k < rule.nodes.size(); ++k) {
    sum += static_cast<Real>(rule.weights[k]) * g(a + (b - a) * (1 + static_cast<Real>(rule.nodes[k])) / 2);
  }
  return sum * (b - a) / 2;
}

double integrate(const std::function<double(double)>& g, double a, double b, double tolerance) {
  return a < b ? refine(g, a, b, tolerance, 20) : 0;
}

double albedo(const Lobe& lobe, double theta_in, double tolerance) {
  const Vector light = light_of({theta_in, 0, 0});
  const auto over_phi = [&](double theta_out) {
    // The mirror direction is at phi = pi; near grazing angles lobes narrow there.
    const double width = lobe.width * std::max(std::cos(theta_in), 1e-4) / std::max(std::sin(theta_in), 1e-3);
    const auto f = [&](double phi) { return static_cast<double>(lobe.f(light, view_of({theta_in, theta_out, phi}))); };
    const double inner = 2 * integrate_panels(f, graded_cuts(0, pi, pi, std::min(width, 1.0)), 0.1 * tolerance);
    return inner * std::cos(theta_out) * std::sin(theta_out);
  };
  const double width = lobe.width * std::max(std::cos(theta_in), 1e-4);
  return integrate_panels(over_phi, graded_cuts(0, pi / 2, theta_in, width), tolerance);
}

double albedo_at(const Lobe& lobe, double theta_in, double phi_in, double tolerance) {
  const Vector light = light_of({theta_in, 0, 0, phi_in});
  const auto over_phi = [&](double theta_out) {
    const auto f = [&](double phi) {
      return static_cast<double>(lobe.f(light, view_of({theta_in, theta_out, phi, phi_in})));
    };
    return integrate_panels(f, graded_cuts(0, 2 * pi, pi, std::min(lobe.width, 1.0)), 0.1 * tolerance) *
           std::cos(theta_out) * std::sin(theta_out);
  };
  return integrate_panels(over_phi, graded_cuts(0, pi / 2, theta_in, lobe.width), tolerance);
}

double turned_point_product(const Lobe& f, const Lobe& g, int order, int azimuths) {
  const GaussRule rule = gauss_legendre(order);
  // theta = pi/2 (1 - t^2): N.X may have a root at the horizon.
  struct Node {
    double theta, weight;
  };
  std::vector<Node> nodes;
  for (std::size_t i = 0; i < rule.nodes.size(); ++i) {
    const double t = (1 + rule.nodes[i]) / 2;
    const double theta = pi / 2 * (1 - t * t);
    nodes.push_back({theta, rule.weights[i] / 2 * pi * t * std::cos(theta) * std::sin(theta)});
  }
  double sum = 0;
  for (const auto& in : nodes) {
    for (int k = 0; k < azimuths; ++k) {
      const double phi_in = 2 * pi * k / azimuths;
      const Vector light = light_of({in.theta, 0, 0, phi_in});
      for (const auto& out : nodes) {
        double ring = 0;
        for (int j = 0; j < azimuths; ++j) {
          const Vector view = view_of({in.theta, out.theta, 2 * pi * j / azimuths, phi_in});
          ring += static_cast<double>(f.f(light, view) * g.f(light, view));
        }
        sum += in.weight * out.weight * ring;
      }
    }
  }
  return sum * (2 * pi / azimuths) * (2 * pi / azimuths);
}

double mean_albedo(const Lobe& lobe) {
  return over_hemisphere([&](double theta) { return albedo(lobe, theta, 1e-8); }) / pi;
}

double daylight_product(const Lobe& f, const Lobe& g) {
  return over_hemisphere([&](double theta) { return albedo(f, theta, 1e-8) * albedo(g, theta, 1e-8); });
}

double composition(const Lobe& f, const Lobe& g, const Directions& pair, double tolerance) {
  const Vector light = light_of(pair);
  const Vector view = view_of(pair);
  const Vector centre{-light.x, -light.y, 0};
  const Vector other{-view.x, -view.y, 0};
  const Vector apart = other - centre;
  const auto distance = static_cast<double>(length(apart));
  const auto towards = static_cast<double>(std::atan2(apart.y, apart.x));
  const double narrow = std::min({f.width, g.width, 1.0});

  const auto along_ray = [&](double angle) {
    const Vector ray{std::cos(static_cast<Real>(angle)), std::sin(static_cast<Real>(angle)), 0};
    const Real before = dot(centre, ray);
    const Real last = -before + std::sqrt(before * before + light.z * light.z);  // where |X_P| = 1
    // r = last (1 - t^2), because N.X begins like a root at the rim of the disc.
    const auto integrand = [&](double t) {
      const Real r = last * (1 - static_cast<Real>(t) * t);
      Vector x = centre + r * ray;
      x.z = t * std::sqrt(last * (last + r + 2 * before));
      return static_cast<double>(f.f(light, x) * g.f(x, view) * r * 2 * last * t);
    };
    const auto end = static_cast<double>(last);
    auto cuts = graded_cuts(0, end, 0, narrow);
    const double nearest = distance * std::cos(angle - towards);
    if (nearest > 0 && nearest < end) {
      for (const double cut : graded_cuts(0, end, nearest, narrow)) cuts.push_back(cut);
    }
    for (auto& cut : cuts) cut = std::sqrt(std::max(0.0, 1 - cut / end));
    std::sort(cuts.begin(), cuts.end());
    return integrate_panels(integrand, cuts, 0.1 * tolerance);
  };
  const double angle_width = distance > 0 ? std::min(narrow / distance, 1.0) : 1.0;
  return integrate_panels(along_ray, graded_cuts(towards - pi, towards + pi, towards, angle_width), tolerance);
}

double point_product(const Lobe& f, const Lobe& g, int order) {
  const GaussRule rule = gauss_legendre(order);
  // Panels shrink towards the mirror direction, where lobes peak and max() kinks.
  const std::vector<double> in_cuts{0, 0.3 * pi, 0.45 * pi, 0.5 * pi};
  const std::vector<double> share_cuts{0, 0.5, 0.8, 0.95, 1};
  const std::vector<double> phi_cuts{0, 0.5 * pi, 0.75 * pi, 0.9 * pi, 0.97 * pi, pi};
  const auto over = [&rule](const std::vector<double>& cuts, const std::function<double(double)>& h) {
    double sum = 0;
    for (std::size_t i = 0; i + 1 < cuts.size(); ++i) sum += apply(rule, h, cuts[i], cuts[i + 1]);
    return sum;
  };
  const double half_triangle = over(in_cuts, [&](double theta_in) {
    const Vector light = light_of({theta_in, 0, 0});
    return std::sin(2 * theta_in) / 2 * over(share_cuts, [&](double share) {
             const double theta_out = theta_in * share;
             return theta_in * std::sin(2 * theta_out) / 2 * over(phi_cuts, [&](double phi) {
                      const Vector view = view_of({theta_in, theta_out, phi});
                      return static_cast<double>(f.f(light, view) * g.f(light, view));
                    });
           });
  });
  return 2 * 2 * 2 * pi * half_triangle;  // both triangles, both signs of phi, every azimuth of the light
}

}  // namespace lobe::reference
