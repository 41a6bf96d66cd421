#pragma once

#include <string>
#include <vector>

#include "interface/report.hpp"
#include "lobe/table/table.hpp"

namespace lobe::cli {

/// A line "name   text" of a report.
struct Field {
  std::string name;
  std::string text;
};

/// The fields below each other, texts aligned.
[[nodiscard]] std::string fields_text(const std::vector<Field>& fields);

/// Rows from a table's header: expression, formulas, grid, resolution, delta parts.
[[nodiscard]] std::vector<Field> header_fields(const BrdfTable& table);
[[nodiscard]] Json header_json(const BrdfTable& table);

/// Rows derived from its values: relative error, mean albedo, extremes of the albedos.
[[nodiscard]] std::vector<Field> albedo_fields(const BrdfTable& table, const TableAlbedo& albedo);
[[nodiscard]] Json albedo_json(const BrdfTable& table, const TableAlbedo& albedo);

/// theta of a row in degrees.
[[nodiscard]] double row_theta_deg(const BrdfTable& table, std::size_t row);

/// Units of what the two JSON objects hold.
[[nodiscard]] Json table_units();

/// "NAME" or, of several channels, "NAME, channel C".
[[nodiscard]] std::string channel_name(std::string_view name, const BrdfTable& table, std::size_t channel);

/// A relative error as text; "unknown" for NaN.
[[nodiscard]] std::string relative_text(double error);

}  // namespace lobe::cli
