// What ranks make of a plan: units are handed out as a run does it, each for the time that its stage takes in the plan.
#include <algorithm>
#include <map>
#include <numeric>
#include <set>
#include <span>
#include <utility>
#include <vector>

#include "compare/comparison_tiles.hpp"
#include "lobe/core/error.hpp"
#include "lobe/study/study_plan.hpp"
#include "metric/products.hpp"
#include "model/lobes.hpp"
#include "study/run/study_computation.hpp"
#include "study/run/study_units.hpp"
#include "study/run/unit_dealer.hpp"

namespace lobe {
namespace {

/// Of a record on its way: its name, its checksum, and the question for the next unit.
constexpr std::uint64_t kEnvelope = 90;

/// The stage of a plan that a unit belongs to.
std::string stage_of(const StudyUnit& unit, const Study& study) {
  switch (unit.kind) {
    case StudyUnit::Kind::lighting:
    case StudyUnit::Kind::slab:
      return study.lightings[unit.index].name();
    case StudyUnit::Kind::comparison:
    case StudyUnit::Kind::tile:
      return std::string(to_string(study.comparison_metrics[unit.index]));
    case StudyUnit::Kind::curves:
      return "curves";
    case StudyUnit::Kind::figure:
      return "published figures";
    case StudyUnit::Kind::chart_curve:
      break;
  }
  return "chart " + study.charts[unit.index].name;
}

/// Sizes of records (docs/scaling.md).
class RecordSizes {
 public:
  explicit RecordSizes(const StudyComputation& computation)
      : study_(computation.study()),
        materials_(study_.materials.size()),
        rows_(materials_),
        channels_(std::max<std::size_t>(study_.channels.size(), 1)),
        tiles_(comparison_tiles(materials_)) {
    const std::vector<Material> all = formulas(study_);
    if (all.size() < materials_ || all.empty()) return;
    rows_ = make_lobe_set(all, {.with_deltas = true, .with_anisotropic = true}).lobes();
  }

  [[nodiscard]] std::uint64_t of(const StudyUnit& unit) const {
    constexpr std::uint64_t kNumber = sizeof(double);
    constexpr std::uint64_t kDirections = 30;  // of the last levels of a slab, at most
    constexpr std::uint64_t kAngles = 8848;    // bytes of a material's curves
    const std::uint64_t parts = channels_ == 1 ? 1 : channels_ + 1;
    switch (unit.kind) {
      case StudyUnit::Kind::slab:
        return kEnvelope + (study_.lightings[unit.index] == Lighting::point()
                                ? kNumber / 2 * kLevelsKept * rows_ * (rows_ + 1)
                                : kNumber * kDirections * rows_);
      case StudyUnit::Kind::lighting:
        return kEnvelope + 4 * kNumber * parts * materials_ * materials_;
      case StudyUnit::Kind::comparison:
        return kEnvelope + 2 * kNumber * parts * materials_ * materials_;
      case StudyUnit::Kind::tile: {
        const ComparisonTile& tile = tiles_.at(unit.part);
        const std::uint64_t others = tile.is_triangle() ? 2 * tile.materials() + 1 : 0;  // with black, and diagonal
        return kEnvelope + 2 * kNumber * channels_ * (tile.pairs() + others);
      }
      case StudyUnit::Kind::curves:
        return kEnvelope + kAngles * channels_of(study_.materials[unit.index]);
      case StudyUnit::Kind::figure:
        return kEnvelope + 4 * kNumber;
      case StudyUnit::Kind::chart_curve:
        break;
    }
    return kEnvelope + 2 * kNumber * study_.charts[unit.index].x.size();
  }

 private:
  /// Curves of a grey material are those of one channel.
  [[nodiscard]] std::uint64_t channels_of(const StudyMaterial& material) const {
    const Material* formula = material.formula();
    return formula == nullptr ? channels_ : formula->channels();
  }

  const Study& study_;
  std::uint64_t materials_;
  std::uint64_t rows_;  // of products: lobes, or materials that are no formulas
  std::uint64_t channels_;
  std::vector<ComparisonTile> tiles_;
};

/// Seconds of each unit, and of what comes first for whoever begins with its group.
struct UnitSeconds {
  std::vector<double> own;
  std::vector<double> shared;
};

UnitSeconds seconds_of(const std::vector<StudyUnit>& units, const Study& study, const StudyPlan& plan) {
  std::map<std::string, double> costs;
  std::set<std::size_t> groups;
  for (const StudyUnit& unit : units) {
    const bool is_first = groups.insert(unit.group).second;
    costs[stage_of(unit, study)] += unit.cost + (is_first ? unit.shared_cost : 0);
  }
  UnitSeconds seconds;
  for (const StudyUnit& unit : units) {
    const std::string stage = stage_of(unit, study);
    const auto planned = std::ranges::find(plan.stages, stage, &PlannedStage::name);
    const bool is_taken = planned != plan.stages.end() && !planned->is_kept;
    const double all = is_taken ? planned->seconds - planned->alone_seconds : 0;
    const double scale = costs[stage] > 0 ? all / costs[stage] : 0;
    seconds.own.push_back(scale * unit.cost);
    seconds.shared.push_back(scale * unit.shared_cost);
  }
  return seconds;
}

/// In place of seconds, where nothing was in time.
UnitSeconds costs_of(const std::vector<StudyUnit>& units) {
  UnitSeconds costs;
  for (const StudyUnit& unit : units) {
    costs.own.push_back(unit.cost);
    costs.shared.push_back(unit.shared_cost);
  }
  return costs;
}

}  // namespace

RankPlan plan_ranks(const Device& device, const Study& study, const StudyPlan& plan, std::size_t ranks,
                    const ProgressCallback& progress) {
  if (ranks < 1 || ranks > kMostRanks) {
    throw ArgumentError("a plan for " + std::to_string(ranks) + " ranks; expected 1 to " + std::to_string(kMostRanks));
  }
  StudyComputation computation(device, study, UnitStore::none(), progress);
  const std::vector<StudyUnit> units = computation.units();
  const bool has_times = plan.tried > 0 || plan.materials == 0;
  const UnitSeconds seconds = has_times ? seconds_of(units, computation.study(), plan) : costs_of(units);
  const RecordSizes sizes(computation);
  const auto is_known = [&](const StudyUnit& unit) {
    const auto planned = std::ranges::find(plan.stages, stage_of(unit, computation.study()), &PlannedStage::name);
    return planned != plan.stages.end() && planned->is_kept;
  };

  RankPlan result;
  result.ranks = ranks;
  UnitDealer dealer(units, is_known, ranks);
  std::vector<double> busy(ranks, 0.0);
  std::set<std::pair<std::size_t, std::size_t>> begun;  // groups of a rank
  std::set<std::pair<double, std::size_t>> asking;      // ranks by the time when they ask for a unit
  for (std::size_t rank = 0; rank < ranks; ++rank) asking.emplace(0.0, rank);
  while (!asking.empty()) {
    const auto [time, rank] = *asking.begin();
    asking.erase(asking.begin());
    const auto unit = dealer.next(rank);
    if (!unit) continue;
    ++result.units;
    const bool is_new = begun.emplace(rank, units[*unit].group).second;
    const double taken = seconds.own[*unit] + (is_new ? seconds.shared[*unit] : 0);
    busy[rank] = time + taken;
    if (taken > result.longest_seconds) {
      result.longest_seconds = taken;
      result.longest_unit = units[*unit].name;
    }
    result.all_bytes += sizes.of(units[*unit]);
    if (rank > 0) result.moved_bytes += sizes.of(units[*unit]);
    asking.emplace(busy[rank], rank);
  }
  const double together = std::accumulate(seconds.own.begin(), seconds.own.end(), 0.0);
  double first_passes = 0;
  std::set<std::size_t> groups;
  for (std::size_t u = 0; u < units.size(); ++u) {
    if (groups.insert(units[u].group).second) first_passes += seconds.shared[u];
  }
  result.first_bytes = plan.work_bytes;
  if (ranks > 1) {
    // The first rank has all records until they are summed, and once more for the checkpoint's file.
    result.first_bytes += 2 * result.all_bytes;
    result.other_bytes = plan.unit_bytes;
  }
  if (!has_times) {
    result.longest_unit.clear();
    result.longest_seconds = 0;
    return result;
  }
  // What is not shared: the beginning, which every rank has, and the end, which rank 0 has alone.
  result.alone_seconds = std::max(plan.seconds - together - first_passes, 0.0);
  result.seconds = result.alone_seconds + std::ranges::max(busy);
  return result;
}

}  // namespace lobe
