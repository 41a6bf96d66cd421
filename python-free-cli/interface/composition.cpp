#include "interface/composition.hpp"

#include <fmt/core.h>

#include <algorithm>

#include "core/text.hpp"
#include "interface/options.hpp"
#include "interface/table_making.hpp"
#include "interface/table_report.hpp"
#include "lobe/algebra/algebra.hpp"
#include "lobe/core/error.hpp"
#include "lobe/reflectance/composition.hpp"

namespace lobe::cli {
namespace {

/// Whether operands, one of which is no material, are composed by their own values on a grid.
bool has_own_values(std::span<const Operand> operands, const HemisphereGrid& grid) {
  if (!grid.is_product() || grid.has_cells() || std::ranges::all_of(operands, &Operand::is_formula)) return false;
  return std::ranges::all_of(operands, [](const Operand& operand) { return can_be_composed(operand.shape()); });
}

/// The grid of --grid, else that of a table or file, where its own values are composed; else as fine as operands that
/// are tabulated need.
HemisphereGrid grid_of(const Session& session, const Device& device, std::span<const Operand> operands) {
  if (const auto given = given_grid(session.arguments())) return *given;
  const auto found = std::ranges::find_if_not(operands, &Operand::is_formula);
  const HemisphereGrid natural = natural_grid((found == operands.end() ? operands.front() : *found).shape());
  return has_own_values(operands, natural) ? natural : common_grid(session, device, operands);
}

/// Operands as tables, and their product.
class Composer {
 public:
  Composer(Session& session, const Device& device, std::span<const Operand> operands, unsigned times)
      : session_(session),
        device_(device),
        operands_(operands),
        times_(times),
        tabulation_(tabulate_options(session)),
        options_{.precision = session.precision(),
                 .exact_grid = session.arguments().is_given(option::exact_grid),
                 .allow_unresolved = tabulation_.allow_unresolved,
                 .resolve_formulas = std::ranges::all_of(operands, &Operand::has_values),
                 .tolerance = session.tolerance(ComposeOptions{}.tolerance),
                 .progress = session.progress()} {}

  [[nodiscard]] BrdfTable on_grid(const HemisphereGrid& grid) const {
    state_memory(grid);
    if (has_own_values(operands_, grid)) return of_own_values(grid);
    const auto tables = tabulated(session_, device_, operands_, grid, tabulation_);
    return tables.size() == 1 ? self_compose(device_, tables.front(), times_, options_)
                              : compose(device_, tables.front(), tables.back(), options_);
  }

  /// On gauss:64x128, or the coarsest grid that resolves the materials where that is finer.
  [[nodiscard]] BrdfTable on_usual_grid() const {
    if (session_.arguments().has(option::allow_unresolved)) return on_grid(HemisphereGrid::default_grid());
    return on_grid(common_grid(session_, device_, operands_));
  }

  /// On the first grid from gauss:8x16 on that resolves the materials and reaches a relative error, else on the finest.
  [[nodiscard]] BrdfTable to_tolerance(double tolerance) const {
    HemisphereGrid grid = resolving(HemisphereGrid::gauss(8, 16));
    while (true) {
      BrdfTable product = on_grid(grid);
      const double reached = relative_error(product);
      if (!(reached > tolerance)) return product;
      session_.remark(fmt::format("lobe: {} reaches a relative error of {}\n", grid.name(), relative_text(reached)));
      const HemisphereGrid finer = resolving(next(grid));
      if (finer.n_theta() <= grid.n_theta()) {
        session_.note_missed({.quantity = fmt::format("'{}' on {}", product.expression, grid.name()),
                              .relative_error = reached,
                              .tolerance = tolerance});
        return product;
      }
      grid = finer;
    }
  }

 private:
  /// Further factors than two are tables.
  [[nodiscard]] BrdfTable of_own_values(const HemisphereGrid& grid) const {
    const Operand& first = operands_.front();
    BrdfTable product = compose(device_, first.reflectance(), operands_.back().reflectance(), grid, options_);
    if (operands_.size() > 1) return product;
    if (times_ > 1) {
      TabulateOptions tabulation = tabulation_;
      tabulation.allow_unresolved = true;
      const BrdfTable factor = tabulated(session_, device_, first, grid, tabulation);
      for (unsigned k = 1; k < times_; ++k) product = compose(device_, product, factor, options_);
    }
    product.expression = fmt::format("self_compose({}, times={})", first.shape_on(grid).expression, times_);
    return product;
  }

  /// The first grid from this one on that resolves the materials; never finer than nobody asked for.
  [[nodiscard]] HemisphereGrid resolving(const HemisphereGrid& start) const {
    std::vector<Reflectance> reflectances;
    for (const auto& operand : operands_) reflectances.push_back(operand.shape());
    return resolving_grid(device_, reflectances, start, TableUse::values, tabulation_);
  }

  /// 8, 12, 16, 24, 32 ... rings.
  static HemisphereGrid next(const HemisphereGrid& grid) {
    const std::size_t rings = grid.n_theta();
    const bool is_power_of_two = (rings & (rings - 1)) == 0;
    const std::size_t more = is_power_of_two ? rings / 2 * 3 : rings / 3 * 4;
    return HemisphereGrid::gauss(more, 2 * more);
  }

  void state_memory(const HemisphereGrid& grid) const {
    BrdfTable f = operands_.front().shape_on(grid);
    f.grid = grid;
    const BrdfTable g = operands_.size() == 1 ? f : operands_.back().shape_on(grid);
    const std::uint64_t product = std::max(value_bytes(f), value_bytes(operands_.back(), grid));
    std::uint64_t factors = value_bytes(f) + (operands_.size() == 1 ? 0 : value_bytes(g));
    if (times_ > 1) {
      factors += product;  // the power so far
      f.source.insert(f.source.end(), g.source.begin(), g.source.end());
    }
    session_.state_memory(std::max(tabulated_bytes(operands_, grid), factors + compose_bytes(device_, f, g, options_)),
                          product);
  }

  Session& session_;
  const Device& device_;
  std::span<const Operand> operands_;
  unsigned times_;
  TabulateOptions tabulation_;
  ComposeOptions options_;
};

}  // namespace

BrdfTable composition(Session& session, const Device& device, std::span<const Operand> operands, unsigned times) {
  const auto& arguments = session.arguments();
  const bool has_table = !std::ranges::all_of(operands, &Operand::is_formula);
  if (arguments.has(option::tolerance) && (has_table || arguments.has(option::grid))) {
    throw ArgumentError("--tolerance chooses a grid, which " + std::string(has_table
                                                                               ? "a table has already; leave it out"
                                                                               : "--grid does, too; give one of them"));
  }
  const Composer composer(session, device, operands, times);
  if (has_table || arguments.has(option::grid)) return composer.on_grid(grid_of(session, device, operands));
  return arguments.has(option::tolerance) ? composer.to_tolerance(session.tolerance(0)) : composer.on_usual_grid();
}

std::vector<Option> composition_options(std::vector<Option> own, bool needs_output) {
  own.push_back(tolerance_option("for materials: refine the grid to this relative error"));
  own.push_back({.handle = option::exact_grid, .help = "refuse tables on different grids instead of interpolating"});
  return table_command_options(
      std::move(own), "the grid (default: that of the first table, else gauss:64x128 or as fine as materials need)",
      needs_output);
}

}  // namespace lobe::cli
