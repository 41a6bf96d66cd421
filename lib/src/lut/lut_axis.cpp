#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>

#include "core/text.hpp"
#include "lobe/core/error.hpp"
#include "lobe/lut/lut.hpp"
#include "lut/lut_measure.hpp"
#include "lut/parameter_places.hpp"

namespace lobe {
namespace {

constexpr std::size_t kMostEntries = 1U << 16;  // of one axis

constexpr std::array<std::string_view, 4> kMaps{"linear", "sqrt", "square", "log"};
constexpr std::array<std::string_view, 2> kEntries{"centres", "nodes"};

double unmapped(AxisMap map, double u) {
  switch (map) {
    case AxisMap::linear:
      return u;
    case AxisMap::sqrt:
      return u * u;
    case AxisMap::square:
      return std::sqrt(u);
    case AxisMap::log:
      return std::exp(u);
  }
  return u;
}

template <std::size_t N>
std::size_t index_of(std::string_view word, const std::array<std::string_view, N>& known, std::string_view what) {
  const auto found = std::ranges::find(known, word);
  if (found == known.end()) {
    throw ArgumentError(fmt::format("unknown {} '{}'{}", what, excerpt(word), did_you_mean(word, known)));
  }
  return static_cast<std::size_t>(found - known.begin());
}

double number_of(std::string_view text, std::string_view key, const std::string& axis) {
  double number = 0;
  if (!parse_number(text, number)) {
    throw ArgumentError(fmt::format("'{}' is no number; expected one for {} of axis {}", excerpt(text), key, axis));
  }
  return number;
}

[[noreturn]] void refuse(const LutAxis& axis, std::string_view problem, std::string_view expected) {
  throw ArgumentError(fmt::format("axis {}: {}; expected {}", axis.name, problem, expected));
}

void check_range(const LutAxis& axis) {
  const auto [low, high] = std::minmax(axis.from, axis.to);
  const std::string range = fmt::format("{} to {}", shortest(axis.from), shortest(axis.to));
  if (!(low < high)) refuse(axis, "its range " + range + " is empty", "different ends");
  if (axis.name == "cos_theta" && (low < 0 || high > 1)) refuse(axis, "its range is " + range, "values from 0 to 1");
  if (axis.name == "theta" && (low < 0 || high > 90)) refuse(axis, "its range is " + range, "0 to 90 degrees");
  if (axis.map == AxisMap::log && low <= 0) refuse(axis, "its range is " + range, "ends above 0 for map=log");
  if (axis.map == AxisMap::sqrt && low < 0) refuse(axis, "its range is " + range, "ends from 0 on for map=sqrt");
  if (axis.map == AxisMap::square && low < 0) refuse(axis, "its range is " + range, "ends from 0 on for map=square");
}

}  // namespace

double mapped(AxisMap map, double value) {
  switch (map) {
    case AxisMap::linear:
      return value;
    case AxisMap::sqrt:
      return std::sqrt(value);
    case AxisMap::square:
      return value * value;
    case AxisMap::log:
      return std::log(value);
  }
  return value;
}

std::string_view to_string(AxisMap map) {
  return kMaps.at(static_cast<std::size_t>(map));
}

std::string_view to_string(AxisEntries entries) {
  return kEntries.at(static_cast<std::size_t>(entries));
}

double LutAxis::coordinate(std::size_t entry) const {
  if (entries == AxisEntries::centres) return (static_cast<double>(entry) + 0.5) / static_cast<double>(count);
  return static_cast<double>(entry) / static_cast<double>(count - 1);
}

double LutAxis::mapped_value(double coordinate) const {
  if (coordinate <= 0) return mapped(map, from);
  if (coordinate >= 1) return mapped(map, to);
  const double low = mapped(map, from);
  return low + coordinate * (mapped(map, to) - low);
}

double LutAxis::value(double coordinate) const {
  if (coordinate <= 0) return std::max(from, least);
  if (coordinate >= 1) return std::max(to, least);
  return std::max(unmapped(map, mapped_value(coordinate)), least);
}

LutAxis parse_lut_axis(std::string_view text, const Reflectance& reflectance) {
  if (has_control_characters(text)) {
    throw ArgumentError(fmt::format("axis '{}' has control characters; expected NAME:key=value,...", excerpt(text)));
  }
  LutAxis axis;
  const std::size_t colon = text.find(':');
  axis.name = std::string(trim(text.substr(0, colon)));
  std::optional<double> from;
  std::optional<double> to;
  const std::string_view keys = colon == std::string_view::npos ? std::string_view() : text.substr(colon + 1);
  for (const std::string_view part : split(keys, ',')) {
    if (trim(part).empty()) continue;
    const std::size_t equals = part.find('=');
    const std::string_view key = trim(part.substr(0, equals));
    constexpr std::array<std::string_view, 5> kKeys{"count", "from", "to", "map", "entries"};
    const std::size_t which = index_of(key, kKeys, "key of axis " + axis.name);
    if (equals == std::string_view::npos) {
      throw ArgumentError(fmt::format("axis {}: '{}' has no value; expected {}=VALUE", axis.name, key, key));
    }
    const std::string_view value = trim(part.substr(equals + 1));
    switch (which) {
      case 0: {
        const double count = number_of(value, key, axis.name);
        if (!(count >= 2 && count <= kMostEntries && count == std::floor(count))) {
          refuse(axis, fmt::format("count={}", value), fmt::format("a whole number from 2 to {}", kMostEntries));
        }
        axis.count = static_cast<std::size_t>(count);
        break;
      }
      case 1:
        from = number_of(value, key, axis.name);
        break;
      case 2:
        to = number_of(value, key, axis.name);
        break;
      case 3:
        axis.map = static_cast<AxisMap>(index_of(value, kMaps, "map"));
        break;
      default:
        axis.entries = static_cast<AxisEntries>(index_of(value, kEntries, "place of entries"));
    }
  }
  if (axis.name == "cos_theta" || axis.name == "theta") {
    axis.from = from.value_or(0);
    axis.to = to.value_or(axis.name == "theta" ? 90 : 1);
  } else {
    const ParameterRange range = parameter_range(reflectance, axis.name);
    const bool is_share = range.minimum >= 0 && range.maximum <= 1;
    if ((!from || !to) && !is_share) {
      refuse(axis, "the parameter has no range from 0 to 1", "from=... and to=...");
    }
    // Beside the range such a least value is 0: u is then the roughness itself, say.
    constexpr double kTiny = 1e-3;
    const bool begins_near_0 = range.minimum > 0 && range.minimum <= kTiny * range.maximum;
    axis.from = from.value_or(begins_near_0 && axis.map != AxisMap::log ? 0 : range.minimum);
    axis.to = to.value_or(range.maximum);
    if (begins_near_0 && std::min(axis.from, axis.to) == 0) axis.least = range.minimum;
  }
  check_range(axis);
  return axis;
}

std::string to_string(const LutAxis& axis) {
  return fmt::format("{}:count={},from={},to={},map={},entries={}", axis.name, axis.count, shortest(axis.from),
                     shortest(axis.to), to_string(axis.map), to_string(axis.entries));
}

}  // namespace lobe
