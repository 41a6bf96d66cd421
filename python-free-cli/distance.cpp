#include <fmt/core.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>

#include "command.hpp"
#include "core/text.hpp"
#include "lobe/error.hpp"
#include "lobe/metric.hpp"
#include "lobe/table_metric.hpp"
#include "session.hpp"
#include "table_making.hpp"
#include "table_report.hpp"
#include "terminal.hpp"

namespace lobe::cli {
namespace {

constexpr double kDegreesPerRadian = 180 / std::numbers::pi;

/// What two materials have to do with each other under a lighting.
struct Comparison {
  Estimate distance;
  Estimate norm_a;
  Estimate norm_b;
  Estimate product;
};

/// The comparison of all channels together, and where it was computed.
struct Answer {
  Comparison combined;
  std::vector<Comparison> channels;  ///< of materials with several
  std::vector<Unresolved> unresolved;
  DeviceInfo device;
};

using Operands = std::array<Operand, 2>;

Comparison comparison(const Metric& metric) {
  return {{metric.distance(0, 1), metric.distance_error(0, 1)},
          {metric.norm(0), metric.norm_error(0)},
          {metric.norm(1), metric.norm_error(1)},
          {metric.gram(0, 1), metric.gram_error(0, 1)}};
}

/// Angle between the two materials as vectors, in degrees; NaN when one of them is zero under the lighting. Taken from
/// the chord between the normalised vectors, which does not cancel for near-parallel ones.
double angle_deg(const Comparison& pair) {
  const double norms = pair.norm_a.value * pair.norm_b.value;
  if (!(norms > 0)) return std::numeric_limits<double>::quiet_NaN();
  const double distance = pair.distance.value;
  const double difference = pair.norm_a.value - pair.norm_b.value;
  const double chord = std::sqrt(std::max(0.0, (distance - difference) * (distance + difference) / norms));
  return 2 * std::asin(std::min(1.0, chord / 2)) * kDegreesPerRadian;
}

Answer compare_materials(Session& session, const Operands& operands, Lighting lighting, const MetricOptions& options) {
  const std::array materials{operands[0].material(), operands[1].material()};
  const auto device = session.choose_device();
  const auto result = measure(device, materials, lighting, options);
  Answer answer{comparison(result.combined), {}, result.unresolved, device.info()};
  for (const auto& channel : result.channels) answer.channels.push_back(comparison(channel));
  return answer;
}

Estimate norm(const BrdfTable& table, Lighting lighting) {
  const Estimate square = scalar_product(table, table, lighting);
  const double norm = std::sqrt(std::max(0.0, square.value));
  return {norm, norm > 0 ? square.error / (2 * norm) : std::sqrt(square.error)};
}

/// On the grid of the first table; what lies on another one is interpolated.
Answer compare_tables(Session& session, const Operands& operands, Lighting lighting) {
  const auto grid = common_grid(session.arguments(), operands);
  const auto device = session.choose_device();
  session.state_memory(tabulated_bytes(operands, grid));
  auto tables = tabulated(device, operands, grid, tabulate_options(session));
  for (auto& table : tables) table = resample(table, grid);
  const BrdfTable& a = tables.front();
  const BrdfTable& b = tables.back();
  return {.combined = {distance(a, b, lighting), norm(a, lighting), norm(b, lighting), scalar_product(a, b, lighting)},
          .channels = {},
          .unresolved = {},
          .device = device.info()};
}

Json comparison_json(const Comparison& pair) {
  return {{"distance", to_json(pair.distance)},
          {"norm_a", to_json(pair.norm_a)},
          {"norm_b", to_json(pair.norm_b)},
          {"product", to_json(pair.product)},
          {"angle_deg", to_json(angle_deg(pair))}};
}

Json operand_json(const Operand& operand) {
  return operand.is_table() ? header_json(operand.header()) : material_json(operand.material());
}

void print_json(Session& session, const Operands& operands, const Answer& result, Lighting lighting,
                const MetricOptions& options) {
  const bool is_point = lighting == Lighting::point;
  Json answer = json_answer("distance");
  answer["a"] = operand_json(operands[0]);
  answer["b"] = operand_json(operands[1]);
  answer["lighting"] = lobe::to_string(lighting);
  answer["tolerance"] = options.tolerance;
  answer["units"] = {
      {"distance", is_point ? "1" : "sr^1/2"}, {"norm", is_point ? "1" : "sr^1/2"}, {"product", is_point ? "1" : "sr"}};
  answer.update(comparison_json(result.combined));
  if (!result.channels.empty()) {
    answer["channels"] = Json::array();
    for (const auto& channel : result.channels) answer["channels"].push_back(comparison_json(channel));
  }
  answer["reached_tolerance"] = result.unresolved.empty();
  if (session.arguments().has("fail-above")) {
    const double limit = session.arguments().number("fail-above");
    answer["fail_above"] = to_json(limit);
    answer["is_above"] = result.combined.distance.value > limit;
  }
  answer["precision"] = to_string(options.precision);
  answer["device"] = to_json(result.device);
  session.print_json(answer);
}

ExitCode execute(Session& session) {
  const auto& arguments = session.arguments();
  const Operands operands{session.operand("A"), session.operand("B")};
  const auto lighting = arguments.has("lighting") ? parse_lighting(arguments.text("lighting")) : Lighting::point;
  const double limit =
      arguments.has("fail-above") ? arguments.number("fail-above") : std::numeric_limits<double>::infinity();
  MetricOptions options;
  options.tolerance = session.tolerance(options.tolerance);
  options.precision = session.precision();
  options.progress = session.progress();

  const InterruptWatch watch;
  const bool has_table = operands[0].is_table() || operands[1].is_table();
  const Answer result =
      has_table ? compare_tables(session, operands, lighting) : compare_materials(session, operands, lighting, options);
  session.end_progress();
  const Comparison& pair = result.combined;
  if (session.wants_json()) {
    print_json(session, operands, result, lighting, options);
  } else {
    session.print(format_estimate(pair.distance) + "\n");
  }
  for (const auto& product : result.unresolved) {
    session.warn(fmt::format("the product of '{}' and '{}' reached a relative error of {:.2g} instead of {}",
                             operands.at(product.first).material().name, operands.at(product.second).material().name,
                             product.relative_error, shortest(options.tolerance)));
  }
  session.remark(format_table({{"|A|", format_estimate(pair.norm_a)},
                               {"|B|", format_estimate(pair.norm_b)},
                               {"A.B", format_estimate(pair.product)},
                               {"angle/deg", fmt::format("{:.6g}", angle_deg(pair))}},
                              2, false));
  const bool is_above = pair.distance.value > limit;
  if (is_above && !arguments.has("quiet")) {
    write_error(fmt::format("lobe: the distance is above {}\n", shortest(limit)));
  }
  return is_above ? ExitCode::negative : ExitCode::success;
}

}  // namespace

Command distance_command() {
  return {.name = "distance",
          .group = "Materials",
          .summary = "how far two materials are apart",
          .description =
              "Prints the distance of two materials under a lighting and a bound on its error. With -v also "
              "their norms, their scalar product and the angle between them.\n"
              "Under 'point' light from every direction counts by itself. Under 'daylight' the sky is "
              "uniform and only the albedos count, so that different materials can be at distance 0.\n"
              "Tables are compared on the grid of the first one, materials beside them tabulated there; the error "
              "then includes that of the grid.",
          .positionals = {{.name = "A", .help = "the one material", .is_material = true},
                          {.name = "B", .help = "the other material", .is_material = true}},
          .options = {{.name = "lighting",
                       .value = "NAME",
                       .help = "point (default) or daylight",
                       .choices = {"point", "daylight"}},
                      tolerance_option("largest relative error of the scalar products (default 1e-6)"),
                      {.name = "fail-above", .value = "X", .help = "end with exit status 1 if the distance is above X"},
                      json_option()},
          .examples = {{"two highlights under point light", "lobe distance phong:n=20 ward:m=0.2"},
                       {"a check for a script: are they alike under daylight?",
                        "lobe distance lambert oren_nayar:sigma=0.1 --lighting daylight --fail-above 0.1"}},
          .execute = execute};
}

}  // namespace lobe::cli
