#include <algorithm>
#include <array>
#include <string>

#include "core/text.hpp"
#include "lobe/error.hpp"
#include "lobe/metric.hpp"

namespace lobe {
namespace {

constexpr std::array<std::string_view, 2> kNames{"point", "daylight"};

}  // namespace

std::string_view to_string(Lighting lighting) {
  return kNames[static_cast<std::size_t>(lighting)];
}

Lighting parse_lighting(std::string_view name) {
  const auto found = std::find(kNames.begin(), kNames.end(), name);
  if (found == kNames.end()) {
    throw ArgumentError("unknown lighting '" + std::string(name) + "'" + did_you_mean(name, kNames));
  }
  return static_cast<Lighting>(found - kNames.begin());
}

}  // namespace lobe
