#pragma once

#include <string_view>

#include "lobe/metric/lighting.hpp"

namespace [[gnu::visibility("default")]] lobe {

/// Notations of units.
enum class UnitStyle {
  plain,    ///< on terminals and in JSON: "1", "sr^1/2", "sr^2"
  udunits,  ///< in files, as UDUNITS reads it: "1", "sr^0.5", "sr2"
  printed   ///< in pictures: "", "√sr", "sr²"
};

/// Unit of norms and distances under a lighting.
[[nodiscard]] std::string_view norm_unit(const Lighting& lighting, UnitStyle style = UnitStyle::plain);

/// Unit of scalar products under a lighting, the square of the norms' unit.
[[nodiscard]] std::string_view product_unit(const Lighting& lighting, UnitStyle style = UnitStyle::plain);

}  // namespace lobe
