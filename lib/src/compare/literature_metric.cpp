#include "lobe/compare/literature_metric.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include "compare/comparison_measure.hpp"
#include "core/text.hpp"
#include "lobe/core/error.hpp"

namespace lobe {
namespace {

using enum LiteratureMetric;

constexpr double kOffset = 1e-3;  // Nielsen et al. 2015, Lavoue et al. 2021

// Factor on f before it is mapped.

double one(double, double) {
  return 1;
}
double cos_in(double cos_i, double) {
  return cos_i;
}
/// ln(f w + e) - ln(g w + e) = ln(1 + f w/e) - ln(1 + g w/e)
double above_epsilon(double cos_i, double cos_o) {
  return std::max(cos_i * cos_o, kOffset) / kOffset;
}
/// Scale above epsilon for f^(1/3), so that f has the cube.
double cube_above_epsilon(double cos_i, double cos_o) {
  const double w = above_epsilon(cos_i, cos_o);
  return w * w * w;
}

// Published weights beside the measure of the domain.

double sine_in(double cos_i, double) {
  return sine(cos_i);
}
double both_sines(double cos_i, double cos_o) {
  return sine(cos_i) * sine(cos_o);
}
double cos_out_and_sines(double cos_i, double cos_o) {
  return cos_o * sine(cos_i) * sine(cos_o);
}

constexpr std::string_view kSquares = "sr^-1 rad^1.5";
constexpr std::string_view kLogarithms = "rad^1.5";
constexpr std::string_view kCubeRoots = "sr^(-1/3)";
constexpr ComparisonRecipe kLog{.map = NodeMap::log};

/// In the order of the enumeration, which says what each is and where from.
constexpr auto kRows = std::to_array<ComparisonRow>({
    {ngan_l2, "ngan-l2", kSquares, {}, cos_in, both_sines},
    {low_l2, "low-l2", kSquares, {}, cos_in, sine_in},
    {bieron_l2, "bieron-l2", kSquares, {}, cos_in, cos_out_and_sines},
    {low_log, "low-log", kLogarithms, kLog, cos_in, sine_in},
    {bieron_log, "bieron-log", kLogarithms, kLog, cos_in, cos_out_and_sines},
    {standard_log, "standard-log", kLogarithms, kLog, cos_in, both_sines},
    {cube_root, "cube-root", kCubeRoots, {.term = PairTerm::two_thirds, .is_mean = true}, cos_in, one},
    {log_relative,
     "log-relative",
     "",
     {.domain = ComparisonDomain::half_difference, .map = NodeMap::log, .is_mean = true},
     above_epsilon,
     one},
    {albedo_of_difference,
     "albedo-of-difference",
     "sr",
     {.domain = ComparisonDomain::projected, .term = PairTerm::absolute, .is_root = false},
     one,
     one},
    {cube_root_l2, "cube-root-l2", kCubeRoots, {.map = NodeMap::cube_root, .is_mean = true}, one, one},
    {cube_root_log,
     "cube-root-log",
     "",
     {.map = NodeMap::cube_root_log, .term = PairTerm::absolute, .is_mean = true, .is_root = false},
     cube_above_epsilon,
     one},
});

template <typename Field>
constexpr auto column(Field ComparisonRow::*field) {
  std::array<Field, kRows.size()> fields{};
  std::ranges::transform(kRows, fields.begin(), field);
  return fields;
}
constexpr auto kAll = column(&ComparisonRow::comparison);
constexpr auto kNames = column(&ComparisonRow::name);

constexpr bool is_in_order() {
  for (std::size_t k = 0; k < kAll.size(); ++k) {
    if (static_cast<std::size_t>(kAll[k]) != k) return false;
  }
  return true;
}
static_assert(is_in_order());

}  // namespace

const ComparisonRow& row_of(LiteratureMetric comparison) {
  return kRows[static_cast<std::size_t>(comparison)];
}

std::span<const LiteratureMetric> literature_metrics() {
  return kAll;
}

std::string_view to_string(LiteratureMetric comparison) {
  return row_of(comparison).name;
}

LiteratureMetric parse_literature_metric(std::string_view name) {
  const auto found = std::find(kNames.begin(), kNames.end(), name);
  if (found == kNames.end()) {
    throw ArgumentError("unknown comparison metric '" + std::string(name) + "'" + did_you_mean(name, kNames));
  }
  return static_cast<LiteratureMetric>(found - kNames.begin());
}

std::string_view unit_of(LiteratureMetric comparison) {
  return row_of(comparison).unit;
}

}  // namespace lobe
