#include <array>

#include "core/text.hpp"
#include "interface/options.hpp"
#include "interface/table_making.hpp"
#include "lobe/algebra/algebra.hpp"
#include "lobe/core/error.hpp"

namespace lobe::cli {
namespace {

constexpr Text kFactor{"FACTOR"};

double factor_argument(const Arguments& arguments) {
  double factor = 0;
  if (parse_number(arguments.text(kFactor), factor)) return factor;
  throw ArgumentError("FACTOR '" + arguments.text(kFactor) +
                      "' is not a number; expected one behind the table, as in 'lobe scale A 0.5'");
}

ExitCode execute_scale(Session& session) {
  const double factor = factor_argument(session.arguments());
  const std::array operand{session.operand(argument::a)};
  const TableOutput output(session);
  const auto options = tabulate_options(session);
  const auto device = session.choose_device();
  const auto grid = common_grid(session, device, operand);

  session.state_memory(tabulated_bytes(operand, grid), value_bytes(operand.front(), grid));
  return finish(session, "scale", device, scale(tabulated(session, device, operand.front(), grid, options), factor),
                output);
}

}  // namespace

Command scale_command() {
  return {.name = "scale",
          .group = "Tables",
          .summary = "multiply a table by a number",
          .description = "Multiplies a table, its delta parts and its errors by a number.",
          .positionals = {{.handle = argument::a, .help = "the table or material", .is_material = true},
                          {.handle = kFactor, .help = "the number"}},
          .options = table_command_options(
              {}, "the grid (default: the table's own; else as fine as a material or file needs)"),
          .examples = {{"a Phong material at half its strength", "lobe scale phong:n=20 0.5 -o half.h5"},
                       {"a mirror that keeps 90 %", "lobe scale mirror 0.9 -o mirror.h5"}},
          .execute = execute_scale};
}

}  // namespace lobe::cli
