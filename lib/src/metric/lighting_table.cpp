// The lighting W as an operator on a grid.
#include <algorithm>
#include <cmath>
#include <numbers>
#include <string>
#include <vector>

#include "device/tabulate_patch_light.hpp"
#include "lobe/algebra/algebra.hpp"
#include "lobe/core/error.hpp"
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
  if (!grid.is_product()) {
    throw ArgumentError("lighting '" + lighting.name() + "' on the grid " + grid.name() +
                        "; expected a grid with the same azimuths on every ring");
  }
  BrdfTable table = empty_light(lighting, grid);
  fill_isotropic(device, lighting.shares(kDensityNodes), table);
  return table;
}

BrdfTable tabulate_given_light(const Device&, const Lighting& lighting, const HemisphereGrid& grid) {
  const BrdfTable& given = lighting.table();
  return symmetrised(given.grid == grid ? given : resample(given, grid));
}

BrdfTable lighting_table(const Device& device, const Lighting& lighting, const HemisphereGrid& grid) {
  const LightingTraits& traits = traits_of(lighting);
  if (traits.tabulate == nullptr) {
    throw ArgumentError("lighting '" + lighting.name() + "' is no integral with a W; expected another one");
  }
  return traits.tabulate(device, lighting, grid);
}

}  // namespace lobe
