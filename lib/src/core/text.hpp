#pragma once

#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace lobe {

/// The candidate nearest to a word by edit distance, if near enough to be a typing mistake; else empty.
[[nodiscard]] std::string nearest_word(std::string_view word, std::span<const std::string_view> candidates);

/// "; did you mean 'x'?" when there is a near word, else "; known: a, b, c".
[[nodiscard]] std::string did_you_mean(std::string_view word, std::span<const std::string_view> candidates);

/// Reads a whole text as a floating-point number; false when it is not one, or not finite.
[[nodiscard]] bool parse_number(std::string_view text, double& value);

/// Shortest decimal text that reads back as the same number.
[[nodiscard]] std::string shortest(double value);

[[nodiscard]] std::vector<std::string_view> split(std::string_view text, char separator);
[[nodiscard]] std::string_view trim(std::string_view text);

/// Converts ASCII letters to lower case.
[[nodiscard]] std::string lowercase(std::string_view text);

/// Whether a text holds what terminals obey: control characters of ASCII (NUL, line breaks, tabs, escapes, DEL), or
/// those of ISO 8859-1 as UTF-8 or as single bytes.
[[nodiscard]] bool has_control_characters(std::string_view text);

/// A text with its control characters as "\x1b", to be shown in a line.
[[nodiscard]] std::string printable(std::string_view text);

/// The beginning of a text, printable(), for messages that quote what may have any length; "..." stands for the rest.
[[nodiscard]] std::string excerpt(std::string_view text);

/// Text between marks of HTML or XML; control characters, which XML does not have, become blanks.
[[nodiscard]] std::string escaped_markup(std::string_view text);

/// A field of a comma-separated table (RFC 4180): quoted when it holds a comma, a quote or a line break.
[[nodiscard]] std::string csv_field(std::string_view text);

}  // namespace lobe
