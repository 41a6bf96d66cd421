#include "hemisphere/composition_rule.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

namespace lobe {
namespace {

using std::numbers::pi;

/// A point of the base plane, with the mirror direction of L at azimuth 0.
struct Point {
  double x, y;
};

void add_elevation(const Point& point, std::vector<PanelEdge>& edges) {
  const double from_normal = std::hypot(point.x, point.y);
  if (from_normal < 1) edges.push_back({std::acos(from_normal)});
}

/// The edge of a patch.
struct Circle {
  Point centre;
  double radius;
};

std::vector<Circle> circles(const LobeExtent& extent, const Point& mirror) {
  std::vector<Circle> list;
  for (const double radius : extent.patch_radii) list.push_back({mirror, radius});
  for (const double radius : extent.retro_patch_radii) list.push_back({{-mirror.x, -mirror.y}, radius});
  return list;
}

/// Elevation of the point of a circle that is nearest to another centre: where a lobe about that one has its largest
/// value within a patch.
void add_nearest(const Circle& circle, const Point& other, std::vector<PanelEdge>& edges) {
  const Point& centre = circle.centre;
  const double distance = std::hypot(other.x - centre.x, other.y - centre.y);
  if (distance == 0) return;
  const double share = circle.radius / distance;
  add_elevation({centre.x + share * (other.x - centre.x), centre.y + share * (other.y - centre.y)}, edges);
}

/// Elevations of the points where two circles cross.
void add_crossings(const Circle& circle, const Circle& other, std::vector<PanelEdge>& edges) {
  const auto& [centre, radius] = circle;
  const double x = other.centre.x - centre.x;
  const double y = other.centre.y - centre.y;
  const double distance = std::hypot(x, y);
  if (distance == 0) return;
  const double along = ((radius - other.radius) * (radius + other.radius) / distance + distance) / 2;
  const double across2 = (radius - along) * (radius + along);
  if (across2 < 0) return;
  for (const double across : {std::sqrt(across2), -std::sqrt(across2)}) {
    add_elevation({centre.x + (along * x - across * y) / distance, centre.y + (along * y + across * x) / distance},
                  edges);
  }
}

/// An azimuth in [0, 2 pi].
double wrapped(double azimuth) {
  const double turns = std::floor(azimuth / (2 * pi));
  return std::clamp(azimuth - 2 * pi * turns, 0.0, 2 * pi);
}

}  // namespace

CompositionRule::CompositionRule(LobeExtent f, LobeExtent g, const Directions& directions)
    : f_(std::move(f)),
      g_(std::move(g)),
      elevation_in_(pi / 2 - directions.theta_in),
      elevation_out_(pi / 2 - directions.theta_out),
      turn_(std::remainder(directions.delta_phi, 2 * pi)),
      in_plane_(std::abs(std::sin(turn_)) < 1e-15) {
  if (g_.both_orders) g_ = exchanged(std::move(g_));  // whose panels are those of X seen from V
  if (in_plane_) turn_ = std::abs(turn_) < 1 ? 0 : pi;
}

std::vector<PanelEdge> CompositionRule::elevations() const {
  auto edges = elevation_panels(elevation_in_, f_);
  const auto of_g = elevation_panels(elevation_out_, g_);
  edges.insert(edges.end(), of_g.begin(), of_g.end());
  const Point mirror_in{std::cos(elevation_in_), 0};
  const Point mirror_out{std::cos(elevation_out_) * std::cos(turn_), std::cos(elevation_out_) * std::sin(turn_)};
  const auto of_in = circles(f_, mirror_in);
  const auto of_out = circles(g_, mirror_out);
  for (const Circle& circle : of_in) add_nearest(circle, mirror_out, edges);
  for (const Circle& circle : of_out) add_nearest(circle, mirror_in, edges);
  for (const Circle& circle : of_in) {
    for (const Circle& other : of_out) add_crossings(circle, other, edges);
  }
  tidy_edges(edges);
  return edges;
}

std::vector<PanelEdge> CompositionRule::azimuths(double elevation) const {
  const auto of_f = azimuth_panels(elevation_in_, elevation, f_);
  const auto of_g = azimuth_panels(elevation_out_, elevation, g_);
  std::vector<PanelEdge> edges;
  if (in_plane_) {
    edges = of_f;
    for (const auto& edge : of_g) edges.push_back({turn_ == 0 ? edge.at : pi - edge.at, edge.root});
  } else {
    edges = {{0}, {2 * pi}};
    for (const auto& edge : of_f) {
      edges.push_back(edge);
      edges.push_back({2 * pi - edge.at, edge.root});
    }
    for (const auto& edge : of_g) {
      edges.push_back({wrapped(turn_ + edge.at), edge.root});
      edges.push_back({wrapped(turn_ - edge.at), edge.root});
    }
  }
  tidy_edges(edges);
  return edges;
}

}  // namespace lobe
