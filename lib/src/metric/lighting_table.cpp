// The lighting W as an operator on a grid.
#include <algorithm>
#include <cmath>
#include <numbers>
#include <string>
#include <vector>

#include "device/tabulate_patch_light.hpp"
#include "lobe/algebra/algebra.hpp"
#include "lobe/core/error.hpp"
#include "lobe/reflectance/tabulate.hpp"
#include "metric/lighting_traits.hpp"
#include "metric/products.hpp"
#include "metric/table_lighting.hpp"
#include "table/tabulate.hpp"

namespace lobe {
namespace {

constexpr int kDensityNodes = 12;                                  // between the radii of a density
constexpr std::size_t kLargestBlockBytes = std::size_t{64} << 20;  // of W at a time

/// A table without smooth values yet.
BrdfTable empty_table(const HemisphereGrid& grid, TableForm form, const std::string& expression) {
  BrdfTable table;
  table.grid = grid;
  table.form = form;
  table.expression = expression;
  table.values.resize(table.size());
  table.error.assign(grid.rings().size() * grid.rings().size(), 0.0);
  return table;
}

/// Directions of all rings with azimuths from 0 to pi.
DiscPoints half_points(const HemisphereGrid& grid) {
  DiscPoints points;
  for (const Ring& ring : grid.rings()) {
    for (std::size_t k = 0; k < grid.half_azimuths(); ++k) {
      points.push(std::sin(ring.theta),
                  2 * std::numbers::pi * static_cast<double>(k) / static_cast<double>(ring.count));
    }
  }
  return points;
}

/// W between the directions of one ring each, azimuth 0, and those of all rings up to azimuth pi.
void fill_isotropic(const Device& device, const std::vector<PatchShare>& shares, BrdfTable& table) {
  const HemisphereGrid& grid = table.grid;
  DiscPoints from;
  for (const Ring& ring : grid.rings()) from.push(std::sin(ring.theta), 0);
  const DiscPoints to = half_points(grid);
  PatchLight light(device, light_discs(shares));
  light.place(to, from);
  const std::size_t rows = grid.rings().size();
  const std::size_t block = std::max<std::size_t>(1, kLargestBlockBytes / (light.stride() * sizeof(double)));
  std::vector<double> values;
  for (std::size_t first = 0; first < rows; first += block) {
    const std::size_t count = std::min(block, rows - first);
    values.resize(count * light.stride());
    light.tabulate(first, count, values);
    for (std::size_t i = 0; i < count; ++i) {
      std::copy_n(values.data() + i * light.stride(), to.size(), table.values.data() + (first + i) * to.size());
    }
  }
  // W has a cone where both directions coincide; its value there is chosen so that the sum over the grid is the albedo
  // of W, which is known.
  for (std::size_t i = 0; i < rows; ++i) {
    const double response = light_response(shares, from.radius[i]);
    double sum = 0;
    for (std::size_t j = 0; j < rows; ++j) {
      const double* const ring = table.values.data() + (i * rows + j) * grid.half_azimuths();
      for (std::size_t k = 0; k < grid.half_azimuths(); ++k) {
        const double share = k == 0 || k + 1 == grid.half_azimuths() ? 1 : 2;
        sum += share * grid.rings()[j].weight * ring[k];
      }
    }
    table.values[(i * rows + i) * grid.half_azimuths()] += (response - sum) / grid.rings()[i].weight;
  }
}

/// Points of all cells, `side` squared of each.
DiscPoints cell_points(const HemisphereGrid& grid, std::size_t side) {
  DiscPoints points;
  for (std::size_t node = 0; node < grid.nodes(); ++node) {
    for (const Direction& direction : grid.cell_points(node, side)) {
      const double turn = std::fmod(direction.phi, 2 * std::numbers::pi);
      points.push(std::sin(direction.theta), turn < 0 ? turn + 2 * std::numbers::pi : turn);
    }
  }
  return points;
}

/// Means of W over pairs of cells, from `side` squared points of each: nodes x nodes. The mean of a cell with itself,
/// where W has its cone, is what the other cells leave of the albedo of W, which is known.
std::vector<double> cell_means(const Device& device, const std::vector<PatchShare>& shares, const HemisphereGrid& grid,
                               std::size_t side) {
  const std::size_t nodes = grid.nodes();
  const std::size_t points = side * side;
  const DiscPoints all = cell_points(grid, side);
  PatchLight light(device, light_discs(shares));
  light.place(all, all);
  std::vector<double> means(nodes * nodes, 0.0);
  std::vector<double> values(points * light.stride());
  for (std::size_t i = 0; i < nodes; ++i) {
    light.tabulate(i * points, points, values);
    double response = 0;
    for (std::size_t k = 0; k < points; ++k) {
      response += light_response(shares, all.radius[i * points + k]) / static_cast<double>(points);
      const double* const row = values.data() + k * light.stride();
      for (std::size_t at = 0; at < all.size(); ++at) {
        means[i * nodes + at / points] += row[at] / static_cast<double>(points * points);
      }
    }
    for (std::size_t j = 0; j < nodes; ++j) {
      if (j != i) response -= grid.weights()[j] * means[i * nodes + j];
    }
    means[i * nodes + i] = response / grid.weights()[i];
  }
  return means;
}

/// W between cells, with the difference to the means over a quarter of the points as its error.
void fill_cells(const Device& device, const std::vector<PatchShare>& shares, BrdfTable& table) {
  constexpr double kMostPoints = 10'000;  // of all cells, for one disc: what takes a second or two
  const HemisphereGrid& grid = table.grid;
  const std::size_t nodes = grid.nodes();
  const double points = kMostPoints / std::sqrt(static_cast<double>(shares.size()));
  const double most = std::sqrt(points / static_cast<double>(nodes)) / 2;
  const auto half = static_cast<std::size_t>(std::clamp(std::floor(most), 1.0, 4.0));
  const std::vector<double> coarse = cell_means(device, shares, grid, half);
  const std::vector<double> fine = cell_means(device, shares, grid, 2 * half);
  const std::size_t rings = grid.rings().size();
  for (std::size_t i = 0; i < nodes; ++i) {
    for (std::size_t j = 0; j < nodes; ++j) {
      // Means over both orders of the cells, which points of their own differ in.
      const double value = (fine[i * nodes + j] + fine[j * nodes + i]) / 2;
      table.values[i * nodes + j] = value;
      double& error = table.error[grid.ring_of(i) * rings + grid.ring_of(j)];
      error = std::max(error, std::abs(value - (coarse[i * nodes + j] + coarse[j * nodes + i]) / 2));
    }
  }
}

/// W in the middle between W and its adjoint (5.26).
BrdfTable symmetrised(const BrdfTable& table) {
  const std::vector<BrdfTable> both{table, transpose(table)};
  BrdfTable result = mix(std::vector<double>{0.5, 0.5}, both, true);
  result.expression = table.expression;
  return result;
}

BrdfTable empty_light(const Lighting& lighting, const HemisphereGrid& grid) {
  return empty_table(grid, grid.is_product() ? TableForm::isotropic : TableForm::general, lighting.name());
}

}  // namespace

BrdfTable tabulate_point_light(const Device&, const Lighting& lighting, const HemisphereGrid& grid) {
  BrdfTable table = empty_light(lighting, grid);
  std::ranges::fill(table.values, 0.0);
  table.retro.assign(table.rows(), 1.0);
  return table;
}

BrdfTable tabulate_daylight(const Device&, const Lighting& lighting, const HemisphereGrid& grid) {
  BrdfTable table = empty_light(lighting, grid);
  std::ranges::fill(table.values, 1.0);
  return table;
}

BrdfTable tabulate_patch_light(const Device& device, const Lighting& lighting, const HemisphereGrid& grid) {
  BrdfTable table = empty_light(lighting, grid);
  const auto shares = lighting.shares(kDensityNodes);
  if (grid.is_product()) {
    fill_isotropic(device, shares, table);
  } else {
    fill_cells(device, shares, table);
  }
  return table;
}

BrdfTable tabulate_given_light(const Device&, const Lighting& lighting, const HemisphereGrid& grid) {
  const BrdfTable& given = lighting.table();
  return symmetrised(given.grid == grid ? given : resample(given, grid));
}

BrdfTable tabulate_material_light(const Device& device, const Lighting& lighting, const HemisphereGrid& grid) {
  const BrdfTable eta = tabulate(device, lighting.material(), grid, {.allow_unresolved = true});
  BrdfTable w = compose(device, transpose(eta), eta, {.resolve_formulas = true});
  w.expression = lighting.name();
  return w;
}

BrdfTable lighting_table(const Device& device, const Lighting& lighting, const HemisphereGrid& grid) {
  const LightingTraits& traits = traits_of(lighting);
  if (traits.tabulate == nullptr) {
    throw ArgumentError("lighting '" + lighting.name() + "' is no integral with a W; expected another one");
  }
  return traits.tabulate(device, lighting, grid);
}

}  // namespace lobe
