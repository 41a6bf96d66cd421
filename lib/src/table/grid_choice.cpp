#include "table/grid_choice.hpp"

#include <algorithm>

#include "core/text.hpp"
#include "lobe/core/error.hpp"
#include "model/delta_shares.hpp"
#include "table/resolution.hpp"
#include "table/tabulate.hpp"

namespace lobe {
namespace {

/// The most rings of a grid that nobody asked for. Isotropic tables hold n^3 values of a gauss grid of n rings, general
/// ones 4 n^4; values of files take several times as long as those of formulas, and decompositions of general tables
/// grow as n^6.
std::size_t most_rings(const GridJudge& judge, TableUse use) {
  if (judge.is_isotropic()) return judge.has_functions() || use == TableUse::decomposition ? 256 : 512;
  if (use == TableUse::decomposition) return 24;
  return judge.has_functions() ? 48 : 64;
}

}  // namespace

GridJudge::GridJudge(const Device& device, std::span<const Material> materials, std::span<const BrdfFunction> functions,
                     const TabulateOptions& options)
    : functions_(functions), tolerance_(options.tolerance), cell_points_(options.cell_points) {
  for (const auto& material : materials) {
    const auto smooth = split_delta(material).smooth;
    if (!smooth.terms.empty()) tabulators_.emplace_back(device, smooth, options.precision);
  }
}

GridVerdict GridJudge::verdict(const HemisphereGrid& grid) const {
  GridVerdict verdict;
  const auto is_fine = [&](double error) { return error <= tolerance_; };
  for (const auto& tabulator : tabulators_) {
    const Resolution found = measure_resolution(tabulator, grid, 1);
    if (is_fine(found.error)) continue;
    return {false, found.error, "lobe " + tabulator.lobes().names[found.lobe]};
  }
  for (const auto& function : functions_) {
    const double found = resolution_of(function, grid, cell_points_);
    if (is_fine(found)) continue;
    return {false, found, "'" + function.name + "'"};
  }
  return verdict;
}

bool GridJudge::is_isotropic() const {
  return std::ranges::all_of(tabulators_, &LobeTabulator::is_isotropic) &&
         std::ranges::all_of(functions_, &BrdfFunction::is_isotropic);
}

HemisphereGrid choose_grid(const Device& device, std::span<const Material> materials,
                           std::span<const BrdfFunction> functions, const TabulateOptions& options) {
  constexpr std::size_t kLargest = 512;
  const GridJudge judge(device, materials, functions, options);
  GridVerdict verdict;
  HemisphereGrid grid = HemisphereGrid::gauss(8, 16);
  while (true) {
    verdict = judge.verdict(grid);
    if (verdict.is_resolved || grid.n_theta() >= kLargest) break;
    grid = next_gauss(grid);
  }
  if (verdict.is_resolved) return grid;
  throw NumericError(verdict.worst + " is resolved to " + shortest(verdict.error) + " only by " + grid.name() +
                     "; expected " + shortest(options.tolerance) + ", give a larger tolerance");
}

HemisphereGrid resolving_grid(const Device& device, std::span<const Material> materials,
                              std::span<const BrdfFunction> functions, const HemisphereGrid& start, TableUse use,
                              const TabulateOptions& options) {
  if (start.kind() != GridKind::gauss) return start;
  const GridJudge judge(device, materials, functions, options);
  const std::size_t most = most_rings(judge, use);
  HemisphereGrid grid = start.n_theta() > most ? HemisphereGrid::gauss(most, 2 * most) : start;
  while (next_gauss(grid).n_theta() <= most && !judge.verdict(grid).is_resolved) grid = next_gauss(grid);
  return grid;
}

HemisphereGrid next_gauss(const HemisphereGrid& grid) {
  const std::size_t rings = grid.n_theta();
  const std::size_t more = rings % 3 == 0 ? rings / 3 * 4 : rings / 2 * 3;
  return HemisphereGrid::gauss(more, 2 * more);
}

}  // namespace lobe
