#include "algebra/formula_blocks.hpp"

#include <algorithm>
#include <cmath>

#include "algebra/source_values.hpp"
#include "core/parallel.hpp"
#include "model/traits.hpp"
#include "table/tabulate.hpp"

namespace lobe {
namespace {

constexpr std::size_t kMostRings = 128;  // of tables that are compared with finer ones

/// 2.4, because with twice as many the kink of max(N.L, N.V) would keep its place between the nodes over many rings.
std::size_t more_rings(std::size_t rings) {
  return (12 * rings + 4) / 5;
}

HemisphereGrid compared_grid(const HemisphereGrid& grid) {
  const std::size_t rings = grid.rings().size();
  const std::size_t azimuths = std::ranges::max(grid.rings(), {}, &Ring::count).count;
  if (rings > kMostRings) return HemisphereGrid::gauss(rings / 2, (azimuths / 2 + 1) / 2 * 2);
  return HemisphereGrid::gauss(more_rings(rings), 3 * azimuths);
}

/// The factor of a channel's delta part if it is the same for all directions.
std::optional<std::vector<double>> constants(const std::vector<double>& parts, std::size_t channels) {
  if (parts.empty()) return std::vector<double>(channels);
  const std::size_t rows = parts.size() / channels;
  std::vector<double> factors;
  for (std::size_t c = 0; c < channels; ++c) {
    const auto channel = std::span(parts).subspan(c * rows, rows);
    const auto [low, high] = std::ranges::minmax(channel);
    if (low != high) return {};
    factors.push_back(low);
  }
  return factors;
}

void fill(std::vector<double>& parts, const std::vector<double>& factors, std::size_t rows) {
  if (std::ranges::all_of(factors, [](double factor) { return factor == 0; })) return;
  for (const double factor : factors) parts.insert(parts.end(), rows, factor);
}

}  // namespace

std::optional<FormulaTable> FormulaTable::make(const Device& device, const BrdfTable& table) {
  const auto mirror = constants(table.mirror, table.channels);
  const auto retro = constants(table.retro, table.channels);
  if (table.source.empty() || !mirror || !retro || !std::ranges::all_of(table.source, is_isotropic)) return {};
  require_source_values(device, table);
  FormulaTable formula;
  formula.frame_.grid = compared_grid(table.grid);
  formula.frame_.channels = table.channels;
  formula.is_finer_ = formula.frame_.grid.n_theta() > table.grid.rings().size();
  fill(formula.frame_.mirror, *mirror, formula.frame_.rows());
  fill(formula.frame_.retro, *retro, formula.frame_.rows());
  TabulateOptions options;
  options.allow_unresolved = true;
  for (const Material& material : table.source) {
    formula.factors_.push_back(tabulate(device, material, formula.frame_.grid, options));
  }
  return formula;
}

OperatorBlocks FormulaTable::smooth_blocks(std::size_t channel) const {
  const auto of_factor = [&](const BrdfTable& factor) {
    return lobe::smooth_blocks(factor, std::min(channel, factor.channels - 1));
  };
  OperatorBlocks product = of_factor(factors_.front());
  for (std::size_t k = 1; k < factors_.size(); ++k) {
    const OperatorBlocks factor = of_factor(factors_[k]);
    parallel_for(product.size(),
                 [&](std::size_t b) { product.blocks[b] = (product.blocks[b] * factor.blocks[b]).eval(); });
  }
  return product;
}

std::uint64_t compared_bytes(const BrdfTable& table) {
  BrdfTable shape;
  shape.grid = compared_grid(table.grid);
  return sizeof(double) * table.channels * shape.size();
}

}  // namespace lobe
