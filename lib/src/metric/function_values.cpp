#include "metric/function_values.hpp"

#include <algorithm>
#include <cmath>
#include <string>

#include "core/parallel.hpp"
#include "lobe/core/error.hpp"

namespace lobe {
namespace {

constexpr std::size_t kPairsAtOnce = 512;  // that a thread asks for

// Of sums over one panel of functions that are not smooth at a random place, by levels of 4, 6 and 9 nodes: with half
// of the first, roots are off by more than stated at 6 instead of 4 % of the places; with half of the second, jumps at
// 12 instead of 3 %. What is left are places that no node tells from the end of the panel.
constexpr double kSafety = 3;   // of the difference of two levels: functions have kinks and jumps
constexpr double kEarlier = 1;  // of the difference before: two levels may agree by accident, three hardly do

}  // namespace

double turn_of(std::size_t number, int level) {
  constexpr double kGolden = 0.6180339887498949;
  const double turn = kGolden * static_cast<double>(number) + 0.37 * level;
  return turn - std::floor(turn);
}

Eigen::MatrixXd error_of_levels(std::span<const Eigen::MatrixXd> levels) {
  const auto change = [&](std::size_t level) -> Eigen::MatrixXd {
    return (levels[level] - levels[level - 1]).cwiseAbs();
  };
  const Eigen::MatrixXd error = kSafety * change(levels.size() - 1);
  if (levels.size() == 2) return error;
  return error.cwiseMax(kEarlier * change(levels.size() - 2));
}

BrdfValues values_at(const BrdfFunction& function, std::span<const Directions> pairs) {
  const auto count = static_cast<Eigen::Index>(pairs.size());
  const auto channels = static_cast<Eigen::Index>(function.channels.size());
  BrdfValues all{Eigen::MatrixXd(count, channels), Eigen::MatrixXd::Zero(count, channels)};
  const std::size_t piece = function.is_concurrent ? kPairsAtOnce : std::max<std::size_t>(1, pairs.size());
  parallel_for_pieces(pairs.size(), piece, [&](std::size_t begin, std::size_t end) {
    const BrdfValues values = function.at(pairs.subspan(begin, end - begin));
    const auto first = static_cast<Eigen::Index>(begin);
    all.value.middleRows(first, values.value.rows()) = values.value;
    if (values.error.size() > 0) all.error.middleRows(first, values.error.rows()) = values.error;
  });
  if (!all.value.allFinite()) throw NumericError("'" + function.name + "' has values that are no finite numbers");
  return all;
}

std::size_t common_channels(std::span<const BrdfFunction> functions) {
  if (functions.empty()) throw ArgumentError("no functions; expected at least one");
  std::size_t channels = 1;
  for (const auto& function : functions) channels = std::max(channels, function.channels.size());
  for (const auto& function : functions) {
    require_no_delta(function, "expected values alone, or a grid to measure tables on");
    if (function.channels.size() == 1 || function.channels.size() == channels) continue;
    throw ArgumentError("'" + function.name + "' has " + std::to_string(function.channels.size()) +
                        " channels; expected 1 or " + std::to_string(channels));
  }
  return channels;
}

}  // namespace lobe
