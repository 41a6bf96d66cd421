#include "lobe/fit/fit.hpp"

#include <fmt/core.h>

#include <cmath>
#include <optional>
#include <span>
#include <variant>

#include "core/text.hpp"
#include "interface/command.hpp"
#include "interface/deviations.hpp"
#include "interface/measuring.hpp"
#include "interface/options.hpp"
#include "interface/output_file.hpp"
#include "interface/session.hpp"
#include "interface/terminal.hpp"
#include "lobe/core/directions.hpp"
#include "lobe/core/error.hpp"
#include "lobe/core/version.hpp"
#include "lobe/formats/measurement.hpp"
#include "lobe/plot/fit_pictures.hpp"
#include "lobe/study/material_file.hpp"

namespace lobe::cli {
namespace {

constexpr Text kFamily{"family"};
constexpr Number kFloor{"floor"};
constexpr Text kMetric{"metric"};
constexpr Text kObjective{"objective"};
constexpr Texts kRange{"range"};
constexpr Count kSearches{"searches"};
constexpr Texts kStart{"start"};

/// The request.
struct FitRequest {
  Operand target;
  Family family;
  FitOptions options;
};

/// "m=0.1" of --start, "m=0.01:1" of --range, apart.
std::pair<std::string, std::string_view> entry_of(std::string_view option, std::string_view text) {
  const std::size_t equals = text.find('=');
  if (equals == std::string_view::npos || equals == 0) {
    throw ArgumentError("cannot read '" + std::string(text) + "' in --" + std::string(option) +
                        "; expected PARAMETER=" + (option == "range" ? "LOWEST:HIGHEST" : "VALUE"));
  }
  return {std::string(trim(text.substr(0, equals))), trim(text.substr(equals + 1))};
}

std::vector<NamedValue> read_start(std::string_view text) {
  std::vector<NamedValue> values;
  for (const std::string_view part : split(text, ',')) {
    const auto [label, value] = entry_of("start", part);
    values.emplace_back(label, numbers_in(kStart, value).front());
  }
  return values;
}

FitRange read_range(std::string_view text) {
  const auto [label, value] = entry_of("range", text);
  const auto ends = split(value, ':');
  if (ends.size() != 2) {
    throw ArgumentError("cannot read '" + std::string(text) + "' in --range; expected PARAMETER=LOWEST:HIGHEST");
  }
  return {label, numbers_in(kRange, ends[0]).front(), numbers_in(kRange, ends[1]).front()};
}

FitRequest read_fit(Session& session) {
  const auto& arguments = session.arguments();
  FitRequest request{session.operand(argument::target), parse_family(arguments.text(kFamily)), {}};
  FitOptions& options = request.options;
  if (arguments.has(kObjective)) options.objective = parse_fit_objective(arguments.text(kObjective));
  const auto lightings = lightings_of(arguments);
  if (lightings.size() > 1) throw ArgumentError("--lighting is given more than once; give it once");
  options.lighting = lightings.front();
  if (arguments.has(kMetric)) {
    if (options.objective != FitObjective::log) {
      throw ArgumentError("--metric is of the objective 'log'; give --objective log, too");
    }
    options.metric = parse_literature_metric(arguments.text(kMetric));
  }
  if (arguments.has(option::tolerance)) options.tolerance = session.tolerance(0);
  if (arguments.has(kFloor)) options.radiance_floor = options.albedo_floor = arguments.number(kFloor);
  if (arguments.has(kSearches)) options.searches = arguments.count(kSearches);
  for (const auto& text : arguments.texts(kStart)) options.starts.push_back(read_start(text));
  for (const auto& text : arguments.texts(kRange)) options.ranges.push_back(read_range(text));
  options.theta_max = domain_of(arguments);
  options.precision = session.precision();
  options.progress = session.progress();
  return request;
}

/// The metric in which the residual is a distance.
std::string metric_name(const FitRequest& request) {
  const FitOptions& options = request.options;
  return options.objective == FitObjective::log ? std::string(to_string(options.metric)) : options.lighting.name();
}

std::string_view residual_unit(const FitRequest& request) {
  const FitOptions& options = request.options;
  return options.objective == FitObjective::log ? unit_of(options.metric) : norm_unit(options.lighting);
}

double degrees(double radians) {
  return to_degrees(radians);
}

/// \param deviation by the standard deviations of the target's samples, where these are known
std::string value_text(const FittedValue& value, std::optional<double> deviation) {
  if (value.at_bound) return shortest(value.value) + " (at its bound)";
  if (std::isnan(value.standard_error)) return fmt::format("{:.7g}", value.value);
  if (std::isinf(value.standard_error)) return fmt::format("{:.7g} (undetermined)", value.value);
  const std::string text = format_estimate({value.value, value.standard_error});
  return deviation ? text + fmt::format(" (fit) ± {:.2g} (measurement)", *deviation) : text;
}

std::optional<double> deviation_of(const std::vector<double>& deviations, std::size_t value) {
  return deviations.empty() ? std::nullopt : std::optional(deviations[value]);
}

std::string label_text(const FittedValue& value) {
  return value.channel ? fmt::format("{}[{}]", value.label, *value.channel) : value.label;
}

std::string place_text(const LargestError& error, bool is_albedo, const Operand& target) {
  std::string text =
      fmt::format("{} at theta_in {:.4g}", format_estimate(error.value), degrees(error.directions.theta_in));
  if (!is_albedo) {
    text += fmt::format(", theta_out {:.4g}, delta_phi {:.4g} degrees", degrees(error.directions.theta_out),
                        degrees(error.directions.delta_phi));
  } else {
    text += " degrees";
  }
  const auto labels = channel_labels(std::span(&target, 1));
  return labels.size() == 1 ? text : text + ", " + labels[error.channel];
}

/// Comments of the material file: where it comes from and how good it is.
std::string provenance(const Session& session, const FitRequest& request, const FitResult& result,
                       const std::vector<double>& deviations) {
  std::string text = session.command_line() + "\n" + fmt::format("lobe {} ({})\n", version(), commit());
  text +=
      fmt::format("{} fit of '{}' to '{}'\n", to_string(result.objective), request.family.name, request.target.label());
  text += fmt::format("relative residual ({}) {}\n", metric_name(request), format_estimate(result.relative_residual));
  if (result.errors) {
    text += "largest relative error of radiances " + place_text(result.errors->radiance, false, request.target) + "\n";
    text += "largest relative error of albedos " + place_text(result.errors->albedo, true, request.target) + "\n";
  }
  for (std::size_t j = 0; j < result.values.size(); ++j) {
    const FittedValue& value = result.values[j];
    text += fmt::format("  {} {}\n", label_text(value), value_text(value, deviation_of(deviations, j)));
  }
  return text;
}

Json matrix_json(const Eigen::MatrixXd& matrix) {
  Json rows = Json::array();
  for (const auto& row : matrix.rowwise()) {
    rows.push_back(Json::array());
    for (const double entry : row) rows.back().push_back(to_json(entry));
  }
  return rows;
}

Json error_json(const LargestError& error, bool is_albedo) {
  Json json = to_json(error.value);
  json["theta_in_deg"] = degrees(error.directions.theta_in);
  json["phi_in_deg"] = degrees(error.directions.phi_in);
  if (!is_albedo) {
    json["theta_out_deg"] = degrees(error.directions.theta_out);
    json["delta_phi_deg"] = degrees(error.directions.delta_phi);
  }
  json["channel"] = error.channel;
  return json;
}

Json answer_json(const FitRequest& request, const FitResult& result, const std::vector<double>& deviations) {
  Json json = json_answer("fit");
  if (const Material* formula = request.target.shape().formula()) {
    json["target"] = material_json(*formula);
  } else {
    json["target"] = {{request.target.shape().function() != nullptr ? "file" : "table", request.target.label()}};
  }
  json["family"] = request.family.name;
  json["objective"] = to_string(result.objective);
  json["metric"] = metric_name(request);
  if (const auto degrees = domain_degrees(request.options.theta_max)) json["domain_theta_max_deg"] = *degrees;
  json["specification"] = result.material.name;
  json["values"] = Json::array();
  for (const FittedValue& value : result.values) {
    Json entry{{"label", value.label}};
    if (value.channel) entry["channel"] = *value.channel;
    entry["value"] = to_json(value.value);
    if (!std::isnan(value.standard_error)) entry["standard_error"] = to_json(value.standard_error);
    if (const auto deviation = deviation_of(deviations, json["values"].size())) {
      entry["measurement"] = to_json(*deviation);
    }
    entry["minimum"] = to_json(value.minimum);
    entry["maximum"] = to_json(value.maximum);
    entry["at_bound"] = value.at_bound;
    json["values"].push_back(std::move(entry));
  }
  if (result.covariance.size() > 0) {
    json["covariance"] = matrix_json(result.covariance);
    json["correlation"] = matrix_json(correlation(result.covariance));
  }
  json["units"] = {{"residual", residual_unit(request)}};
  json["target_norm"] = to_json(result.target_norm);
  json["residual"] = to_json(result.residual);
  json["relative_residual"] = to_json(result.relative_residual);
  if (result.errors) {
    json["largest_errors"] = {{"radiance", error_json(result.errors->radiance, false)},
                              {"albedo", error_json(result.errors->albedo, true)},
                              {"floor", request.options.radiance_floor}};
  }
  json["minima"] = Json::array();
  for (const double minimum : result.minima) json["minima"].push_back(to_json(minimum));
  json["starting_points"] = result.starting_points;
  json["evaluations"] = result.evaluations;
  json["converged"] = result.converged;
  json["material"] = material_json(result.material);
  return json;
}

void print_text(Session& session, const FitRequest& request, const FitResult& result,
                const std::vector<double>& deviations) {
  std::vector<std::vector<std::string>> values{{"value", "found"}};
  for (std::size_t j = 0; j < result.values.size(); ++j) {
    const FittedValue& value = result.values[j];
    values.push_back({label_text(value), value_text(value, deviation_of(deviations, j))});
  }
  std::vector<std::vector<std::string>> rows{
      {"residual (" + metric_name(request) + ")", format_estimate(result.residual)},
      {"relative residual", format_estimate(result.relative_residual)}};
  if (result.errors) {
    rows.push_back({"largest error of radiances", place_text(result.errors->radiance, false, request.target)});
    rows.push_back({"largest error of albedos", place_text(result.errors->albedo, true, request.target)});
  }
  rows.push_back({"materials compared", std::to_string(result.evaluations)});
  session.print(result.material.name + "\n\n" + format_table(values, 2, session.colors_output()) + "\n" +
                format_table(rows, 2, false));
}

PictureFiles draw(const Session& session, const Device& device, const Reflectance& target, const FitResult& result) {
  const auto& arguments = session.arguments();
  const TablePictureOptions options{.overwrite = arguments.has(option::force)};
  const std::filesystem::path directory = arguments.text(option::plot);
  const std::string stem = fmt::format("fit.{}", to_string(result.objective));
  return write_fit_pictures(device, target, result, directory, stem, options);
}

/// Standard deviations of the values, as caused by those of the target's samples; none if it states none.
std::vector<double> deviations_of(Session& session, const Device& device, const FitRequest& request,
                                  const FitResult& result) {
  if (!state_deviations({&request.target, 1})) return {};
  if (result.objective != FitObjective::l2 || result.route != Route::functions) {
    session.warn(
        "standard deviations of samples are followed by --objective l2 under point, daylight and mean-albedo "
        "light only");
    return {};
  }
  const auto replicates = replicated(session, {&request.target, 1});
  if (replicates.empty()) return {};
  return fit_deviations(device, replicates.front(), request.family, result, request.options);
}

void warn_of_doubts(Session& session, const FitResult& result) {
  if (!result.converged) {
    session.warn_of_miss("the search ended before it converged; try other --start values, a --range or another family");
  }
  for (const FittedValue& value : result.values) {
    if (!value.is_scale && value.at_bound) {
      session.warn("'" + value.label + "' is at its bound " + shortest(value.value));
    } else if (std::isinf(value.standard_error)) {
      session.warn("the target does not determine '" + label_text(value) + "'");
    }
  }
}

ExitCode execute_fit(Session& session) {
  const FitRequest request = read_fit(session);
  const OutputFile output(session);
  if (output.is_wanted() && output.path().extension() != ".toml") {
    throw ArgumentError("--output " + output.path().string() + " is no name of a material file; expected FILE.toml");
  }
  const auto device = session.choose_device();
  const Reflectance target = request.target.reflectance();
  const FitResult result = fit(device, target, request.family, request.options);
  if (result.is_coarse) note_coarse(session, request.target, *result.grid, device);
  if (InterruptWatch::interrupted()) throw Cancelled("interrupted");
  const std::vector<double> deviations = deviations_of(session, device, request, result);
  output.write(output.is_wanted() ? material_toml(result.material, provenance(session, request, result, deviations))
                                  : "");
  PictureFiles pictures;
  if (session.arguments().has(option::plot)) pictures = draw(session, device, target, result);
  session.end_progress();
  if (!pictures.note.empty()) session.warn(pictures.note);
  warn_of_doubts(session, result);
  if (request.options.tolerance) {
    session.note_if_missed("the residual", {result.target_norm.value, result.residual.error},
                           *request.options.tolerance);
  }
  if (session.wants_json()) {
    Json json = answer_json(request, result, deviations);
    if (output.is_wanted()) json["file"] = output.path().string();
    if (session.arguments().has(option::plot)) {
      json["pictures"] = Json::array();
      for (const auto& picture : pictures.pictures) json["pictures"].push_back(picture.lexically_normal().string());
    }
    json["precision"] = to_string(request.options.precision);
    json["device"] = to_json(device.info());
    session.print_json(json);
  } else {
    print_text(session, request, result, deviations);
    for (const auto& picture : pictures.pictures) {
      session.print(fmt::format("picture: {}\n", picture.lexically_normal().string()));
    }
  }
  return ExitCode::success;
}

}  // namespace

Command fit_command() {
  return {
      .name = "fit",
      .group = "Materials",
      .summary = "fit a family's parameters to a target",
      .description =
          "Finds the member of a material family that is nearest to the target. It varies the scales of the terms (at "
          "least 0, per channel) and the parameters of the models (shared by all channels). Prints the best member as "
          "a specification, the fitted values with standard errors, and the remaining distance.\n"
          "A family is written as a material with values left out: 'lambert+ward' leaves two scales and the parameter "
          "m to find. Values that are given are fixed; 'f0=free' frees a parameter that has a default. If several "
          "terms have a parameter of the same name, its term is named, too: '2.m'.\n"
          "Objectives: 'l2' minimises the distance under the lighting; 'log' minimises a distance from the literature "
          "(--metric), by default one of logarithms; 'perceptual' minimises the largest relative error of radiances "
          "under a point light and of albedos at once.\n"
          "For a table, and for log of a measured file, members of the family are tabulated on its grid as far as the "
          "grid resolves them. The standard error is how far a value may move, with the others following, until the "
          "squared residual has doubled.",
      .positionals = {{.handle = argument::target,
                       .help = "the material, measurement or table to fit",
                       .is_material = true}},
      .options =
          {{.handle = kFamily,
            .value = "FAMILY",
            .help = "the family to fit, for example lambert+ward",
            .required = true},
           {.handle = kObjective,
            .value = "NAME",
            .help = "the quantity to minimise: l2 (default), log or perceptual",
            .choices = {"l2", "log", "perceptual"}},
           {.handle = option::lighting,
            .value = "LIGHTING",
            .help = "lighting for l2, as for 'distance' (default: point)"},
           domain_option(),
           {.handle = kMetric,
            .value = "METRIC",
            .help = "metric for log: bieron-log (default), low-log, standard-log, log-relative, ngan-l2, low-l2, "
                    "bieron-l2 or cube-root-l2"},
           {.handle = kFloor,
            .value = "X",
            .help = "for perceptual: errors of radiances and albedos below X are relative to X (default 0.001)"},
           {.handle = kStart,
            .value = "NAME=X,...",
            .help = "start only from these values, one for each parameter; may be repeated"},
           {.handle = kRange, .value = "NAME=X:Y", .help = "bounds of a parameter; may be repeated"},
           {.handle = kSearches, .value = "N", .help = "how many of the best starting points to follow (default 3)"},
           tolerance_option("largest relative error of the distances (default 1e-6; log: 1e-3)"),
           strict_option(),
           {.handle = option::output, .letter = 'o', .value = "FILE.toml", .help = "write the fit as a material file"},
           {.handle = option::plot, .value = "DIR", .help = "draw target, fit and residual into this directory"},
           {.handle = option::force, .letter = 'f', .help = "replace existing files"},
           json_option()},
      .examples = {{"a metal as a diffuse part and Ward's highlight",
                    "lobe fit cook_torrance:m=0.3 --family lambert+ward -o fit.toml"},
                   {"the smallest relative errors, as the eye may see them",
                    "lobe fit cook_torrance:m=0.3 --family ggx --objective perceptual"}},
      .execute = execute_fit};
}

}  // namespace lobe::cli
