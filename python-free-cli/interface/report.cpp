#include "interface/report.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>

#include "core/text.hpp"
#include "interface/terminal.hpp"

namespace lobe::cli {

std::size_t display_width(std::string_view text) {
  // Count the bytes that begin a UTF-8 character.
  return static_cast<std::size_t>(
      std::ranges::count_if(text, [](char byte) { return (static_cast<unsigned char>(byte) & 0xC0U) != 0x80U; }));
}

std::string wrap(std::string_view text, std::size_t indent) {
  constexpr std::size_t kColumns = 80;
  std::string result;
  std::size_t column = indent;
  for (const auto word : split(text, ' ')) {
    const std::size_t width = display_width(word);
    if (column > indent && column + 1 + width > kColumns) {
      result += '\n';
      result.append(indent, ' ');
      column = indent;
    } else if (column > indent) {
      result += ' ';
      ++column;
    }
    result += word;
    column += width;
  }
  return result;
}

std::string format_table(const std::vector<std::vector<std::string>>& rows, std::size_t numbers_from, bool color) {
  std::vector<std::size_t> widths;
  for (const auto& row : rows) {
    widths.resize(std::max(widths.size(), row.size()));
    for (std::size_t i = 0; i < row.size(); ++i) widths[i] = std::max(widths[i], display_width(row[i]));
  }
  std::string text;
  for (const auto& row : rows) {
    std::string line;
    for (std::size_t i = 0; i < row.size(); ++i) {
      const std::string padding(widths[i] - display_width(row[i]), ' ');
      if (i > 0) line += "  ";
      line += i < numbers_from ? row[i] + padding : padding + row[i];
    }
    line.erase(line.find_last_not_of(' ') + 1);
    text += (&row == rows.data() ? bold(line, color) : line) + "\n";
  }
  return text;
}

std::string format_estimate(const Estimate& estimate) {
  if (std::isnan(estimate.error)) return fmt::format("{:.6g} (error unknown)", estimate.value);
  if (!(estimate.error > 0) || !std::isfinite(estimate.error) || !std::isfinite(estimate.value)) {
    return fmt::format("{} ± {}", estimate.value, estimate.error);
  }
  constexpr double kMostDigits = 17;
  const double ratio = std::abs(estimate.value) / estimate.error;
  const double digits = ratio > 1 ? std::floor(std::log10(ratio)) + 2 : 2;
  return fmt::format("{:.{}g} ± {:.2g}", estimate.value, static_cast<int>(std::min(digits, kMostDigits)),
                     estimate.error);
}

Json json_answer(std::string_view command) {
  Json json;
  json["schema"] = fmt::format("lobe.{}/1", command);
  return json;
}

Json to_json(double value) {
  if (std::isfinite(value)) return value;
  if (std::isnan(value)) return "nan";
  return value > 0 ? "inf" : "-inf";
}

Json to_json(const Estimate& estimate) {
  return {{"value", to_json(estimate.value)}, {"error", to_json(estimate.error)}};
}

Json to_json(const DeviceInfo& device) {
  return {{"selector", device.selector},
          {"platform", device.platform},
          {"platform_version", device.platform_version},
          {"name", device.name},
          {"vendor", device.vendor},
          {"driver", device.driver},
          {"version", device.version},
          {"is_cpu", device.is_cpu},
          {"has_double", device.has_double},
          {"compute_units", device.compute_units},
          {"global_memory_bytes", device.global_memory_bytes},
          {"largest_buffer_bytes", device.largest_buffer_bytes}};
}

Json material_json(const Material& material) {
  return Json::parse(lobe::to_json(material));
}

std::string json_text(const Json& json) {
  // Bytes that are no UTF-8, as in a file name, are replaced rather than refused.
  return json.dump(2, ' ', false, Json::error_handler_t::replace) + "\n";
}

Json files_json(const std::vector<std::filesystem::path>& files) {
  Json json = Json::array();
  for (const auto& file : files) json.push_back(file.lexically_normal().string());
  return json;
}

}  // namespace lobe::cli
