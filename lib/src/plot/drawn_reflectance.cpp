#include "plot/drawn_reflectance.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "lobe/energy/albedo.hpp"
#include "lobe/reflectance/adjusted.hpp"
#include "lobe/reflectance/as_function.hpp"
#include "lobe/reflectance/evaluate.hpp"
#include "model/delta.hpp"
#include "model/delta_shares.hpp"
#include "model/traits.hpp"
#include "plot/slice_picture.hpp"
#include "table/evaluate.hpp"
#include "table/interpolator.hpp"

namespace lobe {
namespace {

using std::numbers::pi;

std::size_t nearest_ring(const HemisphereGrid& grid, double theta) {
  const auto rings = grid.rings();
  const auto found =
      std::ranges::min_element(rings, {}, [&](const Ring& ring) { return std::abs(ring.theta - theta); });
  return static_cast<std::size_t>(found - rings.begin());
}

std::size_t nearest_node(const HemisphereGrid& grid, const Ring& ring, double phi) {
  std::size_t best = ring.first_node;
  for (std::size_t node = ring.first_node; node < ring.first_node + ring.count; ++node) {
    const auto distance = [&](std::size_t n) {
      return std::abs(std::remainder(grid.directions()[n].phi - phi, 2 * pi));
    };
    if (distance(node) < distance(best)) best = node;
  }
  return best;
}

/// Row of L and place of V within it, in the plane of incidence through the first node of ring i.
std::size_t value_index(const BrdfTable& table, std::size_t i, std::size_t j, bool on_mirror_side) {
  const HemisphereGrid& grid = table.grid;
  if (table.form == TableForm::isotropic) {
    const std::size_t half = grid.half_azimuths();
    return (i * grid.n_theta() + j) * half + (on_mirror_side ? half - 1 : 0);
  }
  const std::size_t in = grid.rings()[i].first_node;
  const double phi = grid.directions()[in].phi + (on_mirror_side ? pi : 0);
  return in * grid.nodes() + nearest_node(grid, grid.rings()[j], phi);
}

double mean_of_channels(const BrdfTable& table, std::size_t index) {
  double sum = 0;
  for (std::size_t c = 0; c < table.channels; ++c) sum += table.channel(c)[index];
  return sum / static_cast<double>(table.channels);
}

/// Polar angles at which the value of a ring of cells is drawn.
std::vector<double> drawn_angles(const Ring& ring) {
  const double span = ring.theta_high - ring.theta_low;
  const double steps = std::max(1.0, std::ceil(span / kDegree));
  std::vector<double> angles;
  for (double k = 0; k <= steps; ++k) angles.push_back(ring.theta_low + span * k / steps);
  return angles;
}

void mark_delta_parts(const BrdfTable& table, std::size_t i, IncidencePlane& plane) {
  const std::size_t row = table.form == TableForm::isotropic ? i : table.grid.rings()[i].first_node;
  plane.has_mirror = !table.mirror.empty() && table.mirror[row] != 0;
  plane.has_retro = !table.retro.empty() && table.retro[row] != 0;
}

IncidencePlane stepped_plane(const BrdfTable& table, std::size_t i) {
  IncidencePlane plane;
  plane.theta_in = table.grid.rings()[i].theta;
  for (const bool on_mirror_side : {false, true}) {
    for (std::size_t j = 0; j < table.grid.rings().size(); ++j) {
      const double f = mean_of_channels(table, value_index(table, i, j, on_mirror_side));
      for (const double theta : drawn_angles(table.grid.rings()[j])) {
        plane.theta_out.push_back(on_mirror_side ? theta : -theta);
        plane.f.push_back(f);
      }
    }
    if (on_mirror_side) continue;
    std::ranges::reverse(plane.theta_out);
    std::ranges::reverse(plane.f);
  }
  mark_delta_parts(table, i, plane);
  return plane;
}

/// Between the nodes, where a table has values at directions.
IncidencePlane interpolated_plane(const BrdfTable& table, const Interpolator& interpolator, double theta_in) {
  IncidencePlane plane;
  plane.theta_in = theta_in;
  plane.theta_out = plane_views(theta_in, std::min(table.grid.rings().back().theta, kLastDrawn));
  for (const double theta : plane.theta_out) {
    const Direction out = {std::abs(theta), theta < 0 ? 0 : pi};
    double sum = 0;
    for (std::size_t c = 0; c < table.channels; ++c) sum += interpolator.at(c, {theta_in, 0}, out).value;
    plane.f.push_back(sum / static_cast<double>(table.channels));
  }
  mark_delta_parts(table, nearest_ring(table.grid, theta_in), plane);
  return plane;
}

/// Albedos of a table's rows by ring, means of the channels and of the ring's nodes.
std::vector<double> by_ring(const BrdfTable& table, const std::vector<std::vector<Estimate>>& rows) {
  std::vector<double> means(table.grid.rings().size());
  std::vector<double> counts(means.size());
  for (const auto& channel : rows) {
    for (std::size_t row = 0; row < channel.size(); ++row) {
      const std::size_t ring = table.form == TableForm::isotropic ? row : table.grid.ring_of(row);
      means[ring] += channel[row].value;
      ++counts[ring];
    }
  }
  for (std::size_t ring = 0; ring < means.size(); ++ring) means[ring] /= counts[ring];
  return means;
}

AlbedoByAngle albedo_of(const BrdfTable& table) {
  const TableAlbedo albedos = row_albedos(table);
  const std::vector<double> in = by_ring(table, albedos.in);
  const std::vector<double> out = by_ring(table, albedos.out);
  AlbedoByAngle result;
  const auto add = [&](double theta, std::size_t ring) {
    result.theta.push_back(theta);
    result.in.push_back(in[ring]);
    result.out.push_back(out[ring]);
  };
  for (std::size_t ring = 0; ring < in.size(); ++ring) {
    const Ring& place = table.grid.rings()[ring];
    if (table.grid.has_cells()) {
      add(place.theta_low, ring);
      add(place.theta_high, ring);
    } else {
      add(place.theta, ring);
    }
  }
  for (const auto& channel : albedos.mean) result.mean += channel.value / static_cast<double>(table.channels);
  return result;
}

/// Means of the channels.
std::vector<Estimate> channel_means(const std::vector<std::vector<Estimate>>& channels) {
  std::vector<Estimate> means(channels.front().size());
  for (const auto& channel : channels) {
    for (std::size_t i = 0; i < means.size(); ++i) {
      means[i].value += channel[i].value / static_cast<double>(channels.size());
      means[i].error += channel[i].error / static_cast<double>(channels.size());
    }
  }
  return means;
}

/// f(V, L) as a function.
BrdfFunction transposed(const BrdfFunction& brdf) {
  BrdfFunction result = brdf;
  result.ring_cells = nullptr;
  result.samples = nullptr;
  result.at = [at = brdf.at](std::span<const Directions> pairs) {
    std::vector<Directions> turned;
    turned.reserve(pairs.size());
    for (const Directions& pair : pairs) {
      turned.push_back({pair.theta_out, pair.theta_in, -pair.delta_phi, pair.phi_in + pair.delta_phi});
    }
    return at(turned);
  };
  return result;
}

/// Angles at which albedos of functions are drawn.
std::vector<double> albedo_angles() {
  std::vector<double> angles;
  for (int degrees = 0; degrees <= 88; degrees += 2) angles.push_back(degrees * kDegree);
  angles.push_back(89 * kDegree);
  return angles;
}

/// Means over azimuth, where a reflectance depends on it.
std::vector<double> mean_albedos_at(const Device& device, const Reflectance& reflectance,
                                    std::span<const double> angles) {
  constexpr double kTolerance = 1e-4;  // less than a line is wide
  constexpr std::size_t kAzimuths = 8;
  const std::size_t azimuths = reflectance.is_isotropic() ? 1 : kAzimuths;
  std::vector<Direction> incident;
  for (const double theta : angles) {
    for (std::size_t k = 0; k < azimuths; ++k) {
      incident.push_back({theta, 2 * pi * static_cast<double>(k) / static_cast<double>(azimuths)});
    }
  }
  const auto all = channel_means(albedo(device, reflectance, incident, {.tolerance = kTolerance}));
  std::vector<double> means(angles.size());
  for (std::size_t i = 0; i < all.size(); ++i) means[i / azimuths] += all[i].value / static_cast<double>(azimuths);
  return means;
}

AlbedoByAngle albedo_of(const Device& device, const Reflectance& reflectance, const Reflectance& smooth) {
  AlbedoByAngle result{albedo_angles(), {}, {}, 0};
  result.in = mean_albedos_at(device, reflectance, result.theta);
  result.out = result.in;
  const Material* formula = smooth.formula();
  if (formula == nullptr || !is_reciprocal(*formula)) {
    // Delta parts reflect as much either way.
    const Reflectance turned = transposed(as_function(device, smooth));
    const auto in = mean_albedos_at(device, smooth, result.theta);
    const auto out = mean_albedos_at(device, turned, result.theta);
    for (std::size_t i = 0; i < out.size(); ++i) result.out[i] += out[i] - in[i];
  }
  const auto means = mean_albedo(device, reflectance, {.tolerance = 1e-4});
  for (const Estimate& mean : means) result.mean += mean.value / static_cast<double>(means.size());
  return result;
}

IncidencePlane plane_of(const Device& device, const Reflectance& smooth, double theta_in) {
  IncidencePlane plane{theta_in, plane_views(theta_in, kLastDrawn), {}};
  std::vector<Directions> directions;
  for (const double theta : plane.theta_out) {
    directions.push_back({theta_in, std::abs(theta), theta < 0 ? 0 : pi});
  }
  for (const Estimate& value : channel_means(estimates(evaluate(device, smooth, directions)))) {
    plane.f.push_back(value.value);
  }
  return plane;
}

void mark_delta_parts(const Device& device, const Material& deltas, std::vector<IncidencePlane>& planes) {
  std::vector<double> elevations;
  for (const IncidencePlane& plane : planes) elevations.push_back(pi / 2 - plane.theta_in);
  const DeltaParts parts = delta_parts(device, deltas, deltas.channels(), elevations);
  for (std::size_t i = 0; i < planes.size(); ++i) {
    const auto at = static_cast<Eigen::Index>(i);
    planes[i].has_mirror = (parts.mirror.col(at).array() != 0).any();
    planes[i].has_retro = (parts.retro.col(at).array() != 0).any();
  }
}

}  // namespace

std::vector<double> plane_angles() {
  return {0, 30 * kDegree, 60 * kDegree, 75 * kDegree};
}

std::vector<double> plane_views(double theta_in, double last) {
  std::vector<double> angles = {-theta_in, theta_in};
  const auto steps = static_cast<int>(2 * last / kDegree);
  for (int k = -steps; k <= steps; ++k) angles.push_back(k * kDegree / 2);
  angles.insert(angles.end(), {-last, last});
  std::ranges::sort(angles);
  angles.erase(std::unique(angles.begin(), angles.end()), angles.end());
  return angles;
}

std::vector<IncidencePlane> incidence_planes(const BrdfTable& table) {
  std::vector<IncidencePlane> planes;
  if (table.grid.has_cells()) {
    std::vector<std::size_t> rows;
    for (const double angle : plane_angles()) rows.push_back(nearest_ring(table.grid, angle));
    rows.erase(std::unique(rows.begin(), rows.end()), rows.end());
    for (const std::size_t row : rows) planes.push_back(stepped_plane(table, row));
    return planes;
  }
  const Interpolator interpolator(table);
  for (const double angle : plane_angles()) {
    // Beyond the last ring a polynomial would be continued, not interpolated.
    if (angle > table.grid.rings().back().theta) break;
    planes.push_back(interpolated_plane(table, interpolator, angle));
  }
  return planes;
}

DrawnReflectance drawn(const BrdfTable& table) {
  check(table);
  return {.name = table.expression,
          .source = table.grid.name(),
          .has_channels = table.channels > 1,
          .has_azimuths = table.form == TableForm::general,
          .has_delta = table.has_delta(),
          .has_steps = table.grid.has_cells(),
          .planes = incidence_planes(table),
          .slice = channel_means(evaluate(table, slice_directions())),
          .albedo = albedo_of(table)};
}

DrawnReflectance drawn(const Device& device, const Reflectance& reflectance) {
  const Reflectance prepared = adjusted(device, reflectance);
  if (const BrdfTable* table = prepared.table()) return drawn(*table);
  if (const BrdfFunction* function = prepared.function(); function != nullptr && function->cells) {
    return drawn(*function->cells);
  }
  const Material* formula = prepared.formula();
  const Reflectance smooth = formula != nullptr ? Reflectance(smooth_part(*formula)) : prepared;
  DrawnReflectance result{.name = reflectance.name(),
                          .source = "own values",
                          .has_channels = prepared.channels() > 1,
                          .has_azimuths = !prepared.is_isotropic(),
                          .has_delta = prepared.has_delta()};
  for (const double theta : plane_angles()) result.planes.push_back(plane_of(device, smooth, theta));
  if (result.has_delta) mark_delta_parts(device, split_delta(*formula).deltas, result.planes);
  result.slice = channel_means(estimates(evaluate(device, smooth, slice_directions())));
  result.albedo = albedo_of(device, prepared, smooth);
  return result;
}

std::string source_names(std::span<const DrawnReflectance> drawn) {
  std::vector<std::string> names;
  for (const auto& one : drawn) {
    if (std::ranges::find(names, one.source) == names.end()) names.push_back(one.source);
  }
  return fmt::format("{}", fmt::join(names, ", "));
}

}  // namespace lobe
