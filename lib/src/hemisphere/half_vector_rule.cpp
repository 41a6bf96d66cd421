#include "hemisphere/half_vector_rule.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <span>
#include <utility>

#include "core/text.hpp"
#include "hemisphere/gauss.hpp"
#include "hemisphere/geometry.hpp"
#include "lobe/core/error.hpp"

namespace lobe {
namespace {

using std::numbers::pi;

constexpr double kHalfRatio = 0.5;      // of successive panels of theta_h
constexpr double kAzimuthRatio = 0.3;   // of successive panels of phi_h
constexpr double kHalfInnermost = 0.7;  // smallest panel of theta_h, in lobe widths
constexpr double kTurn = 2;             // turn that a lobe of aspect 1 needs the nodes of a panel for

/// What is drawn out more than a thousandfold would take hours.
void require_aspect(double aspect) {
  constexpr double kLargest = 1000;
  if (aspect > kLargest) {
    throw NumericError("a lobe is " + shortest(std::round(aspect)) + " times longer than wide; expected at most " +
                       shortest(kLargest) + " times");
  }
}

/// How many times the nodes of a panel an angle needs.
std::size_t turns_of(double angle, double aspect) {
  require_aspect(aspect);
  return static_cast<std::size_t>(std::ceil(angle * aspect / kTurn));
}

/// Length of z on the horizon, at an azimuth from L.
double horizon_reach(double cos_i, double sin_i, double azimuth) {
  const double across = sin_i * std::cos(azimuth);
  const double root = std::hypot(cos_i, across);
  return across > 0 ? root + across : cos_i * cos_i / (root - across);
}

/// Axes of the norms and crossings of edges and horizon; turn is the azimuth that those of the panels begin at. Within
/// a smaller disc than the base plane, cos_i is the half of its chord through L, across the plane of incidence.
void add_edge_azimuths(double cos_i, double sin_i, double turn, std::span<const PatchEdge> patch_edges,
                       std::vector<PanelEdge>& edges) {
  if (patch_edges.empty()) return;
  for (const PanelEdge& limit : norm_panels(patch_edges, {})) {
    for (const double half_turn : {0.0, pi}) {
      edges.push_back({std::remainder(limit.at + half_turn - turn, 2 * pi), limit.root});
    }
  }
  tidy_edges(edges);
  std::vector<PanelEdge> crossings;
  for (const PatchEdge& edge : patch_edges) {
    if (std::isinf(edge.radius)) continue;
    const auto difference = [&](double azimuth) {
      return edge.reach(turn + azimuth) - horizon_reach(cos_i, sin_i, azimuth);
    };
    for (const double at : sign_changes(difference, edges)) crossings.push_back({at});
  }
  edges.insert(edges.end(), crossings.begin(), crossings.end());
  tidy_edges(edges);
}

/// Azimuths of H from L, [-pi, pi].
std::vector<PanelEdge> azimuth_edges(double cos_i, double sin_i, double aspect) {
  std::vector<PanelEdge> edges{{-pi}, {-pi / 2}, {0}, {pi / 2}, {pi}};
  const double finest = sin_i > 0 ? cos_i / sin_i : pi;
  for (double step = pi / 2 * kAzimuthRatio; step > finest; step *= kAzimuthRatio) {
    for (const double plane : {-pi / 2, pi / 2}) {
      edges.push_back({plane - step});
      edges.push_back({plane + step});
    }
  }
  const std::size_t panels = turns_of(pi / 2, aspect);
  for (std::size_t k = 1; k < 4 * panels; ++k) {
    edges.push_back({-pi + pi / 2 * static_cast<double>(k) / static_cast<double>(panels)});
  }
  tidy_edges(edges);
  return edges;
}

/// theta_h from the mirror direction to the horizon, or to N.V = cos_min.
/// \param reaches lengths of z at which lobes jump
std::vector<PanelEdge> ray_edges(const HalfVectorRay& ray, double width, std::span<const double> reaches,
                                 double cos_min) {
  const double cos_i = ray.cos_i;
  std::vector<PanelEdge> edges{{0}, {ray.horizon, true}};
  // N.V = 0 also behind the mirror direction.
  const double behind = std::atan2(cos_i, ray.across) / 2;
  for (double e = ray.horizon * kHalfRatio; e > kHalfInnermost * std::min(width, behind); e *= kHalfRatio)
    edges.push_back({e});
  if (ray.kink > 0) {
    // Attenuation takes N.V for small or large by that of L: a pole as far behind the horizon as the kink is before it.
    edges.push_back({ray.kink});
    const double finest = ray.horizon - ray.kink;
    for (double e = ray.horizon * kHalfRatio; e > finest; e *= kHalfRatio) edges.push_back({ray.horizon - e});
  }
  // R.V = 0, where (R.V)^n begins.
  const double square = ray.across * ray.across;
  const double cosine2 = (square + cos_i * cos_i - 0.5) / (ray.radius * ray.radius);
  if (cosine2 > 0 && cosine2 < 1) {
    const double begin = std::acos(std::sqrt(cosine2));
    if (begin < ray.horizon) edges.push_back({begin, true});
  }
  for (const double reach : reaches) {
    // 2 (L.H) sin(theta_h) = reach, a quadratic equation for the tangent.
    const double square_reach = cos_i * cos_i + (2 * ray.across - reach) * reach;
    if (square_reach < 0) continue;
    const double at = std::atan(reach / (cos_i + std::sqrt(square_reach)));
    if (at < ray.horizon) edges.push_back({at});
  }
  if (cos_min > 0) {
    const double end = ray.horizon - std::asin(std::min(1.0, cos_min / ray.radius)) / 2;
    std::erase_if(edges, [&](const PanelEdge& edge) { return edge.at >= end; });
    edges.push_back({std::max(end, 0.0), true});
  }
  tidy_edges(edges);
  return edges;
}

/// The pair of directions at an angle of the half-vector.
KinkPair pair_on(const HalfVectorRay& ray, double theta_h) {
  const double sine = std::sin(theta_h);
  const double cos_d = ray.across * sine + ray.cos_i * std::cos(theta_h);
  const double reach = 2 * cos_d * sine;
  const double cos_o = ray.radius * std::sin(2 * (ray.horizon - theta_h));
  const double side = ray.about_retro ? 1 : -1;
  const double out_x = side * ray.in_x + reach * ray.turn_x;
  const double out_y = side * ray.in_y + reach * ray.turn_y;
  return {.cos_i = ray.cos_i,
          .cos_o = cos_o,
          .cos_between = ray.cos_i * cos_o + ray.in_x * out_x + ray.in_y * out_y,
          .in_x = ray.in_x,
          .in_y = ray.in_y,
          .out_x = out_x,
          .out_y = out_y};
}

/// Where rays end: N.V = cos_min.
double end_of(const HalfVectorRay& ray, double cos_min) {
  return std::max(0.0, ray.horizon - std::asin(std::min(1.0, cos_min / ray.radius)) / 2);
}

}  // namespace

double scatter(std::size_t place, std::size_t count) {
  const double share = static_cast<double>(place) * (std::numbers::phi - 1);
  return (share - std::floor(share)) * 2 * pi / static_cast<double>(count);
}

std::size_t azimuth_count(double aspect, int nodes_per_panel, double density) {
  require_aspect(aspect);
  return static_cast<std::size_t>(std::ceil(nodes_per_panel * std::max(1.0, density * aspect))) | 1U;
}

std::vector<Azimuth> equal_azimuths(double aspect, int nodes_per_panel, double density) {
  return equal_azimuths(azimuth_count(aspect, nodes_per_panel, density));
}

std::vector<Azimuth> equal_azimuths(std::size_t count) {
  const double share = 1 / static_cast<double>(count);
  std::vector<Azimuth> azimuths;
  for (std::size_t k = 0; k < count; ++k) azimuths.push_back({2 * pi * static_cast<double>(k) * share, share});
  return azimuths;
}

std::vector<PanelEdge> turn_panels(std::vector<PanelEdge> limits, double aspect, bool half_turn) {
  for (PanelEdge& limit : limits) limit.at -= pi * std::floor(limit.at / pi);
  tidy_edges(limits);
  limits.push_back({limits.front().at + pi, limits.front().root});
  const std::size_t steps = turns_of(pi, aspect);
  const double longest = pi / static_cast<double>(steps);
  std::vector<PanelEdge> panels{limits.front()};
  for (std::size_t i = 1; i < limits.size(); ++i) {
    const double length = limits[i].at - limits[i - 1].at;
    const double parts = std::max(1.0, std::ceil(length / longest * (1 - 1e-12)));
    for (double k = 1; k < parts; ++k) panels.push_back({limits[i - 1].at + length * k / parts});
    panels.push_back(limits[i]);
  }
  if (half_turn) return panels;
  const std::size_t count = panels.size();
  for (std::size_t i = 1; i < count; ++i) panels.push_back({panels[i].at + pi, panels[i].root});
  return panels;
}

std::vector<Azimuth> panel_azimuths(const std::vector<PanelEdge>& panels, const GaussRule& gauss) {
  const double turn = panels.back().at - panels.front().at;
  std::vector<Azimuth> azimuths;
  for (std::size_t side = 0; side + 1 < panels.size(); ++side) {
    for (std::size_t k = 0; k < gauss.nodes.size(); ++k) {
      const PanelPoint point = panel_point(panels[side], panels[side + 1], gauss.nodes[k]);
      azimuths.push_back({point.at, point.stretch * gauss.weights[k] / turn});
    }
  }
  return azimuths;
}

HalfVectorRule::HalfVectorRule(LobeExtent extent) : extent_(std::move(extent)) {}

HalfVectorRay::HalfVectorRay(double elevation, double azimuth, bool retro, double phi)
    : cos_i(std::sin(elevation)),
      in_x(std::cos(elevation) * std::cos(azimuth)),
      in_y(std::cos(elevation) * std::sin(azimuth)),
      turn((retro ? azimuth + pi : azimuth) + phi),
      turn_x(std::cos(turn)),
      turn_y(std::sin(turn)),
      about_retro(retro),
      across(std::cos(elevation) * std::cos(phi)),
      horizon(std::atan2(cos_i, -across) / 2),
      kink(std::atan2(across, cos_i)),
      radius(std::hypot(cos_i, across)) {}

TangentNode HalfVectorRay::node(double theta_h, double weight) const {
  const double sine = std::sin(theta_h);
  const double cosine = std::cos(theta_h);
  const double cos_o = radius * std::sin(2 * (horizon - theta_h));
  const double cos_d = across * sine + cos_i * cosine;
  const double factor = weight * 4 * cos_d * cos_o * sine;
  if (about_retro) {
    const double reach = 2 * cos_d * sine;
    return node_of_components({cos_i, in_x, in_y}, {cos_o, in_x + reach * turn_x, in_y + reach * turn_y}, factor);
  }
  const double tangent = sine / cosine;
  const double fall = cos_i * sine - across * cosine;  // (N.L - N.V) / (2 sine)
  const double tan2_h = tangent * tangent;
  const double deficit = 2 * sine * sine * (fall * fall + cos_d * cos_d);
  return {{cos_i, cos_o, cosine, cos_d, tan2_h, -0.5 * std::log1p(tan2_h), log_mirror_cosine(deficit), factor},
          {tangent * turn_x, tangent * turn_y, in_x, in_y}};
}

std::vector<PanelEdge> HalfVectorRule::azimuths(double elevation, double azimuth, bool about_retro) const {
  const double cos_i = std::sin(elevation);
  const double sin_i = std::cos(elevation);
  const auto& patch_edges = about_retro ? extent_.retro_patch_edges : extent_.patch_edges;
  auto edges = azimuth_edges(cos_i, sin_i, extent_.aspect);
  const double cos_min = extent_.cos_min;
  const double half_chord = cos_min > 0 ? std::sqrt(std::max(0.0, cos_i * cos_i - cos_min * cos_min)) : cos_i;
  add_edge_azimuths(half_chord, sin_i, about_retro ? azimuth + pi : azimuth, patch_edges, edges);
  constexpr int kSteps = 4;
  std::vector<PanelEdge> found;
  for (const Kink& kink : extent_.kinks) {
    if (!kink.is_on_rays()) continue;
    const auto at_end = [&](double phi) {
      const HalfVectorRay ray(elevation, azimuth, about_retro, phi);
      return kink(pair_on(ray, end_of(ray, cos_min)));
    };
    append_zeros(at_end, edges, kSteps, true, found);
  }
  edges.insert(edges.end(), found.begin(), found.end());
  tidy_edges(edges);
  return edges;
}

std::vector<PanelEdge> HalfVectorRule::along(const HalfVectorRay& ray) const {
  const auto& patch_edges = ray.about_retro ? extent_.retro_patch_edges : extent_.patch_edges;
  std::vector<double> reaches;
  for (const PatchEdge& edge : patch_edges) reaches.push_back(edge.reach(ray.turn));
  auto edges = ray_edges(ray, ray.about_retro ? extent_.retro_width : extent_.width, reaches, extent_.cos_min);
  constexpr int kSteps = 2;
  std::vector<PanelEdge> found;
  for (const Kink& kink : extent_.kinks) {
    if (!kink.is_on_rays()) continue;
    append_zeros([&](double theta_h) { return kink(pair_on(ray, theta_h)); }, edges, kSteps, kink.has_root(), found);
  }
  edges.insert(edges.end(), found.begin(), found.end());
  tidy_edges(edges);
  return edges;
}

void HalfVectorRule::place(double elevation, double azimuth, bool about_retro, int nodes_per_panel, NodeBlock& block,
                           const std::function<void()>& flush) const {
  const GaussRule gauss = gauss_rule(nodes_per_panel);
  const auto sides = azimuths(elevation, azimuth, about_retro);
  for (std::size_t side = 0; side + 1 < sides.size(); ++side) {
    for (std::size_t j = 0; j < gauss.nodes.size(); ++j) {
      const PanelPoint phi = panel_point(sides[side], sides[side + 1], gauss.nodes[j]);
      const HalfVectorRay ray(elevation, azimuth, about_retro, phi.at);
      const auto edges = along(ray);
      for (std::size_t panel = 0; panel + 1 < edges.size(); ++panel) {
        for (std::size_t k = 0; k < gauss.nodes.size(); ++k) {
          const PanelPoint theta = panel_point(edges[panel], edges[panel + 1], gauss.nodes[k]);
          const auto [node, tangents] =
              ray.node(theta.at, phi.stretch * gauss.weights[j] * theta.stretch * gauss.weights[k]);
          block.push(node, tangents);
          if (block.full()) flush();
        }
      }
    }
  }
}

}  // namespace lobe
