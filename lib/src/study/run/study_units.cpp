#include "study/run/study_units.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <numeric>
#include <set>

#include "lobe/compare/literature_metric.hpp"
#include "metric/lighting_traits.hpp"
#include "study/run/checkpoint_records.hpp"

namespace lobe {
namespace {

// Estimates by one core. They decide who computes what, never a result; a shard with more than its share only takes
// longer. Rules refine until errors are small enough, so that nothing better is known beforehand.
constexpr double kPerMaterial = 0.05;    // s, under point light, for all slabs
constexpr double kPerPair = 4e-4;        // s
constexpr double kCoarseShare = 0.1;     // of the first pass, which every shard of a lighting makes
constexpr double kDaylightShare = 0.2;   // of the time under point light
constexpr double kPatchFactor = 5;       // of the time under point light
constexpr double kComparisonFactor = 1;  // of the time under point light
constexpr double kTableFactor = 10;      // of the time under point light, for whatever goes by functions or tables
constexpr double kCurves = 0.03;         // s, of a material
constexpr double kFigure = 0.1;          // s
constexpr double kChartPoint = 5e-3;     // s

double point_cost(std::size_t materials) {
  const auto n = static_cast<double>(materials);
  return kPerMaterial * n + kPerPair * n * n;
}

/// \param by_formulas the route
double lighting_cost(const Lighting& lighting, std::size_t materials, bool by_formulas) {
  const double point = point_cost(materials);
  if (!by_formulas) return kTableFactor * point;
  const LightingTraits& traits = traits_of(lighting);
  if (traits.has_operator) return kPatchFactor * point;
  return lighting == Lighting::point() ? point : kDaylightShare * point;
}

}  // namespace

std::string slab_name(const Lighting& lighting, std::size_t slab) {
  return fmt::format("slab {} of lighting {}", slab + 1, lighting.name());
}

std::string curves_name(std::size_t material) {
  return fmt::format("curves of material {}", material + 1);
}

std::string figure_name(std::size_t figure) {
  return fmt::format("published figure {}", figure + 1);
}

std::string chart_curve_name(std::size_t chart, std::size_t curve) {
  return fmt::format("curve {} of chart {}", curve + 1, chart + 1);
}

std::vector<StudyUnit> study_units(const Study& study, RoutedSet& set) {
  using enum StudyUnit::Kind;
  std::vector<StudyUnit> units;
  const std::size_t materials = study.materials.size();
  std::size_t group = 0;
  for (std::size_t i = 0; i < study.lightings.size(); ++i, ++group) {
    const Lighting& lighting = study.lightings[i];
    const std::size_t slabs = set.slabs(lighting);
    const bool by_formulas = choose_route(set.reflectances(), lighting, metric_options(study)).route == Route::formulas;
    const double cost = lighting_cost(lighting, materials, by_formulas);
    if (slabs < 2) {
      units.push_back(
          {.kind = StudyUnit::Kind::lighting, .index = i, .name = record_name(lighting), .cost = cost, .group = group});
    }
    for (std::size_t slab = 0; slab < slabs && slabs > 1; ++slab) {
      units.push_back({.kind = StudyUnit::Kind::slab,
                       .index = i,
                       .part = slab,
                       .name = slab_name(lighting, slab),
                       .cost = (1 - kCoarseShare) * cost / static_cast<double>(slabs),
                       .shared_cost = kCoarseShare * cost,
                       .group = group});
    }
  }
  for (std::size_t i = 0; i < study.comparison_metrics.size(); ++i, ++group) {
    units.push_back({.kind = comparison,
                     .index = i,
                     .name = record_name(study.comparison_metrics[i]),
                     .cost = kComparisonFactor * point_cost(materials),
                     .group = group});
  }
  for (std::size_t i = 0; i < materials; ++i) {
    units.push_back({.kind = curves, .index = i, .name = curves_name(i), .cost = kCurves, .group = group});
  }
  ++group;
  for (std::size_t i = 0; i < study.published.size(); ++i) {
    units.push_back({.kind = figure, .index = i, .name = figure_name(i), .cost = kFigure, .group = group});
  }
  ++group;
  for (std::size_t i = 0; i < study.charts.size(); ++i, ++group) {
    for (std::size_t k = 0; k < study.charts[i].curves.size(); ++k) {
      units.push_back({.kind = chart_curve,
                       .index = i,
                       .part = k,
                       .name = chart_curve_name(i, k),
                       .cost = kChartPoint * static_cast<double>(study.charts[i].x.size()),
                       .group = group});
    }
  }
  return units;
}

std::vector<std::size_t> dealt_units(const std::vector<StudyUnit>& units, std::size_t shards) {
  std::map<std::size_t, std::vector<std::size_t>> members;  // of groups
  for (std::size_t u = 0; u < units.size(); ++u) members[units[u].group].push_back(u);
  std::vector<std::vector<std::size_t>> groups;
  for (auto& [group, all] : members) groups.push_back(std::move(all));
  const auto cost_of = [&](const std::vector<std::size_t>& group) {
    return std::accumulate(group.begin(), group.end(), 0.0,
                           [&](double sum, std::size_t unit) { return sum + units[unit].cost; });
  };
  // What cannot be cut comes first, and fills the gaps in which the others then go.
  std::ranges::stable_sort(groups, [&](const auto& one, const auto& other) {
    const bool is_whole = one.size() == 1;
    const bool is_other_whole = other.size() == 1;
    if (is_whole != is_other_whole) return is_whole;
    return cost_of(one) > cost_of(other);
  });
  double total = 0;
  for (const auto& group : groups) total += cost_of(group) + units[group.front()].shared_cost;
  const double fair = total / static_cast<double>(shards);

  std::vector<double> loads(shards, 0.0);
  std::vector<std::size_t> owners(units.size(), 0);
  const auto idlest = [&] { return static_cast<std::size_t>(std::ranges::min_element(loads) - loads.begin()); };
  for (const auto& group : groups) {
    std::set<std::size_t> taking;
    std::size_t shard = idlest();
    for (const std::size_t unit : group) {
      if (loads[shard] + units[unit].cost / 2 > fair && !taking.empty()) shard = idlest();
      if (taking.insert(shard).second) loads[shard] += units[unit].shared_cost;
      loads[shard] += units[unit].cost;
      owners[unit] = shard;
    }
  }
  return owners;
}

}  // namespace lobe
