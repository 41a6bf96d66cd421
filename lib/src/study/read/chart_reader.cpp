#include "study/read/chart_reader.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <map>

#include "core/text.hpp"
#include "lobe/core/directions.hpp"
#include "study/read/keys.hpp"
#include "study/read/material_reader.hpp"
#include "study/read/sweep.hpp"

namespace lobe {
namespace {

namespace reader = toml_reader;

constexpr auto kCurveNames = names_of(kCurveKeys);
constexpr double kChartHorizon = 90;
constexpr std::size_t kChartChannels = 1;

/// The name becomes part of file names.
std::string read_name(const toml::node& node) {
  std::string name = reader::text(node, "name");
  const auto is_plain = [](char c) { return static_cast<unsigned char>(c) > 0x20 && c != 0x7f && c != '/'; };
  if (!std::ranges::all_of(name, is_plain)) {
    reader::fail(node, fmt::format("name '{}' is no part of file names; expected neither blanks nor '/'", name));
  }
  return name;
}

void require_angles(const toml::node& node, const std::vector<double>& degrees, bool is_signed) {
  for (const double angle : degrees) {
    if (angle < kChartHorizon && angle > (is_signed ? -kChartHorizon : -1e-12)) continue;
    reader::fail(node, fmt::format("x has {} degrees; expected values in {}{}, 90)", shortest(angle),
                                   is_signed ? "(" : "[", is_signed ? -90 : 0));
  }
}

std::vector<double> read_abscissae(const toml::table& table, Chart& chart, Sweep& sweep) {
  const toml::node* node = table.get("x");
  if (node == nullptr) {
    if (!is_over_angle(chart.quantity)) (void)reader::require(table, "x", "[[chart]] over a parameter");
    return default_abscissae(chart.quantity, chart.log_x);
  }
  sweep = read_sweep("x", *node);
  std::vector<double> x = sweep.values;
  if (x.size() < 2 || std::ranges::adjacent_find(x, std::greater_equal{}) != x.end()) {
    reader::fail(*node, "x does not ascend; expected two values or more, each larger than the one before");
  }
  if (is_over_angle(chart.quantity)) {
    require_angles(*node, x, is_over_viewer(chart.quantity));
    for (double& angle : x) angle *= kDegree;
  } else if (chart.log_x && !(x.front() > 0)) {
    reader::fail(*node, fmt::format("x begins at {}; expected values above 0 for log_x", shortest(x.front())));
  }
  return x;
}

/// A material for each value of the swept parameter.
std::vector<Material> read_swept(const toml::table& table, const Chart& chart, const Sweep& sweep,
                                 const std::vector<Adjustment>& adjustments) {
  const std::string& parameter = chart.parameter;
  std::vector<std::string_view> keys(kCurveNames.begin(), kCurveNames.end());
  keys.insert(keys.end(), kTermNames.begin(), kTermNames.end());
  const TermModel model = read_model(table, keys, "a curve over a parameter");
  if (std::ranges::find(model.parameters, parameter) == model.parameters.end()) {
    reader::fail(*table.get("model"), fmt::format("model '{}' has no parameter '{}' to sweep", model.name, parameter));
  }
  if (table.contains(parameter)) {
    reader::fail(reader::place_of(table, parameter),
                 fmt::format("'{}' is given but swept by the chart; expected it in x only", parameter));
  }
  std::vector<Material> materials;
  for (std::size_t k = 0; k < sweep.values.size(); ++k) {
    std::vector<NamedValue> values;
    std::map<std::string, const toml::node*> places;
    for (const auto& name : model.parameters) {
      const toml::node* node = name == parameter ? sweep.place : table.get(name);
      if (node == nullptr) continue;
      values.emplace_back(name, name == parameter ? sweep.values[k] : reader::number(*node, fmt::format("'{}'", name)));
      places.emplace(name, node);
    }
    Term term = checked_term(model, values, places, *table.get("model"));
    term.weight = read_weight(table, {}, kChartChannels);
    term.factors = read_factors(table, {});
    term.pumping = read_pumping(table);
    materials.push_back(
        {fmt::format("{}, {} = {}", chart.name, chart.parameter, sweep.texts[k]), "", {std::move(term)}, adjustments});
  }
  return materials;
}

ChartCurve read_curve(const toml::table& table, const Chart& chart, const Sweep& sweep) {
  ChartCurve curve;
  curve.label = reader::text(reader::require(table, "label", "a curve"), "label");
  const std::vector<Adjustment> adjustments = read_adjustments(table);
  if (is_over_angle(chart.quantity)) {
    curve.materials = {{fmt::format("{}, {}", chart.name, curve.label), "",
                        read_terms(table, {}, kChartChannels, kCurveNames, "a curve"), adjustments}};
  } else {
    curve.materials = read_swept(table, chart, sweep, adjustments);
  }
  if (is_over_viewer(chart.quantity)) {
    const toml::node& node = reader::require(table, "theta_in", "a curve over the viewer's angle");
    const double degrees = reader::number(node, "theta_in");
    if (!(degrees >= 0 && degrees < kChartHorizon)) {
      reader::fail(node, fmt::format("theta_in is {} degrees; expected a value in [0, 90)", shortest(degrees)));
    }
    curve.theta_in = degrees * kDegree;
  } else if (table.contains("theta_in")) {
    reader::fail(reader::place_of(table, "theta_in"),
                 fmt::format("theta_in has no meaning for {}; expected it for reflectance and radiance only",
                             to_string(chart.quantity)));
  }
  return curve;
}

std::pair<double, double> read_y_range(const toml::node& node, bool log_y) {
  const std::vector<double> ends = reader::numbers(node, "y_range");
  if (ends.size() != 2 || !(ends[0] < ends[1]) || (log_y && !(ends[0] > 0))) {
    reader::fail(node, fmt::format("y_range is no range; expected [lowest, highest]{}", log_y ? ", above 0" : ""));
  }
  return {ends[0], ends[1]};
}

/// The name of the swept parameter, which mean albedos have and no others.
std::string read_parameter(const toml::table& table, ChartQuantity quantity) {
  if (!is_over_angle(quantity)) {
    return reader::text(reader::require(table, "parameter", "[[chart]] of mean albedos"), "parameter");
  }
  if (table.contains("parameter")) {
    reader::fail(reader::place_of(table, "parameter"),
                 fmt::format("parameter has no meaning for {}; expected it for mean-albedo only", to_string(quantity)));
  }
  return {};
}

}  // namespace

Chart read_chart(const toml::table& table) {
  reader::require_known_keys(table, names_of(kChartKeys), "[[chart]]");
  Chart chart;
  chart.name = read_name(reader::require(table, "name", "[[chart]]"));
  chart.title = chart.name;
  if (const toml::node* node = table.get("title")) chart.title = reader::text(*node, "title");
  const toml::node& quantity = reader::require(table, "quantity", "[[chart]]");
  chart.quantity = located(quantity, [&] { return parse_chart_quantity(reader::text(quantity, "quantity")); });
  chart.parameter = read_parameter(table, chart.quantity);
  if (const toml::node* node = table.get("log_x")) chart.log_x = reader::truth(*node, "log_x");
  if (const toml::node* node = table.get("log_y")) chart.log_y = reader::truth(*node, "log_y");
  if (chart.log_x && is_over_viewer(chart.quantity)) {
    reader::fail(
        reader::place_of(table, "log_x"),
        fmt::format("log_x has no meaning for {}, whose angles go from -90 to 90 degrees", to_string(chart.quantity)));
  }
  Sweep sweep;
  chart.x = read_abscissae(table, chart, sweep);
  chart.tolerance = reader::tolerance(table, "tolerance");
  if (const toml::node* node = table.get("y_range")) chart.y_range = read_y_range(*node, chart.log_y);
  if (const toml::node* node = table.get("unit")) {
    chart.unit = Material{"unit", "", read_term(reader::table(*node, "unit"), {}, kChartChannels, kTermNames, "unit")};
  }
  const toml::node& curves = reader::require(table, "curves", "[[chart]]");
  for (const auto& entry : reader::array(curves, "curves")) {
    chart.curves.push_back(read_curve(reader::table(entry, "an entry of curves"), chart, sweep));
  }
  if (chart.curves.empty()) reader::fail(curves, "curves is empty; expected at least one {label = ..., model = ...}");
  return chart;
}

}  // namespace lobe
