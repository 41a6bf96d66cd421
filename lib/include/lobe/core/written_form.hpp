#pragma once

#include <span>
#include <string_view>

namespace [[gnu::visibility("default")]] lobe {

/// A way of writing something.
struct WrittenForm {
  std::string_view word;     ///< what it begins with: "patch"
  std::string_view written;  ///< the whole, values in capitals: "patch:R"
  std::string_view meaning;  ///< what that is, one phrase
};

// Each list is the one that its reader goes by.

/// What HemisphereGrid::parse() reads, in the order of GridKind.
[[nodiscard]] std::span<const WrittenForm> grid_forms();

/// What parse_lighting() reads, and the tables that only commands read.
[[nodiscard]] std::span<const WrittenForm> lighting_forms();

/// What may be done to a whole material, written behind '@'.
[[nodiscard]] std::span<const WrittenForm> adjustment_forms();

}  // namespace lobe
