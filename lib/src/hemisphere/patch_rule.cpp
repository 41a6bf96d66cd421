#include "hemisphere/patch_rule.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

#include "core/parallel.hpp"
#include "hemisphere/disc_nodes.hpp"
#include "hemisphere/gauss.hpp"
#include "hemisphere/geometry.hpp"

namespace lobe {
namespace {

LobeExtent with_lights(LobeExtent extent, const std::vector<double>& radii, bool has_mirror_and_retro) {
  extent.patch_radii.insert(extent.patch_radii.end(), radii.begin(), radii.end());
  for (const double radius : radii) {
    if (!has_mirror_and_retro || radius >= 1) continue;
    // Common areas of discs begin with the power 3/2. The centres are as far from the origin as L.
    extent.kinks.push_back(cosine_kinks(std::sqrt((1 - radius) * (1 + radius)), 1.5).front());
  }
  return extent;
}

/// Polynomials oscillate evenly in the elevation and in psi; a node stands for four radians of that.
int more_nodes(double length, double degree) {
  return static_cast<int>(std::ceil(degree * length / 4));
}

/// The integral of l_j g for the Lagrange polynomials l_j of some nodes and g at finer ones.
Eigen::MatrixXd product_weights(const GaussRule& nodes, const GaussRule& fine) {
  const auto count = static_cast<Eigen::Index>(nodes.nodes.size());
  const auto fine_count = static_cast<Eigen::Index>(fine.nodes.size());
  const Eigen::Map<const Eigen::VectorXd> at(nodes.nodes.data(), count);
  const Eigen::Map<const Eigen::VectorXd> weights(fine.weights.data(), fine_count);
  if (count == fine_count) return weights.asDiagonal();
  Eigen::MatrixXd values = Eigen::MatrixXd::Ones(count, fine_count);
  for (Eigen::Index k = 0; k < fine_count; ++k) {
    const double x = fine.nodes[static_cast<std::size_t>(k)];
    for (Eigen::Index j = 0; j < count; ++j) {
      for (Eigen::Index i = 0; i < count; ++i) {
        if (i != j) values(j, k) *= (x - at(i)) / (at(j) - at(i));
      }
    }
  }
  return values * weights.asDiagonal();
}

}  // namespace

PatchRule::PatchRule(LobeExtent extent, const std::vector<double>& light_radii, bool has_mirror_and_retro)
    : extent_(std::move(extent)), outer_(with_lights(extent_, light_radii, has_mirror_and_retro)) {
  extent_.common = CommonKinks::all();
  for (const double radius : light_radii) light_edges_.push_back({std::acos(std::abs(1 - radius)), true});
}

const PatchRule::Rule& PatchRule::rule_of(const PanelEdge& low, const PanelEdge& high, int count, double degree,
                                          int known) const {
  const int more = more_nodes(high.at - low.at, degree);
  return rules_->at({count + std::min(more, known), count + more});
}

PatchNodes PatchRule::place(double elevation, int count, int degree, int known) {
  // No panel is longer than a right angle.
  for (int more = 0; more <= more_nodes(std::numbers::pi / 2, degree) + 1; ++more) {
    const std::pair key(count + std::min(more, known), count + more);
    const auto [place, is_new] = rules_->try_emplace(key);
    if (!is_new) continue;
    Rule& rule = place->second;
    rule.fine = gauss_rule(key.second);
    rule.nodes = gauss_rule(key.first);
    rule.weights = product_weights(rule.nodes, rule.fine);
  }
  auto elevations = elevation_panels(elevation, extent_);
  elevations.insert(elevations.end(), light_edges_.begin(), light_edges_.end());
  tidy_edges(elevations);
  PatchNodes placed;
  auto& rings = placed.rings;
  std::vector<double> factors;
  for (std::size_t panel = 0; panel + 1 < elevations.size(); ++panel) {
    const Rule& rule = rule_of(elevations[panel], elevations[panel + 1], count, degree, known);
    placed.panels.push_back({elevations[panel], elevations[panel + 1], rings.size(), &rule.weights, &rule.fine});
    for (const double at : rule.nodes.nodes) {
      const PanelPoint out = panel_point(elevations[panel], elevations[panel + 1], at);
      rings.push_back({out.at, elevation_pair(elevation, out.at), {}, {}});
      // Both halves of the azimuth; N.X sin(theta_X).
      factors.push_back(2 * out.stretch * std::sin(out.at) * std::cos(out.at));
    }
  }
  parallel_for(rings.size(), [&](std::size_t ring) {
    auto& [at, pair, nodes, panels] = rings[ring];
    const auto azimuths = azimuth_panels(elevation, at, extent_);
    // Near the normal polynomials have few orders; functions that are not interpolated may have more.
    const double orders = known == kAllKnown ? degree : std::min(orders_at(degree, std::cos(at)), degree);
    for (std::size_t side = 0; side + 1 < azimuths.size(); ++side) {
      const Rule& around = rule_of(azimuths[side], azimuths[side + 1], count, orders, known);
      panels.push_back({azimuths[side], azimuths[side + 1], nodes.size(), &around.weights, &around.fine});
      for (const double share : around.nodes.nodes) {
        const PanelPoint psi = panel_point(azimuths[side], azimuths[side + 1], share);
        nodes.push_back({psi.at, factors[ring] * psi.stretch});
      }
    }
  });
  return placed;
}

std::vector<PatchRing> PatchRule::gauss_rings(double elevation, int count, int degree) {
  PatchNodes placed = place(elevation, count, degree, kAllKnown);
  for (const ProductPanel& across : placed.panels) {
    for (std::size_t k = 0; k < across.fine->nodes.size(); ++k) {
      PatchRing& ring = placed.rings[across.first + k];
      for (const ProductPanel& around : ring.panels) {
        for (std::size_t j = 0; j < around.fine->nodes.size(); ++j) {
          ring.nodes[around.first + j].factor *= across.fine->weights[k] * around.fine->weights[j];
        }
      }
    }
  }
  return std::move(placed.rings);
}

}  // namespace lobe
