#include "lobe/metric/unit.hpp"

#include <array>
#include <cstddef>

namespace lobe {
namespace {

/// The steradian to a power of halves.
std::string_view steradians(int halves, UnitStyle style) {
  constexpr std::array<std::array<std::string_view, 5>, 3> kSpellings{{{"1", "sr^1/2", "sr", "sr^3/2", "sr^2"},
                                                                       {"1", "sr^0.5", "sr", "sr^1.5", "sr2"},
                                                                       {"", "√sr", "sr", "sr√sr", "sr²"}}};
  return kSpellings.at(static_cast<std::size_t>(style)).at(static_cast<std::size_t>(halves));
}

}  // namespace

std::string_view norm_unit(const Lighting& lighting, UnitStyle style) {
  return steradians(lighting.product_power(), style);
}

std::string_view product_unit(const Lighting& lighting, UnitStyle style) {
  return steradians(2 * lighting.product_power(), style);
}

}  // namespace lobe
