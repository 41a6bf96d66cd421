#include "core/text.hpp"

#include <algorithm>
#include <array>
#include <cctype>
#include <charconv>
#include <cmath>
#include <numeric>

namespace lobe {
namespace {

char lower(char c) {
  return static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
}

/// Capitals count as their small letters.
std::size_t edit_distance(std::string_view a, std::string_view b) {
  std::vector<std::size_t> row(b.size() + 1);
  std::iota(row.begin(), row.end(), std::size_t{0});
  for (std::size_t i = 1; i <= a.size(); ++i) {
    std::size_t diagonal = row[0];
    row[0] = i;
    for (std::size_t j = 1; j <= b.size(); ++j) {
      const std::size_t above = row[j];
      row[j] = std::min({above + 1, row[j - 1] + 1, diagonal + (lower(a[i - 1]) == lower(b[j - 1]) ? 0U : 1U)});
      diagonal = above;
    }
  }
  return row[b.size()];
}

/// Length of the control character with which a text begins; 0 where it begins with something else, whose length
/// `other` becomes.
std::size_t control_length(std::string_view text, std::size_t& other) {
  const auto byte = [&](std::size_t at) { return at < text.size() ? static_cast<unsigned char>(text[at]) : 0U; };
  const unsigned first = byte(0);
  other = 1;
  if (first < 0x20U || first == 0x7fU || (first >= 0x80U && first < 0xa0U)) return 1;
  if (first < 0xc2U || first > 0xf4U) return 0;
  if (first == 0xc2U && byte(1) >= 0x80U && byte(1) < 0xa0U) return 2;
  const std::size_t length = first < 0xe0U ? 2 : first < 0xf0U ? 3 : 4;
  for (std::size_t at = 1; at < length; ++at) {
    if ((byte(at) & 0xc0U) != 0x80U) return 0;  // no UTF-8: the next byte is looked at by itself
  }
  other = length;
  return 0;
}

}  // namespace

std::string nearest_word(std::string_view word, std::span<const std::string_view> candidates) {
  std::size_t best = std::max<std::size_t>(word.size() < 4 ? 1 : 2, word.size() / 3) + 1;
  std::string_view found;
  for (const auto candidate : candidates) {
    const bool extends = word.size() >= 3 && candidate.find(word) != std::string_view::npos;
    const std::size_t distance = extends ? 1 : edit_distance(word, candidate);
    if (distance < best && distance < candidate.size()) {
      best = distance;
      found = candidate;
    }
  }
  return std::string(found);
}

std::string did_you_mean(std::string_view word, std::span<const std::string_view> candidates) {
  const std::string near = nearest_word(word, candidates);
  if (!near.empty()) return "; did you mean '" + near + "'?";
  std::string text = "; known: ";
  for (std::size_t i = 0; i < candidates.size(); ++i) {
    if (i > 0) text += ", ";
    text += candidates[i];
  }
  return text;
}

bool parse_number(std::string_view text, double& value) {
  if (text.size() > 1 && text.front() == '+' && text[1] != '-') text.remove_prefix(1);
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  return error == std::errc{} && end == text.data() + text.size() && std::isfinite(value);
}

std::string shortest(double value) {
  std::array<char, 32> buffer{};
  const auto [end, error] = std::to_chars(buffer.data(), buffer.data() + buffer.size(), value);
  return std::string(buffer.data(), end);
}

std::vector<std::string_view> split(std::string_view text, char separator) {
  std::vector<std::string_view> parts;
  for (;;) {
    const std::size_t at = text.find(separator);
    parts.push_back(text.substr(0, at));
    if (at == std::string_view::npos) return parts;
    text.remove_prefix(at + 1);
  }
}

std::string_view trim(std::string_view text) {
  constexpr std::string_view kBlank = " \t\r\n";
  const std::size_t first = text.find_first_not_of(kBlank);
  if (first == std::string_view::npos) return {};
  return text.substr(first, text.find_last_not_of(kBlank) - first + 1);
}

std::string csv_field(std::string_view text) {
  if (text.find_first_of(",\"\r\n") == std::string_view::npos) return std::string(text);
  std::string quoted = "\"";
  for (const char c : text) {
    if (c == '"') quoted += '"';
    quoted += c;
  }
  return quoted + '"';
}

bool has_control_characters(std::string_view text) {
  std::size_t step = 1;
  for (; !text.empty(); text.remove_prefix(step)) {
    if (control_length(text, step) > 0) return true;
  }
  return false;
}

std::string excerpt(std::string_view text) {
  constexpr std::size_t kLongest = 40;
  if (text.size() <= kLongest) return printable(text);
  std::size_t end = kLongest;
  const auto is_inside = [](char byte) { return (static_cast<unsigned char>(byte) & 0xc0U) == 0x80U; };  // of UTF-8
  while (end > 0 && is_inside(text[end])) --end;
  return printable(text.substr(0, end == 0 ? kLongest : end)) + "...";
}

std::string printable(std::string_view text) {
  constexpr std::string_view kDigits = "0123456789abcdef";
  std::string result;
  std::size_t step = 1;
  for (; !text.empty(); text.remove_prefix(step)) {
    const std::size_t length = control_length(text, step);
    if (length == 0) {
      result += text.substr(0, step);
      continue;
    }
    step = length;
    const auto code = static_cast<unsigned char>(text[length - 1]);
    result += "\\x";
    result += kDigits[code >> 4U];
    result += kDigits[code & 15U];
  }
  return result;
}

std::string lowercase(std::string_view text) {
  std::string result(text);
  std::ranges::transform(result, result.begin(), lower);
  return result;
}

std::string escaped_markup(std::string_view text) {
  std::string result;
  for (const char c : text) {
    if (c == '&') {
      result += "&amp;";
    } else if (c == '<') {
      result += "&lt;";
    } else if (c == '>') {
      result += "&gt;";
    } else {
      result += static_cast<unsigned char>(c) < ' ' ? ' ' : c;
    }
  }
  return result;
}

}  // namespace lobe
