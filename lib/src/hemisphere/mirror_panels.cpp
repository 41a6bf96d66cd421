#include "hemisphere/mirror_panels.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

#include "core/bisection.hpp"

namespace lobe {
namespace {

using std::numbers::pi;

constexpr double kElevationRatio = 0.3;   // of successive panels of the elevation
constexpr double kPsiRatio = 0.3;         // of successive panels of psi
constexpr double kPanelGrowth = 3;        // of panels away from limits that all but coincide
constexpr double kMirrorInnermost = 0.7;  // smallest panel beside the mirror direction, in lobe widths
constexpr double kPeakInnermost = 1.5;    // smallest panel beside where the mirror direction crosses a kink, likewise
constexpr int kSlabSteps = 8;             // of a slab, between which kinks are found

/// Where circles of these radii about L'_P, or about L_P, touch a circle about the origin of the base plane.
void add_patch_elevations(double incident, std::span<const double> radii, std::vector<PanelEdge>& edges) {
  const double centre = std::cos(incident);
  for (const double radius : radii) {
    for (const double distance : {std::abs(centre - radius), centre + radius}) {
      if (distance < 1) edges.push_back({std::acos(distance), true});
    }
    // A circle that all but touches the horizon from outside has no limit there, but is as sharp.
    const double gap = std::sqrt(2 * std::abs(1 - centre - radius));
    if (gap > 0 && gap < 1) edges.push_back({gap});
  }
}

/// Where a factor goes over from one smooth piece to the next, found between steps of a degree.
void add_piece_elevations(double incident, const LobeExtent& extent, std::vector<PanelEdge>& edges) {
  constexpr int kSteps = 90;
  constexpr int kInAStep = 4;
  constexpr int kHalvings = 40;
  const double cos_i = std::sin(incident);
  for (const auto& piece : extent.pieces) {
    double low = 0.5 * pi / 2 / kSteps;
    unsigned piece_below = piece(cos_i, std::sin(low));
    for (int step = 1; step < kSteps; ++step) {
      const double at = (step + 0.5) * pi / 2 / kSteps;
      const unsigned piece_above = piece(cos_i, std::sin(at));
      for (int found = 0; piece_below != piece_above && found < kInAStep; ++found) {
        const auto is_below = [&](double elevation) { return piece(cos_i, std::sin(elevation)) == piece_below; };
        low = bisect({low, at}, kHalvings, is_below).high;
        edges.push_back({low});
        piece_below = piece(cos_i, std::sin(low));
      }
      low = at;
      piece_below = piece_above;
    }
  }
}

/// Where |X_P - L'_P| is one of the radii: sin^2(psi/2) = (R^2 - off^2) / (4 sin sin). The same about the retro
/// direction, pi - psi for psi.
void add_patch_azimuths(double off, double sines, const LobeExtent& extent, std::vector<PanelEdge>& edges) {
  const auto share = [&](double radius) { return (radius - off) * (radius + off) / (4 * sines); };
  for (const double radius : extent.patch_radii) {
    const double at = share(radius);
    // Profiles of patches may end as a fractional power.
    if (at > 0 && at < 1) edges.push_back({2 * std::asin(std::sqrt(at)), true});
  }
  for (const double radius : extent.retro_patch_radii) {
    const double at = share(radius);
    if (at > 0 && at < 1) edges.push_back({2 * std::acos(std::sqrt(at))});
  }
}

/// Where kinks enter at psi = 0 or pi.
void add_kink_elevations(double incident, const LobeExtent& extent, std::vector<PanelEdge>& edges) {
  constexpr int kSteps = 3;
  std::vector<PanelEdge> found;
  for (const Kink& kink : extent.kinks) {
    if (kink.is_anisotropic) continue;
    for (const double psi : {0.0, pi}) {
      append_zeros([&](double elevation) { return kink(kink_pair(incident, elevation, psi)); }, edges, kSteps, true,
                   found);
    }
  }
  edges.insert(edges.end(), found.begin(), found.end());
}

void add_kink_azimuths(double incident, double elevation, const LobeExtent& extent, std::vector<PanelEdge>& edges) {
  constexpr int kSteps = 2;
  const double cos_i = std::sin(incident);
  const double cos_o = std::sin(elevation);
  const double product = std::cos(incident) * std::cos(elevation);
  std::vector<PanelEdge> found;
  for (const Kink& kink : extent.kinks) {
    if (kink.is_anisotropic) continue;
    const auto at = [&](double psi) {
      return kink(KinkPair{.cos_i = cos_i, .cos_o = cos_o, .cos_between = cos_i * cos_o - product * std::cos(psi)});
    };
    append_zeros(at, edges, kSteps, kink.has_root(), found);
  }
  edges.insert(edges.end(), found.begin(), found.end());
}

}  // namespace

LobeExtent exchanged(LobeExtent extent) {
  for (Kink& kink : extent.kinks) kink = exchanged(kink);
  for (PeakKink& peak : extent.peak_kinks) peak.kink = exchanged(peak.kink);
  for (auto& piece : extent.pieces) {
    piece = [of = std::move(piece)](double cos_i, double cos_o) { return of(cos_o, cos_i); };
  }
  return extent;
}

KinkPair kink_pair(double elevation_i, double elevation_o, double psi) {
  const double cos_i = std::sin(elevation_i);
  const double cos_o = std::sin(elevation_o);
  const double product = std::cos(elevation_i) * std::cos(elevation_o);
  return {.cos_i = cos_i, .cos_o = cos_o, .cos_between = cos_i * cos_o - product * std::cos(psi)};
}

std::vector<PanelEdge> peak_crossings(const PeakKink& peak, std::span<const PanelEdge> limits) {
  std::vector<PanelEdge> crossings;
  append_zeros([&](double incident) { return peak.kink(kink_pair(incident, incident, 0)); }, limits, kSlabSteps,
               peak.width == 0, crossings);
  return crossings;
}

void add_kink_slabs(const LobeExtent& extent, double lowest, std::vector<PanelEdge>& edges) {
  std::vector<PanelEdge> found;
  for (const Kink& kink : extent.kinks) {
    if (kink.is_anisotropic) continue;
    const auto add = [&](double elevation, double psi) {
      append_zeros([&](double incident) { return kink(kink_pair(incident, elevation, psi)); }, edges, kSlabSteps, true,
                   found);
    };
    add(lowest, 0);
    add(lowest, pi);
    add(pi / 2, 0);
  }
  bool has_bends = false;
  for (const PeakKink& peak : extent.peak_kinks) {
    const double step = kPeakInnermost * peak.width;
    for (const PanelEdge& crossing : peak_crossings(peak, edges)) {
      found.push_back(crossing);
      if (step == 0) continue;
      has_bends = true;
      if (crossing.at > step) found.push_back({crossing.at - step});
      if (crossing.at + step < pi / 2) found.push_back({crossing.at + step});
    }
  }
  edges.insert(edges.end(), found.begin(), found.end());
  tidy_edges(edges);
  if (has_bends) grade_edges(edges, kPanelGrowth);
}

std::vector<PanelEdge> elevation_panels(double incident, const LobeExtent& extent) {
  // sqrt(N.X) begins at the horizon, cusps lie at the mirror direction.
  std::vector<PanelEdge> edges{{0, true}, {incident, true}, {pi / 2}};
  const double width = std::min(extent.width, extent.retro_width);
  for (double step = kMirrorInnermost * std::min(width, incident); step < pi / 2; step /= kElevationRatio) {
    if (incident + step < pi / 2) edges.push_back({incident + step});
    if (step < 0.8 * incident) edges.push_back({incident - step});
  }
  // Where kinks enter at psi = 0 or pi.
  const auto add_entry = [&](double e) {
    if (e > 0 && e < pi / 2) edges.push_back({e, true});
  };
  if (extent.common.attenuation) {
    for (const double e : {incident / 3, 3 * incident, (pi - incident) / 3, pi - 3 * incident}) add_entry(e);
  }
  if (extent.common.mirror_cosine || extent.retro_width < 1) add_entry(pi / 2 - incident);
  add_patch_elevations(incident, extent.patch_radii, edges);
  add_patch_elevations(incident, extent.retro_patch_radii, edges);
  add_piece_elevations(incident, extent, edges);
  tidy_edges(edges);
  if (!extent.kinks.empty()) {
    add_kink_elevations(incident, extent, edges);
    tidy_edges(edges);
  }
  if (extent.cos_min > 0) edges = cut_below(std::asin(extent.cos_min), std::move(edges));
  const bool has_close_limits =
      !extent.patch_radii.empty() || !extent.retro_patch_radii.empty() || !extent.kinks.empty();
  if (has_close_limits) grade_edges(edges, kPanelGrowth);
  return edges;
}

std::vector<PanelEdge> azimuth_panels(double incident, double elevation, const LobeExtent& extent) {
  const double cos_i = std::sin(incident);
  const double cos_o = std::sin(elevation);
  const double product = std::cos(incident) * std::cos(elevation);  // sin sin
  std::vector<PanelEdge> edges{{0, true}, {pi / 2}, {pi}};
  const auto add_kink = [&](double cos_delta_phi, bool root) {
    if (std::abs(cos_delta_phi) < 1) edges.push_back({pi - std::acos(cos_delta_phi), root});
  };
  if (product > 0) {
    if (extent.common.attenuation) {
      add_kink((2 * std::min(cos_i, cos_o) * (cos_i + cos_o) - 1 - cos_i * cos_o) / product, false);
    }
    if (extent.common.mirror_cosine) add_kink(cos_i * cos_o / product, true);
    const double off = std::abs(std::cos(elevation) - std::cos(incident));
    const double scale = 0.7 * std::max(extent.width * (cos_i + cos_o), off) / std::sqrt(product);
    for (double psi = pi * kPsiRatio; psi > scale; psi *= kPsiRatio) edges.push_back({psi});
    add_patch_azimuths(off, product, extent, edges);
    if (extent.retro_width < 1) {
      add_kink(-cos_i * cos_o / product, true);  // (L.X)^n begins
      const double finest = 0.7 * std::max(extent.retro_width, std::abs(elevation - incident)) / std::sqrt(product);
      for (double step = pi * kPsiRatio; step > finest; step *= kPsiRatio) edges.push_back({pi - step});
    }
  }
  tidy_edges(edges);
  if (product > 0 && !extent.kinks.empty()) {
    add_kink_azimuths(incident, elevation, extent, edges);
    tidy_edges(edges);
    grade_edges(edges, kPanelGrowth);
  }
  return edges;
}

}  // namespace lobe
