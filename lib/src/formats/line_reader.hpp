#pragma once

#include <cstddef>
#include <string_view>
#include <vector>

#include "formats/file_bytes.hpp"

namespace lobe {

/// The lines of a text, ended by LF or CR LF, one after the other, without the byte-order mark that UTF-8 may begin
/// with.
class LineReader {
 public:
  explicit LineReader(const FileBytes& file);

  /// Goes to the next line; false at the end.
  [[nodiscard]] bool next();
  /// Goes to the next line that is not blank; false at the end.
  [[nodiscard]] bool next_filled();
  /// The line without its end.
  [[nodiscard]] std::string_view line() const { return line_; }
  /// Counts from 1.
  [[nodiscard]] std::size_t number() const { return number_; }
  /// Where the next line begins.
  [[nodiscard]] std::size_t offset() const { return file_.size() - rest_.size(); }

  /// The numbers of a text, apart by blanks, tabs, commas or semicolons.
  /// \param most that are expected
  /// \throws IoError for anything that is no finite number, and for more of them
  [[nodiscard]] std::vector<double> numbers(std::string_view text, std::size_t most) const;
  [[nodiscard]] std::vector<double> numbers(std::size_t most) const { return numbers(line_, most); }
  /// How many rows of as many numbers there can be from here on, for storage that does not outgrow the file: a number
  /// has two characters at least.
  [[nodiscard]] std::size_t most_rows(std::size_t numbers) const;

  /// \throws IoError that names the line
  [[noreturn]] void refuse(std::string_view complaint) const { file_.refuse_line(number_, complaint); }

 private:
  const FileBytes& file_;
  std::string_view rest_;
  std::string_view line_;
  std::size_t number_ = 0;
};

/// The words of a text, apart by blanks, tabs, commas, semicolons or ends of lines.
[[nodiscard]] std::vector<std::string_view> words_of(std::string_view text);

/// Reads the next word of a text and cuts it off; empty at the end.
[[nodiscard]] std::string_view take_word(std::string_view& text);

}  // namespace lobe
