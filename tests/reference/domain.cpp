#include "reference/domain.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace lobe::reference {
namespace {

using std::numbers::pi;
using DomainFunction = std::function<double(double)>;

/// Gauss rule on panels between [a, b] that grow threefold from a width on both sides of a point and from both ends.
double graded_domain(const DomainFunction& g, double a, double b, double point, double width, const GaussRule& rule) {
  std::vector<double> cuts{a, b, std::clamp(point, a, b)};
  for (double distance = width; distance < b - a; distance *= 3) {
    for (const double at : {point - distance, point + distance, b - distance}) cuts.push_back(std::clamp(at, a, b));
  }
  std::sort(cuts.begin(), cuts.end());
  double sum = 0;
  for (std::size_t p = 0; p + 1 < cuts.size(); ++p) {
    const double half = (cuts[p + 1] - cuts[p]) / 2;
    if (half <= 0) continue;
    for (std::size_t k = 0; k < rule.nodes.size(); ++k) {
      sum += half * rule.weights[k] * g(cuts[p] + half * (1 + rule.nodes[k]));
    }
  }
  return sum;
}

/// Integral of h(light, view) dmu(view) over theta_V <= theta_max, for light at azimuth 0; h even in the azimuth.
double over_views(double theta_max, double theta_in, double width, const GaussRule& rule,
                  const std::function<double(const Vector&, const Vector&)>& h) {
  const Vector light = direction(theta_in, 0);
  const auto over_theta = [&](double theta_out) {
    const auto over_phi = [&](double phi) { return h(light, direction(theta_out, phi)); };
    const double azimuth = std::min(1.0, width * std::cos(theta_in) / std::max(std::sin(theta_in), 1e-3));
    return std::sin(theta_out) * std::cos(theta_out) * 2 * graded_domain(over_phi, 0, pi, pi, azimuth, rule);
  };
  return graded_domain(over_theta, 0, theta_max, theta_in, width * std::cos(theta_in), rule);
}

double over_lights(double theta_max, const GaussRule& rule, const DomainFunction& h) {
  const auto weighted = [&](double theta) { return 2 * pi * std::sin(theta) * std::cos(theta) * h(theta); };
  return graded_domain(weighted, 0, theta_max, 0, 0.1, rule);
}

double albedo_up_to(double theta_max, const Lobe& f, double theta_in, const GaussRule& rule) {
  return over_views(theta_max, theta_in, std::min(f.width, 0.3), rule,
                    [&](const Vector& light, const Vector& view) { return static_cast<double>(f.f(light, view)); });
}

/// Area that discs of radii a and b have in common at a distance.
double lens(double a, double b, double distance) {
  if (distance >= a + b) return 0;
  if (distance <= std::abs(a - b)) return pi * std::min(a, b) * std::min(a, b);
  const double along_a = (distance * distance + a * a - b * b) / (2 * distance);
  const double along_b = distance - along_a;
  return a * a * std::acos(along_a / a) + b * b * std::acos(along_b / b) -
         distance * std::sqrt(std::max(0.0, a * a - along_a * along_a));
}

}  // namespace

double point_product_up_to(double theta_max, const Lobe& f, const Lobe& g, int order) {
  const GaussRule rule = gauss_legendre(order);
  const double width = std::min({f.width, g.width, 0.3});
  return over_lights(theta_max, rule, [&](double theta_in) {
    return over_views(theta_max, theta_in, width, rule, [&](const Vector& light, const Vector& view) {
      return static_cast<double>(f.f(light, view) * g.f(light, view));
    });
  });
}

double daylight_product_up_to(double theta_max, const Lobe& f, const Lobe& g, int order) {
  const GaussRule rule = gauss_legendre(order);
  return over_lights(theta_max, rule, [&](double theta_in) {
    return albedo_up_to(theta_max, f, theta_in, rule) * albedo_up_to(theta_max, g, theta_in, rule);
  });
}

double mean_albedo_product_up_to(double theta_max, const Lobe& f, const Lobe& g, int order) {
  const GaussRule rule = gauss_legendre(order);
  const auto total = [&](const Lobe& lobe) {
    return over_lights(theta_max, rule, [&](double theta_in) { return albedo_up_to(theta_max, lobe, theta_in, rule); });
  };
  return total(f) * total(g);
}

double patch_square_up_to(double theta_max, double radius) {
  const double limit = std::sin(theta_max);
  const auto ring = [&](double distance) { return 2 * pi * distance * lens(radius, limit, distance); };
  const double kink = std::clamp(limit - radius, 0.0, limit);
  const double area = integrate(ring, 0, kink, 1e-11) + integrate(ring, kink, limit, 1e-11);
  return area / (pi * radius * radius * pi * radius * radius);
}

}  // namespace lobe::reference
