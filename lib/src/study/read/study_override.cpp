#include "study/read/study_override.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <memory>
#include <optional>
#include <utility>
#include <vector>

#include "core/text.hpp"
#include "lobe/core/error.hpp"

namespace lobe {
namespace {

namespace reader = toml_reader;

/// Keys that identify the entries of a list.
struct Kind {
  std::string_view key;
  std::array<std::string_view, 2> names;
};
constexpr std::array<Kind, 5> kOverrideKinds = {{{"family", {"name", "name"}},
                                                 {"material", {"name", "name"}},
                                                 {"measured", {"name", "family"}},
                                                 {"published", {"title", "title"}},
                                                 {"chart", {"name", "name"}}}};

/// "KEY=VALUE" taken apart.
struct Assignment {
  std::string label;  ///< for messages: "--set KEY=VALUE"
  std::string key;
  std::vector<std::string> parts;
  std::string value;
};

[[noreturn]] void refuse(const Assignment& given, const std::string& complaint) {
  throw ArgumentError(given.label + ": " + complaint, {.topic = Topic::studies});
}

/// Messages show what was given, as long as it is short.
std::string label_of(const std::string& text) {
  constexpr std::size_t kLongest = 60;
  std::string label = "--set " + (text.size() > kLongest ? text.substr(0, text.find('=') + 1) + "..." : text);
  std::ranges::replace(label, '\n', ' ');
  return label;
}

/// Where the key ends: the first '=' that is in no quotes, which begin with a part.
std::size_t end_of_key(const std::string& text) {
  char quote = '\0';
  for (std::size_t i = 0; i < text.size(); ++i) {
    const char c = text[i];
    const bool begins_part = i == 0 || text[i - 1] == '.';
    if (quote == '\0' && c == '=') return i;
    if (quote == '\0' && begins_part && (c == '"' || c == '\'')) {
      quote = c;
    } else if (c == quote) {
      quote = '\0';
    }
  }
  return std::string::npos;
}

std::vector<std::string> parts_of(const Assignment& given) {
  std::vector<std::string> parts(1);
  char quote = '\0';
  bool is_quoted = false;
  for (const char c : given.key) {
    if (quote != '\0') {
      if (c == quote) {
        quote = '\0';
      } else {
        parts.back() += c;
      }
    } else if ((c == '"' || c == '\'') && parts.back().empty()) {
      quote = c;
      is_quoted = true;
    } else if (c == '.') {
      parts.emplace_back();
      is_quoted = false;
    } else if (is_quoted) {
      refuse(given, "something follows a quoted part of the key; expected a dot");
    } else {
      parts.back() += c;
    }
  }
  if (quote != '\0') refuse(given, "a quote of the key is not closed; expected one");
  for (auto& part : parts) {
    if (part.empty()) refuse(given, "the key has an empty part; expected one like family.NAME.KEY");
  }
  return parts;
}

Assignment taken_apart(const std::string& text) {
  Assignment given{label_of(text), {}, {}, {}};
  const std::size_t end = end_of_key(text);
  if (end == std::string::npos) refuse(given, "there is no '='; expected KEY=VALUE, such as study.tolerance=1e-4");
  given.key = std::string(trim(text.substr(0, end)));
  given.value = std::string(trim(text.substr(end + 1)));
  if (given.value.empty()) refuse(given, "there is no value after '='; expected one as in a study file");
  given.parts = parts_of(given);
  return given;
}

/// Whether a text that is no TOML can be meant as a text without quotes.
bool is_plain_text(const std::string& text) {
  constexpr std::string_view kOther = "\"'[{}],+-.0123456789";
  const auto is_control = [](char c) { return static_cast<unsigned char>(c) < 0x20 || c == 0x7f; };
  return kOther.find(text.front()) == std::string_view::npos && std::ranges::none_of(text, is_control);
}

/// The key with quotes where TOML wants them.
std::string key_of(const Assignment& given) {
  std::string key;
  for (const auto& part : given.parts) {
    const auto is_bare = [](char c) {
      return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') || c == '-' || c == '_';
    };
    const char* const quote = std::ranges::all_of(part, is_bare) ? "" : "\"";
    key += (key.empty() ? "" : ".") + (quote + part + quote);
  }
  return key;
}

/// The value, in a table with the key "value". Its place is the label.
toml::table value_of(const Assignment& given) {
  const std::string_view label = given.label;
  if (given.value.find('\n') == std::string::npos) {
    try {
      return toml::parse("value = " + given.value, label);
    } catch (const toml::parse_error& error) {
      if (!is_plain_text(given.value)) {
        refuse(given, "not valid TOML: " + std::string(error.description()) + "; put a text in quotes, KEY='\"...\"'");
      }
    }
  } else if (!is_plain_text(given.value)) {
    refuse(given, "the value has several lines; expected one");
  }
  // A literal text has no quotes of its kind; one with both kinds has to be quoted by the user.
  const char quote = given.value.find('\'') == std::string::npos ? '\'' : '"';
  if (quote == '"' && given.value.find_first_of("\"\\") != std::string::npos) {
    refuse(given, "the text has quotes of both kinds; expected it quoted as in a study file");
  }
  return toml::parse("value = " + (quote + given.value + quote), label);
}

/// Description of a table or list with its place, for messages: "family 'Ward' of FILE:6".
std::string whereabouts(const std::string& what, const toml::node& node) {
  const toml::source_region& region = node.source();
  if (!region.path || region.begin.line == 0 || region.path->starts_with(reader::kOverride)) return what;
  return fmt::format("{} of {}:{}", what, *region.path, region.begin.line);
}

std::string known_keys(const toml::table& table, const std::string& word) {
  std::vector<std::string_view> known;
  for (const auto& [key, node] : table) known.push_back(key.str());
  return known.empty() ? "; it has none" : did_you_mean(word, known);
}

std::size_t place_in(const toml::array& list, const std::string& part, const Assignment& given,
                     const std::string& what) {
  std::size_t index = 0;
  const auto [end, error] = std::from_chars(part.data(), part.data() + part.size(), index);
  if (error != std::errc{} || end != part.data() + part.size() || index >= list.size()) {
    refuse(given, fmt::format("'{}' is no place in {}; expected {}", part, whereabouts(what, list),
                              list.empty() ? "an entry, but it is empty"
                                           : fmt::format("a whole number from 0 to {}", list.size() - 1)));
  }
  return index;
}

/// Goes down the key from `from` on, and sets what the last part means.
void assign(toml::table& table, std::span<const std::string> parts, const Assignment& given, std::string what) {
  toml::table parsed = value_of(given);
  toml::node& value = *parsed.get("value");
  const toml::source_region region = value.source();
  toml::node* at = &table;
  for (const auto& part : parts.first(parts.size() - 1)) {
    toml::node* next = nullptr;
    if (auto* list = at->as_array()) {
      next = list->get(place_in(*list, part, given, what));
    } else if (auto* group = at->as_table()) {
      next = group->get(part);
      if (next == nullptr) {
        refuse(given, fmt::format("there is no '{}' in {}{}", part, whereabouts(what, *at), known_keys(*group, part)));
      }
    } else {
      break;
    }
    at = next;
    what = fmt::format("'{}'", part);
  }
  const std::string& last = parts.back();
  if (auto* list = at->as_array()) {
    const auto place = static_cast<std::ptrdiff_t>(place_in(*list, last, given, what));
    value.visit([&](auto& found) { list->replace(list->cbegin() + place, std::move(found)); });
  } else if (auto* group = at->as_table()) {
    group->erase(last);  // with the place of the key
    value.visit([&](auto& found) { group->insert(toml::key(last, region), std::move(found)); });
  } else {
    refuse(given, fmt::format("{} is {}, which has no '{}'; expected a table or a list", whereabouts(what, *at),
                              reader::kind_of(*at), last));
  }
}

std::string name_of(const Kind& kind, const toml::table& entry) {
  for (const auto key : kind.names) {
    if (const auto* name = entry[key].as_string()) return name->get();
  }
  return kind.key == "measured" ? "measured" : "";  // the family that files have by default
}

/// The only entry of a kind that has the name.
toml::table& entry_named(StudySources& sources, const Kind& kind, const Assignment& given) {
  const std::string& name = given.parts[1];
  std::vector<toml::table*> found;
  std::vector<std::string> names;
  for (auto& file : sources.files) {
    toml::array* list = file.root[kind.key].as_array();
    if (list == nullptr) continue;  // what else it is shows when it is read
    for (toml::node& node : *list) {
      toml::table* entry = node.as_table();
      if (entry == nullptr) continue;
      names.push_back(name_of(kind, *entry));
      if (names.back() == name) found.push_back(entry);
    }
  }
  if (found.size() == 1) return *found.front();
  if (found.empty()) {
    std::vector<std::string_view> known;
    for (const auto& other : names) {
      if (!other.empty() && std::ranges::find(known, other) == known.end()) known.push_back(other);
    }
    refuse(given, fmt::format("there is no [[{}]] '{}' in {}{}", kind.key, name, sources.files.back().path.string(),
                              known.empty() ? "; it has none" : did_you_mean(name, known)));
  }
  refuse(given, fmt::format("there are {} [[{}]] '{}', at {}:{} and {}:{}; expected one", found.size(), kind.key, name,
                            *found[0]->source().path, found[0]->source().begin.line, *found[1]->source().path,
                            found[1]->source().begin.line));
}

}  // namespace

void apply_override(StudySources& sources, const std::string& text) {
  const Assignment given = taken_apart(text);
  const std::string& first = given.parts.front();
  const std::span<const std::string> parts(given.parts);
  if (first == "study") {
    if (parts.size() < 2) refuse(given, "the key names all of [study]; expected one of its keys, study.KEY");
    assign(sources.settings, parts.subspan(1), given, "[study]");
    sources.overrides.push_back({key_of(given), &sources.settings});
    return;
  }
  const auto kind = std::ranges::find(kOverrideKinds, first, &Kind::key);
  if (kind == kOverrideKinds.end()) {
    std::vector<std::string_view> known{"study"};
    for (const auto& other : kOverrideKinds) known.push_back(other.key);
    refuse(given, fmt::format("nothing in a study is called '{}'{}", first, did_you_mean(first, known)));
  }
  if (parts.size() < 3) {
    refuse(given, fmt::format("the key has {} parts; expected three or more, {}.NAME.KEY", parts.size(), first));
  }
  toml::table& entry = entry_named(sources, *kind, given);
  assign(entry, parts.subspan(2), given, fmt::format("{} '{}'", first, given.parts[1]));
  sources.overrides.push_back({key_of(given), &entry});
}

}  // namespace lobe
