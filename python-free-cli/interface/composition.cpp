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

constexpr std::size_t kUsualRings = 64;
constexpr std::size_t kLargestRings = 512;

/// Whether operands, one of which is no material, are composed by their own values on a grid.
bool has_own_values(std::span<const Operand> operands, const HemisphereGrid& grid) {
  if (!grid.is_product() || grid.has_cells() || std::ranges::all_of(operands, &Operand::is_formula)) return false;
  return std::ranges::all_of(operands, [](const Operand& operand) { return can_be_composed(operand.shape()); });
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
                 .allow_unresolved = session.arguments().has(option::allow_unresolved),
                 .resolve_formulas = std::ranges::all_of(operands, &Operand::has_values),
                 .tolerance = session.tolerance(ComposeOptions{}.tolerance),
                 .progress = session.progress()} {}

  [[nodiscard]] BrdfTable on_grid(const HemisphereGrid& grid) const {
    state_memory(grid);
    if (has_own_values(operands_, grid)) return of_own_values(grid);
    const auto tables = tabulated(device_, operands_, grid, tabulation_);
    return tables.size() == 1 ? self_compose(device_, tables.front(), times_, options_)
                              : compose(device_, tables.front(), tables.back(), options_);
  }

  /// On gauss:64x128, or the coarsest grid that resolves the materials where that is finer.
  [[nodiscard]] BrdfTable on_usual_grid() const {
    const auto usual = HemisphereGrid::gauss(kUsualRings, 2 * kUsualRings);
    if (tabulation_.allow_unresolved) return on_grid(usual);
    const HemisphereGrid coarsest = coarsest_grid();
    return on_grid(coarsest.n_theta() > kUsualRings ? coarsest : usual);
  }

  /// On the first grid of the series of choose_grid() that reaches a relative error.
  [[nodiscard]] BrdfTable to_tolerance(double tolerance) const {
    HemisphereGrid grid = coarsest_grid();
    while (true) {
      BrdfTable product = on_grid(grid);
      const double reached = relative_error(product);
      if (!(reached > tolerance)) return product;
      session_.remark(fmt::format("lobe: {} reaches a relative error of {}\n", grid.name(), relative_text(reached)));
      if (grid.n_theta() >= kLargestRings) {
        throw NumericError(
            fmt::format("{} reaches a relative error of {} only, not {}; give a larger --tolerance, or "
                        "a --grid",
                        grid.name(), relative_text(reached), shortest(tolerance)));
      }
      grid = next(grid);
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
      const BrdfTable factor = tabulated(device_, first, grid, tabulation);
      for (unsigned k = 1; k < times_; ++k) product = compose(device_, product, factor, options_);
    }
    product.expression = fmt::format("self_compose({}, times={})", first.shape_on(grid).expression, times_);
    return product;
  }

  [[nodiscard]] HemisphereGrid coarsest_grid() const {
    std::vector<Reflectance> reflectances;
    for (const auto& operand : operands_) reflectances.push_back(operand.shape());
    return choose_grid(device_, reflectances, tabulation_);
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
  if (has_table || arguments.has(option::grid)) return composer.on_grid(common_grid(arguments, operands));
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
