#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <optional>
#include <set>
#include <span>
#include <utility>

#include "core/text.hpp"
#include "interface/chart_output.hpp"
#include "interface/command.hpp"
#include "interface/deviations.hpp"
#include "interface/operand_json.hpp"
#include "interface/options.hpp"
#include "interface/reading.hpp"
#include "interface/session.hpp"
#include "interface/table_making.hpp"
#include "interface/table_report.hpp"
#include "lobe/core/directions.hpp"
#include "lobe/core/error.hpp"
#include "lobe/energy/albedo.hpp"
#include "lobe/formats/measurement.hpp"
#include "lobe/reflectance/tabulate.hpp"
#include "lobe/table/cell_error.hpp"

namespace lobe::cli {
namespace {

constexpr Numbers kAzimuth{"azimuth"};
constexpr Flag kMean{"mean"};
constexpr Numbers kTheta{"theta"};

/// The azimuths of --azimuth, degrees; 0 without.
std::vector<double> azimuths_of(const Arguments& arguments) {
  return arguments.has(kAzimuth) ? arguments.numbers(kAzimuth) : std::vector<double>{0};
}

/// Directions of incidence in degrees, those of one azimuth after each other; none without --theta.
std::vector<Direction> incidence(const Arguments& arguments) {
  if (!arguments.has(kTheta)) {
    if (arguments.has(kAzimuth) && !arguments.has(option::plot)) {
      throw ArgumentError("--azimuth is of angles of incidence; give these by --theta");
    }
    return {};
  }
  const auto angles = arguments.numbers(kTheta);
  for (const double angle : angles) {
    if (!(angle >= 0 && angle < 90)) {
      throw ArgumentError(
          fmt::format("--theta {} is out of range; expected at least 0 and less than 90 degrees", shortest(angle)));
    }
  }
  std::vector<Direction> degrees;
  for (const double azimuth : azimuths_of(arguments)) {
    for (const double angle : angles) degrees.push_back({angle, azimuth});
  }
  return degrees;
}

std::vector<Direction> radians_of(const std::vector<Direction>& degrees) {
  std::vector<Direction> radians;
  for (const auto& [theta, phi] : degrees) radians.push_back({theta * kDegree, phi * kDegree});
  return radians;
}

/// The azimuth is told where one is not 0.
bool has_azimuths(const std::vector<Direction>& degrees) {
  return std::ranges::any_of(degrees, [](const Direction& at) { return at.phi != 0; });
}

/// rows[i][channel]: one row per direction, then the mean if wanted.
using Rows = std::vector<std::vector<Estimate>>;
/// Standard deviations that those of the samples cause, as the rows; none where the samples state none.
using Deviations = std::vector<std::vector<double>>;

/// \param missed called with the number of each row that misses the tolerance
Rows albedos_of(const Device& device, const Reflectance& reflectance, const std::vector<Direction>& degrees,
                bool wants_mean, AlbedoOptions options, const MissedToleranceCallback& missed) {
  Rows rows(degrees.size());
  options.missed = missed;
  if (!degrees.empty()) {
    for (const auto& channel : albedo(device, reflectance, radians_of(degrees), options)) {
      for (std::size_t i = 0; i < rows.size(); ++i) rows[i].push_back(channel[i]);
    }
  }
  options.missed = [&](MissedTolerance mean) {
    mean.index = degrees.size();
    missed(mean);
  };
  if (wants_mean) rows.push_back(mean_albedo(device, reflectance, options));
  return rows;
}

/// Takes the replicates out of the rows of a function that has such.
/// \return what they say
Deviations take_deviations(const BrdfFunction& function, Rows& rows) {
  Deviations deviations;
  for (auto& row : rows) {
    std::vector<double> numbers;
    for (const Estimate& estimate : row) numbers.push_back(estimate.value);
    deviations.push_back(measurement_deviations(function, numbers));
    row.resize(own_channels(function));
  }
  return deviations;
}

/// The table that a reflectance is, or that is constant on its cells; null: there is none.
const BrdfTable* table_of(const Reflectance& reflectance) {
  return reflectance.function() != nullptr ? reflectance.function()->cells.get() : reflectance.table();
}

/// Replicates as what they are replicates of: where that is a table, on its grid.
Reflectance on_grid_of(const Device& device, const BrdfFunction& replicates, const Reflectance& reflectance) {
  const BrdfTable* table = reflectance.table();
  if (table == nullptr) return replicates;
  return tabulate(device, replicates, table->grid, {.allow_unresolved = true});
}

std::span<const double> deviations_of(const Deviations& deviations, std::size_t row) {
  return deviations.empty() ? std::span<const double>() : deviations[row];
}

Json row_json(const Rows& rows, const Deviations& deviations, std::size_t row) {
  Json json = Json::array();
  for (const Figure& figure : figures(rows[row], deviations_of(deviations, row))) json.push_back(to_json(figure));
  return json;
}

std::string rows_text(const Rows& rows, const Deviations& deviations, const std::vector<Direction>& degrees,
                      std::vector<std::string> labels, bool color) {
  if (labels.size() == 1) labels = {"albedo"};
  std::vector<std::vector<std::string>> table{{"theta/deg"}};
  if (has_azimuths(degrees)) table.front().emplace_back("phi/deg");
  table.front().insert(table.front().end(), labels.begin(), labels.end());
  for (std::size_t i = 0; i < rows.size(); ++i) {
    const bool is_mean = i >= degrees.size();
    table.push_back({is_mean ? "mean" : shortest(degrees[i].theta)});
    if (has_azimuths(degrees)) table.back().push_back(is_mean ? "" : shortest(degrees[i].phi));
    for (const Figure& figure : figures(rows[i], deviations_of(deviations, i))) {
      table.back().push_back(format_figure(figure));
    }
  }
  return format_table(table, 0, color);
}

/// \param missed numbers of the rows that miss the tolerance; none where there is none
void add_rows(Json& answer, const Rows& rows, const Deviations& deviations, const std::vector<Direction>& degrees,
              const std::optional<std::set<std::size_t>>& missed) {
  answer["albedos"] = Json::array();
  for (std::size_t i = 0; i < degrees.size(); ++i) {
    Json row{{"theta_deg", degrees[i].theta}, {"phi_deg", degrees[i].phi}, {"albedo", row_json(rows, deviations, i)}};
    if (missed) row["reached_tolerance"] = !missed->contains(i);
    answer["albedos"].push_back(std::move(row));
  }
  if (rows.size() > degrees.size()) answer["mean_albedo"] = row_json(rows, deviations, rows.size() - 1);
}

/// Notes the rows of files and tables, whose values nothing refines, where their errors exceed a tolerance.
void note_errors(Session& session, const Rows& rows, const std::vector<Direction>& degrees, double tolerance) {
  const std::string& name = session.arguments().text(argument::material);
  for (std::size_t i = 0; i < rows.size(); ++i) {
    const std::string what =
        i < degrees.size() ? fmt::format("albedo at {} degrees", shortest(degrees[i].theta)) : "mean albedo";
    for (const Estimate& channel : rows[i]) session.note_if_missed(what + " of '" + name + "'", channel, tolerance);
  }
}

/// A curve for each azimuth and channel, up to 89.9 degrees.
/// \param albedos_at rows at directions in degrees
template <typename AlbedosAt>
void draw(Session& session, const std::filesystem::path& stem, const std::vector<std::string>& labels,
          const AlbedosAt& albedos_at) {
  const auto& arguments = session.arguments();
  const auto azimuths = azimuths_of(arguments);
  Chart chart;
  chart.name = "albedo";
  chart.title = "Albedo of " + arguments.text(argument::material);
  chart.x = default_abscissae(ChartQuantity::albedo, false);
  ChartValues values;
  for (const double azimuth : azimuths) {
    std::vector<Direction> degrees;
    for (const double x : chart.x) degrees.push_back({x / kDegree, azimuth});
    const Rows rows = albedos_at(degrees);
    for (std::size_t c = 0; c < rows.front().size(); ++c) {
      const std::string of_channel = labels.size() == 1 ? "" : labels[c];
      const std::string at_azimuth = azimuths.size() == 1 ? "" : fmt::format("azimuth {} degrees", shortest(azimuth));
      const std::string separator = of_channel.empty() || at_azimuth.empty() ? "" : ", ";
      chart.curves.push_back({.label = at_azimuth + separator + of_channel, .materials = {}});
      auto& curve = values.emplace_back();
      for (const auto& row : rows) curve.push_back(row[c]);
    }
  }
  if (chart.curves.size() == 1) chart.curves.front().label = "albedo";
  draw_chart(session, chart, values, stem);
}

ExitCode execute_albedo(Session& session) {
  const auto& arguments = session.arguments();
  const auto degrees = incidence(arguments);
  const bool wants_mean = arguments.has(kMean);
  const auto stem = picture_stem(arguments);
  if (degrees.empty() && !wants_mean && !stem) {
    throw ArgumentError("nothing to compute; give angles of incidence by --theta 0,30,60, or --mean, or --plot");
  }
  const AlbedoOptions options{.tolerance = session.tolerance(AlbedoOptions{}.tolerance),
                              .precision = session.precision()};
  const auto operand = session.operand(argument::material);
  const auto labels = channel_labels(std::span(&operand, 1));
  const Device& device = session.device();
  const Reflectance reflectance = session.reflectance(operand);
  Json answer = json_answer("albedo");
  add_operand(answer, operand);
  std::set<std::size_t> missed;
  const auto note_missed = [&](const MissedTolerance& row) {
    session.note_missed(row);
    missed.insert(row.index);
  };
  Rows rows;
  Deviations deviations;
  const auto replicates = replicated(session, {&operand, 1});
  if (!replicates.empty()) {
    const Reflectance copies = on_grid_of(device, replicates.front(), reflectance);
    rows = albedos_of(device, copies, degrees, wants_mean, options, note_missed);
    deviations = take_deviations(replicates.front(), rows);
  }
  // Those of a table's replicates are for deviations alone: their noise is not in its values.
  if (replicates.empty() || reflectance.table() != nullptr) {
    rows = albedos_of(device, reflectance, degrees, wants_mean, options, note_missed);
  }
  if (arguments.has(option::tolerance) && !operand.is_formula()) note_errors(session, rows, degrees, options.tolerance);
  std::vector<std::vector<double>> cell_errors;  // of matrices of cells
  if (const BrdfTable* table = table_of(reflectance); table != nullptr && is_constant_on_cells(*table)) {
    cell_errors = albedo_cell_error(*table, radians_of(degrees));
  }
  if (stem) {
    draw(session, *stem, labels,
         [&](const auto& at) { return albedos_of(device, reflectance, at, false, options, session.missed()); });
  }
  if (operand.is_formula()) {
    answer["tolerance"] = options.tolerance;
    answer["reached_tolerance"] = session.reached_tolerance();
    answer["precision"] = to_string(options.precision);
    answer["device"] = to_json(device.info());
  }
  answer["units"] = {{"angles", "deg"}, {"albedo", "1"}};
  add_rows(answer, rows, deviations, degrees, operand.is_formula() ? std::optional(missed) : std::nullopt);
  for (std::size_t c = 0; c < cell_errors.size(); ++c) {
    for (std::size_t i = 0; i < degrees.size(); ++i) {
      answer["albedos"][i]["cell_error"].push_back(to_json(cell_errors[c][i]));
    }
  }
  if (session.wants_json()) {
    session.print_json(answer);
  } else if (!rows.empty()) {
    session.print(rows_text(rows, deviations, degrees, labels, session.colors_output()));
  }
  return ExitCode::success;
}

}  // namespace

Command albedo_command() {
  return {
      .name = "albedo",
      .group = "Materials",
      .summary = "compute directional albedos",
      .description =
          "Computes the directional albedo, per channel, for light from the given angles of incidence (in degrees from "
          "the surface normal), with error bounds. --mean adds the mean albedo under diffuse light. A table's albedo "
          "is integrated from its values and interpolated to the angle; the error for a measured file is that of its "
          "interpolation and of the quadrature. Klems files and other BSDF matrices are constant on their patches, so "
          "that their albedos are exact sums; the cell error, in JSON and in 'lobe info', says how far those of a "
          "continuous reflectance may differ.",
      .positionals = {{.handle = argument::material, .help = "the material to integrate", .is_material = true}},
      .options =
          {{.handle = kTheta, .value = "A", .help = "angle of incidence, at least 0 and below 90, or a list 0,30,60"},
           {.handle = kAzimuth, .value = "A", .help = "azimuth of the light, for anisotropic materials (default 0)"},
           {.handle = kMean, .help = "also compute the cosine-weighted mean over all directions of incidence"},
           plot_option("draw the albedos up to 89.9 degrees into this file (.png), a curve per channel and azimuth"),
           {.handle = option::force, .letter = 'f', .help = "replace an existing picture"},
           tolerance_option(
               "largest relative error (formulas: default 1e-6; files and tables have the errors they have)"),
           strict_option(),
           json_option()},
      .examples = {{"a brushed metal under light from three azimuths",
                    "lobe albedo ward_anisotropic:m_x=0.05,m_y=0.3 --theta 60 --azimuth 0,45,90"},
                   {"a picture of a paint's albedo",
                    "lobe albedo lambert:scale=0.3+ward:m=0.1,scale=0.5 --plot paint.png"}},
      .execute = execute_albedo};
}

}  // namespace lobe::cli
