#include "lobe/metric/comparison.hpp"

#include <algorithm>
#include <array>

#include "core/text.hpp"
#include "lobe/core/error.hpp"

namespace lobe {
namespace {

using enum Comparison;

constexpr std::array kAll{ngan_l2,      low_l2,       bieron_l2,
                          low_log,      bieron_log,   standard_log,
                          cube_root,    log_relative, albedo_of_difference,
                          cube_root_l2, cube_root_log};
constexpr std::array<std::string_view, kAll.size()> kNames{"ngan-l2",      "low-l2",       "bieron-l2",
                                                           "low-log",      "bieron-log",   "standard-log",
                                                           "cube-root",    "log-relative", "albedo-of-difference",
                                                           "cube-root-l2", "cube-root-log"};

}  // namespace

std::span<const Comparison> comparisons() {
  return kAll;
}

std::string_view to_string(Comparison comparison) {
  return kNames[static_cast<std::size_t>(comparison)];
}

Comparison parse_comparison(std::string_view name) {
  const auto found = std::find(kNames.begin(), kNames.end(), name);
  if (found == kNames.end()) {
    throw ArgumentError("unknown comparison metric '" + std::string(name) + "'" + did_you_mean(name, kNames));
  }
  return static_cast<Comparison>(found - kNames.begin());
}

std::string_view unit_of(Comparison comparison) {
  switch (comparison) {
    case ngan_l2:
    case low_l2:
    case bieron_l2:
      return "sr^-1 rad^1.5";
    case low_log:
    case bieron_log:
    case standard_log:
      return "rad^1.5";
    case cube_root:
    case cube_root_l2:
      return "sr^(-1/3)";
    case log_relative:
    case cube_root_log:
      return "";
    case albedo_of_difference:
      return "sr";
  }
  return "";
}

}  // namespace lobe
