#include <fmt/core.h>

#include <array>
#include <cmath>

#include "interface/options.hpp"
#include "interface/placed_value.hpp"
#include "interface/table_making.hpp"
#include "lobe/algebra/inverse.hpp"

namespace lobe::cli {
namespace {

constexpr Text kF{"F"};
constexpr Text kG{"G"};
constexpr Number kLambda{"lambda"};

std::string_view reason(Regularisation regularisation) {
  switch (regularisation) {
    case Regularisation::given:
      return "given";
    case Regularisation::none:
      return "none needed";
    case Regularisation::discrepancy:
      return "by the stated errors of F and G";
    case Regularisation::cross_validation:
      return "by generalised cross validation";
  }
  return "";
}

std::string_view name_of(Regularisation regularisation) {
  switch (regularisation) {
    case Regularisation::given:
      return "given";
    case Regularisation::none:
      return "none";
    case Regularisation::discrepancy:
      return "discrepancy";
    case Regularisation::cross_validation:
      return "cross-validation";
  }
  return "";
}

std::string discrepancy_text(const ChannelSolution& solution) {
  std::string text = fmt::format("{:.4g}", solution.discrepancy);
  if (!std::isnan(solution.relative_discrepancy))
    text += fmt::format("; relative {:.4g}", solution.relative_discrepancy);
  return text + (std::isnan(solution.expected_discrepancy)
                     ? "; errors of F and G are unknown"
                     : fmt::format("; errors of F and G allow {:.2g}", solution.expected_discrepancy));
}

Findings findings(const Solution& solution) {
  Findings found;
  found.json["solutions"] = Json::array();
  for (std::size_t c = 0; c < solution.channels.size(); ++c) {
    const ChannelSolution& channel = solution.channels[c];
    const auto add = [&](std::string_view name, std::string text) {
      found.fields.push_back({channel_name(name, solution.table, c), std::move(text)});
    };
    add("lambda", fmt::format("{:.4g}, {}", channel.lambda, reason(channel.regularisation)));
    add("|F o X - G|", discrepancy_text(channel));
    add("|X|", fmt::format("{:.6g}", channel.norm));
    add("condition of F", fmt::format("{:.3g}", channel.condition));
    add("singular values", fmt::format("{} of {} above lambda", channel.kept, channel.components));
    add("noise", fmt::format("a change of G changes X by up to {:.3g} times as much", channel.amplification));
    add("X's least value", text_of(channel.least_value));
    found.json["solutions"].push_back({{"regularisation", name_of(channel.regularisation)},
                                       {"lambda", to_json(channel.lambda)},
                                       {"discrepancy", to_json(channel.discrepancy)},
                                       {"relative_discrepancy", to_json(channel.relative_discrepancy)},
                                       {"expected_discrepancy", to_json(channel.expected_discrepancy)},
                                       {"norm", to_json(channel.norm)},
                                       {"condition", to_json(channel.condition)},
                                       {"kept", channel.kept},
                                       {"components", channel.components},
                                       {"amplification", to_json(channel.amplification)},
                                       {"least_value", json_of(channel.least_value)}});
  }
  return found;
}

ExitCode execute_solve(Session& session) {
  const auto& arguments = session.arguments();
  const std::array operands{session.operand(kF), session.operand(kG)};
  const TableOutput output(session);
  SolveOptions options;
  options.exact_grid = arguments.has(option::exact_grid);
  if (arguments.has(kLambda)) options.lambda = arguments.number(kLambda);
  const auto tabulation = tabulate_options(session);
  const auto device = session.choose_device();
  const auto grid = common_grid(session, device, operands, TableUse::decomposition);

  options.progress = session.progress();
  // Blocks of F, G and X, and both factors of the decomposition.
  constexpr std::uint64_t kCopies = 6;
  const std::uint64_t bytes = value_bytes(operands[0], grid);
  session.state_memory(tabulated_bytes(operands, grid) + kCopies * bytes, 3 * bytes, kCopies * bytes);
  const auto tables = tabulated(session, device, operands, grid, tabulation);
  const Solution solution = solve(tables[0], tables[1], options);
  return finish(session, "solve", device, solution.table, output, findings(solution));
}

}  // namespace

Command solve_command() {
  return {
      .name = "solve",
      .group = "Operators",
      .summary = "find X with F o X = G",
      .description =
          "Finds the X that minimises |F o X - G|^2 + lambda^2 |X|^2, in the norms of point light. Prints the "
          "remaining |F o X - G|, how stable X is, and its least value (X need not be a reflectance). Without "
          "--lambda, lambda is 0 if F is so well conditioned that errors of F and G change X by less than a tenth. "
          "Otherwise it makes |F o X - G| as large as those errors, or is chosen by cross-validation if they are "
          "unknown.\n"
          "-o writes X. The errors of its values bound what errors of F and G make of it for this lambda; they leave "
          "out "
          "the loss by regularisation.",
      .positionals = {{.handle = kF, .help = "the factor that meets the light", .is_material = true},
                      {.handle = kG, .help = "the composition F o X", .is_material = true}},
      .options = table_command_options(
          {{.handle = kLambda, .value = "X", .help = "weight of |X|, 0 or more (default: chosen)"},
           {.handle = option::exact_grid, .help = "refuse tables on different grids instead of interpolating"}},
          "the grid (default: that of the first table, else as fine as the materials and files need)", false),
      .examples = {{"a composition", "lobe compose phong:n=5 ward:m=0.4 -o c.h5"},
                   {"the second factor, as far as the first one lets it through", "lobe solve phong:n=5 c.h5 -o x.h5"}},
      .execute = execute_solve};
}

}  // namespace lobe::cli
