#include "hemisphere/inner_rule.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

namespace lobe {
namespace {

using std::numbers::pi;

constexpr double kInnerRatio = 0.3;      // of successive panels towards the horizon and towards the offset 0
constexpr double kLongest = 2.5;         // ratio of the elevations that a panel ends on
constexpr double kWidths = 2;            // longest panel of the elevation, in lobe widths
constexpr double kMostParts = 64;        // of a panel between two rings
constexpr double kFromPanelEnd = 1e-12;  // of a panel, in its lengths: functions may jump where panels meet
constexpr double kLowest = 0.09;         // end of the lowest panel, in elevations of the lowest ring

/// Resolution of a refinement level.
struct Level {
  int elevations;  ///< nodes per panel
  int offsets;     ///< nodes per panel of offsets
  double steps;    ///< steps of the azimuth per lobe width, if they are equal
  double least;    ///< least number of these steps per step of the grid
};
constexpr std::array<Level, InnerRule::kLevels> kLevelTable{
    {{2, 4, 2, 1}, {3, 5, 2.7, 2}, {5, 7, 4, 3}, {8, 10, 6, 5}, {12, 14, 9, 8}}};

/// Elevations of the rings, rising.
std::vector<double> ring_elevations(const HemisphereGrid& grid) {
  std::vector<double> elevations;
  for (const Ring& ring : grid.rings()) elevations.push_back(pi / 2 - ring.theta);
  std::ranges::sort(elevations);
  return elevations;
}

/// Without rings between which lobes of a width hardly change.
std::vector<double> thinned(const std::vector<double>& rings, double width) {
  std::vector<double> kept{rings.front()};
  for (std::size_t r = 1; r + 1 < rings.size(); ++r) {
    // The next one would be too far.
    const double next = rings[r + 1];
    if (next - kept.back() > width || next > kLongest * kept.back()) kept.push_back(rings[r]);
  }
  if (rings.size() > 1) kept.push_back(rings.back());
  return kept;
}

std::vector<PanelEdge> panel_edges(const std::vector<double>& rings, double width) {
  const double lowest = rings.front();
  std::vector<PanelEdge> edges{{0, true}, {kLowest * lowest}, {kInnerRatio * lowest}, {lowest}};
  for (std::size_t r = 0; r < rings.size(); ++r) {
    const double from = rings[r];
    const double to = r + 1 < rings.size() ? rings[r + 1] : pi / 2;
    const double by_ratio = std::log(to / from) / std::log(kLongest);
    const double by_width = (to - from) / (kWidths * width);
    const double parts = std::clamp(std::ceil(std::max(by_ratio, by_width)), 1.0, kMostParts);
    for (double part = 1; part <= parts; ++part) {
      // Towards grazing elevations in equal ratios, else in equal steps.
      const double share = part / parts;
      edges.push_back({part == parts         ? to
                       : by_ratio > by_width ? from * std::pow(to / from, share)
                                             : from + (to - from) * share});
    }
  }
  return edges;
}

/// The smallest azimuth over which any lobe changes between a ring of the grid and X of a panel.
double azimuth_scale(const std::vector<double>& rings, double low, double high, const LobeExtent& extent) {
  double smallest = pi;
  for (const double ring : rings) {
    const double nearest = std::clamp(ring, low, high);
    const double sines = std::sqrt(std::cos(ring) * std::cos(nearest));
    if (sines <= 0) continue;
    const double off = std::abs(std::cos(nearest) - std::cos(ring));
    const double mirror = std::max(extent.width * (std::sin(ring) + std::sin(nearest)), off);
    const double retro = extent.retro_width < 1 ? std::max(extent.retro_width, std::abs(nearest - ring)) : mirror;
    smallest = std::min(smallest, std::min(mirror, retro) / sines);
  }
  return smallest;
}

std::vector<WeightedPoint> equal_offsets(double step, std::size_t parts) {
  std::vector<WeightedPoint> offsets;
  for (std::size_t b = 0; 2 * b <= parts; ++b) {
    const bool has_mirror_image = b != 0 && 2 * b != parts;
    const auto share = 1 / static_cast<double>(parts);
    offsets.push_back({step * share * static_cast<double>(b), step * share * (has_mirror_image ? 2 : 1)});
  }
  return offsets;
}

std::vector<WeightedPoint> graded_offsets(double half_step, double scale, int nodes) {
  std::vector<double> edges{half_step};
  while (edges.back() * kInnerRatio > scale) edges.push_back(edges.back() * kInnerRatio);
  edges.push_back(0);
  const GaussRule gauss = gauss_rule(nodes);
  std::vector<WeightedPoint> offsets;
  for (std::size_t k = edges.size() - 1; k > 0; --k) {
    const double length = edges[k - 1] - edges[k];
    for (std::size_t j = 0; j < gauss.nodes.size(); ++j) {
      offsets.push_back({edges[k] + length * gauss.nodes[j], 2 * length * gauss.weights[j]});
    }
  }
  return offsets;
}

std::vector<WeightedPoint> offsets_of(double step, double scale, const Level& level) {
  const double parts = std::max(level.least, std::ceil(level.steps * step / scale));
  auto graded = graded_offsets(step / 2, scale, level.offsets);
  if (parts / 2 > static_cast<double>(graded.size())) return graded;
  return equal_offsets(step, static_cast<std::size_t>(parts));
}

}  // namespace

InnerRule::InnerRule(const HemisphereGrid& grid, const LobeExtent& f, const LobeExtent& g, std::size_t level,
                     InnerPanels panels) {
  const Level& fineness = kLevelTable.at(level);
  const auto rings = ring_elevations(grid);
  const double step = 2 * pi / static_cast<double>(grid.n_phi());
  const double width = std::min({f.width, g.width, f.retro_width, g.retro_width});
  const auto edges = panel_edges(panels == InnerPanels::by_width ? thinned(rings, width) : rings, width);
  const GaussRule gauss = gauss_rule(fineness.elevations);
  for (std::size_t k = 0; k + 1 < edges.size(); ++k) {
    InnerBand band;
    for (const std::size_t end : {0U, 1U}) {
      const PanelPoint point = panel_point(edges[k], edges[k + 1], end == 0 ? kFromPanelEnd : 1 - kFromPanelEnd);
      band.ends.at(end) = {point.at, point.stretch * std::sin(point.at) * std::cos(point.at)};
    }
    for (std::size_t j = 0; j < gauss.nodes.size(); ++j) {
      const PanelPoint point = panel_point(edges[k], edges[k + 1], gauss.nodes[j]);
      band.elevations.push_back({point.at, point.stretch * gauss.weights[j] * std::sin(point.at) * std::cos(point.at)});
    }
    const double scale = std::min(azimuth_scale(rings, edges[k].at, edges[k + 1].at, f),
                                  azimuth_scale(rings, edges[k].at, edges[k + 1].at, g));
    band.offsets = offsets_of(step, scale, fineness);
    bands_.push_back(std::move(band));
  }
}

std::size_t InnerRule::size() const {
  std::size_t sum = 0;
  for (const InnerBand& band : bands_) sum += band.size();
  return sum;
}

}  // namespace lobe
