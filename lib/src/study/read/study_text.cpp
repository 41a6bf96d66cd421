#include "study/read/study_text.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <tuple>
#include <utility>
#include <vector>

#include "core/text.hpp"

namespace lobe {
namespace {

constexpr std::size_t kWidth = 100;

std::string literal(std::string_view text) {
  std::string quoted = "\"";
  for (const char c : text) {
    if (c == '"' || c == '\\') {
      quoted += '\\';
      quoted += c;
    } else if (c == '\n') {
      quoted += "\\n";
    } else if (static_cast<unsigned char>(c) < 0x20 || c == 0x7f) {
      quoted += fmt::format("\\u{:04x}", static_cast<unsigned char>(c));
    } else {
      quoted += c;
    }
  }
  return quoted + "\"";
}

std::string key_text(std::string_view key) {
  const auto is_bare = [](char c) {
    return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') || c == '-' || c == '_';
  };
  return !key.empty() && std::ranges::all_of(key, is_bare) ? std::string(key) : literal(key);
}

/// Floating-point numbers stay such.
std::string number_text(double value) {
  std::string text = shortest(value);
  if (text.find_first_not_of("-0123456789") == std::string::npos) text += ".0";
  return text;
}

/// Keys in the order in which they stand in their file, then those of overrides.
std::vector<std::pair<std::string_view, const toml::node*>> ordered(const toml::table& table) {
  std::vector<std::tuple<bool, toml::source_index, toml::source_index, std::string_view, const toml::node*>> entries;
  for (const auto& [key, node] : table) {
    const toml::source_region& region = key.source();
    const bool is_override = region.path && region.path->starts_with(toml_reader::kOverride);
    entries.emplace_back(is_override, region.begin.line, region.begin.column, key.str(), &node);
  }
  std::ranges::sort(entries);
  std::vector<std::pair<std::string_view, const toml::node*>> list;
  for (const auto& [is_override, line, column, key, node] : entries) list.emplace_back(key, node);
  return list;
}

/// A value in one line; lists too long for it have a line per entry.
/// \param column where the value begins
std::string value_text(const toml::node& node, std::size_t column) {
  if (const auto* text = node.as_string()) return literal(text->get());
  if (const auto* number = node.as_integer()) return std::to_string(number->get());
  if (const auto* number = node.as_floating_point()) return number_text(number->get());
  if (const auto* truth = node.as_boolean()) return truth->get() ? "true" : "false";
  std::vector<std::string> parts;
  if (const auto* table = node.as_table()) {
    for (const auto& [key, value] : ordered(*table)) {
      parts.push_back(fmt::format("{} = {}", key_text(key), value_text(*value, 0)));
    }
    return fmt::format("{{{}}}", fmt::join(parts, ", "));
  }
  const auto* list = node.as_array();
  if (list == nullptr) return "\"\"";  // dates, which no study has
  for (const auto& entry : *list) parts.push_back(value_text(entry, 0));
  std::string line = fmt::format("[{}]", fmt::join(parts, ", "));
  if (column == 0 || column + line.size() <= kWidth) return line;
  return fmt::format("[\n  {},\n]", fmt::join(parts, ",\n  "));
}

std::string table_text(const std::string& heading, const toml::table& table) {
  std::string text = heading + "\n";
  for (const auto& [key, node] : ordered(table)) {
    const std::string begin = key_text(key) + " = ";
    text += begin + value_text(*node, begin.size()) + "\n";
  }
  return text;
}

}  // namespace

std::string study_text(const StudySources& sources, const std::string& name) {
  std::string text = fmt::format("# What {} says", sources.files.back().name);
  for (std::size_t i = 0; i + 1 < sources.files.size(); ++i) text += fmt::format(", with {}", sources.files[i].name);
  for (const auto& change : sources.overrides) text += fmt::format(", --set {}", change.key);
  // A comment has no control characters.
  std::ranges::replace_if(
      text, [](char c) { return static_cast<unsigned char>(c) < 0x20 || c == 0x7f; }, ' ');
  text += fmt::format("; written out by lobe.\n\n{}", table_text("[study]", sources.settings));
  if (!sources.settings.contains("name")) text += fmt::format("name = {}\n", literal(name));
  constexpr std::array<std::string_view, 5> kKinds = {"family", "material", "measured", "published", "chart"};
  for (const auto& [key, table] : sources.entries(kKinds))
    text += "\n" + table_text(fmt::format("[[{}]]", key), *table);
  return text;
}

}  // namespace lobe
