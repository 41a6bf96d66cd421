#include "study/read/published_reader.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>

#include "lobe/core/directions.hpp"
#include "study/read/keys.hpp"
#include "study/read/material_reader.hpp"

namespace lobe {
namespace {

namespace reader = toml_reader;

constexpr auto kNamesOfKeys = names_of(kPublishedKeys);
constexpr std::size_t kChannels = 1;

/// An angle in degrees, in [0, limit).
double angle(const toml::node& node, std::string_view what, double limit) {
  const double degrees = reader::number(node, what);
  if (!(degrees >= 0 && degrees < limit)) {
    reader::fail(node, fmt::format("{} is {} degrees; expected a value in [0, {})", what, degrees, limit));
  }
  return degrees * kDegree;
}

Directions directions(const toml::node& node) {
  constexpr double kHorizon = 90;
  constexpr double kTurn = 360;
  const toml::array& list = reader::array(node, "an entry of at");
  if (list.size() != 3) {
    reader::fail(node,
                 fmt::format("an entry of at has {} numbers; expected theta_in, theta_out and delta_phi in degrees",
                             list.size()));
  }
  return {angle(*list.get(0), "theta_in", kHorizon), angle(*list.get(1), "theta_out", kHorizon),
          angle(*list.get(2), "delta_phi", kTurn)};
}

void read_reflectance(const toml::table& table, const TableRow* row, PublishedFigure& figure) {
  const toml::node& at = resolve(reader::require(table, "at", "[[published]] of reflectances"), row);
  for (const auto& entry : reader::array(at, "at")) figure.at.push_back(directions(entry));
  if (figure.at.empty()) reader::fail(at, "at is empty; expected at least one [theta_in, theta_out, delta_phi]");
  figure.coefficients.assign(figure.at.size(), 1.0);
  if (const toml::node* given = table.get("coefficients")) {
    const toml::node& node = resolve(*given, row);
    figure.coefficients = reader::numbers(node, "coefficients");
    if (figure.coefficients.size() != figure.at.size()) {
      reader::fail(node, fmt::format("coefficients has {} numbers; expected {}, one per entry of at",
                                     figure.coefficients.size(), figure.at.size()));
    }
  }
}

std::string read_printed(const toml::node& node, std::string_view what) {
  const std::string printed = reader::text(node, what);
  (void)located(node, [&] { return unit_of_last_digit(printed); });
  return printed;
}

/// The key in the table, or the cell of the column of that name.
const toml::node* key_or_column(const toml::table& table, const TableRow* row, std::string_view key) {
  if (const toml::node* node = table.get(key)) return &resolve(*node, row);
  if (row == nullptr) return nullptr;
  const auto found = std::find(row->columns.begin(), row->columns.end(), key);
  return found == row->columns.end() ? nullptr : row->cells.get(static_cast<std::size_t>(found - row->columns.begin()));
}

/// The cells that tell rows apart: "n = 8", "d = 0.1, theta = 30".
std::string default_label(const LabelTexts& texts, const std::vector<std::string>& columns) {
  std::string label;
  for (const auto& column : columns) {
    if (column == "printed" || column == "corrected" || !texts.contains(column)) continue;
    label += fmt::format("{}{} = {}", label.empty() ? "" : ", ", column, texts.find(column)->second);
  }
  return label;
}

PublishedFigure read_figure(const toml::table& table, const TableRow* row) {
  constexpr double kHorizon = 90;
  PublishedFigure figure;
  figure.table = reader::text(reader::require(table, "title", "[[published]]"), "title");
  const toml::node& quantity = resolve(reader::require(table, "quantity", "[[published]]"), row);
  const std::string name = reader::text(quantity, "quantity");
  figure.quantity = located(quantity, [&] { return parse_published_quantity(name); });
  const auto refuse = [&](std::string_view key, std::string_view of) {
    if (!table.contains(key)) return;
    reader::fail(reader::place_of(table, key),
                 fmt::format("{} has no meaning for {}; expected it for {} only", key, name, of));
  };
  if (figure.quantity == PublishedQuantity::reflectance) {
    read_reflectance(table, row, figure);
  } else {
    refuse("at", "reflectance");
    refuse("coefficients", "reflectance");
  }
  if (figure.quantity == PublishedQuantity::albedo) {
    const toml::node& theta = resolve(reader::require(table, "theta", "[[published]] of albedos"), row);
    figure.at = {{angle(theta, "theta", kHorizon), 0, 0}};
  } else {
    refuse("theta", "albedo");
  }
  figure.material.terms = read_terms(table, {.row = row}, kChannels, kNamesOfKeys, "[[published]]");
  if (const toml::node* node = table.get("unit")) {
    figure.unit =
        Material{"", "", read_term(reader::table(*node, "unit"), {.row = row}, kChannels, kTermNames, "unit")};
  }
  if (const toml::node* node = table.get("offset")) figure.offset = reader::number(resolve(*node, row), "offset");

  figure.tolerance = reader::tolerance(table, "tolerance");

  const toml::node* printed = key_or_column(table, row, "printed");
  if (printed == nullptr) reader::fail(table, "[[published]] has no 'printed'; expected it as a key or as a column");
  figure.printed = read_printed(*printed, "printed");
  if (const toml::node* corrected = key_or_column(table, row, "corrected")) {
    // In a column, rows that are right leave it empty.
    if (!(corrected->is_string() && corrected->as_string()->get().empty())) {
      figure.corrected = read_printed(*corrected, "corrected");
    }
  }
  if (row != nullptr) {
    const toml::node* label = table.get("label");
    const LabelTexts texts = label_texts(*row);
    figure.label = label != nullptr ? fill_label(reader::text(*label, "label"), texts, *label)
                                    : default_label(texts, row->columns);
  } else if (const toml::node* label = table.get("label")) {
    figure.label = reader::text(*label, "label");
  }
  figure.material.name = fmt::format("{}, {}", figure.table, figure.label);
  return figure;
}

}  // namespace

std::vector<PublishedFigure> read_published(const toml::table& table) {
  if (!table.contains("rows") && !table.contains("columns")) return {read_figure(table, nullptr)};
  const std::vector<std::string> columns =
      reader::texts(reader::require(table, "columns", "[[published]] with 'rows'"), "columns");
  std::vector<PublishedFigure> figures;
  for (const TableRow& row : read_rows(table, columns, "[[published]] with 'columns'")) {
    figures.push_back(read_figure(table, &row));
  }
  return figures;
}

}  // namespace lobe
