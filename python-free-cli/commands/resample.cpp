#include <array>

#include "interface/table_making.hpp"

namespace lobe::cli {
namespace {

ExitCode execute(Session& session) {
  const std::array operand{session.operand("A")};
  const auto grid = HemisphereGrid::parse(session.arguments().text("grid"));
  const TableOutput output(session);
  const auto options = tabulate_options(session);
  const auto device = session.choose_device();

  session.state_memory(tabulated_bytes(operand, grid), value_bytes(operand.front(), grid));
  return finish(session, "resample", device, tabulated(device, operand.front(), grid, options), output);
}

}  // namespace

Command resample_command() {
  auto options = table_output_options(true);
  options.insert(options.begin(), {.name = "grid", .value = "GRID", .help = "the other grid", .required = true});
  return {.name = "resample",
          .group = "Tables",
          .summary = "a table on another grid",
          .description =
              "Interpolates a table between its directions. The error of that is measured, added to the table's own, "
              "and printed. A material is better tabulated anew ('lobe tabulate').",
          .positionals = {{.name = "A", .help = "the table", .is_material = true}},
          .options = std::move(options),
          .examples = {{"a table first", "lobe tabulate phong:n=20 --grid gauss:32x64 -o a.h5"},
                       {"and a coarser one made from it", "lobe resample a.h5 --grid gauss:24x48 -o coarse.h5"}},
          .execute = execute};
}

}  // namespace lobe::cli
