#include <fmt/core.h>

#include <numbers>

#include "command.hpp"
#include "core/text.hpp"
#include "lobe/energy.hpp"
#include "lobe/error.hpp"
#include "session.hpp"

namespace lobe::cli {
namespace {

constexpr double kRadiansPerDegree = std::numbers::pi / 180;

/// Angles of incidence in degrees; none without --theta.
std::vector<double> incidence_angles(const Arguments& arguments) {
  if (!arguments.has("theta")) return {};
  auto angles = arguments.numbers("theta");
  for (const double angle : angles) {
    if (!(angle >= 0 && angle < 90)) {
      throw ArgumentError(
          fmt::format("--theta {} is out of range; expected at least 0 and less than 90 degrees", shortest(angle)));
    }
  }
  return angles;
}

Json channels_json(const std::vector<Estimate>& channels) {
  Json json = Json::array();
  for (const auto& estimate : channels) json.push_back(to_json(estimate));
  return json;
}

ExitCode execute(Session& session) {
  const auto& arguments = session.arguments();
  const auto degrees = incidence_angles(arguments);
  const bool wants_mean = arguments.has("mean");
  if (degrees.empty() && !wants_mean) {
    throw ArgumentError("nothing to compute; give angles of incidence by --theta 0,30,60, or --mean, or both");
  }
  const AlbedoOptions options{.tolerance = session.tolerance(AlbedoOptions{}.tolerance),
                              .precision = session.precision()};
  const auto material = session.material("MATERIAL");
  const auto device = session.choose_device();

  // rows[i][channel]: one row per angle, then the mean.
  std::vector<std::vector<Estimate>> rows(degrees.size());
  if (!degrees.empty()) {
    std::vector<double> radians = degrees;
    for (double& angle : radians) angle *= kRadiansPerDegree;
    for (const auto& channel : albedo(device, material, radians, options)) {
      for (std::size_t i = 0; i < rows.size(); ++i) rows[i].push_back(channel[i]);
    }
  }
  if (wants_mean) rows.push_back(mean_albedo(device, material, options));

  if (session.wants_json()) {
    Json answer = json_answer("albedo");
    answer["material"] = material_json(material);
    answer["tolerance"] = options.tolerance;
    answer["units"] = {{"angles", "deg"}, {"albedo", "1"}};
    answer["albedos"] = Json::array();
    for (std::size_t i = 0; i < degrees.size(); ++i) {
      answer["albedos"].push_back({{"theta_deg", degrees[i]}, {"albedo", channels_json(rows[i])}});
    }
    if (wants_mean) answer["mean_albedo"] = channels_json(rows.back());
    answer["precision"] = to_string(options.precision);
    answer["device"] = to_json(device.info());
    session.print_json(answer);
    return ExitCode::success;
  }
  const std::size_t channels = rows.front().size();
  std::vector<std::vector<std::string>> table{{"theta/deg"}};
  for (std::size_t channel = 0; channel < channels; ++channel) {
    table.front().push_back(channels == 1 ? "albedo" : fmt::format("albedo_{}", channel));
  }
  for (std::size_t i = 0; i < rows.size(); ++i) {
    table.push_back({i < degrees.size() ? shortest(degrees[i]) : "mean"});
    for (const auto& estimate : rows[i]) table.back().push_back(format_estimate(estimate));
  }
  session.print(format_table(table, 0, session.colors_output()));
  return ExitCode::success;
}

}  // namespace

Command albedo_command() {
  return {.name = "albedo",
          .group = "Materials",
          .summary = "share of light that a material reflects",
          .description =
              "Prints the albedo, per channel, for light from the given angles of incidence (in degrees from "
              "the surface normal), each with a bound on its error. With --mean also the mean albedo under "
              "diffuse light.",
          .positionals = {{.name = "MATERIAL", .help = "the material to integrate", .is_material = true}},
          .options = {{.name = "theta",
                       .value = "A",
                       .help = "angle of incidence, at least 0 and below 90, or a list 0,30,60"},
                      {.name = "mean", .help = "the cosine-weighted mean over all angles of incidence"},
                      tolerance_option("largest relative error (default 1e-6)"),
                      json_option()},
          .examples = {{"a metal from normal to grazing incidence", "lobe albedo ward:m=0.2 --theta 0,30,60,80,89"},
                       {"the mean of a rough diffuse surface", "lobe albedo oren_nayar:sigma=0.5 --mean"}},
          .execute = execute};
}

}  // namespace lobe::cli
