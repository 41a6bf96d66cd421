#include <array>

#include "interface/options.hpp"
#include "interface/table_making.hpp"
#include "lobe/core/error.hpp"

namespace lobe::cli {
namespace {

/// \param options of the table, given the tolerance that the grid is chosen by
HemisphereGrid choose(Session& session, const Device& device, const Operand& operand, TabulateOptions& options) {
  const auto& arguments = session.arguments();
  if (!arguments.has(option::tolerance)) return common_grid(session, device, {&operand, 1});
  if (arguments.has(option::grid)) throw ArgumentError("--grid and --tolerance both choose the grid; give one of them");
  options.tolerance = session.tolerance(options.tolerance);
  return resolving_grid(device, {operand.shape()}, HemisphereGrid::gauss(8, 16), TableUse::values, options);
}

ExitCode execute_tabulate(Session& session) {
  const std::array operand{session.operand(argument::material)};
  if (!operand.front().is_formula()) {
    const std::string& given = session.arguments().text(argument::material);
    throw ArgumentError(operand.front().shape().table() != nullptr
                            ? "'" + given + "' is a table already; bring it to another grid by 'lobe resample'"
                            : "'" + given + "' is a measured file; 'lobe import' makes a table of it");
  }
  const TableOutput output(session);
  auto options = tabulate_options(session);
  const auto device = session.choose_device();

  const HemisphereGrid grid = choose(session, device, operand.front(), options);
  session.state_memory(tabulated_bytes(operand, grid), value_bytes(operand.front(), grid));
  return finish(session, "tabulate", device, tabulated(session, device, operand.front(), grid, options), output);
}

}  // namespace

Command tabulate_command() {
  return {
      .name = "tabulate",
      .group = "Tables",
      .summary = "tabulate a material on a grid of directions",
      .description =
          "Writes a table of a material's values for every pair of directions on a grid, and prints how well the "
          "grid resolves the material, its albedos, and their errors. Mirrors are stored separately and exactly.\n"
          "A GRID is KIND:SIZE. gauss:64x128 has 64 rings of 128 directions and suits smooth materials best; "
          "uniform:64x128, cells:64x128, shirley-chiu:32 and klems:145 serve data and other programs.\n"
          "If the grid does not resolve a lobe, a warning names the grid that the lobe needs; with --strict that is an "
          "error. Without --grid the grid is as fine as the material needs, from gauss:64x128 up to gauss:512x1024 (of "
          "anisotropic materials gauss:64x128).",
      .positionals = {{.handle = argument::material, .help = "the material to tabulate", .is_material = true}},
      .options = table_command_options(
          {tolerance_option("choose the smallest gauss grid that resolves the material to this relative error")},
          "the grid (default: as fine as the material needs)"),
      .examples = {{"a glossy paint", "lobe tabulate lambert:scale=0.3+phong:n=50,scale=0.5 -o paint.h5"},
                   {"a metal, on as coarse a grid as will do",
                    "lobe tabulate ward:m=0.2 --tolerance 0.01 -o metal.h5"}},
      .execute = execute_tabulate};
}

}  // namespace lobe::cli
