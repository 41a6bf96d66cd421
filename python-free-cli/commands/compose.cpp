#include <fmt/core.h>

#include <algorithm>
#include <array>
#include <optional>
#include <set>

#include "interface/composition.hpp"
#include "interface/deviations.hpp"
#include "interface/options.hpp"
#include "interface/table_making.hpp"
#include "interface/values_report.hpp"
#include "lobe/algebra/algebra.hpp"
#include "lobe/algebra/pointwise.hpp"
#include "lobe/core/error.hpp"
#include "lobe/formats/measurement.hpp"
#include "lobe/reflectance/composition.hpp"
#include "lobe/reflectance/evaluate.hpp"

namespace lobe::cli {
namespace {

constexpr Texts kAt{"at"};

using Operands = std::array<Operand, 2>;

constexpr double kFunctionTolerance = 1e-4;  // of single values beside a file: kinks may lie anywhere

/// The triples of --at, in degrees.
std::vector<Directions> given_directions(const Arguments& arguments) {
  std::vector<Directions> directions;
  for (const auto& text : arguments.texts(kAt)) {
    const auto angles = numbers_in(kAt, text);
    if (angles.size() != 3) {
      throw ArgumentError("--at " + text + " has " + std::to_string(angles.size()) +
                          " numbers; expected THETA_IN,THETA_OUT,DELTA_PHI in degrees, as in --at 30,30,0");
    }
    directions.push_back({angles[0], angles[1], angles[2]});
  }
  return directions;
}

bool is_of_formulas(const Operands& operands) {
  return std::ranges::all_of(operands, &Operand::is_formula);
}

bool is_by_table(const Session& session, const Operands& operands) {
  const auto has_values = [](const Operand& operand) {
    return operand.is_formula() || (operand.has_values() && !operand.shape().has_delta());
  };
  return session.arguments().has(option::grid) ||
         (!is_of_formulas(operands) && !std::ranges::all_of(operands, has_values));
}

/// [channel][pair] of the composition: of materials and functions by quadrature at each pair, else from the composed
/// table.
std::vector<std::vector<Estimate>> values_at(Session& session, const Device& device, const Operands& operands,
                                             std::span<const Directions> degrees,
                                             const MissedToleranceCallback& missed) {
  const auto radians = to_radians(degrees);
  if (is_by_table(session, operands)) {
    const BrdfTable table = composition(session, device, operands);
    if (table.has_delta()) session.warn("values do not contain the delta parts of the composition");
    if (table.is_unresolved && !session.has_coarse_grid()) session.note_coarse(table.grid);
    return estimates(evaluate(device, table, radians));
  }
  const PointwiseOptions options{
      .tolerance = session.tolerance(is_of_formulas(operands) ? PointwiseOptions{}.tolerance : kFunctionTolerance),
      .precision = session.precision(),
      .missed = missed};
  if (std::ranges::all_of(operands, [](const Operand& operand) { return operand.shape().has_delta(); })) {
    session.warn("values do not contain the delta parts of the composition");
  }
  return composition_at(device, operands[0].reflectance(), operands[1].reflectance(), radians, options);
}

/// Standard deviations of the values, as caused by those of the samples, on a separate grid: deviations need no fine
/// one.
/// \return [channel][pair]; none where no file states any
std::vector<std::vector<double>> deviations_at(Session& session, const Device& device, const Operands& operands,
                                               std::span<const Directions> degrees) {
  const auto functions = replicated(session, operands);
  if (functions.empty()) return {};
  if (!std::ranges::all_of(functions, &BrdfFunction::is_isotropic)) {
    session.warn("standard deviations of samples are followed through compositions of isotropic reflectances only");
    return {};
  }
  const auto grid = HemisphereGrid::default_grid(false);
  std::vector<BrdfTable> tables;
  for (const auto& function : functions) tables.push_back(tabulate(device, function, grid, {.allow_unresolved = true}));
  const BrdfTable product = compose(device, tables[0], tables[1], {.allow_unresolved = true});
  return measurement_deviations(functions.front(), evaluate(device, product, to_radians(degrees)).value);
}

ExitCode print_values(Session& session, const Operands& operands) {
  const auto& arguments = session.arguments();
  if (arguments.has(option::output)) throw ArgumentError("--at makes no table; leave out --output, or --at");
  const auto degrees = given_directions(arguments);
  const auto device = session.choose_device();
  std::optional<std::set<std::size_t>> missed;
  if (!is_by_table(session, operands)) missed.emplace();
  const auto values = values_at(session, device, operands, degrees, [&](const MissedTolerance& value) {
    session.note_missed(value);
    missed->insert(value.index);
  });
  const auto deviations = deviations_at(session, device, operands, degrees);
  session.end_progress();
  if (session.wants_json()) {
    Json answer = json_answer("compose");
    answer["a"] = arguments.text(argument::a);
    answer["b"] = arguments.text(argument::b);
    answer["units"] = {{"angles", "deg"}, {"brdf", "sr^-1"}};
    answer["values"] = values_json(degrees, values, deviations);
    for (std::size_t i = 0; missed && i < degrees.size(); ++i) {
      answer["values"][i]["reached_tolerance"] = !missed->contains(i);
    }
    answer["precision"] = to_string(session.precision());
    answer["device"] = to_json(device.info());
    session.print_json(answer);
  } else {
    session.print(values_text(degrees, values, channel_names(operands), session.colors_output(), deviations));
  }
  return ExitCode::success;
}

ExitCode execute_compose(Session& session) {
  const Operands operands{session.operand(argument::a), session.operand(argument::b)};
  if (session.arguments().has(kAt)) return print_values(session, operands);
  const TableOutput output(session);
  const auto device = session.choose_device();

  return finish(session, "compose", device, composition(session, device, operands), output);
}

}  // namespace

Command compose_command() {
  return {.name = "compose",
          .group = "Tables",
          .summary = "compose two reflectances (operator product)",
          .description =
              "Composes two materials, measured files or tables, C(L,V) = integral of A(L,X) B(X,V) over X, and prints "
              "the properties of the result; -o writes it as a table. The composition of two highlights is a highlight "
              "around the light (delta-phi 0), just as two mirrors reflect light back.\n"
              "Materials are composed on gauss:64x128, or on a finer grid if they need one, and files on gauss:64x128; "
              "beside a table they are tabulated on its grid, and a second table is interpolated to it. For materials, "
              "and for isotropic files that have values at any directions, each node of the result holds an integral "
              "that resolves both factors; beside a table the result is a product of matrices. All errors are "
              "accounted for. With --at, materials and files are composed at single pairs of directions, without any "
              "grid, to a relative error of 1e-8 (1e-4 with a file) or --tolerance; with a table or a file of cells, "
              "the composed table is interpolated.",
          .positionals = {{.handle = argument::a, .help = "the factor that meets the light", .is_material = true},
                          {.handle = argument::b, .help = "the factor that meets the viewer", .is_material = true}},
          .options = composition_options(
              {{.handle = kAt,
                .value = "TI,TO,DP",
                .help = "compute only the value at theta_in, theta_out, delta_phi, in degrees; may be repeated"}},
              false),
          .examples = {{"a highlight and a metal", "lobe compose phong:n=20 ward:m=0.3 -o c.h5"},
                       {"two values of a composition, without a grid",
                        "lobe compose phong:n=5 phong:n=20 --at 30,30,0 --at 30,40,180"}},
          .execute = execute_compose};
}

}  // namespace lobe::cli
