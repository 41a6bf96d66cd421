#include "hemisphere/opposite_patch_rule.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <utility>

#include "hemisphere/geometry.hpp"
#include "hemisphere/half_vector_rule.hpp"
#include "hemisphere/patch_edge.hpp"
#include "hemisphere/refinement.hpp"

namespace lobe {
namespace {

using std::numbers::pi;

/// Gauss nodes per panel and axis. Four axes have panels: the levels of other rules cost ten times as much.
constexpr std::array<int, kLevels> kNodesOfFourAxes{4, 5, 7, 9, 11, 13, 15, 18, 22};

constexpr double kLengthRatio = 0.4;  // of successive panels of a profile
constexpr double kFirstLength = 0.5;  // of a profile, in lobe widths
constexpr double kTurnRatio = 0.3;    // of successive panels of phi_v towards the plane across u
constexpr int kTurnPanels = 4;

bool has_profile(const std::vector<PatchEdge>& edges) {
  return std::ranges::any_of(edges, [](const PatchEdge& edge) { return std::isinf(edge.radius); });
}

/// How far the edges go at an azimuth, up to a largest length: where some have a profile, as far as that.
std::vector<double> reaches(const std::vector<PatchEdge>& edges, double azimuth, double largest) {
  std::vector<double> found;
  for (const PatchEdge& edge : edges) found.push_back(std::min(edge.reach(azimuth), largest));
  std::ranges::sort(found);
  return found;
}

/// The largest |v| at |u| = length, or the other way about, where the cosine of the angle between them has that
/// magnitude.
double largest_other(double reach, double length, double cosine) {
  const double root = std::sqrt(std::max(0.0, reach * reach - length * length * (1 - cosine * cosine)));
  return (reach - length) * (reach + length) / (root + length * cosine);
}

void add_profile(double width, double upper, std::vector<PanelEdge>& edges) {
  for (double e = 1; e > kFirstLength * width; e *= kLengthRatio) {
    if (e < upper) edges.push_back({e});
  }
}

}  // namespace

struct OppositePatchRule::Ray {
  Ray(double phi, std::vector<double> lengths)
      : azimuth(phi), cosine(std::cos(phi)), sine(std::sin(phi)), ends(std::move(lengths)) {}

  double azimuth, cosine, sine;
  std::vector<double> ends;  ///< of edges on the ray, rising
};

OppositePatchRule::OppositePatchRule(LobeExtent extent)
    : extent_(std::move(extent)),
      reach_(2 * std::sqrt((1 - extent_.cos_min) * (1 + extent_.cos_min))),
      has_profile_u_(has_profile(extent_.patch_edges)),
      has_profile_v_(has_profile(extent_.retro_patch_edges)) {
  const std::array radii{reach_};
  turns_ = turn_panels(norm_panels(extent_.patch_edges, radii), 1, true);
  turns_v_ = turn_panels(norm_panels(extent_.retro_patch_edges, radii), 1, true);
  if (extent_.both_orders) {
    const LobeExtent other = exchanged(extent_);
    extent_.kinks.insert(extent_.kinks.end(), other.kinks.begin(), other.kinks.end());
  }
  extent_.kinks.insert(extent_.kinks.end(), extent_.piece_kinks.begin(), extent_.piece_kinks.end());
}

std::vector<PanelEdge> OppositePatchRule::across(const Ray& ray) const {
  std::vector<PanelEdge> panels = turns_v_;
  const double first = turns_v_.front().at;
  const auto add = [&](double azimuth) { panels.push_back({azimuth - pi * std::floor((azimuth - first) / pi)}); };
  add(ray.azimuth + pi / 2);
  bool meets_limit = false;
  for (const PatchEdge& edge : extent_.retro_patch_edges) {
    if (ray.ends.back() + edge.farthest() <= reach_) continue;
    meets_limit = true;
    for (const double end : ray.ends) {
      const auto beyond_limit = [&](double azimuth) {
        const double other = std::min(edge.reach(azimuth), reach_);
        const double cosine = std::abs(std::cos(azimuth - ray.azimuth));
        return end * end + other * other + 2 * end * other * cosine - reach_ * reach_;
      };
      for (const double at : sign_changes(beyond_limit, turns_v_)) add(at);
    }
  }
  double step = pi / 2;
  for (int k = 0; k < kTurnPanels && meets_limit; ++k) {
    step *= kTurnRatio;
    add(ray.azimuth + pi / 2 + step);
    add(ray.azimuth + pi / 2 - step);
  }
  tidy_edges(panels);
  return panels;
}

/// \param cosine magnitude of that of the angle between u and v
/// \param ends of edges of v
std::vector<PanelEdge> OppositePatchRule::lengths_u(const Ray& ray, double cosine,
                                                    const std::vector<double>& ends) const {
  const double upper = ray.ends.back();
  std::vector<PanelEdge> edges{{0}, {upper, upper >= reach_}};
  const auto add = [&](double at) {
    if (at > 0 && at < upper) edges.push_back({at});
  };
  for (const double end : ray.ends) add(end);
  for (const double end : ends) {
    if (end < reach_) add(largest_other(reach_, end, cosine));
  }
  if (has_profile_u_) add_profile(2 * extent_.width, upper, edges);
  tidy_edges(edges);
  return edges;
}

/// \param length of u
/// \param ends of edges of v
std::vector<PanelEdge> OppositePatchRule::lengths_v(const Ray& ray, double azimuth, double length,
                                                    const std::vector<double>& ends) const {
  const double between = std::cos(azimuth - ray.azimuth);
  const double limit = largest_other(reach_, length, std::abs(between));
  const double upper = std::min(ends.back(), limit);
  std::vector<PanelEdge> edges{{0}, {upper, upper >= limit}};
  for (const double end : ends) {
    if (end < upper) edges.push_back({end});
  }
  if (has_profile_v_) add_profile(2 * extent_.retro_width, upper, edges);
  tidy_edges(edges);
  if (extent_.kinks.empty()) return edges;
  constexpr int kSteps = 3;
  std::vector<PanelEdge> found;
  for (const Kink& kink : extent_.kinks) {
    if (kink.is_anisotropic) continue;
    const auto value = [&](double other) {
      const double square = (length * length + other * other) / 4;
      const double half = length * other * between / 2;
      KinkPair pair;
      pair.cos_i = std::sqrt(std::max(0.0, 1 - (square - half)));
      pair.cos_o = std::sqrt(std::max(0.0, 1 - (square + half)));
      pair.cos_between = (length - other) * (length + other) / 4 + pair.cos_i * pair.cos_o;
      return kink(pair);
    };
    append_zeros(value, edges, kSteps, true, found);
  }
  edges.insert(edges.end(), found.begin(), found.end());
  tidy_edges(edges);
  return edges;
}

void OppositePatchRule::place(std::size_t slab, int level, NodeBlock& block, const std::function<void()>& flush) const {
  const GaussRule gauss = gauss_rule(kNodesOfFourAxes[static_cast<std::size_t>(level)]);
  const std::size_t count = gauss.nodes.size();
  const int turns = extent_.half_turn ? 1 : 2;
  const int orders = extent_.both_orders ? 2 : 1;
  const auto each = [&](const std::vector<PanelEdge>& panels, const auto& visit) {
    for (std::size_t panel = 0; panel + 1 < panels.size(); ++panel) {
      for (std::size_t k = 0; k < count; ++k) {
        const PanelPoint point = panel_point(panels[panel], panels[panel + 1], gauss.nodes[k]);
        visit(point.at, point.stretch * gauss.weights[k]);
      }
    }
  };
  each({turns_[slab], turns_[slab + 1]}, [&](double phi_u, double weight_phi_u) {
    const Ray ray(phi_u, reaches(extent_.patch_edges, phi_u, reach_));
    each(across(ray), [&](double phi_v, double weight_phi_v) {
      const double between = std::cos(phi_v - phi_u);
      const double cos_v = std::cos(phi_v);
      const double sin_v = std::sin(phi_v);
      const std::vector<double> ends = reaches(extent_.retro_patch_edges, phi_v, reach_);
      each(lengths_u(ray, std::abs(between), ends), [&](double u, double weight_u) {
        each(lengths_v(ray, phi_v, u, ends), [&](double v, double weight_v) {
          // Four pairs of signs of u and v, and dmu dmu = du dv / 4.
          const double weight = weight_phi_u * weight_phi_v * weight_u * weight_v * u * v;
          for (int k = 0; k < turns * orders; ++k) {
            const double sign_u = k / orders == 0 ? 1 : -1;
            const double sign_v = k % orders == 0 ? sign_u : -sign_u;
            const double u_x = sign_u * u * ray.cosine;
            const double u_y = sign_u * u * ray.sine;
            const double in_x = (u_x - sign_v * v * cos_v) / 2;
            const double in_y = (u_y - sign_v * v * sin_v) / 2;
            const double half = sign_u * sign_v * u * v * between / 2;
            const double square = (u * u + v * v) / 4;
            const double cos_i = std::sqrt(1 - (square - half));
            const double cos_o = std::sqrt(1 - (square + half));
            if (!(cos_i > 0 && cos_o > 0)) continue;  // rounding, at the horizon
            const TangentNode node = node_of_components({cos_i, in_x, in_y}, {cos_o, u_x - in_x, u_y - in_y},
                                                        std::sqrt(weight / (turns * orders)));
            block.push(node.node, node.tangents);
            if (block.full()) flush();
          }
        });
      });
    });
  });
  if (block.size() > 0) flush();
}

}  // namespace lobe
