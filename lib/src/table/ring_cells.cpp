#include "table/ring_cells.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace lobe {
namespace {

using std::numbers::pi;

/// Rounding of sums over a row of cells, over rows and over rings, 128 each at most, relative to that of absolute
/// values.
constexpr double kRingRounding = 4e-14;

/// Sum of what cells have, times the projected solid angle of one.
template <typename Value>
Estimate over_cells(std::size_t side, const Value& value) {
  Estimate sum;
  for (std::size_t a = 0; a < side; ++a) {
    Estimate row;
    for (std::size_t b = 0; b < side; ++b) {
      const double one = value(a, b);
      row.value += one;
      row.error += std::abs(one);
    }
    sum += row;
  }
  const double cell = pi / static_cast<double>(side * side);
  return {cell * sum.value, cell * kRingRounding * sum.error};
}

/// Sum over rings, each times its projected solid angle.
template <typename Value>
Estimate over_rings(std::size_t rings, const Value& value) {
  Estimate sum;
  for (std::size_t ring = 0; ring < rings; ++ring) {
    const auto count = static_cast<double>(rings);
    const double inner = static_cast<double>(ring) / count;
    const double outer = static_cast<double>(ring + 1) / count;
    const double measure = pi * (outer + inner) * (outer - inner);
    sum += measure * value(ring);
  }
  return sum;
}

double value_at(const RingCells& brdf, std::size_t channel, std::size_t ring, std::size_t a, std::size_t b) {
  return brdf.values[((channel * brdf.rings + ring) * brdf.side + a) * brdf.side + b];
}

Estimate albedo_of_ring(const RingCells& brdf, std::size_t channel, std::size_t ring) {
  return over_cells(brdf.side, [&](std::size_t a, std::size_t b) { return value_at(brdf, channel, ring, a, b); });
}

/// Integral of combine(f, g) over the cells of the finer one.
template <typename Combine>
Estimate together(const RingCells& f, std::size_t f_channel, const RingCells& g, std::size_t g_channel,
                  const Combine& combine) {
  const std::size_t rings = std::max(f.rings, g.rings);
  const std::size_t side = std::max(f.side, g.side);
  const auto at = [&](const RingCells& one, std::size_t channel, std::size_t ring, std::size_t a, std::size_t b) {
    return value_at(one, channel, ring * one.rings / rings, a * one.side / side, b * one.side / side);
  };
  return over_rings(rings, [&](std::size_t ring) {
    return over_cells(side, [&](std::size_t a, std::size_t b) {
      return combine(at(f, f_channel, ring, a, b), at(g, g_channel, ring, a, b));
    });
  });
}

}  // namespace

Estimate albedo(const RingCells& brdf, std::size_t channel, double theta_in) {
  const double place = std::sin(theta_in) * static_cast<double>(brdf.rings);
  // The rings are those of the file, whose coordinate falls with the angle: a limit belongs to the ring inside.
  const auto ring = static_cast<std::size_t>(std::max(std::ceil(place) - 1, 0.0));
  return albedo_of_ring(brdf, channel, std::min(ring, brdf.rings - 1));
}

Estimate mean_albedo(const RingCells& brdf, std::size_t channel) {
  const Estimate sum = over_rings(brdf.rings, [&](std::size_t ring) { return albedo_of_ring(brdf, channel, ring); });
  return {sum.value / pi, sum.error / pi};
}

Estimate product(const RingCells& f, std::size_t f_channel, const RingCells& g, std::size_t g_channel) {
  return together(f, f_channel, g, g_channel, [](double x, double y) { return x * y; });
}

Estimate squared_distance(const RingCells& f, std::size_t f_channel, const RingCells& g, std::size_t g_channel) {
  return together(f, f_channel, g, g_channel, [](double x, double y) { return (x - y) * (x - y); });
}

}  // namespace lobe
