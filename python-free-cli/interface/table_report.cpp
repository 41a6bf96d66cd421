#include "interface/table_report.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <span>

#include "core/text.hpp"
#include "lobe/core/directions.hpp"

namespace lobe::cli {
namespace {

/// Where the albedos of a channel are smallest and largest.
struct Extremes {
  std::size_t smallest = 0;
  std::size_t largest = 0;
};

Extremes extremes_of(const std::vector<Estimate>& albedos) {
  const auto [smallest, largest] = std::ranges::minmax_element(albedos, {}, &Estimate::value);
  return {static_cast<std::size_t>(smallest - albedos.begin()), static_cast<std::size_t>(largest - albedos.begin())};
}

std::string extremes_text(const BrdfTable& table, const std::vector<Estimate>& albedos) {
  const Extremes at = extremes_of(albedos);
  const auto text = [&](std::size_t row) {
    return fmt::format("{} at {:.1f}°", format_estimate(albedos[row]), row_theta_deg(table, row));
  };
  return text(at.smallest) + "  to  " + text(at.largest);
}

Json extremes_json(const BrdfTable& table, const std::vector<std::vector<Estimate>>& albedos) {
  Json channels = Json::array();
  for (const auto& channel : albedos) {
    const Extremes at = extremes_of(channel);
    const auto entry = [&](std::size_t row) {
      Json json = to_json(channel[row]);
      json["theta_deg"] = row_theta_deg(table, row);
      return json;
    };
    channels.push_back({{"min", entry(at.smallest)}, {"max", entry(at.largest)}});
  }
  return channels;
}

std::string delta_text(std::string_view name, std::span<const double> factors) {
  if (factors.empty()) return {};
  const auto [smallest, largest] = std::ranges::minmax(factors);
  if (smallest == largest) return fmt::format("{} {}", name, shortest(smallest));
  return fmt::format("{} {:.6g} to {:.6g}", name, smallest, largest);
}

std::string delta_text(const BrdfTable& table) {
  const std::string mirror = delta_text("mirror", table.mirror);
  const std::string retro = delta_text("rrim", table.retro);
  if (mirror.empty() && retro.empty()) return "none";
  return mirror + (mirror.empty() || retro.empty() ? "" : ", ") + retro;
}

Json delta_json(std::span<const double> factors) {
  const auto [smallest, largest] = std::ranges::minmax(factors);
  return {{"min", smallest}, {"max", largest}};
}

std::string grid_text(const BrdfTable& table) {
  const std::string form = table.form == TableForm::isotropic ? "isotropic" : "general";
  const std::string text = fmt::format("{} ({} directions), {}", table.grid.name(), table.grid.nodes(), form);
  return table.channels == 1 ? text : fmt::format("{}, {} channels", text, table.channels);
}

std::string formulas_text(const BrdfTable& table) {
  std::string text;
  for (const auto& material : table.source) text += (text.empty() ? "" : " composed with ") + material.name;
  return text;
}

}  // namespace

std::string relative_text(double error) {
  return std::isnan(error) ? "unknown" : fmt::format("{:.2g}", error);
}

std::string channel_name(std::string_view name, const BrdfTable& table, std::size_t channel) {
  if (table.channels == 1) return std::string(name);
  if (!table.channel_names.empty()) return fmt::format("{}, {}", name, table.channel_names[channel]);
  return fmt::format("{}, channel {}", name, channel + 1);
}

double row_theta_deg(const BrdfTable& table, std::size_t row) {
  const std::size_t ring = table.form == TableForm::isotropic ? row : table.grid.ring_of(row);
  return to_degrees(table.grid.rings()[ring].theta);
}

std::string fields_text(const std::vector<Field>& fields) {
  std::size_t width = 0;
  for (const auto& field : fields) width = std::max(width, display_width(field.name));
  std::string text;
  for (const auto& field : fields) {
    text += field.name + std::string(width - display_width(field.name) + 2, ' ') + field.text + "\n";
  }
  return text;
}

std::vector<Field> header_fields(const BrdfTable& table) {
  std::vector<Field> fields{{"expression", table.expression}};
  const std::string formulas = formulas_text(table);
  if (!formulas.empty() && formulas != table.expression) fields.push_back({"formulas", formulas});
  fields.push_back({"grid", grid_text(table)});
  if (table.resolution_error > 0) {
    fields.push_back({"resolution error", relative_text(table.resolution_error) + " of integrals of the square, mean"});
  }
  if (table.is_unresolved) fields.push_back({"unresolved", "yes: the grid is too coarse for a lobe"});
  fields.push_back({"delta parts", delta_text(table)});
  return fields;
}

Json header_json(const BrdfTable& table) {
  Json json;
  json["expression"] = table.expression;
  json["formulas"] = Json::array();
  for (const auto& material : table.source) json["formulas"].push_back(material_json(material));
  json["grid"] = table.grid.name();
  json["directions"] = table.grid.nodes();
  json["form"] = table.form == TableForm::isotropic ? "isotropic" : "general";
  json["channels"] = table.channels;
  json["resolution_error"] = to_json(table.resolution_error);
  json["is_unresolved"] = table.is_unresolved;
  json["delta"] = Json::object();
  if (!table.mirror.empty()) json["delta"]["mirror"] = delta_json(table.mirror);
  if (!table.retro.empty()) json["delta"]["rrim"] = delta_json(table.retro);
  return json;
}

std::vector<Field> albedo_fields(const BrdfTable& table, const TableAlbedo& albedo) {
  std::vector<Field> fields;
  for (std::size_t c = 0; c < table.channels; ++c) {
    fields.push_back({channel_name("mean albedo", table, c), format_estimate(albedo.mean[c])});
    fields.push_back({channel_name("albedo in", table, c), extremes_text(table, albedo.in[c])});
    fields.push_back({channel_name("albedo out", table, c), extremes_text(table, albedo.out[c])});
  }
  return fields;
}

Json albedo_json(const BrdfTable& table, const TableAlbedo& albedo) {
  Json json;
  json["mean_albedo"] = Json::array();
  for (const auto& mean : albedo.mean) json["mean_albedo"].push_back(to_json(mean));
  json["albedo_in"] = extremes_json(table, albedo.in);
  json["albedo_out"] = extremes_json(table, albedo.out);
  return json;
}

Json table_units() {
  return {{"theta", "deg"}, {"albedo", "1"}, {"relative_error", "1"}, {"resolution_error", "1"}, {"bytes", "B"}};
}

}  // namespace lobe::cli
