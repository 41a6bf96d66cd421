#include "formats/text_end.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <optional>
#include <string_view>
#include <vector>

#include "core/text.hpp"
#include "formats/line_reader.hpp"

namespace lobe {
namespace {

constexpr std::size_t kLooked = std::size_t{1} << 14;  // bytes at the end
constexpr std::size_t kFewestLines = 4;                // that tell how numbers are written

bool is_text(std::string_view bytes) {
  return std::ranges::none_of(bytes, [](char c) {
    const auto code = static_cast<unsigned char>(c);
    return code < ' ' && c != '\n' && c != '\r' && c != '\t';
  });
}

std::string_view last_word(std::string_view line) {
  const auto words = words_of(line);
  return words.empty() ? std::string_view() : words.back();
}

bool is_number(std::string_view word) {
  double value = 0;
  return parse_number(word, value);
}

/// Characters behind the decimal point, those of an exponent among them.
std::size_t decimals(std::string_view number) {
  const std::size_t point = number.find('.');
  return point == std::string_view::npos ? 0 : number.size() - point - 1;
}

/// How many decimals the last numbers of lines have where all have as many, and some.
std::optional<std::size_t> common_decimals(const std::vector<std::string_view>& lines) {
  std::optional<std::size_t> common;
  std::size_t count = 0;
  for (const std::string_view line : lines) {
    const std::string_view word = last_word(line);
    if (word.empty()) continue;
    if (!is_number(word)) {  // a heading, above all that counts
      common.reset();
      count = 0;
      continue;
    }
    if (count > 0 && decimals(word) != common) return {};
    common = decimals(word);
    ++count;
  }
  return count >= kFewestLines && common > 0 ? common : std::nullopt;
}

}  // namespace

std::string remark_on_end(const FileBytes& file) {
  const std::string_view content = file.content();
  const std::string_view end = content.substr(content.size() - std::min(content.size(), kLooked));
  const std::size_t before = end.rfind('\n');
  if (before == std::string_view::npos || !is_text(end)) return {};
  const std::string_view line = end.substr(before + 1);
  const std::string_view number = last_word(line);
  if (!is_number(number) || !line.ends_with(number)) return {};
  std::vector<std::string_view> lines = split(end.substr(0, before), '\n');
  if (end.size() < content.size()) lines.erase(lines.begin());  // which may begin before
  const auto common = common_decimals(lines);
  if (common && decimals(number) < *common) {
    file.refuse_end(
        fmt::format("the file ends within the number '{}', which has fewer decimals than those above it; "
                    "expected {}, or an end of this line",
                    number, *common));
  }
  return fmt::format("its last line is not ended: nobody can tell whether its last number, {}, was cut", number);
}

}  // namespace lobe
