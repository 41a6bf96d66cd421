#include "study/read/origin.hpp"

#include <fmt/format.h>

#include <cctype>
#include <charconv>
#include <string_view>

namespace lobe {
namespace {

constexpr std::string_view kSet = "--set ";
constexpr std::string_view kNext = ", --set ";

/// Splits "FILE:LINE" at its colon; npos for another text.
std::size_t colon_of(std::string_view place) {
  const std::size_t colon = place.rfind(':');
  if (colon == std::string_view::npos || colon == 0 || colon + 1 == place.size()) return std::string_view::npos;
  const bool is_number = place.find_first_not_of("0123456789", colon + 1) == std::string_view::npos;
  return is_number ? colon : std::string_view::npos;
}

/// Takes the keys that were set from outside off the end.
void take_overrides(std::string_view& text, Origin& origin) {
  std::size_t begin = text.starts_with(kSet) ? 0 : text.find(kNext);
  if (begin == std::string_view::npos) return;
  std::string_view keys = text.substr(begin + (begin == 0 ? kSet : kNext).size());
  text = text.substr(0, begin);
  for (std::size_t end = keys.find(kNext); end != std::string_view::npos; end = keys.find(kNext)) {
    origin.overrides.emplace_back(keys.substr(0, end));
    keys.remove_prefix(end + kNext.size());
  }
  origin.overrides.emplace_back(keys);
}

/// Takes "(m=0.1)" off the end: all behind the first "FILE:LINE ", or the whole.
void take_swept(std::string_view& text, Origin& origin) {
  if (!text.ends_with(')')) return;
  std::size_t open = text.starts_with('(') ? 0 : text.find(" (");
  while (open != 0 && open != std::string_view::npos && colon_of(text.substr(0, open)) == std::string_view::npos) {
    open = text.find(" (", open + 1);
  }
  if (open == std::string_view::npos) return;
  const std::size_t first = open + (open == 0 ? 1 : 2);
  origin.swept = text.substr(first, text.size() - 1 - first);
  text = text.substr(0, open);
}

}  // namespace

std::string to_string(const Origin& origin) {
  std::string text = origin.file;
  if (origin.line > 0) text += fmt::format(":{}", origin.line);
  if (!origin.swept.empty()) text += fmt::format("{}({})", text.empty() ? "" : " ", origin.swept);
  for (const auto& key : origin.overrides) text += fmt::format("{}--set {}", text.empty() ? "" : ", ", key);
  return text.empty() ? "default" : text;
}

Origin read_origin(const std::string& text) {
  Origin origin;
  if (text == to_string(origin)) return origin;
  std::string_view rest = text;
  take_overrides(rest, origin);
  take_swept(rest, origin);
  if (const std::size_t colon = colon_of(rest); colon != std::string_view::npos) {
    origin.file = rest.substr(0, colon);
    std::from_chars(rest.data() + colon + 1, rest.data() + rest.size(), origin.line);
    rest = {};
  }
  if (rest.empty() && to_string(origin) == text) return origin;
  return {.file = text, .line = 0, .swept = "", .overrides = {}};
}

}  // namespace lobe
