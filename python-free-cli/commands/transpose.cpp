#include <array>

#include "interface/options.hpp"
#include "interface/table_making.hpp"
#include "lobe/algebra/algebra.hpp"

namespace lobe::cli {
namespace {

ExitCode execute_transpose(Session& session) {
  const std::array operand{session.operand(argument::a)};
  const TableOutput output(session);
  const auto options = tabulate_options(session);
  const auto device = session.choose_device();
  const auto grid = common_grid(session, device, operand);

  const std::uint64_t bytes = value_bytes(operand.front(), grid);
  session.state_memory(tabulated_bytes(operand, grid) + bytes, 2 * bytes);
  const BrdfTable table = tabulated(session, device, operand.front(), grid, options);
  return finish(session, "transpose", device, transpose(table), output);
}

}  // namespace

Command transpose_command() {
  return {.name = "transpose",
          .group = "Tables",
          .summary = "exchange light and viewer in a table",
          .description =
              "Exchanges light and viewer: turns f(L, V) into f(V, L). A reciprocal material is its own transpose; for "
              "reciprocal A and B, the transpose of the composition of A and B is that of B and A.",
          .positionals = {{.handle = argument::a, .help = "the table or material", .is_material = true}},
          .options = table_command_options(
              {}, "the grid (default: the table's own; else as fine as a material or file needs)"),
          .examples = {{"a composition, which is not reciprocal", "lobe compose phong:n=20 ward:m=0.3 -o c.h5"},
                       {"its transpose", "lobe transpose c.h5 -o reversed.h5"}},
          .execute = execute_transpose};
}

}  // namespace lobe::cli
