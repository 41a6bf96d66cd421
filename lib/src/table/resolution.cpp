#include "table/resolution.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "lobe/core/error.hpp"

namespace lobe {
namespace {

constexpr std::size_t kRows = 32;           // rings that are enough to judge a grid by
constexpr std::size_t kTurns = 5;           // azimuths of L on them, for anisotropic lobes
constexpr std::size_t kLargestRings = 512;  // of the search for a sufficient grid

/// At most kRows of the grid's rings, evenly chosen: one node of each, or kTurns.
NodeSet some_rings(const HemisphereGrid& grid, std::size_t points, bool is_isotropic) {
  const auto rings = grid.rings();
  const std::size_t step = (rings.size() + kRows - 1) / kRows;
  NodeSet some;
  for (std::size_t at = step / 2; at < rings.size(); at += step) {
    const Ring& ring = rings[at];
    const std::size_t turns = is_isotropic ? 1 : std::min(kTurns, ring.count);
    for (std::size_t turn = 0; turn < turns; ++turn) {
      const auto directions = grid.cell_points(ring.first_node + turn * ring.count / turns, points);
      some.directions.points = directions.size();
      some.directions.directions.insert(some.directions.directions.end(), directions.begin(), directions.end());
      some.weights.push_back(ring.weight * static_cast<double>(ring.count) / static_cast<double>(turns));
      ++some.directions.count;
    }
  }
  return some;
}

/// integral(f^2 dmu(V)) by row of L.
std::vector<double> squared_norms(const LobeTabulator& tabulator, std::size_t lobe, const NodeSet& rows,
                                  const NodeSet& columns) {
  std::vector<double> values(rows.weights.size() * columns.weights.size());
  tabulator.lobe(lobe, rows.directions, columns.directions, values);
  std::vector<double> norms(rows.weights.size());
  for (std::size_t i = 0; i < norms.size(); ++i) {
    for (std::size_t j = 0; j < columns.weights.size(); ++j) {
      const double value = values[i * columns.weights.size() + j];
      norms[i] += columns.weights[j] * value * value;
    }
  }
  return norms;
}

/// Mean over L of the relative difference.
double mean_error(std::span<const double> coarse, std::span<const double> fine, std::span<const double> weights) {
  double sum = 0;
  double total = 0;
  for (std::size_t i = 0; i < weights.size(); ++i) {
    const double error = fine[i] > 0 ? std::abs(coarse[i] - fine[i]) / fine[i] : coarse[i] == fine[i] ? 0 : 1;
    sum += weights[i] * error;
    total += weights[i];
  }
  return sum / total;
}

/// Nodes so far apart, in half-vector widths of the lobe, that all of them may miss it.
bool may_miss(const LobeTabulator& tabulator, const HemisphereGrid& grid) {
  constexpr double kWidths = 6;
  return std::numbers::pi / 2 / static_cast<double>(grid.rings().size()) > kWidths * tabulator.lobes().sharpest();
}

}  // namespace

Resolution measure_resolution(const LobeTabulator& tabulator, const HemisphereGrid& grid, std::size_t points) {
  Resolution worst;
  const bool is_isotropic = tabulator.is_isotropic();
  const auto columns_of = [is_isotropic](const HemisphereGrid& of, std::size_t count) {
    return is_isotropic ? row_nodes(of, count) : all_nodes(of, count);
  };
  const NodeSet rows = some_rings(grid, points, is_isotropic);
  const NodeSet columns = columns_of(grid, points);
  // Halved points of halved cells are the same directions.
  const NodeSet fine_columns = columns_of(grid.refined(), std::max<std::size_t>(points / 2, 1));
  // Averages over cells lose norm in both directions, of which refining the columns restores three quarters of one.
  const double share = grid.has_cells() ? 8.0 / 3 : 1;
  for (std::size_t lobe = 0; lobe < tabulator.lobes().lobes(); ++lobe) {
    const double error = share * mean_error(squared_norms(tabulator, lobe, rows, columns),
                                            squared_norms(tabulator, lobe, rows, fine_columns), rows.weights);
    if (!(error <= worst.error)) worst = {error, lobe};
  }
  if (may_miss(tabulator, grid)) worst.error = std::max(worst.error, 1.0);
  return worst;
}

std::string resolution_needed(const LobeTabulator& tabulator, const HemisphereGrid& grid, double tolerance) {
  const std::size_t rings = grid.is_product() ? grid.n_theta() : 16;
  const std::size_t azimuths = grid.is_product() ? grid.n_phi() : 32;
  // A cosine lobe of exponent n asks for 3 sqrt(n) rings (reference/errata, quadrature advice); its width is
  // 1/sqrt(2n).
  const double needed = 3 / (std::numbers::sqrt2 * tabulator.lobes().sharpest());
  for (std::size_t factor = 2; factor * rings <= kLargestRings; factor *= 2) {
    if (static_cast<double>(8 * factor * rings) < needed) continue;  // no use measuring it
    const auto finer = HemisphereGrid::gauss(factor * rings, factor * azimuths);
    if (measure_resolution(tabulator, finer, 1).error <= tolerance) return finer.name();
  }
  const auto power = static_cast<std::size_t>(std::exp2(std::ceil(std::log2(std::max(needed, 2.0 * kLargestRings)))));
  return "about gauss:" + std::to_string(power) + "x" + std::to_string(2 * power) + " or more";
}

}  // namespace lobe
