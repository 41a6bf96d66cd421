#include "formats/line_reader.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "core/text.hpp"

namespace lobe {
namespace {

constexpr std::string_view kBetweenWords = " \t\r\n,;";
constexpr std::size_t kQuoted = 40;  // characters of a word that complaints show
constexpr std::string_view kByteOrderMark = "\xEF\xBB\xBF";

}  // namespace

LineReader::LineReader(const FileBytes& file) : file_(file), rest_(file.content()) {
  if (rest_.starts_with(kByteOrderMark)) rest_.remove_prefix(kByteOrderMark.size());
}

bool LineReader::next() {
  if (rest_.empty()) return false;
  const std::size_t end = std::min(rest_.find('\n'), rest_.size());
  line_ = rest_.substr(0, end);
  if (line_.ends_with('\r')) line_.remove_suffix(1);
  rest_.remove_prefix(std::min(end + 1, rest_.size()));
  ++number_;
  return true;
}

bool LineReader::next_filled() {
  while (next()) {
    if (!trim(line_).empty()) return true;
  }
  return false;
}

std::vector<double> LineReader::numbers(std::string_view text, std::size_t most) const {
  std::vector<double> found;
  found.reserve(std::min(most, text.size() / 2 + 1));
  for (auto word = take_word(text); !word.empty(); word = take_word(text)) {
    double value = 0;
    if (!parse_number(word, value)) {
      refuse(fmt::format("'{}' is no finite number", word.substr(0, kQuoted)));
    }
    if (found.size() == most) refuse(fmt::format("more than {} numbers", most));
    found.push_back(value);
  }
  return found;
}

std::size_t LineReader::most_rows(std::size_t numbers) const {
  const auto ends = static_cast<std::size_t>(std::ranges::count(rest_, '\n'));
  return std::min(ends + 1, rest_.size() / (2 * std::max<std::size_t>(numbers, 1)) + 1);
}

std::string_view take_word(std::string_view& text) {
  const std::size_t begin = std::min(text.find_first_not_of(kBetweenWords), text.size());
  text.remove_prefix(begin);
  const std::string_view word = text.substr(0, text.find_first_of(kBetweenWords));
  text.remove_prefix(word.size());
  return word;
}

std::vector<std::string_view> words_of(std::string_view text) {
  std::vector<std::string_view> words;
  for (auto word = take_word(text); !word.empty(); word = take_word(text)) words.push_back(word);
  return words;
}

}  // namespace lobe
