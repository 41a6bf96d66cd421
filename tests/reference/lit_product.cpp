#include "reference/lit_product.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <utility>

namespace lobe::reference {
namespace {

using std::numbers::pi;

struct Point {
  double x, y;
};

/// Nodes in [-1, 1] and weights by Newton's method on the Legendre polynomial.
std::vector<std::pair<double, double>> gauss(int count) {
  std::vector<std::pair<double, double>> rule;
  for (int k = 0; k < count; ++k) {
    double x = std::cos(pi * (k + 0.75) / (count + 0.5));
    double slope = 0;
    for (int step = 0; step < 50; ++step) {
      double now = 1;
      double before = 0;
      for (int n = 1; n <= count; ++n) before = std::exchange(now, ((2 * n - 1) * x * now - (n - 1) * before) / n);
      slope = count * (x * now - before) / (x * x - 1);
      x -= now / slope;
    }
    rule.emplace_back(x, 2 / ((1 - x * x) * slope * slope));
  }
  return rule;
}

/// Where a ray from a point crosses a circle: the part inside, empty if first > second.
std::pair<double, double> inside(Point from, Point along, Point centre, double radius) {
  const double x = from.x - centre.x;
  const double y = from.y - centre.y;
  const double half = x * along.x + y * along.y;
  const double left = half * half - (x * x + y * y - radius * radius);
  if (left <= 0) return {1, -1};
  return {std::max(0.0, -half - std::sqrt(left)), -half + std::sqrt(left)};
}

/// A point with its share of an area.
struct Node {
  Point at;
  double weight;
};

/// Angles about a point with their weights: all, or those under which a disc is seen from outside, by the sine of the
/// angle so that chords begin smoothly.
std::vector<std::pair<double, double>> angles_to(Point from, Point centre, double radius, int count) {
  std::vector<std::pair<double, double>> angles;
  const double distance = std::hypot(centre.x - from.x, centre.y - from.y);
  if (distance < radius) {
    for (int a = 0; a < count; ++a) angles.emplace_back(2 * pi * (a + 0.5) / count, 2 * pi / count);
    return angles;
  }
  const double middle = std::atan2(centre.y - from.y, centre.x - from.x);
  for (int a = 0; a < count; ++a) {
    const double t = pi * ((a + 0.5) / count - 0.5);
    const double sine = radius / distance * std::sin(t);
    const double stretch = radius / distance * std::cos(t) / std::sqrt(1 - sine * sine);
    angles.emplace_back(middle + std::asin(sine), stretch * pi / count);
  }
  return angles;
}

/// Nodes on rays from a point, in panels between limits.
/// \param cut the part of a ray that counts
template <typename Cut>
std::vector<Node> ray_nodes(Point from, const std::vector<double>& limits,
                            const std::vector<std::pair<double, double>>& angles, int nodes, const Cut& cut) {
  static thread_local std::vector<std::pair<int, std::vector<std::pair<double, double>>>> rules;
  auto found = std::ranges::find(rules, nodes, [](const auto& rule) { return rule.first; });
  if (found == rules.end()) found = rules.insert(rules.end(), {nodes, gauss(nodes)});
  std::vector<Node> result;
  for (const auto& [angle, share] : angles) {
    const Point along{std::cos(angle), std::sin(angle)};
    const auto [first, last] = cut(along);
    for (std::size_t panel = 0; panel + 1 < limits.size(); ++panel) {
      const double low = std::max(first, limits[panel]);
      const double high = std::min(last, limits[panel + 1]);
      if (!(high > low)) continue;
      for (const auto& [x, w] : found->second) {
        const double t = (low + high) / 2 + (high - low) / 2 * x;
        result.push_back({{from.x + t * along.x, from.y + t * along.y}, w * (high - low) / 2 * t * share});
      }
    }
  }
  return result;
}

/// Both directions by their points of the base plane.
Directions pair_of(Point light, Point view) {
  const auto polar = [](Point p) { return std::asin(std::min(std::hypot(p.x, p.y), 1 - 1e-14)); };
  const double phi = std::atan2(light.y, light.x);
  return {polar(light), polar(view), std::atan2(view.y, view.x) - phi, phi};
}

}  // namespace

std::vector<double> lit_products(const PairValues& f, const PairValues& g, double radius, const LitRule& rule) {
  const double constant = 1 / (pi * std::min(1.0, radius * radius));
  // The response steps where the disc reaches the mirror direction, as steeply as the lobe is narrow.
  std::vector<double> limits{0, 2};
  for (double width = rule.narrowest; width < 1; width *= 3) {
    limits.push_back(width);
  }
  std::vector<double> steps{0, radius, 2};
  for (double width = rule.narrowest; width < 1; width *= 3) {
    if (radius - width > 0) steps.push_back(radius - width);
    if (radius + width < 2) steps.push_back(radius + width);
  }
  std::ranges::sort(limits);
  std::ranges::sort(steps);

  std::vector<double> sums(3, 0.0);
  const auto outer = gauss(rule.incident);
  for (const double middle : {pi / 8, 3 * pi / 8}) {
    for (const auto& [x, w] : outer) {
      const double theta = middle + pi / 8 * x;
      const double share = w * pi / 8 * std::sin(theta) * std::cos(theta) * 2 * pi / rule.turns;
      for (int turn = 0; turn < rule.turns; ++turn) {
        const double phi = 2 * pi * (turn + 0.3) / rule.turns;
        const Point viewer{std::sin(theta) * std::cos(phi), std::sin(theta) * std::sin(phi)};
        const Point mirror{-viewer.x, -viewer.y};
        const auto within = [&](Point along) { return inside(mirror, along, {0, 0}, 1); };
        const auto ps = ray_nodes(mirror, steps, angles_to(mirror, {0, 0}, 2, rule.azimuths), rule.nodes, within);
        std::vector<std::vector<Node>> discs;
        for (const Node& p : ps) {
          discs.push_back(
              ray_nodes(mirror, limits, angles_to(mirror, p.at, radius, rule.azimuths), rule.nodes, [&](Point along) {
                const auto [a, b] = within(along);
                const auto [c, d] = inside(mirror, along, p.at, radius);
                return std::pair(std::max(a, c), std::min(b, d));
              }));
        }
        // All values of this viewer at once: a call costs more than a value.
        std::vector<Directions> pairs;
        for (const auto& disc : discs) {
          for (const Node& node : disc) pairs.push_back(pair_of(node.at, viewer));
        }
        const auto of_f = f(pairs);
        const auto of_g = g(pairs);
        std::size_t place = 0;
        for (std::size_t k = 0; k < ps.size(); ++k) {
          double a = 0;
          double b = 0;
          for (const Node& node : discs[k]) {
            a += node.weight * of_f[place];
            b += node.weight * of_g[place++];
          }
          const double factor = share * ps[k].weight * constant * constant;
          sums[0] += factor * a * a;
          sums[1] += factor * a * b;
          sums[2] += factor * b * b;
        }
      }
    }
  }
  return sums;
}

}  // namespace lobe::reference
