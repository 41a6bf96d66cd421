#pragma once

#include <span>
#include <string_view>

namespace [[gnu::visibility("default")]] lobe {

/// A notation that a reader accepts.
struct WrittenForm {
  std::string_view word;     ///< its first word: "patch"
  std::string_view written;  ///< the whole notation, with values in capitals: "patch:R"
  std::string_view meaning;  ///< its meaning, one phrase
};

// The readers themselves use these lists.

/// Notations for grids, as HemisphereGrid::parse() reads them, in the order of GridKind.
[[nodiscard]] std::span<const WrittenForm> grid_forms();

/// Notations for lightings, as parse_lighting() reads them, and for tables, which only commands read.
[[nodiscard]] std::span<const WrittenForm> lighting_forms();

/// Notations for adjustments of a whole material, written behind '@'.
[[nodiscard]] std::span<const WrittenForm> adjustment_forms();

}  // namespace lobe
