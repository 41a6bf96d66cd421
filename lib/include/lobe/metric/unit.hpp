#pragma once

#include <string_view>

#include "lobe/metric/lighting.hpp"

namespace [[gnu::visibility("default")]] lobe {

/// How a unit is written.
enum class UnitStyle {
  plain,    ///< on terminals and in JSON: "1", "sr^1/2", "sr^2"
  udunits,  ///< in files, as UDUNITS reads it: "1", "sr^0.5", "sr2"
  printed   ///< in pictures: "", "√sr", "sr²"
};

/// The unit of norms and distances under a lighting.
[[nodiscard]] std::string_view norm_unit(const Lighting& lighting, UnitStyle style = UnitStyle::plain);

/// The unit of scalar products under a lighting, which is that of norms squared.
[[nodiscard]] std::string_view product_unit(const Lighting& lighting, UnitStyle style = UnitStyle::plain);

}  // namespace lobe
