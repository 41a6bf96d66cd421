#include "lobe/algebra/square_root.hpp"

#include <fmt/core.h>

#include <array>

#include "interface/options.hpp"
#include "interface/placed_value.hpp"
#include "interface/table_making.hpp"
#include "lobe/algebra/spectrum.hpp"
#include "lobe/core/directions.hpp"

namespace lobe::cli {
namespace {

std::string_view verdict(Definiteness definiteness) {
  switch (definiteness) {
    case Definiteness::semi_definite:
      return "yes: no negative eigenvalue";
    case Definiteness::indefinite:
      return "no: it has negative eigenvalues; the root is that of the nearest one";
    case Definiteness::undecided:
      return "undecided: its negative eigenvalues are within their errors; the root is that of the nearest one";
  }
  return "";
}

std::string_view name_of(Definiteness definiteness) {
  switch (definiteness) {
    case Definiteness::semi_definite:
      return "semi-definite";
    case Definiteness::indefinite:
      return "indefinite";
    case Definiteness::undecided:
      return "undecided";
  }
  return "";
}

Findings findings(const SquareRoot& root) {
  Findings found;
  found.json["roots"] = Json::array();
  for (std::size_t c = 0; c < root.channels.size(); ++c) {
    const ChannelRoot& channel = root.channels[c];
    const auto add = [&](std::string_view name, std::string text) {
      found.fields.push_back({channel_name(name, root.table, c), std::move(text)});
    };
    const double theta_deg = to_degrees(channel.largest_albedo_theta);
    add("self-composition", std::string(verdict(channel.definiteness)));
    add("norm |A|", format_estimate(channel.norm));
    add("smallest eigenvalue", format_estimate(channel.smallest));
    if (channel.skew.value > 0) add("not reciprocal by", format_estimate(channel.skew));
    std::string distance = format_estimate(channel.distance);
    if (!root.table.has_delta()) distance += "; relative " + format_estimate(channel.relative_distance);
    add("distance to nearest", distance);
    add("root's least value", text_of(channel.least_value));
    add("root's largest albedo", fmt::format("{} at {:.1f}°", format_estimate(channel.largest_albedo), theta_deg));
    Json albedo = to_json(channel.largest_albedo);
    albedo["theta_deg"] = theta_deg;
    found.json["roots"].push_back({{"definiteness", name_of(channel.definiteness)},
                                   {"norm", to_json(channel.norm)},
                                   {"smallest", to_json(channel.smallest)},
                                   {"skew", to_json(channel.skew)},
                                   {"distance", to_json(channel.distance)},
                                   {"relative_distance", to_json(channel.relative_distance)},
                                   {"least_value", json_of(channel.least_value)},
                                   {"largest_albedo", albedo}});
  }
  return found;
}

ExitCode execute_square_root(Session& session) {
  const std::array operand{session.operand(argument::a)};
  const TableOutput output(session);
  SquareRootOptions options;
  options.tolerance = session.tolerance(options.tolerance);
  const auto tabulation = tabulate_options(session);
  const auto device = session.choose_device();
  const auto grid = common_grid(session, device, operand, TableUse::decomposition);

  options.progress = session.progress();
  const BrdfTable shape = operand.front().shape_on(grid);
  const std::uint64_t block_bytes = spectrum_bytes(shape);
  session.state_memory(tabulated_bytes(operand, grid) + block_bytes, 2 * value_bytes(operand.front(), grid),
                       block_bytes);
  const BrdfTable table = tabulated(session, device, operand.front(), grid, tabulation);
  const SquareRoot root = square_root(device, table, options);
  return finish(session, "square-root", device, root.table, output, findings(root));
}

}  // namespace

Command square_root_command() {
  return {
      .name = "square-root",
      .group = "Operators",
      .summary = "find X with X o X nearest to a reflectance",
      .description =
          "Computes the self-adjoint root X of a reciprocal material or table A, so that X composed with X is A. The "
          "root exists if A has no negative eigenvalues. Otherwise the answer is the root of the nearest "
          "self-composition (A without the negative part of its spectrum; of an A that is not reciprocal, its "
          "reciprocal part without that), and its distance to A, in the norm of point light, is printed. The root's "
          "least value and largest albedo tell whether it is a reflectance. Delta parts "
          "have exact roots, unless the mirror's factor exceeds that of the RRIM.\n"
          "-o writes the root. Its error is measured on a finer grid if the formulas of A are known.",
      .positionals = {{.handle = argument::a, .help = "the table or material", .is_material = true}},
      .options =
          table_command_options({tolerance_option("eigenvalues down to -X |A| count as zero (default 1e-10)")},
                                "the grid (default: the table's own; else as fine as a material or file needs)", false),
      .examples = {{"a self-composition", "lobe self-compose phong:n=20 -o c.h5"},
                   {"its square root", "lobe square-root c.h5 -o root.h5"},
                   {"whether a material is a self-composition", "lobe square-root ward:m=0.3"}},
      .execute = execute_square_root};
}

}  // namespace lobe::cli
