#include "render/sphere_parts.hpp"

#include <algorithm>
#include <cmath>
#include <map>

namespace lobe {
namespace {

/// Nearer to the silhouette and to the poles than this directions are those there, as in kernels/lobes/shade_sphere.cl.

double reach_at(double y) {
  return std::sqrt(std::max((1 - y) * (1 + y), 0.0));
}

/// The integral of min(max(x, -reach), reach) over y, between the kinks of it.
double integral_of_limit(double x, double y_low, double y_high) {
  const double reach = reach_at((y_low + y_high) / 2);
  if (std::abs(x) < reach) return x * (y_high - y_low);
  const auto half_disc = [](double y) { return (y * reach_at(y) + std::asin(std::clamp(y, -1.0, 1.0))) / 2; };
  return std::copysign(half_disc(y_high) - half_disc(y_low), x);
}

/// Limits of y within a pixel at which its sides meet the outline.
std::vector<double> limits_of(double x_low, double x_high, double y_low, double y_high) {
  std::vector<double> limits{y_low, y_high};
  for (const double x : {x_low, x_high}) {
    for (const double y : {-reach_at(x), reach_at(x)}) {
      if (y > y_low && y < y_high) limits.push_back(y);
    }
  }
  std::ranges::sort(limits);
  return limits;
}

}  // namespace

SphereParts sphere_parts(std::size_t size) {
  SphereParts result;
  const auto count = static_cast<Eigen::Index>(size);
  result.pixel = 2 / static_cast<double>(size);
  result.coverage = Eigen::VectorXd::Zero(count * count);
  const auto limit = [&](Eigen::Index k) { return static_cast<double>(2 * k - count) / static_cast<double>(count); };
  for (Eigen::Index row = 0; row < count; ++row) {
    for (Eigen::Index column = 0; column < count; ++column) {
      const double x_low = limit(column);
      const double x_high = limit(column + 1);
      const auto limits = limits_of(x_low, x_high, -limit(row + 1), -limit(row));
      for (std::size_t k = 0; k + 1 < limits.size(); ++k) {
        const double area =
            integral_of_limit(x_high, limits[k], limits[k + 1]) - integral_of_limit(x_low, limits[k], limits[k + 1]);
        if (!(area > 0)) continue;
        result.parts.push_back({x_low, x_high, limits[k], limits[k + 1]});
        result.pixel_of.push_back(row * count + column);
        result.coverage(row * count + column) += area / (result.pixel * result.pixel);
      }
    }
  }
  return result;
}

SpherePoint::SpherePoint(double x, double y, double reach)
    : normal_{x, y, std::max(std::sqrt(std::max((reach - x) * (reach + x), 0.0)), kLeastCosine)},
      reach_(std::max(reach, kLeastCosine)) {}

std::array<double, 3> SpherePoint::local(const std::array<double, 3>& direction) const {
  const auto& [x, y, n] = normal_;
  const auto& [d_x, d_y, d_z] = direction;
  const double outwards = d_x * x + d_z * n;
  return {(d_x * n - d_z * x) / reach_, reach_ * d_y - y * outwards / reach_, outwards + d_y * y};
}

void for_each_node(const SpherePart& part, const GaussRule& rule,
                   const std::function<void(const SpherePoint&, double)>& visit) {
  const double height = part.y_high - part.y_low;
  for (std::size_t j = 0; j < rule.nodes.size(); ++j) {
    const double y = part.y_low + height * rule.nodes[j];
    const double reach = reach_at(y);
    const double from = std::clamp(part.x_low, -reach, reach);
    const double width = std::clamp(part.x_high, -reach, reach) - from;
    for (std::size_t i = 0; i < rule.nodes.size(); ++i) {
      visit({from + width * rule.nodes[i], y, reach}, width * height * rule.weights[j] * rule.weights[i]);
    }
  }
}

PartIntegrals integrate_parts(std::span<const int> orders, int highest, Eigen::Index rows,
                              const PartTolerance& tolerance, const PartIntegrator& integrate) {
  constexpr double kSafety = 2;
  constexpr double kEarlier = 0.5;  // of the change before the last one: at kinks two rules may agree by accident
  PartIntegrals result{Eigen::MatrixXd::Zero(rows, static_cast<Eigen::Index>(orders.size())), {}};
  result.error = result.value;
  Eigen::MatrixXd earlier = result.value;
  std::map<int, std::vector<std::size_t>> waiting;  // by the order that comes next
  for (std::size_t k = 0; k < orders.size(); ++k) waiting[orders[k]].push_back(k);
  while (!waiting.empty()) {
    const auto [order, parts] = *waiting.begin();
    waiting.erase(waiting.begin());
    const Eigen::MatrixXd values = integrate(parts, gauss_rule(order));
    for (std::size_t i = 0; i < parts.size(); ++i) {
      const auto at = static_cast<Eigen::Index>(parts[i]);
      const Eigen::ArrayXd value = values.col(static_cast<Eigen::Index>(i));
      const Eigen::ArrayXd change = (value - result.value.col(at).array()).abs();
      const int first = orders[parts[i]];
      result.value.col(at) = value;
      if (order > first) {
        result.error.col(at) = kSafety * change.max(kEarlier * earlier.col(at).array());
        earlier.col(at) = change;
        const Eigen::ArrayXd scale = value.abs().max(tolerance.absolute / tolerance.relative);
        if ((result.error.col(at).array() <= tolerance.relative * scale).all()) continue;
        if (order >= std::max(highest, 2 * first)) continue;
      }
      waiting[2 * order].push_back(parts[i]);
    }
  }
  return result;
}

}  // namespace lobe
