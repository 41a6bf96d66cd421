#include <fmt/core.h>

#include "interface/options.hpp"
#include "interface/reading.hpp"
#include "interface/table_making.hpp"
#include "lobe/algebra/algebra.hpp"
#include "lobe/core/error.hpp"

namespace lobe::cli {
namespace {

constexpr Numbers kWeights{"weights"};

std::vector<Operand> operands_of(const Arguments& arguments) {
  std::vector<Operand> operands;
  for (const auto& text : arguments.texts(argument::materials)) operands.emplace_back(text, read_options(arguments));
  return operands;
}

std::vector<double> weights_of(const Arguments& arguments, std::size_t materials) {
  auto weights = arguments.numbers(kWeights);
  if (weights.size() != materials) {
    throw ArgumentError(
        fmt::format("{} weights for {} materials; give as many, as in --weights 0.3,0.7", weights.size(), materials));
  }
  return weights;
}

/// States what it takes: the tables, each of them on the common grid, and their sum.
void state_memory(Session& session, std::span<const Operand> operands, const HemisphereGrid& grid) {
  std::uint64_t tables = 0;
  std::uint64_t moved = 0;
  std::uint64_t sum = 0;
  for (const auto& operand : operands) {
    tables += value_bytes(operand.shape_on(grid));
    moved += value_bytes(operand, grid);
    sum = std::max(sum, value_bytes(operand, grid));
  }
  session.state_memory(std::max(tabulated_bytes(operands, grid), tables + moved + sum), tables + sum);
}

ExitCode execute_mix(Session& session) {
  const auto operands = operands_of(session.arguments());
  const auto weights = weights_of(session.arguments(), operands.size());
  const TableOutput output(session);
  const auto options = tabulate_options(session);
  const auto device = session.choose_device();
  const auto grid = common_grid(session, device, operands);

  state_memory(session, operands, grid);
  const auto tables = tabulated(session, device, operands, grid, options);
  return finish(session, "mix", device, mix(weights, tables, options.exact_grid), output);
}

}  // namespace

Command mix_command() {
  return {.name = "mix",
          .group = "Tables",
          .summary = "form a weighted sum of tables",
          .description =
              "Adds tables and materials, each times its weight. Tables on other grids than that of the first one are "
              "interpolated, and their errors include that of the interpolation.",
          .positionals = {{.handle = argument::materials,
                           .help = "the tables and materials to add",
                           .is_material = true,
                           .is_repeated = true}},
          .options = table_command_options(
              {{.handle = kWeights, .value = "W,W...", .help = "one number for each", .required = true},
               {.handle = option::exact_grid, .help = "refuse tables on different grids"}},
              "the grid (default: that of the first table, else as fine as the materials and files need)"),
          .examples = {{"a matt and a glossy layer", "lobe mix lambert phong:n=20 --weights 0.3,0.7 -o paint.h5"},
                       {"their difference", "lobe mix lambert phong:n=20 --weights 1,-1 -o difference.h5"}},
          .execute = execute_mix};
}

}  // namespace lobe::cli
