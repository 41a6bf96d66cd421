#pragma once

#include <filesystem>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "study/read/toml.hpp"

/// Reading TOML so that every complaint names the place: ArgumentError "FILE:LINE:COLUMN: what; expected ...".
namespace lobe::toml_reader {

/// How the names of what stands in no file begin: overrides, whose places have no lines.
inline constexpr std::string_view kOverride = "--set ";

/// \throws ArgumentError "FILE:LINE:COLUMN: message", of overrides "--set KEY=VALUE: message".
[[noreturn]] void fail(const toml::source_region& place, const std::string& message);
[[noreturn]] void fail(const toml::node& place, const std::string& message);

/// \param file name for messages
/// \throws ArgumentError for malformed TOML.
[[nodiscard]] toml::table parse(const std::string& text, const std::filesystem::path& file);

/// Place of a key of a table, else of the table.
[[nodiscard]] toml::source_region place_of(const toml::table& table, std::string_view key);

/// \param where what the keys belong to, for the message: "[study]"
/// \throws ArgumentError at the first key that is not known.
void require_known_keys(const toml::table& table, std::span<const std::string_view> known, std::string_view where);

/// The value of a key.
/// \throws ArgumentError when it is missing.
[[nodiscard]] const toml::node& require(const toml::table& table, std::string_view key, std::string_view where);

/// The kind of a value in words, for messages: "a text", "a table", ...
[[nodiscard]] std::string kind_of(const toml::node& node);

/// \throws ArgumentError for a text with control characters, such as line breaks: names and titles come into pictures,
///   tables and onto terminals.
void require_one_line(const toml::node& node, std::string_view what);

/// Values of a given kind; `what` names them in messages.
/// \throws ArgumentError for another kind, and where a text is empty or has control characters, or a number is not
///   finite.
[[nodiscard]] std::string text(const toml::node& node, std::string_view what);
/// A text that may have several lines, and whatever else its reader takes.
[[nodiscard]] std::string long_text(const toml::node& node, std::string_view what);
[[nodiscard]] double number(const toml::node& node, std::string_view what);
[[nodiscard]] bool truth(const toml::node& node, std::string_view what);
[[nodiscard]] const toml::table& table(const toml::node& node, std::string_view what);
[[nodiscard]] const toml::array& array(const toml::node& node, std::string_view what);
[[nodiscard]] std::vector<std::string> texts(const toml::node& node, std::string_view what);
[[nodiscard]] std::vector<double> numbers(const toml::node& node, std::string_view what);

/// Range of relative tolerances.
inline constexpr double kSmallestTolerance = 1e-12;
inline constexpr double kLargestTolerance = 0.1;

/// The value of a key as a relative tolerance; none where the key is missing.
[[nodiscard]] std::optional<double> tolerance(const toml::table& table, std::string_view key);

}  // namespace lobe::toml_reader
