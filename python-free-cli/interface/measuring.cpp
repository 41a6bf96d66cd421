#include "interface/measuring.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include "core/text.hpp"
#include "interface/options.hpp"
#include "interface/reading.hpp"
#include "interface/table_making.hpp"
#include "interface/table_report.hpp"
#include "lobe/algebra/spectrum.hpp"
#include "lobe/core/directions.hpp"
#include "lobe/core/error.hpp"
#include "lobe/formats/chosen_file.hpp"
#include "lobe/hdf5/table_file.hpp"

namespace lobe::cli {
namespace {

std::vector<std::string> labels_of(std::span<const Operand> operands) {
  std::vector<std::string> labels;
  for (const auto& operand : operands) labels.push_back(operand.label());
  return labels;
}

/// A name, "table:FILE" or "material:FILE".
Lighting read_lighting(const std::string& name) {
  constexpr std::string_view kTable = "table:";
  constexpr std::string_view kMaterial = "material:";
  if (name.starts_with(kMaterial) && names_file(name.substr(kMaterial.size()))) {
    const std::string text = name.substr(kMaterial.size());
    return Lighting::material(Operand(text).reflectance(), text);
  }
  if (!name.starts_with(kTable)) return parse_lighting(name);
  const std::string text = name.substr(kTable.size());
  const ChosenFile file = parse_file(text);
  refuse_adjustments(file);
  return Lighting::table(with_channels(load_table(file.path), file.options), text);
}

std::string text_of(const Figure& figure) {
  return std::isnan(figure.estimate.value) ? "undefined" : format_figure(figure);
}

/// Adds the standard deviations of the results, as caused by those of the samples, by rules that need be no finer.
void add_deviations(Session& session, std::span<const Operand> operands, Measurement& measurement) {
  const auto functions = replicated(session, operands);
  if (functions.empty()) return;
  constexpr double kTolerance = 0.1;
  constexpr std::uint64_t kMostValues = 100'000'000;
  const std::size_t own = own_channels(functions);
  const auto is_by_tables = [](const MetricResult& result) { return result.route == Route::tables; };
  if (std::ranges::any_of(measurement.results, is_by_tables)) {
    std::uint64_t values = 0;
    for (const auto& function : functions) values += value_bytes(shape_of(function, *measurement.grid)) / 8;
    if (values > kMostValues) {
      session.warn("standard deviations of samples are not followed on so large a grid; give a smaller --grid");
      return;
    }
  }
  MetricOptions options = measurement.options;
  const std::vector<double> weights = std::exchange(options.channel_weights, {});
  options.function_tolerance = kTolerance;
  options.allow_unresolved = true;
  options.cell_points = TabulateOptions{}.cell_points;
  for (const MetricResult& own_result : measurement.results) {
    options.route = is_by_tables(own_result) ? Route::tables : Route::functions;
    options.grid = own_result.grid;
    measurement.deviations.push_back(
        metric_deviations(measure(session.device(), functions, own_result.lighting, options), own, weights));
  }
}

/// Tells of a tabulated lighting that is not positive semi-definite, whatever is measured under it. Larger tables take
/// longer than what is asked for.
void warn_if_indefinite(Session& session, const Device& device, const Lighting& lighting) {
  constexpr std::size_t kMostRows = 2048;
  constexpr double kRounding = 1e-12;
  if (!lighting.has_table() || lighting.table().rows() > kMostRows) return;
  const BrdfTable w = lighting_table(device, lighting, lighting.table().grid);
  const ChannelSpectrum values = spectrum(device, w, {.refine = false}).channels.front();
  const Estimate& least = values.smallest;
  if (!(least.value < -kRounding * values.norm.value) || least.value + least.error >= 0) return;
  session.warn(
      fmt::format("W of '{}' is not positive semi-definite, its smallest eigenvalue is {}; squares of norms and "
                  "distances may be negative",
                  lighting.name(), format_estimate(least)));
}

}  // namespace

Option domain_option() {
  return {.handle = option::domain_theta_max,
          .value = "DEGREES",
          .help = "largest angle of light and view from the normal in products (default 90)"};
}

double domain_of(const Arguments& arguments) {
  if (!arguments.has(option::domain_theta_max)) return MetricOptions{}.theta_max;
  const double degrees = arguments.number(option::domain_theta_max);
  if (!(degrees > 0 && degrees <= 90)) {
    throw ArgumentError(
        fmt::format("--domain-theta-max is {}; expected degrees above 0, at most 90", shortest(degrees)));
  }
  return degrees == 90 ? MetricOptions{}.theta_max : degrees * kDegree;
}

std::optional<double> domain_degrees(double theta_max) {
  if (theta_max == MetricOptions{}.theta_max) return {};
  return std::round(to_degrees(theta_max) * 1e9) / 1e9;
}

std::vector<Option> measuring_options(bool takes_several_lightings) {
  std::vector<Option> options{
      {.handle = option::lighting,
       .value = "LIGHTING",
       .help = takes_several_lightings
                   ? "point (default), daylight, mean-albedo, patch:R, mixture:R=w,..., density:R=v,..., "
                     "material:MATERIAL or table:FILE.h5; may be repeated, for one matrix each"
                   : "point (default), daylight, mean-albedo, patch:R, mixture:R=w,..., density:R=v,..., "
                     "material:MATERIAL or table:FILE.h5"},
      domain_option(),
      tolerance_option("largest relative error of the scalar products (default 1e-6, for patch lights 1e-5)")};
  for (const auto& option : tabulation_options(
           "compare as tables on this grid, materials and files too (default: that of the first table, else as "
           "fine as they need)")) {
    options.push_back(option);
  }
  return options;
}

std::vector<Lighting> lightings_of(const Arguments& arguments) {
  std::vector<Lighting> lightings;
  for (const auto& name : arguments.texts(option::lighting)) {
    const Lighting lighting = read_lighting(name);
    if (std::ranges::find(lightings, lighting) != lightings.end()) {
      throw ArgumentError("--lighting " + name + " is given twice; give it once");
    }
    lightings.push_back(lighting);
  }
  if (lightings.empty()) lightings.push_back(Lighting::point());
  return lightings;
}

void note_coarse(Session& session, const Operand& operand, const HemisphereGrid& grid, const Device& device) {
  session.note_coarse(grid, operand.label(), resolution_needed(device, operand.shape(), grid));
}

Measurement measured(Session& session, std::span<const Operand> operands, std::span<const Lighting> lightings,
                     std::vector<double> channel_weights, bool allow_infinite) {
  Measurement measurement;
  MetricOptions& options = measurement.options;
  const TabulateOptions tabulation = tabulate_options(session);
  options.tolerance = session.tolerance(options.tolerance);
  options.patch_tolerance = session.tolerance(options.patch_tolerance);
  options.function_tolerance = session.tolerance(options.function_tolerance);
  options.theta_max = domain_of(session.arguments());
  options.precision = session.precision();
  options.channel_weights = std::move(channel_weights);
  options.progress = session.progress();
  options.grid = given_grid(session.arguments());
  options.allow_unresolved = tabulation.allow_unresolved;
  options.cell_points = tabulation.cell_points;
  options.allow_infinite = allow_infinite;
  std::vector<Reflectance> reflectances;
  for (const auto& operand : operands) reflectances.push_back(operand.shape());
  const auto device = session.choose_device();
  for (const auto& lighting : lightings) {
    const auto choice = choose_route(reflectances, lighting, options);
    if (!choice.grid || measurement.grid) continue;
    const bool is_refined = !options.grid && !choice.is_first_grid;
    measurement.grid =
        is_refined ? resolving_grid(device, reflectances, *choice.grid, TableUse::values, tabulation) : choice.grid;
  }
  measurement.device = device.info();
  if (measurement.grid) session.state_memory(tabulated_bytes(operands, *measurement.grid));
  std::ranges::transform(operands, reflectances.begin(), &Operand::reflectance);
  measurement.results = measure(device, reflectances, lightings, options);
  if (lightings.size() == 1) measurement.grid = measurement.results.front().grid;
  add_deviations(session, operands, measurement);
  session.end_progress();
  std::vector<bool> is_coarse(operands.size(), false);
  for (const auto& result : measurement.results) {
    for (const std::size_t i : result.coarse) {
      if (!is_coarse[i]) note_coarse(session, operands[i], *result.grid, device);
      is_coarse[i] = true;
    }
  }
  for (const auto& lighting : lightings) warn_if_indefinite(session, device, lighting);
  for (const auto& result : measurement.results) {
    note_unresolved(session, result, labels_of(operands));
    // By other routes nothing is listed; errors count where a tolerance is asked for.
    const bool is_wanted = session.arguments().has(option::tolerance) && result.route != Route::formulas;
    if (is_wanted) note_errors(session, result, labels_of(operands));
  }
  return measurement;
}

void note_errors(Session& session, const MetricResult& result, std::span<const std::string> names) {
  const Metric& metric = result.combined;
  for (Eigen::Index i = 0; i < metric.gram.rows(); ++i) {
    for (Eigen::Index j = i; j < metric.gram.cols(); ++j) {
      const double size = std::sqrt(std::abs(metric.gram(i, i) * metric.gram(j, j)));
      session.note_if_missed(fmt::format("{}: the product of '{}' and '{}'", result.lighting.name(),
                                         names[static_cast<std::size_t>(i)], names[static_cast<std::size_t>(j)]),
                             {size, metric.gram_error(i, j)}, result.tolerance);
    }
  }
}

void note_unresolved(Session& session, const MetricResult& result, std::span<const std::string> names) {
  for (const auto& pair : result.unresolved) {
    session.note_missed({.quantity = fmt::format("{}: the product of '{}' and '{}'", result.lighting.name(),
                                                 names[pair.first], names[pair.second]),
                         .relative_error = pair.relative_error,
                         .tolerance = result.tolerance});
  }
}

void require_root(const Estimate& root, std::string_view what, const Estimate& square, const Lighting& lighting) {
  if (!std::isnan(root.value)) return;
  throw NumericError(
      fmt::format("the square of the {} under lighting '{}' is {}; norms, distances and angles want a positive "
                  "semi-definite W, 'lobe product' and 'lobe gram' take any",
                  what, lighting.name(), format_estimate(square)));
}

std::string domain_text(const Measurement& measurement) {
  const auto degrees = domain_degrees(measurement.options.theta_max);
  return degrees ? fmt::format("up to {} degrees", shortest(*degrees)) : "";
}

Json circumstances_json(const Measurement& measurement) {
  Json json;
  if (const auto degrees = domain_degrees(measurement.options.theta_max)) json["domain_theta_max_deg"] = *degrees;
  if (measurement.grid) json["grid"] = measurement.grid->name();
  // One for all lightings where they share it.
  Json routes = Json::array();
  for (const auto& result : measurement.results) routes.push_back(to_string(result.route));
  const bool is_common = std::ranges::all_of(routes, [&](const Json& route) { return route == routes.front(); });
  json["route"] = is_common ? routes.front() : routes;
  json["precision"] = to_string(measurement.options.precision);
  json["device"] = to_json(measurement.device);
  return json;
}

std::string channels_text(const Figure& combined, std::span<const Figure> channels, std::span<const Operand> operands,
                          const Measurement& measurement) {
  const std::string domain = domain_text(measurement);
  if (channels.empty()) return text_of(combined) + (domain.empty() ? "" : ", " + domain) + "\n";
  const auto labels = channel_labels(operands);
  std::vector<Field> fields{{"combined", text_of(combined)}};
  for (std::size_t c = 0; c < channels.size(); ++c) fields.push_back({labels[c], text_of(channels[c])});
  if (!domain.empty()) fields.push_back({"directions", domain});
  return fields_text(fields);
}

}  // namespace lobe::cli
