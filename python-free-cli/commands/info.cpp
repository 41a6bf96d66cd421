#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <filesystem>
#include <numbers>

#include "core/text.hpp"
#include "interface/memory.hpp"
#include "interface/operand.hpp"
#include "interface/options.hpp"
#include "interface/reading.hpp"
#include "interface/session.hpp"
#include "interface/study_info.hpp"
#include "interface/table_making.hpp"
#include "interface/table_report.hpp"
#include "interface/terminal.hpp"
#include "interface/values_report.hpp"
#include "lobe/algebra/algebra.hpp"
#include "lobe/core/directions.hpp"
#include "lobe/core/error.hpp"
#include "lobe/energy/albedo.hpp"
#include "lobe/formats/chosen_file.hpp"
#include "lobe/hdf5/file_summary.hpp"
#include "lobe/hdf5/table_file.hpp"
#include "lobe/model/model.hpp"
#include "lobe/study/study_results.hpp"
#include "lobe/table/cell_error.hpp"

namespace lobe::cli {
namespace {

namespace fs = std::filesystem;

/// The largest value of a channel's smooth part and where it is, in degrees.
struct Peak {
  double value = 0;
  Directions degrees;
};

/// Directions that a value of a channel belongs to, in degrees.
Directions place_of(const BrdfTable& table, std::size_t index) {
  const std::size_t rows = table.rows();
  if (table.form == TableForm::general) {
    const Direction in = table.grid.directions()[index / rows];
    const Direction out = table.grid.directions()[index % rows];
    const double delta_phi = std::abs(std::remainder(out.phi - in.phi, 2 * std::numbers::pi));
    return {to_degrees(in.theta), to_degrees(out.theta), to_degrees(delta_phi)};
  }
  const std::size_t half = table.grid.half_azimuths();
  return {row_theta_deg(table, index / half / rows), row_theta_deg(table, index / half % rows),
          360.0 * static_cast<double>(index % half) / static_cast<double>(table.grid.n_phi())};
}

Peak peak_of(const BrdfTable& table, std::size_t channel) {
  const auto values = table.channel(channel);
  const auto largest = std::ranges::max_element(values);
  return {*largest, place_of(table, static_cast<std::size_t>(largest - values.begin()))};
}

std::string peak_text(const Peak& peak) {
  return fmt::format("{:.6g} sr^-1 at theta_in {:.1f}°, theta_out {:.1f}°, delta_phi {:.1f}°", peak.value,
                     peak.degrees.theta_in, peak.degrees.theta_out, peak.degrees.delta_phi);
}

Json peak_json(const Peak& peak) {
  return {{"brdf", to_json(peak.value)},
          {"theta_in_deg", peak.degrees.theta_in},
          {"theta_out_deg", peak.degrees.theta_out},
          {"delta_phi_deg", peak.degrees.delta_phi}};
}

/// "hold", "violated by 0.01 at 30.0° (error bar 0.002)".
std::string check_text(const BoundCheck& check) {
  if (check.excess <= 1e-12) return "hold";
  const std::string where = std::isnan(check.theta) ? "" : fmt::format(" at {:.1f}°", to_degrees(check.theta));
  const std::string bar = std::isnan(check.error) ? "unknown" : fmt::format("{:.2g}", check.error);
  const std::string verdict = check.is_violated()       ? "violated by"
                              : std::isnan(check.error) ? "undecided: missed by"
                                                        : "hold within the error: missed by";
  return fmt::format("{} {:.2g}{} (error bar {})", verdict, check.excess, where, bar);
}

Json bound_json(const BoundCheck& check) {
  Json json{{"name", check.name},
            {"channel", check.channel},
            {"is_violated", check.is_violated()},
            {"excess", to_json(check.excess)},
            {"error", to_json(check.error)}};
  if (!std::isnan(check.theta)) json["theta_deg"] = to_degrees(check.theta);
  return json;
}

void append(std::vector<Field>& fields, const std::vector<Field>& more) {
  fields.insert(fields.end(), more.begin(), more.end());
}

/// Analysis of a table's values.
struct Analysis {
  explicit Analysis(const BrdfTable& table)
      : albedos(row_albedos(table)),
        bounds(check_bounds(table, albedos)),
        relative(relative_error(table)),
        cells(is_constant_on_cells(table) ? cell_error(table) : std::vector<double>()) {
    for (std::size_t c = 0; c < table.channels; ++c) peaks.push_back(peak_of(table, c));
  }

  [[nodiscard]] bool is_plausible() const { return std::ranges::none_of(bounds, &BoundCheck::is_violated); }

  [[nodiscard]] std::vector<Field> fields(const BrdfTable& table) const {
    std::vector<Field> fields{{"relative error", relative_text(relative)}};
    for (std::size_t c = 0; c < cells.size(); ++c) {
      fields.push_back({channel_name("cell error", table, c),
                        relative_text(cells[c]) + " of the values, where a continuous reflectance is meant"});
    }
    append(fields, albedo_fields(table, albedos));
    for (std::size_t c = 0; c < peaks.size(); ++c) {
      fields.push_back({channel_name("largest value", table, c), peak_text(peaks[c])});
    }
    for (const auto& check : bounds) {
      fields.push_back({channel_name("bounds of " + std::string(check.name), table, check.channel), check_text(check)});
    }
    return fields;
  }

  [[nodiscard]] Json json(const BrdfTable& table) const {
    Json json{{"relative_error", to_json(relative)}};
    if (!cells.empty()) {
      json["cell_error"] = Json::array();
      for (const double error : cells) json["cell_error"].push_back(to_json(error));
    }
    json.update(albedo_json(table, albedos));
    json["largest_value"] = Json::array();
    for (const auto& peak : peaks) json["largest_value"].push_back(peak_json(peak));
    json["bounds"] = Json::array();
    for (const auto& check : bounds) json["bounds"].push_back(bound_json(check));
    return json;
  }

  TableAlbedo albedos;
  std::vector<BoundCheck> bounds;
  double relative;
  std::vector<double> cells;  ///< cell errors by channel, of tables that are constant on cells
  std::vector<Peak> peaks;
};

/// Analysis of a function; only its largest values are those of the table that it becomes.
struct FunctionAnalysis {
  FunctionAnalysis(const Device& device, const BrdfFunction& function, const BrdfTable& table)
      : means(mean_albedo(device, function)) {
    std::vector<double> theta;
    for (const double degrees : kDegrees) theta.push_back(degrees * kDegree);
    albedos = albedo(device, function, theta);
    for (std::size_t c = 0; c < table.channels; ++c) peaks.push_back(peak_of(table, c));
  }

  [[nodiscard]] std::vector<Field> fields(const BrdfTable& table) const {
    std::vector<Field> fields;
    for (std::size_t c = 0; c < means.size(); ++c) {
      fields.push_back({channel_name("mean albedo", table, c), format_estimate(means[c])});
      std::string text;
      for (std::size_t k = 0; k < kDegrees.size(); ++k) {
        text += fmt::format("{}{} at {:.0f}°", k == 0 ? "" : ", ", format_estimate(albedos[c][k]), kDegrees[k]);
      }
      fields.push_back({channel_name("albedo in", table, c), text});
    }
    for (std::size_t c = 0; c < peaks.size(); ++c) {
      fields.push_back({channel_name("largest value", table, c), peak_text(peaks[c])});
    }
    return fields;
  }

  [[nodiscard]] Json json() const {
    Json json{{"mean_albedo", Json::array()}, {"albedos", Json::array()}, {"largest_value", Json::array()}};
    for (const auto& mean : means) json["mean_albedo"].push_back(to_json(mean));
    for (std::size_t k = 0; k < kDegrees.size(); ++k) {
      Json entry{{"theta_deg", kDegrees[k]}, {"albedo", Json::array()}};
      for (const auto& channel : albedos) entry["albedo"].push_back(to_json(channel[k]));
      json["albedos"].push_back(std::move(entry));
    }
    for (const auto& peak : peaks) json["largest_value"].push_back(peak_json(peak));
    return json;
  }

  static constexpr std::array<double, 4> kDegrees{0, 30, 60, 80};
  std::vector<Estimate> means;
  std::vector<std::vector<Estimate>> albedos;  ///< by channel, at kDegrees
  std::vector<Peak> peaks;
};

/// Answer on a table: its header, the analysis of its values, and whether bounds are kept.
struct TableAnswer {
  std::vector<Field> fields;
  Json json;
  bool is_plausible = true;
};

ExitCode print(Session& session, const TableAnswer& answer) {
  if (session.wants_json()) {
    session.print_json(answer.json);
  } else {
    session.print(fields_text(answer.fields));
  }
  if (!answer.is_plausible && !session.arguments().has(option::quiet)) {
    write_error("lobe: the table violates bounds of its albedos\n");
  }
  return answer.is_plausible ? ExitCode::success : ExitCode::negative;
}

/// With the size of regular files; standard input and pipes have none.
void add_file(TableAnswer& answer, std::string_view kind, const fs::path& path) {
  std::error_code code;
  const std::uintmax_t bytes = fs::file_size(path, code);
  answer.json["file"] = path.string();
  if (!code) answer.json["file_bytes"] = bytes;
  answer.fields.push_back(
      {std::string(kind), code ? path.string() : fmt::format("{} ({})", path.string(), bytes_text(bytes))});
}

/// A measured file: its conventions, and what follows from its values, or from those of its cells.
ExitCode describe_measured(Session& session, const ChosenFile& file) {
  const fs::path& path = file.path;
  const BrdfFunction function = load_measured(path, file.options);
  TableAnswer answer{{}, json_answer("info")};
  add_file(answer, "file", path);
  append(answer.fields, function_fields(function));
  answer.json.update(function_json(function));
  if (session.arguments().has(option::header_only)) return print(session, answer);
  const HemisphereGrid grid = natural_grid(function);
  session.state_memory(value_bytes(shape_of(function, grid)));
  const BrdfTable table =
      tabulate(session.device(), function, grid, {.allow_unresolved = true, .progress = session.progress()});
  session.end_progress();
  append(answer.fields, header_fields(table));
  answer.json.update(header_json(table));
  if (function.cells) {
    const Analysis analysis(table);
    append(answer.fields, analysis.fields(table));
    answer.json.update(analysis.json(table));
  } else {
    const FunctionAnalysis analysis(session.device(), function, table);
    append(answer.fields, analysis.fields(table));
    answer.json.update(analysis.json());
  }
  answer.json["memory"] = session.memory_json();
  answer.json["units"] = table_units();
  return print(session, answer);
}

std::string shape_text(const std::vector<std::size_t>& shape) {
  return fmt::format("{}", fmt::join(shape, " x "));
}

/// A file of azimuthal modes or a lookup table.
ExitCode describe_summarised(Session& session, const fs::path& path) {
  const FileSummary summary = load_file_summary(path);
  TableAnswer answer{{}, json_answer("info")};
  add_file(answer, summary.schema.starts_with("lobe-lut") ? "lookup table" : "azimuthal modes", path);
  answer.json["file_schema"] = summary.schema;
  answer.json["attributes"] = Json::object();
  for (const auto& [name, text] : summary.attributes) {
    std::string label = name;
    std::ranges::replace(label, '_', ' ');
    // Texts of several lines say the same at length.
    if (text.find('\n') == std::string::npos) answer.fields.push_back({std::move(label), text});
    answer.json["attributes"][name] = text;
  }
  if (!summary.channels.empty()) {
    answer.fields.push_back({"channels", fmt::format("{}", fmt::join(summary.channels, ", "))});
    answer.json["channel_names"] = summary.channels;
  }
  answer.json["datasets"] = Json::array();
  for (const DatasetSummary& dataset : summary.datasets) {
    const std::string unit = dataset.unit.empty() || dataset.unit == "1" ? "" : " " + dataset.unit;
    const std::string description = dataset.description.empty() ? "" : ": " + dataset.description;
    answer.fields.push_back({dataset.name, fmt::format("{}, {:.6g} to {:.6g}{}{}", shape_text(dataset.shape),
                                                       dataset.least, dataset.largest, unit, description)});
    answer.json["datasets"].push_back({{"name", dataset.name},
                                       {"description", dataset.description},
                                       {"unit", dataset.unit},
                                       {"shape", dataset.shape},
                                       {"least", to_json(dataset.least)},
                                       {"largest", to_json(dataset.largest)}});
  }
  return print(session, answer);
}

ExitCode execute_info(Session& session) {
  const ChosenFile file = parse_file(session.arguments().text(argument::file), read_options(session.arguments()));
  const fs::path& path = file.path;
  std::error_code ignored;
  if (!fs::exists(path, ignored) && std::ranges::find(catalogue(), path.string(), &Model::name) != catalogue().end()) {
    throw ArgumentError("'" + path.string() + "' is a model and no file; 'lobe models " + path.string() +
                        "' explains it");
  }
  if (path.extension() == ".toml" && fs::exists(path, ignored)) {
    throw ArgumentError("'" + path.string() +
                        "' is a text of materials or of a study, which holds no values; expected a table, a " +
                        "result of 'lobe run' or a measured file ('lobe tabulate' makes tables of materials)");
  }
  refuse_adjustments(file);
  if (session.arguments().has(option::study) || is_study_results(path)) return describe_study(session, path);
  if (is_summarised_file(path)) return describe_summarised(session, path);
  if (!is_table_file(path) && (is_measured_file(path) || path.extension() != ".h5")) {
    return describe_measured(session, file);
  }
  if (has_choices(file.options)) {
    throw ArgumentError("'" + path.string() + "' is no measured file; expected no choice of channels or angles");
  }
  BrdfTable table = load_table_header(path);
  TableAnswer answer{{}, json_answer("info")};
  add_file(answer, "table", path);
  append(answer.fields, header_fields(table));
  for (const auto& factor : table.factors) answer.fields.push_back({"factor", factor.expression});
  answer.json.update(header_json(table));
  if (!session.arguments().has(option::header_only)) {
    session.state_memory(value_bytes(table));
    table = load_table(path);
    const Analysis analysis(table);
    append(answer.fields, analysis.fields(table));
    answer.json.update(analysis.json(table));
    answer.json["memory"] = session.memory_json();
    answer.is_plausible = analysis.is_plausible();
  }
  answer.json["units"] = table_units();
  return print(session, answer);
}

std::vector<Option> info_options() {
  std::vector<Option> options = reading_options();
  options.push_back(
      {.handle = option::header_only, .help = "print only what needs no values; quick for any size of file"});
  options.push_back({.handle = option::study, .help = "for a result of 'lobe run': print only its study file"});
  options.push_back(json_option());
  return options;
}

}  // namespace

Command info_command() {
  return {
      .name = "info",
      .group = "Tables",
      .summary = "describe a file and check what it holds",
      .description =
          "Prints what a table's file states (expression, formulas, grid, delta parts) and what follows from its "
          "values: relative error, albedos for light (in) and viewer (out), the largest value. The albedos of a "
          "composition are checked against the bounds that the albedos of its factors set; the exit status is 1 if "
          "they violate these by more than their error. Errors of albedos are those of the table's values and of the "
          "sums over the grid's directions.\n"
          "For another program's file ('lobe import --help') it prints format, conventions, channels, shortcomings, "
          "the grid of the table that it becomes, albedos of the measured values for light from four angles, and the "
          "largest value of that table.\n"
          "For the HDF5 files of 'lobe modes' and 'lobe lut' it prints what they say of themselves, and the range of "
          "their numbers.\n"
          "For a result of 'lobe run' it prints what was computed, by which version on which device, and the line of "
          "the study behind each material, metric, figure and chart. --study prints the study file with everything "
          "that it includes and that was set from outside: 'lobe run' computes the same from it.",
      .positionals = {{.handle = argument::file,
                       .help = "a table's file or a study's result (.h5), or a measured file"}},
      .options = info_options(),
      .examples = {{"a composition", "lobe compose phong:n=20 ward:m=0.3 -o c.h5"},
                   {"a description of it", "lobe info c.h5"}},
      .execute = execute_info};
}

}  // namespace lobe::cli
