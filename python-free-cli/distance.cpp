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
#include "session.hpp"
#include "terminal.hpp"

namespace lobe::cli {
namespace {

constexpr double kDegreesPerRadian = 180 / std::numbers::pi;

/// Angle between the two materials as vectors, in degrees; NaN when one of them is zero under the lighting. Taken from
/// the chord between the normalised vectors, which does not cancel for near-parallel ones.
double angle_deg(const Metric& metric) {
  const double norms = metric.norm(0) * metric.norm(1);
  if (!(norms > 0)) return std::numeric_limits<double>::quiet_NaN();
  const double distance = metric.distance(0, 1);
  const double difference = metric.norm(0) - metric.norm(1);
  const double chord = std::sqrt(std::max(0.0, (distance - difference) * (distance + difference) / norms));
  return 2 * std::asin(std::min(1.0, chord / 2)) * kDegreesPerRadian;
}

Json metric_json(const Metric& metric) {
  return {{"distance", to_json(Estimate{metric.distance(0, 1), metric.distance_error(0, 1)})},
          {"norm_a", to_json(Estimate{metric.norm(0), metric.norm_error(0)})},
          {"norm_b", to_json(Estimate{metric.norm(1), metric.norm_error(1)})},
          {"product", to_json(Estimate{metric.gram(0, 1), metric.gram_error(0, 1)})},
          {"angle_deg", to_json(angle_deg(metric))}};
}

ExitCode execute(Session& session) {
  const auto& arguments = session.arguments();
  const std::array materials{session.material("A"), session.material("B")};
  const auto lighting = arguments.has("lighting") ? parse_lighting(arguments.text("lighting")) : Lighting::point;
  const double limit =
      arguments.has("fail-above") ? arguments.number("fail-above") : std::numeric_limits<double>::infinity();
  MetricOptions options;
  options.tolerance = session.tolerance(options.tolerance);
  options.precision = session.precision();
  options.progress = session.progress();
  const auto device = session.choose_device();

  const InterruptWatch watch;
  const auto result = measure(device, materials, lighting, options);
  session.end_progress();
  const Metric& metric = result.combined;
  const Estimate distance{metric.distance(0, 1), metric.distance_error(0, 1)};
  const bool is_above = distance.value > limit;
  const bool is_point = lighting == Lighting::point;

  if (session.wants_json()) {
    Json answer = json_answer("distance");
    answer["a"] = material_json(materials[0]);
    answer["b"] = material_json(materials[1]);
    answer["lighting"] = lobe::to_string(lighting);
    answer["tolerance"] = options.tolerance;
    answer["units"] = {{"distance", is_point ? "1" : "sr^1/2"},
                       {"norm", is_point ? "1" : "sr^1/2"},
                       {"product", is_point ? "1" : "sr"}};
    answer.update(metric_json(metric));
    if (!result.channels.empty()) {
      answer["channels"] = Json::array();
      for (const auto& channel : result.channels) answer["channels"].push_back(metric_json(channel));
    }
    answer["reached_tolerance"] = result.unresolved.empty();
    if (arguments.has("fail-above")) {
      answer["fail_above"] = to_json(limit);
      answer["is_above"] = is_above;
    }
    answer["precision"] = to_string(options.precision);
    answer["device"] = to_json(device.info());
    session.print_json(answer);
  } else {
    session.print(format_estimate(distance) + "\n");
  }

  for (const auto& pair : result.unresolved) {
    session.warn(fmt::format("the product of '{}' and '{}' reached a relative error of {:.2g} instead of {}",
                             materials.at(pair.first).name, materials.at(pair.second).name, pair.relative_error,
                             shortest(options.tolerance)));
  }
  session.remark(format_table({{"|A|", format_estimate({metric.norm(0), metric.norm_error(0)})},
                               {"|B|", format_estimate({metric.norm(1), metric.norm_error(1)})},
                               {"A.B", format_estimate({metric.gram(0, 1), metric.gram_error(0, 1)})},
                               {"angle/deg", fmt::format("{:.6g}", angle_deg(metric))}},
                              2, false));
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
              "uniform and only the albedos count, so that different materials can be at distance 0.",
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
