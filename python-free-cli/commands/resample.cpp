#include <array>

#include "interface/options.hpp"
#include "interface/table_making.hpp"

namespace lobe::cli {
namespace {

ExitCode execute_resample(Session& session) {
  const std::array operand{session.operand(argument::a)};
  const auto grid = HemisphereGrid::parse(session.arguments().text(option::grid));
  const TableOutput output(session);
  const auto options = tabulate_options(session);
  const auto device = session.choose_device();

  session.state_memory(tabulated_bytes(operand, grid), value_bytes(operand.front(), grid));
  return finish(session, "resample", device, tabulated(session, device, operand.front(), grid, options), output);
}

}  // namespace

Command resample_command() {
  auto options = table_command_options({}, "the new grid");
  options.front().required = true;
  return {.name = "resample",
          .group = "Tables",
          .summary = "interpolate a table on another grid",
          .description =
              "Interpolates a table between its directions. The error of interpolation is measured, added to the "
              "table's own error, and printed. For a material, use 'lobe tabulate' instead.",
          .positionals = {{.handle = argument::a, .help = "the table", .is_material = true}},
          .options = std::move(options),
          .examples = {{"a table", "lobe tabulate phong:n=20 --grid gauss:32x64 -o a.h5"},
                       {"a coarser table made from it", "lobe resample a.h5 --grid gauss:24x48 -o coarse.h5"}},
          .execute = execute_resample};
}

}  // namespace lobe::cli
