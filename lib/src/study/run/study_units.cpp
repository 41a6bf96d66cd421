#include "study/run/study_units.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <numeric>
#include <set>

#include "compare/compare.hpp"
#include "compare/comparison_tiles.hpp"
#include "metric/lighting_traits.hpp"
#include "study/run/checkpoint_records.hpp"

namespace lobe {
namespace {

// Estimates in seconds of one core, from studies of 30 to 600 formulas. They decide who computes what, never a result:
// a shard that has more than its share only takes longer. Rules refine until errors are small enough, so that nothing
// better is known beforehand.

/// How the time for all products or distances grows: with the materials that are evaluated, and with their pairs.
struct Growth {
  double per_material;
  double per_pair;
};
constexpr Growth kPoint{3e-3, 2e-5};
constexpr Growth kAlbedos{4e-3, 1e-6};  // daylight and mean albedo
constexpr Growth kPatches{1e-2, 1e-4};
constexpr Growth kTables{0.2, 5e-3};   // whatever is tabulated, or goes by functions
constexpr double kCoarseShare = 0.12;  // of the first pass, which all shards of a lighting make
constexpr double kCurves = 0.015;      // of a material
constexpr double kFigure = 0.1;
constexpr double kChartPoint = 1e-3;

double cost_of(const Growth& growth, std::size_t materials) {
  const auto n = static_cast<double>(materials);
  return growth.per_material * n + growth.per_pair * n * n;
}

/// Terms with kinks take many more nodes, and powers of differences more time at each.
Growth growth_of(LiteratureMetric metric) {
  switch (metric) {
    case LiteratureMetric::cube_root:
      return {1e-3, 2.6e-4};
    case LiteratureMetric::albedo_of_difference:
    case LiteratureMetric::cube_root_log:
      return {1e-3, 8e-5};
    case LiteratureMetric::cube_root_l2:
    case LiteratureMetric::log_relative:
      return {1e-3, 2e-5};
    default:
      return {1e-3, 1e-5};
  }
}

Growth growth_of(const Lighting& lighting, Route route) {
  if (route != Route::formulas) return kTables;
  if (traits_of(lighting).has_operator) return kPatches;
  return lighting == Lighting::point() ? kPoint : kAlbedos;
}

}  // namespace

std::string slab_name(const Lighting& lighting, std::size_t slab) {
  return fmt::format("slab {} of lighting {}", slab + 1, lighting.name());
}

std::string tile_name(LiteratureMetric comparison, std::size_t tile) {
  return fmt::format("tile {} of {}", tile + 1, record_name(comparison));
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

LiteratureOptions literature_options(const Study& study) {
  LiteratureOptions options;
  options.tolerance = study.comparison_tolerance;
  options.precision = study.precision;
  options.channel_weights = study.channel_weights;
  options.grid = study.grid;
  options.allow_unresolved = study.allow_unresolved;
  return options;
}

std::vector<StudyUnit> study_units(const Study& study, RoutedSet& set) {
  using enum StudyUnit::Kind;
  std::vector<StudyUnit> units;
  const std::size_t materials = study.materials.size();
  std::size_t group = 0;
  for (std::size_t i = 0; i < study.lightings.size(); ++i, ++group) {
    const Lighting& lighting = study.lightings[i];
    const std::size_t slabs = set.slabs(lighting);
    const Route route = choose_route(set.reflectances(), lighting, metric_options(study)).route;
    const double cost = cost_of(growth_of(lighting, route), materials);
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
  const auto tiles = study.comparison_metrics.empty() ? std::vector<ComparisonTile>()
                                                      : independent_tiles(set, literature_options(study));
  for (std::size_t i = 0; i < study.comparison_metrics.size(); ++i, ++group) {
    const LiteratureMetric metric = study.comparison_metrics[i];
    if (tiles.empty()) {
      units.push_back({.kind = comparison,
                       .index = i,
                       .name = record_name(metric),
                       .cost = cost_of(growth_of(metric), materials),
                       .group = group});
    }
    const Growth growth = growth_of(metric);
    for (std::size_t k = 0; k < tiles.size(); ++k) {
      // Growth counts each pair in both orders.
      const double cost = growth.per_material * static_cast<double>(tiles[k].materials()) +
                          2 * growth.per_pair * static_cast<double>(tiles[k].pairs());
      units.push_back(
          {.kind = tile, .index = i, .part = k, .name = tile_name(metric, k), .cost = cost, .group = group});
    }
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
  const auto group_cost = [&](const std::vector<std::size_t>& group) {
    return std::accumulate(group.begin(), group.end(), 0.0,
                           [&](double sum, std::size_t unit) { return sum + units[unit].cost; });
  };
  // What cannot be cut comes first, and fills the gaps in which the others then go.
  std::ranges::stable_sort(groups, [&](const auto& one, const auto& other) {
    const bool is_whole = one.size() == 1;
    const bool is_other_whole = other.size() == 1;
    if (is_whole != is_other_whole) return is_whole;
    return group_cost(one) > group_cost(other);
  });
  double total = 0;
  for (const auto& group : groups) total += group_cost(group) + units[group.front()].shared_cost;
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
