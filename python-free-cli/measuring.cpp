#include "measuring.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <numbers>

#include "core/text.hpp"
#include "lobe/chosen_file.hpp"
#include "lobe/error.hpp"
#include "lobe/function_metric.hpp"
#include "lobe/table_file.hpp"
#include "lobe/table_metric.hpp"
#include "reading.hpp"
#include "table_making.hpp"
#include "table_report.hpp"

namespace lobe::cli {
namespace {

std::string_view power_of_steradian(int halves) {
  constexpr std::array<std::string_view, 5> kPowers{"1", "sr^1/2", "sr", "sr^3/2", "sr^2"};
  return kPowers.at(static_cast<std::size_t>(halves));
}

/// All operands on one grid.
std::vector<BrdfTable> tables_on(Session& session, const Device& device, std::span<const Operand> operands,
                                 const HemisphereGrid& grid) {
  session.state_memory(tabulated_bytes(operands, grid));
  auto tables = tabulated(device, operands, grid, tabulate_options(session));
  for (auto& table : tables) {
    if (!(table.grid == grid)) table = resample(table, grid);
  }
  return tables;
}

BrdfFunction function_of(const Device& device, const Operand& operand) {
  return operand.is_foreign() ? operand.function() : as_function(device, operand.material());
}

void warn_that_unresolved(Session& session, const Operand& operand, const HemisphereGrid& grid) {
  session.warn(fmt::format("'{}' is not resolved by the grid {}", operand.label(), grid.name()));
}

std::vector<std::string> labels_of(std::span<const Operand> operands) {
  std::vector<std::string> labels;
  for (const auto& operand : operands) labels.push_back(operand.label());
  return labels;
}

/// A name, or "table:FILE".
Lighting read_lighting(const std::string& name) {
  constexpr std::string_view kTable = "table:";
  if (!name.starts_with(kTable)) return parse_lighting(name);
  const std::string text = name.substr(kTable.size());
  const ChosenFile file = parse_file(text);
  return Lighting::table(with_channels(load_table(file.path), file.options), text);
}

std::string text_of(const Figure& figure) {
  return std::isnan(figure.estimate.value) ? "undefined" : format_figure(figure);
}

/// What the standard deviations of samples make of the results, by rules that need be no finer than these are.
void add_deviations(Session& session, const Device& device, std::span<const Operand> operands, Measurement& measurement,
                    const std::vector<bool>& is_by_functions) {
  const auto functions = replicated(session, device, operands);
  if (functions.empty()) return;
  constexpr double kTolerance = 0.1;
  constexpr std::uint64_t kMostValues = 100'000'000;
  const MetricOptions& options = measurement.options;
  const std::size_t own = own_channels(functions);
  std::vector<BrdfTable> tables;
  if (std::ranges::any_of(is_by_functions, std::logical_not<>())) {
    std::uint64_t values = 0;
    for (const auto& function : functions) values += value_bytes(shape_of(function, *measurement.grid)) / 8;
    if (values > kMostValues) {
      session.warn("standard deviations of samples are not followed on so large a grid; give a smaller --grid");
      return;
    }
    for (const auto& function : functions) {
      tables.push_back(tabulate(function, *measurement.grid, {.allow_unresolved = true}));
    }
  }
  for (std::size_t k = 0; k < measurement.results.size(); ++k) {
    const Lighting& lighting = measurement.results[k].lighting;
    const MetricResult result =
        is_by_functions[k]
            ? measure(functions, lighting,
                      {.tolerance = kTolerance, .theta_max = options.theta_max, .progress = options.progress})
            : measure(device, tables, lighting, {.theta_max = options.theta_max, .progress = options.progress});
    measurement.deviations.push_back(metric_deviations(result, own, options.channel_weights));
  }
}

}  // namespace

Option domain_option() {
  return {.name = "domain-theta-max",
          .value = "DEGREES",
          .help = "take products over directions up to this angle from the normal, of light and of view (default 90)"};
}

double domain_of(const Arguments& arguments) {
  if (!arguments.has("domain-theta-max")) return MetricOptions{}.theta_max;
  const double degrees = arguments.number("domain-theta-max");
  if (!(degrees > 0 && degrees <= 90)) {
    throw ArgumentError(
        fmt::format("--domain-theta-max is {}; expected degrees above 0, at most 90", shortest(degrees)));
  }
  return degrees == 90 ? MetricOptions{}.theta_max : degrees * std::numbers::pi / 180;
}

std::optional<double> domain_degrees(double theta_max) {
  if (theta_max == MetricOptions{}.theta_max) return {};
  return std::round(theta_max * 180 / std::numbers::pi * 1e9) / 1e9;
}

std::vector<Option> measuring_options(bool takes_several_lightings) {
  std::vector<Option> options{
      {.name = "lighting",
       .value = "LIGHTING",
       .help = takes_several_lightings
                   ? "point (default), daylight, mean-albedo, patch:R, mixture:R=w,..., density:R=v,... or "
                     "table:FILE.h5; to be repeated, for a matrix each"
                   : "point (default), daylight, mean-albedo, patch:R, mixture:R=w,..., density:R=v,... or "
                     "table:FILE.h5"},
      domain_option(),
      tolerance_option("largest relative error of the scalar products (default 1e-6, of patch lights 1e-5)"),
      strict_option()};
  for (const auto& option : tabulation_options(
           "compare as tables on this grid, materials and files too (default: that of the first table)")) {
    options.push_back(option);
  }
  return options;
}

std::vector<Lighting> lightings_of(const Arguments& arguments) {
  std::vector<Lighting> lightings;
  for (const auto& name : arguments.texts("lighting")) {
    const Lighting lighting = read_lighting(name);
    if (std::ranges::find(lightings, lighting) != lightings.end()) {
      throw ArgumentError("--lighting " + name + " is given twice; give it once");
    }
    lightings.push_back(lighting);
  }
  if (lightings.empty()) lightings.push_back(Lighting::point());
  return lightings;
}

bool are_functions(std::span<const Operand> operands, const Lighting& lighting) {
  const auto is_function = [](const Operand& operand) {
    if (operand.is_table()) return operand.is_function();
    return std::ranges::none_of(operand.material().terms, [](const Term& term) { return traits_of(term).has_delta; });
  };
  return !takes_tables(lighting) && std::ranges::any_of(operands, &Operand::is_foreign) &&
         std::ranges::all_of(operands, is_function);
}

AnyMaterial content_under(Session& session, const Lighting& lighting, std::span<const Operand> operands) {
  const Operand& first = operands.front();
  if (!first.is_table()) return first.material();
  if (are_functions(operands, lighting)) return first.function();
  BrdfTable table = first.load();
  if (table.is_unresolved) warn_that_unresolved(session, first, table.grid);
  return table;
}

Measurement measured(Session& session, std::span<const Operand> operands, std::span<const Lighting> lightings,
                     std::vector<double> channel_weights) {
  Measurement measurement;
  MetricOptions& options = measurement.options;
  options.tolerance = session.tolerance(options.tolerance);
  options.patch_tolerance = session.tolerance(options.patch_tolerance);
  options.theta_max = domain_of(session.arguments());
  options.precision = session.precision();
  options.channel_weights = std::move(channel_weights);
  options.progress = session.progress();
  const bool has_grid = session.arguments().has("grid");
  const bool has_tables = std::ranges::any_of(operands, &Operand::is_table);
  const auto is_by_functions = [&](const Lighting& lighting) { return !has_grid && are_functions(operands, lighting); };
  const auto is_by_tables = [&](const Lighting& lighting) {
    return has_grid || lighting.kind() == Lighting::Kind::table || (has_tables && !is_by_functions(lighting));
  };
  const auto first_by_tables = std::ranges::find_if(lightings, is_by_tables);
  if (first_by_tables != lightings.end()) {
    // A tabulated W acts on tables, by default on its own grid.
    const bool has_own_grid = !has_grid && !has_tables;
    measurement.grid = has_own_grid ? first_by_tables->table().grid : common_grid(session.arguments(), operands);
  }
  const auto device = session.choose_device();
  measurement.device = device.info();

  std::vector<BrdfTable> tables;
  if (measurement.grid) tables = tables_on(session, device, operands, *measurement.grid);
  std::vector<BrdfFunction> functions;
  std::vector<Material> materials;
  for (const auto& operand : operands) {
    if (std::ranges::any_of(lightings, is_by_functions)) functions.push_back(function_of(device, operand));
    if (!operand.is_table()) materials.push_back(operand.material());
  }
  for (const auto& lighting : lightings) {
    if (is_by_functions(lighting)) {
      measurement.results.push_back(measure(functions, lighting,
                                            {.tolerance = session.tolerance(FunctionMetricOptions{}.tolerance),
                                             .channel_weights = options.channel_weights,
                                             .theta_max = options.theta_max,
                                             .progress = options.progress}));
    } else if (measurement.grid) {
      measurement.results.push_back(measure(
          device, tables, lighting,
          {.channel_weights = options.channel_weights, .theta_max = options.theta_max, .progress = options.progress}));
    } else {
      measurement.results.push_back(measure(device, materials, lighting, options));
    }
  }
  std::vector<bool> by_functions;
  for (const auto& lighting : lightings) by_functions.push_back(is_by_functions(lighting));
  add_deviations(session, device, operands, measurement, by_functions);
  session.end_progress();
  for (std::size_t i = 0; i < tables.size(); ++i) {
    if (!tables[i].is_unresolved) continue;
    warn_that_unresolved(session, operands[i], tables[i].grid);
  }
  for (const auto& result : measurement.results) {
    note_unresolved(session, result, labels_of(operands), tolerance_of(options, result.lighting));
  }
  return measurement;
}

double tolerance_of(const MetricOptions& options, const Lighting& lighting) {
  const bool has_patches = lighting.kind() == Lighting::Kind::patches;
  return has_patches ? std::max(options.tolerance, options.patch_tolerance) : options.tolerance;
}

void note_unresolved(Session& session, const MetricResult& result, std::span<const std::string> names,
                     double tolerance) {
  for (const auto& pair : result.unresolved) {
    session.note_missed({.quantity = fmt::format("{}: the product of '{}' and '{}'", result.lighting.name(),
                                                 names[pair.first], names[pair.second]),
                         .relative_error = pair.relative_error,
                         .tolerance = tolerance});
  }
}

void require_root(const Estimate& root, std::string_view what, const Estimate& square, const Lighting& lighting) {
  if (!std::isnan(root.value)) return;
  throw NumericError(
      fmt::format("the square of the {} under lighting '{}' is {}; norms, distances and angles want a positive "
                  "semi-definite W, 'lobe product' and 'lobe gram' take any",
                  what, lighting.name(), format_estimate(square)));
}

std::string_view product_unit(const Lighting& lighting) {
  return power_of_steradian(2 * lighting.product_power());
}

std::string_view norm_unit(const Lighting& lighting) {
  return power_of_steradian(lighting.product_power());
}

Json operand_json(const Operand& operand) {
  if (operand.is_foreign()) return function_json(operand.function());
  if (!operand.is_table()) return material_json(operand.material());
  Json json{{"name", operand.label()}};
  json.update(header_json(operand.header()));
  return json;
}

std::string domain_text(const Measurement& measurement) {
  const auto degrees = domain_degrees(measurement.options.theta_max);
  return degrees ? fmt::format("up to {} degrees", shortest(*degrees)) : "";
}

Json circumstances_json(const Measurement& measurement) {
  Json json;
  if (const auto degrees = domain_degrees(measurement.options.theta_max)) json["domain_theta_max_deg"] = *degrees;
  if (measurement.grid) json["grid"] = measurement.grid->name();
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
