#include "study/read/toml_reader.hpp"

#include <algorithm>
#include <cmath>

#include "core/text.hpp"
#include "lobe/core/error.hpp"

namespace lobe::toml_reader {
namespace {

[[noreturn]] void fail_kind(const toml::node& node, std::string_view what, std::string_view expected) {
  fail(node, std::string(what) + " is " + kind_of(node) + "; expected " + std::string(expected));
}

}  // namespace

void fail(const toml::source_region& place, const std::string& message) {
  std::string text = place.path ? *place.path : std::string();
  if (!text.starts_with(kOverride)) {
    // The root table has no place of its own.
    text += ":" + std::to_string(std::max<toml::source_index>(place.begin.line, 1)) + ":" +
            std::to_string(std::max<toml::source_index>(place.begin.column, 1));
  }
  text += ": " + message;
  std::replace(text.begin(), text.end(), '\n', ' ');
  throw ArgumentError(printable(text), {.topic = Topic::studies});
}

void fail(const toml::node& place, const std::string& message) {
  fail(place.source(), message);
}

toml::table parse(const std::string& text, const std::filesystem::path& file) {
  const std::string name = file.string();
  try {
    return toml::parse(std::string_view(text), std::string_view(name));
  } catch (const toml::parse_error& error) {
    fail(error.source(), "not valid TOML: " + std::string(error.description()));
  }
}

toml::source_region place_of(const toml::table& table, std::string_view key) {
  for (const auto& [name, node] : table) {
    if (name.str() == key) return name.source();
  }
  return table.source();
}

void require_known_keys(const toml::table& table, std::span<const std::string_view> known, std::string_view where) {
  for (const auto& [name, node] : table) {
    if (std::find(known.begin(), known.end(), name.str()) == known.end()) {
      fail(name.source(),
           "unknown key '" + std::string(name.str()) + "' in " + std::string(where) + did_you_mean(name.str(), known));
    }
  }
}

const toml::node& require(const toml::table& table, std::string_view key, std::string_view where) {
  if (const toml::node* node = table.get(key)) return *node;
  fail(table, std::string(where) + " has no '" + std::string(key) + "'; expected one");
}

std::string kind_of(const toml::node& node) {
  switch (node.type()) {
    case toml::node_type::string:
      return "a text";
    case toml::node_type::integer:
    case toml::node_type::floating_point:
      return "a number";
    case toml::node_type::boolean:
      return "true or false";
    case toml::node_type::array:
      return "a list";
    case toml::node_type::table:
      return "a table";
    default:
      return "a date or time";
  }
}

void require_one_line(const toml::node& node, std::string_view what) {
  const auto* value = node.as_string();
  if (value == nullptr || !has_control_characters(value->get())) return;
  fail(node, std::string(what) + " '" + excerpt(value->get()) +
                 "' has control characters; expected a text in one line, without tabs and escapes");
}

std::string text(const toml::node& node, std::string_view what) {
  std::string value = long_text(node, what);
  require_one_line(node, what);
  return value;
}

std::string long_text(const toml::node& node, std::string_view what) {
  const auto* value = node.as_string();
  if (value == nullptr) fail_kind(node, what, "a text in quotes");
  if (trim(value->get()).empty()) fail(node, std::string(what) + " is empty; expected a text");
  return value->get();
}

double number(const toml::node& node, std::string_view what) {
  if (!node.is_number()) fail_kind(node, what, "a number");
  const double value = node.value<double>().value_or(std::nan(""));
  if (!std::isfinite(value)) fail(node, std::string(what) + " is not finite; expected a number");
  return value;
}

bool truth(const toml::node& node, std::string_view what) {
  if (!node.is_boolean()) fail_kind(node, what, "true or false");
  return node.as_boolean()->get();
}

const toml::table& table(const toml::node& node, std::string_view what) {
  if (!node.is_table()) fail_kind(node, what, "a table");
  return *node.as_table();
}

const toml::array& array(const toml::node& node, std::string_view what) {
  if (!node.is_array()) fail_kind(node, what, "a list");
  return *node.as_array();
}

std::vector<std::string> texts(const toml::node& node, std::string_view what) {
  std::vector<std::string> values;
  for (const auto& entry : array(node, what)) values.push_back(text(entry, "an entry of " + std::string(what)));
  return values;
}

std::vector<double> numbers(const toml::node& node, std::string_view what) {
  std::vector<double> values;
  for (const auto& entry : array(node, what)) values.push_back(number(entry, "an entry of " + std::string(what)));
  return values;
}

std::optional<double> tolerance(const toml::table& table, std::string_view key) {
  const toml::node* node = table.get(key);
  if (node == nullptr) return std::nullopt;
  const double value = number(*node, key);
  if (!(value >= kSmallestTolerance && value <= kLargestTolerance)) {
    fail(*node, std::string(key) + " is " + shortest(value) + "; expected a value in [" + shortest(kSmallestTolerance) +
                    ", " + shortest(kLargestTolerance) + "]");
  }
  return value;
}

}  // namespace lobe::toml_reader
