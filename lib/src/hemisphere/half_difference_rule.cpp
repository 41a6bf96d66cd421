#include "hemisphere/half_difference_rule.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <span>
#include <utility>

#include "hemisphere/gauss.hpp"
#include "hemisphere/geometry.hpp"
#include "hemisphere/half_vector_rule.hpp"
#include "hemisphere/refinement.hpp"

namespace lobe {
namespace {

using std::numbers::pi;

// Panel sizes, found by measuring: the coarsest that let 8 nodes per panel reach 1e-6 for every model at hand, from
// exponent 1 to 1e5.
constexpr double kPeakRatio = 0.4;     // of successive theta_h slabs
constexpr double kGrazingRatio = 0.3;  // of successive theta_d and phi_d panels
constexpr double kCornerRatio = 0.2;   // of successive theta_d panels towards T = 1
constexpr int kCornerPanels = 2;       // on each side of T = 1
constexpr double kFirstSlab = 0.25;    // first slab, in lobe widths
constexpr double kFinestPanel = 0.75;  // smallest panel of the other axes, in lobe widths

constexpr double kWidestPanel = 0.5;  // elevation panels, radians
constexpr double kSlabGrowth = 3;     // of panels beside limits that all but coincide
// Density of azimuths. Products of lobes of aspect a fall off in them as exp(-2 n / a) or so: 7 a of them are as good
// as the coarsest 6 nodes per panel, and with fewer more nodes on all axes would have to make up for them.
constexpr double kPairAzimuths = 1.25;

/// Quantities that depend on theta_h alone.
struct Tilt {
  double angle, sine, cosine, tangent;
  double attenuation_eta;  ///< kink of G; negative where there is none
};

Tilt make_tilt(double theta_h) {
  const double sine = std::sin(theta_h);
  const double cosine = std::cos(theta_h);
  return {theta_h, sine, cosine, sine / cosine, 1 - 1 / (2 * cosine * cosine)};
}

/// sin^2(theta_h) where the edge of a patch passes the limit theta_d = pi/2 - 2 theta_h of the kink of G: the root of
/// 16 x^2 (1-x) = R^2 in [0, 1/2], for R^2 < 2.
double attenuation_crossing(double radius) {
  double low = 0;
  double high = 0.5;
  while (high - low > 1e-15) {
    const double x = (low + high) / 2;
    (4 * x * std::sqrt(1 - x) < radius ? low : high) = x;
  }
  return low;
}

/// Where the edge of a patch, 2 sin(theta_h) cos(theta_d) = R, meets theta_d = 0 or a limit of elevation_edges().
void add_patch_slabs(double radius, std::vector<PanelEdge>& edges) {
  const double square = radius * radius;
  edges.push_back({std::asin(radius / 2), true});
  edges.push_back({std::asin(std::sqrt(radius / 2)), true});  // T = 1
  if (radius < 1) {
    edges.push_back({std::asin(radius) / 2, true});
    edges.push_back({pi / 2 - std::asin(radius) / 2, true});
  }
  if (square >= 2) return;
  edges.push_back({std::asin(radius / std::sqrt(4 - square)), true});
  edges.push_back({std::asin(std::sqrt(attenuation_crossing(radius))), true});
  if (square > 1) edges.push_back({std::asin(radius / std::numbers::sqrt2), true});
}

/// cos^2(theta_d) where the edge of a patch about the retro direction meets the planes phi_d = pi/2 and phi_d = 0, and
/// the horizon; cosine2 = cos^2(theta_h).
std::array<double, 3> retro_patch_limits(double radius, double cosine2) {
  const double quarter = radius * radius / 4;
  return {1 - quarter, 1 - quarter / cosine2, (1 - quarter) / (1 + cosine2)};
}

/// Where these limits meet T = 1, L.V = 0 and edges of patches about the mirror direction.
void add_retro_patch_slabs(double radius, std::span<const double> mirror_radii, std::vector<PanelEdge>& edges) {
  const double square = radius * radius;
  const auto add = [&](double cosine2) {
    if (cosine2 > 0 && cosine2 < 1) edges.push_back({std::acos(std::sqrt(cosine2)), true});
  };
  add(square / 4);
  add(radius / 2);
  add(square / 2);
  add(1 - square / 2);
  for (const double mirror_radius : mirror_radii) {
    const double other = mirror_radius * mirror_radius;
    add(1 - other / (4 - square));
    add((4 - square - other) / (4 - square + other));
    // 4 x^2 + (other - square - 4) x + square = 0
    const double half = (4 + square - other) / 8;
    const double root = half * half - square / 4;
    if (root < 0) continue;
    add(half + std::sqrt(root));
    add(half - std::sqrt(root));
  }
}

/// cos(theta_d) where the limit of a smaller domain meets the edge of a patch about the retro direction; NaN if
/// nowhere.
double retro_patch_at_limit(double radius, double cos_h, double cos_min) {
  const double scale = 1 + cos_h * cos_h;
  const double along = cos_min * cos_h;
  return (along + std::sqrt(along * along + scale * (1 - cos_min * cos_min - radius * radius / 4))) / scale;
}

/// cos(theta_d) where the limit of a smaller domain meets the kinks; NaN if nowhere.
std::array<double, 4> kinks_at_limit(double cos_h, double cos_min) {
  const double along = cos_min * cos_h;
  const double rest = 1 - cos_min * cos_min;
  const double root = std::sqrt(along * along + rest - 0.5);
  const bool has_attenuation = cos_h * cos_h > 0.5;
  return {(along + std::sqrt(along * along + 2 * rest)) / 2, along + root, along - root,
          has_attenuation ? 2 * along : std::nan("")};
}

/// The pair of directions at an elevation pi/2 - theta_d and an eta.
KinkPair pair_at(const Tilt& h, double cos_d, double eta) {
  const double mean = h.cosine * cos_d;
  return {.cos_i = mean * (1 - eta), .cos_o = mean * (1 + eta), .cos_between = 2 * cos_d * cos_d - 1};
}

/// The largest eta at an elevation: that of phi_d = 0, or of the limit of the domain.
double largest_eta(const Tilt& h, double elevation, double cos_min) {
  const double cos_d = std::sin(elevation);
  const double at_limit = 1 - cos_min / (h.cosine * cos_d);
  return std::max(0.0, std::min(h.tangent * std::cos(elevation) / cos_d, at_limit));
}

/// Elevations at which kinks enter at either end of phi_d.
void add_kink_elevations(const Tilt& h, const LobeExtent& extent, std::vector<PanelEdge>& edges) {
  constexpr int kSteps = 3;
  std::vector<PanelEdge> found;
  for (const Kink& kink : extent.kinks) {
    if (kink.is_anisotropic) continue;
    append_zeros([&](double at) { return kink(pair_at(h, std::sin(at), 0)); }, edges, kSteps, true, found);
    append_zeros([&](double at) { return kink(pair_at(h, std::sin(at), largest_eta(h, at, extent.cos_min))); }, edges,
                 kSteps, true, found);
  }
  edges.insert(edges.end(), found.begin(), found.end());
  tidy_edges(edges);
}

/// Slabs of theta_h that end where kinks meet a corner of the domain at theta_h: theta_d = 0, T = 1 on the planes phi_d
/// = 0 and pi/2, and where a smaller domain ends.
void add_kink_slabs(const LobeExtent& extent, std::vector<PanelEdge>& edges) {
  constexpr int kSteps = 8;
  const double from_horizon = std::asin(extent.cos_min);
  std::vector<PanelEdge> found;
  for (const Kink& kink : extent.kinks) {
    if (kink.is_anisotropic) continue;
    const auto add = [&](auto cos_d_at, bool at_limit) {
      const auto value = [&](double theta_h) {
        const double cosine = std::cos(theta_h);
        const double cos_d = cos_d_at(theta_h);
        const double mean = cosine * cos_d;
        const double eta = at_limit && mean > 0 ? std::max(0.0, 1 - extent.cos_min / mean) : 0;
        return kink({.cos_i = mean * (1 - eta), .cos_o = mean * (1 + eta), .cos_between = 2 * cos_d * cos_d - 1});
      };
      append_zeros(value, edges, kSteps, true, found);
    };
    const auto at_corner = [=](double theta_h) { return std::sin(from_horizon + theta_h); };
    add([](double) { return 1.0; }, false);
    add(at_corner, true);
    add(at_corner, false);
    if (extent.cos_min > 0)
      add([&](double theta_h) { return std::min(1.0, extent.cos_min / std::cos(theta_h)); }, false);
  }
  edges.insert(edges.end(), found.begin(), found.end());
  tidy_edges(edges);
}

/// Panels of the elevation pi/2 - theta_d within a smaller domain, from those that the lobes want.
std::vector<PanelEdge> confined_elevations(const Tilt& h, const LobeExtent& extent, std::vector<PanelEdge> edges) {
  const double cos_min = extent.cos_min;
  const double lowest = std::asin(std::min(1.0, cos_min / h.cosine));
  const double corner = std::asin(cos_min) + h.angle;
  edges.push_back({corner, true});
  double step = 1;
  for (int k = 0; k < kCornerPanels; ++k) {
    step *= kCornerRatio;
    edges.push_back({corner - (corner - lowest) * step});
    edges.push_back({corner + h.angle * step});
  }
  for (double e = 2 * h.angle; corner + e < pi / 2; e /= kGrazingRatio) edges.push_back({corner + e});
  for (double e = lowest / kGrazingRatio; e < pi / 2; e /= kGrazingRatio) edges.push_back({e});
  const auto add_crossing = [&](double cos_d) {
    if (cos_d > 0 && cos_d < 1 && std::asin(cos_d) < corner) edges.push_back({std::asin(cos_d), true});
  };
  for (const double cos_d : kinks_at_limit(h.cosine, cos_min)) add_crossing(cos_d);
  for (const double radius : extent.retro_patch_radii) {
    add_crossing(retro_patch_at_limit(radius, h.cosine, cos_min));
  }
  std::erase_if(edges, [](const PanelEdge& edge) { return edge.at > pi / 2; });
  return cut_below(lowest, std::move(edges));
}

/// Panels of the elevation pi/2 - theta_d.
std::vector<PanelEdge> elevation_edges(const Tilt& h, const LobeExtent& extent) {
  const double corner = h.angle;  // T = 1
  // With T = 1 begin and end the kinks of L.V = N.L N.V.
  std::vector<PanelEdge> edges{{0},
                               {kWidestPanel},
                               {2 * kWidestPanel},
                               {pi / 2},
                               {corner, true},
                               {corner / 2},
                               {pi / 2 - corner, true},
                               {pi / 2 - std::atan(h.sine), true}};
  double step = 1;
  for (int k = 0; k < kCornerPanels; ++k) {
    step *= kCornerRatio;
    edges.push_back({corner * (1 - step)});
    edges.push_back({std::min(corner * (1 + step), pi / 2)});
  }
  for (double e = 2 * corner; e < pi / 2; e /= kGrazingRatio) {
    if (e < 0.8 * pi / 2 || e == 2 * corner) edges.push_back({e});
  }
  for (double e = corner / 2 * kGrazingRatio; e > kFinestPanel * extent.width; e *= kGrazingRatio) edges.push_back({e});
  if (h.attenuation_eta > 0) edges.push_back({std::atan2(h.tangent, h.attenuation_eta), true});
  if (h.angle > pi / 4) {
    // R.V = 0 meets the plane phi_d = pi/2 and the horizon.
    edges.push_back({pi / 2 - std::acos(1 / (std::numbers::sqrt2 * h.sine)), true});
    edges.push_back({pi / 4, true});
  }
  if (extent.retro_width < 1) {
    edges.push_back({pi / 4, true});  // (L.V)^n begins
    for (double e = pi / 4 * kPeakRatio; e > kFinestPanel * extent.retro_width; e *= kPeakRatio) {
      edges.push_back({pi / 2 - e});
    }
  }
  for (const double radius : extent.patch_radii) {
    if (radius < 2 * h.sine) edges.push_back({std::asin(radius / (2 * h.sine))});
  }
  for (const double radius : extent.retro_patch_radii) {
    for (const double cosine2 : retro_patch_limits(radius, h.cosine * h.cosine)) {
      if (cosine2 > 0) edges.push_back({std::asin(std::sqrt(cosine2)), true});
    }
  }
  tidy_edges(edges);
  if (extent.cos_min > 0) edges = confined_elevations(h, extent, std::move(edges));
  if (!extent.kinks.empty()) add_kink_elevations(h, extent, edges);
  const bool has_close_limits = !extent.patch_radii.empty() && !extent.retro_patch_radii.empty();
  if (has_close_limits || !extent.kinks.empty()) grade_edges(edges, kSlabGrowth);
  return edges;
}

/// Panels of phi_d from where the horizon, eta_max = 1, or the limit of a smaller domain lets it begin.
std::vector<PanelEdge> azimuth_edges(const Tilt& h, double elevation, double cos_d, double slope, double eta_max,
                                     double first, const LobeExtent& extent) {
  const double excess_slope = slope / eta_max;
  std::vector<PanelEdge> edges{{first, excess_slope > 1}, {pi / 2}};
  const double cos2_d = cos_d * cos_d;
  const double cos2_h = h.cosine * h.cosine;
  const double excess = 2 - 1 / cos2_d;
  const double limit = std::min(eta_max * eta_max, slope * slope);
  const auto add_kink = [&](double eta2, bool root) {
    if (eta2 > 0 && eta2 < limit) edges.push_back({std::acos(std::min(1.0, std::sqrt(eta2) / slope)), root});
  };
  if (h.attenuation_eta > 0) add_kink(h.attenuation_eta * h.attenuation_eta, false);
  add_kink(1 - excess / cos2_h, false);
  add_kink(1 - excess / (2 * cos2_h), true);  // (R.V)^n
  for (const double radius : extent.retro_patch_radii) {
    const double cosine2 = (1 - radius * radius / (4 * (1 - cos2_d))) / (h.sine * h.sine);
    if (cosine2 <= 0 || cosine2 >= 1) continue;
    const double at = std::acos(std::sqrt(cosine2));
    if (at > first) edges.push_back({at});
  }
  if (excess_slope > 0.3 && excess_slope < 3) {
    constexpr double kClosest = 1e-3;  // how near T = 1 the square-root end is followed
    for (double s = std::max(kClosest, std::sqrt(2 * std::abs(excess_slope - 1))); s < 0.4; s *= 4) {
      if (first + s < 0.9 * pi / 2) edges.push_back({first + s});
    }
  }
  if (extent.cos_min > 0 && excess_slope > 1) {
    // From 1 - eta_max the smaller cosine grows with phi_d: lobes may grow as its inverse.
    const double rise = std::sqrt(slope * slope - eta_max * eta_max);
    for (double s = 2 * (1 - eta_max) / rise; s < kWidestPanel; s /= kGrazingRatio) {
      if (first + s < 0.9 * pi / 2) edges.push_back({first + s});
    }
  }
  const double finest = 0.7 * std::max(elevation, kFinestPanel * extent.width / h.sine);
  for (double q = (pi / 2 - first) * kGrazingRatio; q > finest; q *= kGrazingRatio) edges.push_back({pi / 2 - q});
  tidy_edges(edges);
  if (extent.kinks.empty()) return edges;
  constexpr int kSteps = 2;
  std::vector<PanelEdge> found;
  for (const Kink& kink : extent.kinks) {
    if (kink.is_anisotropic) continue;
    const auto at = [&](double phi_d) { return kink(pair_at(h, cos_d, std::min(slope * std::cos(phi_d), eta_max))); };
    append_zeros(at, edges, kSteps, kink.has_root(), found);
  }
  edges.insert(edges.end(), found.begin(), found.end());
  tidy_edges(edges);
  return edges;
}

/// An azimuth of H and its share of the mean over a turn.
struct Turn {
  explicit Turn(const Azimuth& azimuth)
      : cosine(std::cos(azimuth.at)), sine(std::sin(azimuth.at)), share(azimuth.share) {}
  double cosine, sine, share;
};

/// Azimuths of H for nodes of anisotropic lobes.
struct Turns {
  std::vector<Turn> list;
  bool is_mirrored = false;   ///< nodes are of the mirror image of L
  bool both_sides = true;     ///< both signs of phi_d
  bool is_scattered = false;  ///< turned at every node
  bool both_orders = false;   ///< nodes stand in both orders of the directions
};

NodeBlock::Node exchanged(NodeBlock::Node node) {
  std::swap(node[NodeBlock::cos_i], node[NodeBlock::cos_o]);
  return node;
}

/// A node at all azimuths of H and with the signs of phi_d. in_x and in_y are those of L with H at azimuth 0.
/// \param by how far the azimuths are turned
void push_turned(const NodeBlock::Node& node, double tangent, double in_x, double in_y, const Turns& turns, double by,
                 NodeBlock& block, const std::function<void()>& flush) {
  const double cos_i = node[NodeBlock::cos_i];
  const double cos_o = node[NodeBlock::cos_o];
  const double reach = tangent * (cos_i + cos_o);
  const double cos_by = std::cos(by);
  const double sin_by = std::sin(by);
  for (const Turn& turn : turns.list) {
    const double share = turn.share;
    const double cosine = turn.cosine * cos_by - turn.sine * sin_by;
    const double sine = turn.sine * cos_by + turn.cosine * sin_by;
    NodeBlock::Node turned = node;
    turned[NodeBlock::factor] *= std::sqrt((turns.both_sides ? share / 2 : share) / (turns.both_orders ? 2 : 1));
    for (const double aside : {in_y, -in_y}) {
      if (!turns.both_sides && aside != in_y) break;
      const double x = in_x * cosine - aside * sine;
      const double y = in_x * sine + aside * cosine;
      const Components out{cos_o, reach * cosine - x, reach * sine - y};
      for (const bool is_exchanged : {false, true}) {
        if (is_exchanged && !turns.both_orders) break;
        if (turns.is_mirrored) {
          const Components in{cos_i, -x, -y};
          const TangentNode pair =
              node_of_components(is_exchanged ? out : in, is_exchanged ? in : out, turned[NodeBlock::factor]);
          block.push(pair.node, pair.tangents);
        } else if (is_exchanged) {
          block.push(exchanged(turned), {tangent * cosine, tangent * sine, out.x, out.y});
        } else {
          block.push(turned, {tangent * cosine, tangent * sine, x, y});
        }
        if (block.full()) flush();
      }
    }
  }
}

/// Slabs of theta_h within a smaller domain: they end where the curves on which its limit meets kinks and edges of
/// patches cross each other, begin or end.
std::vector<PanelEdge> confined_slabs(const LobeExtent& extent, std::vector<PanelEdge> edges) {
  const double cos_min = extent.cos_min;
  const double theta_max = std::acos(cos_min);
  std::erase_if(edges, [&](const PanelEdge& edge) { return edge.at >= theta_max; });
  edges.push_back({theta_max, true});
  tidy_edges(edges);
  // cos(theta_d) at theta_h; NaN where there is none.
  using Curve = std::function<double(double)>;
  std::vector<Curve> limits{[](double) { return 1.0; }, [=](double theta_h) { return cos_min / std::cos(theta_h); },
                            [=](double theta_h) { return std::cos(theta_max - theta_h); }};
  std::vector<Curve> curves;
  for (std::size_t k = 0; k < kinks_at_limit(1, cos_min).size(); ++k) {
    curves.emplace_back([=](double theta_h) { return kinks_at_limit(std::cos(theta_h), cos_min)[k]; });
  }
  for (const double radius : extent.patch_radii) {
    curves.emplace_back([=](double theta_h) { return radius / (2 * std::sin(theta_h)); });
  }
  for (const double radius : extent.retro_patch_radii) {
    curves.emplace_back([=](double theta_h) { return retro_patch_at_limit(radius, std::cos(theta_h), cos_min); });
  }
  std::vector<PanelEdge> crossings;
  for (const Curve& curve : curves) {
    for (const Curve& limit : limits) {
      const auto difference = [&](double theta_h) { return curve(theta_h) - limit(theta_h); };
      for (const double at : sign_changes(difference, edges)) crossings.push_back({at, true});
    }
    limits.push_back(curve);
  }
  edges.insert(edges.end(), crossings.begin(), crossings.end());
  tidy_edges(edges);
  return edges;
}

/// Slabs of theta_h.
std::vector<PanelEdge> tilt_edges(const LobeExtent& extent) {
  // theta_h ln(theta_h) at the peak.
  std::vector<PanelEdge> edges{{0, true}, {pi / 4}, {pi / 4 * 1.3}, {pi / 4 * 1.65}, {pi / 2}};
  for (double e = pi / 4 * kPeakRatio; e > kFirstSlab * extent.width; e *= kPeakRatio) edges.push_back({e});
  // The horizon cuts into the peak of a retro-reflecting lobe where theta_h + theta_d = pi/2.
  for (double e = pi / 4 * kPeakRatio; e > kFirstSlab * extent.retro_width; e *= kPeakRatio) {
    if (extent.retro_width < 1) edges.push_back({pi / 2 - e});
  }
  for (const double radius : extent.patch_radii) add_patch_slabs(radius, edges);
  for (const double radius : extent.retro_patch_radii) add_retro_patch_slabs(radius, extent.patch_radii, edges);
  tidy_edges(edges);
  if (extent.cos_min > 0) edges = confined_slabs(extent, std::move(edges));
  if (!extent.kinks.empty()) add_kink_slabs(extent, edges);
  return edges;
}

/// Nodes between two angles theta_h.
/// \param turns of blocks with tangents
void place_tilts(const LobeExtent& extent, const PanelEdge& low, const PanelEdge& high, const GaussRule& gauss,
                 const Turns& turns, NodeBlock& block, const std::function<void()>& flush) {
  const std::size_t count = gauss.nodes.size();
  std::size_t place = 0;
  for (std::size_t a = 0; a < count; ++a) {
    const PanelPoint theta_h = panel_point(low, high, gauss.nodes[a]);
    const Tilt h = make_tilt(theta_h.at);
    const double log_cos_h = std::log(h.cosine);
    const double weight_h = theta_h.stretch * gauss.weights[a] * h.sine;
    const auto elevations = elevation_edges(h, extent);
    for (std::size_t panel = 0; panel + 1 < elevations.size(); ++panel) {
      for (std::size_t b = 0; b < count; ++b) {
        const PanelPoint elevation = panel_point(elevations[panel], elevations[panel + 1], gauss.nodes[b]);
        const double sin_d = std::cos(elevation.at);
        const double cos_d = std::sin(elevation.at);
        const double slope = h.tangent * sin_d / cos_d;  // T
        const double eta_max = 1 - extent.cos_min / (h.cosine * cos_d);
        if (eta_max <= 0) continue;  // rounding, at the limit of a smaller domain
        const bool meets_horizon = slope > eta_max;
        const double first = meets_horizon ? std::acos(eta_max / slope) : 0.0;
        const double rise = meets_horizon ? std::sqrt(slope * slope - eta_max * eta_max) : 0.0;
        // 2 pi of phi_h; 4 quadrants of phi_d; 4 of the Jacobian.
        const double weight_d = weight_h * elevation.stretch * gauss.weights[b] * 2 * pi * 16 * cos_d * sin_d;
        auto azimuths = azimuth_edges(h, elevation.at, cos_d, slope, eta_max, first, extent);
        for (auto& edge : azimuths) edge.at -= first;  // phi_d from the horizon, without cancellation
        for (std::size_t side = 0; side + 1 < azimuths.size(); ++side) {
          for (std::size_t k = 0; k < count; ++k) {
            const PanelPoint step = panel_point(azimuths[side], azimuths[side + 1], gauss.nodes[k]);
            const double half_sine = std::sin(step.at / 2);
            const double one_minus_eta =
                meets_horizon ? (1 - eta_max) + 2 * eta_max * half_sine * half_sine + rise * std::sin(step.at)
                              : 1 - slope + 2 * slope * half_sine * half_sine;
            const double cos_phi = std::cos(first + step.at);
            const double cos_i = h.cosine * cos_d * one_minus_eta;
            const double cos_o = h.cosine * cos_d * (2 - one_minus_eta);
            const double deficit = 2 * h.sine * h.sine * (cos_d * cos_d + sin_d * sin_d * cos_phi * cos_phi);
            NodeBlock::Node node{cos_i,
                                 cos_o,
                                 h.cosine,
                                 cos_d,
                                 h.tangent * h.tangent,
                                 log_cos_h,
                                 log_mirror_cosine(deficit),
                                 std::sqrt(weight_d * step.stretch * gauss.weights[k] * cos_i * cos_o)};
            if (block.has_tangents()) {
              const double in_x = cos_d * h.sine + sin_d * cos_phi * h.cosine;
              const double by = turns.is_scattered ? scatter(++place, turns.list.size()) : 0;
              push_turned(node, h.tangent, in_x, sin_d * std::sin(first + step.at), turns, by, block, flush);
              continue;
            }
            if (extent.both_orders) {
              node[NodeBlock::factor] *= std::numbers::sqrt2 / 2;
              block.push(exchanged(node));
              if (block.full()) flush();
            }
            block.push(node);
            if (block.full()) flush();
          }
        }
      }
    }
  }
}

/// Lobes at an azimuth of H, as the rule knows them.
LobeExtent extent_at(LobeExtent extent, double azimuth) {
  for (const PatchEdge& edge : extent.patch_edges) {
    const double reach = edge.reach(azimuth);
    if (reach < 2) extent.patch_radii.push_back(reach);
  }
  return extent;
}

}  // namespace

HalfDifferenceRule::HalfDifferenceRule(LobeExtent extent, double tolerance)
    : extent_(std::move(extent)), is_loose_(tolerance >= kLooseTolerance) {
  extent_.width = std::min(extent_.width, 1.0);
  if (extent_.patch_edges.empty() && !extent_.retro_patch_edges.empty()) {
    is_mirrored_ = true;
    std::swap(extent_.patch_edges, extent_.retro_patch_edges);
    std::swap(extent_.patch_radii, extent_.retro_patch_radii);
    std::swap(extent_.width, extent_.retro_width);
  }
  if (extent_.both_orders) {
    const LobeExtent other = exchanged(extent_);
    extent_.kinks.insert(extent_.kinks.end(), other.kinks.begin(), other.kinks.end());
  }
  extent_.kinks.insert(extent_.kinks.end(), extent_.piece_kinks.begin(), extent_.piece_kinks.end());
  edges_ = tilt_edges(extent_);
  if (extent_.patch_edges.empty()) return;
  // Edges of radius 1 and sqrt(2) begin or cease to meet other limits; 2 is the whole base plane.
  std::vector<double> radii{1, std::numbers::sqrt2, 2};
  for (const auto* known : {&extent_.patch_radii, &extent_.retro_patch_radii}) {
    radii.insert(radii.end(), known->begin(), known->end());
  }
  if (extent_.cos_min > 0) {
    const double sin_max = std::sqrt((1 - extent_.cos_min) * (1 + extent_.cos_min));
    radii.insert(radii.end(), {sin_max, 1 + sin_max, 2 * sin_max});
  }
  turns_ = turn_panels(norm_panels(extent_.patch_edges, radii), extent_.aspect, extent_.half_turn);
}

std::size_t HalfDifferenceRule::azimuths(int nodes_per_panel, double azimuth_share) const {
  return azimuth_count(std::max(1.0, extent_.aspect * azimuth_share), nodes_per_panel, kPairAzimuths);
}

void HalfDifferenceRule::place(std::size_t slab, int level, NodeBlock& block, const std::function<void()>& flush,
                               double azimuth_share) const {
  // The mirrored rule has no panels for what other lobes do about the half-vector, and needs all its nodes for them.
  const bool has_others = extent_.retro_width < 1 || extent_.common.attenuation || extent_.common.mirror_cosine ||
                          !extent_.kinks.empty() || extent_.hides_jumps;
  const bool is_loose = is_loose_ && !turns_.empty() && !(is_mirrored_ && has_others);
  const auto& nodes_per_panel = is_loose ? kLooseNodesPerPanel : kNodesPerPanel;
  place_gauss(slab, nodes_per_panel[static_cast<std::size_t>(level)], block, flush, azimuth_share);
}

void HalfDifferenceRule::place_gauss(std::size_t slab, int nodes_per_panel, std::size_t azimuths, NodeBlock& block,
                                     const std::function<void()>& flush) const {
  const GaussRule gauss = gauss_rule(nodes_per_panel);
  if (turns_.empty()) {
    Turns turns{.list = {},
                .both_sides = extent_.both_sides,
                .is_scattered = extent_.hides_jumps,
                .both_orders = extent_.both_orders};
    if (block.has_tangents()) {
      for (const Azimuth& azimuth : equal_azimuths(azimuths)) turns.list.emplace_back(azimuth);
    }
    place_tilts(extent_, edges_[slab], edges_[slab + 1], gauss, turns, block, flush);
  } else {
    const double turn = turns_.back().at - turns_.front().at;
    for (const Azimuth& azimuth : panel_azimuths({turns_[slab], turns_[slab + 1]}, gauss)) {
      const double share = azimuth.share * (turns_[slab + 1].at - turns_[slab].at) / turn;
      const Turns turns{
          {Turn({azimuth.at, share})}, is_mirrored_, is_mirrored_ || extent_.both_sides, false, extent_.both_orders};
      const LobeExtent extent = extent_at(extent_, azimuth.at);
      auto edges = tilt_edges(extent);
      grade_edges(edges, kSlabGrowth);
      for (std::size_t k = 0; k + 1 < edges.size(); ++k) {
        place_tilts(extent, edges[k], edges[k + 1], gauss, turns, block, flush);
      }
    }
  }
  if (block.size() > 0) flush();
}

}  // namespace lobe
