#include "study/run/study_computation.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <span>
#include <string_view>
#include <utility>

#include "compare/compare.hpp"
#include "core/stopwatch.hpp"
#include "energy/prepare.hpp"
#include "lobe/core/error.hpp"
#include "study/run/checkpoint_records.hpp"
#include "study/run/study_channels.hpp"

namespace lobe {
namespace {

/// Before anything is computed.
void require_clusters(const Study& study) {
  if (study.clustering.clusters <= study.materials.size()) return;
  throw ArgumentError("study has " + std::to_string(study.materials.size()) + " materials and asks for " +
                      std::to_string(study.clustering.clusters) + " clusters; expected at most as many");
}

/// What `compute` makes. A grid that is too coarse is refused with the place in the study that asks for it.
/// \param origins where what is computed is asked for, which counts where the study names no grid
template <typename Compute>
auto with_place(const Study& study, std::span<const Origin> origins, std::size_t index, const Compute& compute) {
  try {
    return compute();
  } catch (const UnresolvedError& error) {
    const Origin asking = index < origins.size() ? origins[index] : Origin();
    const Origin place = study.origins.grid.value_or(asking);
    if (place.file.empty()) throw;
    throw UnresolvedError(to_string(place) + ": " + error.what(), error.fields());
  }
}

std::string unit_text(const MetricResult& result) {
  return written_result(result);
}
std::string unit_text(const LiteratureResult& result) {
  return written_result(result);
}
std::string unit_text(const auto& value) {
  return written_unit(value);
}

bool read_record(std::string_view content, MetricResult& result) {
  return read_result(content, result);
}
bool read_record(std::string_view content, LiteratureResult& result) {
  return read_result(content, result);
}
bool read_record(std::string_view content, auto& value) {
  return read_unit(content, value);
}

template <typename Options>
Options with_progress(Options options, const ProgressCallback& progress) {
  options.progress = progress;
  return options;
}

bool is_unprepared(const StudyMaterial& material) {
  return material.formula() != nullptr && needs_preparation(*material.formula());
}

Study prepared(const Device& device, Study study, std::vector<StageTime>& stages) {
  require_clusters(study);
  if (std::ranges::none_of(study.materials, is_unprepared)) return study;
  Stopwatch watch;
  for (StudyMaterial& material : study.materials) {
    if (is_unprepared(material)) material = prepare(device, *material.formula());
  }
  stages.push_back({"preparation", watch.lap()});
  return study;
}

StudyOperands read_operands(const Study& study, const ProgressCallback& progress, std::vector<StageTime>& stages) {
  Stopwatch watch;
  StudyOperands operands = study_operands(study, progress);
  if (!operands.files.empty()) stages.push_back({"reading", watch.lap()});
  return operands;
}

}  // namespace

UnitStore UnitStore::none() {
  return {.has = [](const std::string&) { return false; },
          .get = [](const std::string&) { return std::string(); },
          .is_worth_keeping = [](const std::string&, double) { return false; },
          .keep = [](const std::string&, const std::string&) {}};
}

StudyComputation::StudyComputation(const Device& device, const Study& study, UnitStore store, ProgressCallback progress)
    : device_(device),
      store_(std::move(store)),
      progress_(std::move(progress)),
      study_(prepared(device, with_channels(study), stages_)),
      operands_(read_operands(study_, progress_, stages_)),
      options_(with_progress(metric_options(study_), progress_)),
      comparison_options_(with_progress(literature_options(study_), progress_)),
      set_(device, operands_.reflectances, options_) {}

void StudyComputation::report(std::string_view stage, std::size_t done, std::size_t all) const {
  if (progress_ && !progress_(stage, static_cast<double>(done) / static_cast<double>(all))) {
    throw Cancelled("cancelled");
  }
}

/// \param value of a record that can be read all that it does not hold
template <typename Value, typename Compute>
Value StudyComputation::taken(const std::string& name, Value value, const Compute& compute) const {
  if (store_.has(name) && read_record(store_.get(name), value)) return value;
  Stopwatch watch;
  value = compute();
  if (store_.is_worth_keeping(name, watch.lap())) store_.keep(name, unit_text(value));
  return value;
}

SlabStore StudyComputation::slabs_of(const Lighting& lighting, std::function<bool(std::size_t)> is_wanted) const {
  return {.has = [this, &lighting](std::size_t slab) { return store_.has(slab_name(lighting, slab)); },
          .get =
              [this, &lighting](std::size_t slab) {
                RefinedSlab found;
                const std::string name = slab_name(lighting, slab);
                if (!read_unit(store_.get(name), found)) throw IoError("the record of " + name + " cannot be read");
                return found;
              },
          .is_wanted = std::move(is_wanted),
          .keep =
              [this, &lighting](std::size_t slab, const RefinedSlab& refined, double seconds) {
                const std::string name = slab_name(lighting, slab);
                if (store_.is_worth_keeping(name, seconds)) store_.keep(name, written_unit(refined));
              }};
}

MetricResult StudyComputation::lighting(std::size_t index) {
  const Lighting& lighting = study_.lightings[index];
  MetricResult empty{.lighting = lighting, .combined = {}, .channels = {}, .unresolved = {}, .work = {}};
  MetricResult result = taken(record_name(lighting), std::move(empty), [&] {
    const SlabStore slabs = slabs_of(lighting, {});
    return with_place(study_, study_.origins.lightings, index, [&] { return set_.measure(lighting, &slabs); });
  });
  result.theta_max = options_.theta_max;
  return result;
}

LiteratureResult StudyComputation::comparison(std::size_t index) {
  const LiteratureMetric metric = study_.comparison_metrics[index];
  LiteratureResult empty{.metric = metric, .combined = {}, .channels = {}, .unresolved = {}, .work = {}};
  return taken(record_name(metric), std::move(empty), [&] {
    const TileStore tiles = tiles_of(metric);
    return with_place(study_, study_.origins.comparison_metrics, index,
                      [&] { return compare(set_, metric, comparison_options_, &tiles); });
  });
}

TileStore StudyComputation::tiles_of(LiteratureMetric comparison) const {
  return {.has = [this, comparison](std::size_t tile) { return store_.has(tile_name(comparison, tile)); },
          .get =
              [this, comparison](std::size_t tile) {
                TileIntegrals found;
                const std::string name = tile_name(comparison, tile);
                if (!read_unit(store_.get(name), found)) throw IoError("the record of " + name + " cannot be read");
                return found;
              },
          .keep =
              [this, comparison](std::size_t tile, const TileIntegrals& integrals, double seconds) {
                const std::string name = tile_name(comparison, tile);
                if (store_.is_worth_keeping(name, seconds)) store_.keep(name, written_unit(integrals));
              }};
}

void StudyComputation::compute_tile(std::size_t index, std::size_t tile) {
  const LiteratureMetric metric = study_.comparison_metrics[index];
  if (tiles_.empty()) tiles_ = independent_tiles(set_, comparison_options_);
  static_cast<void>(taken(tile_name(metric, tile), TileIntegrals(), [&] {
    return with_place(study_, study_.origins.comparison_metrics, index,
                      [&] { return lobe::compare_tile(set_, tiles_.at(tile), metric, comparison_options_); });
  }));
}

MaterialCurves StudyComputation::curves(std::size_t material) const {
  report("curves", material, study_.materials.size());
  return taken(curves_name(material), MaterialCurves(),
               [&] { return material_curves(device_, operands_.reflectances[material], CurveAngles::usual()); });
}

PublishedCheck StudyComputation::figure(std::size_t index) const {
  report("published figures", index, study_.published.size());
  return taken(figure_name(index), PublishedCheck(), [&] {
    return check_published(device_, std::span(&study_.published[index], 1), study_.tolerance, progress_).front();
  });
}

ChartCurveValues StudyComputation::chart_curve(std::size_t chart, std::size_t curve) const {
  const Chart& whole = study_.charts[chart];
  const std::string stage = "chart " + whole.name;
  report(stage, curve, whole.curves.size());
  return taken(chart_curve_name(chart, curve), ChartCurveValues(), [&] {
    Chart one = whole;
    one.curves = {whole.curves[curve]};
    ChartCurveValues found;
    const auto progress = [&](std::string_view, double done) {
      const double share = (static_cast<double>(curve) + done) / static_cast<double>(whole.curves.size());
      return !progress_ || progress_(stage, share);
    };
    const auto note = [&](const MissedTolerance& missed) { found.missed.push_back(missed); };
    found.values = std::move(compute_chart(device_, one, study_.tolerance, progress, note).front());
    return found;
  });
}

void StudyComputation::compute(const std::vector<StudyUnit>& units, const UnitSource& next) {
  std::optional<std::size_t> unit = next();
  while (unit) {
    const StudyUnit& one = units[*unit];
    if (store_.has(one.name)) {
      unit = next();
      continue;
    }
    switch (one.kind) {
      case StudyUnit::Kind::lighting:
        static_cast<void>(lighting(one.index));
        break;
      case StudyUnit::Kind::slab:
        unit = compute_slabs(units, *unit, next);
        continue;
      case StudyUnit::Kind::comparison:
        static_cast<void>(comparison(one.index));
        break;
      case StudyUnit::Kind::tile:
        compute_tile(one.index, one.part);
        break;
      case StudyUnit::Kind::curves:
        static_cast<void>(curves(one.index));
        break;
      case StudyUnit::Kind::figure:
        static_cast<void>(figure(one.index));
        break;
      case StudyUnit::Kind::chart_curve:
        static_cast<void>(chart_curve(one.index, one.part));
        break;
    }
    unit = next();
  }
}

std::optional<std::size_t> StudyComputation::compute_slabs(const std::vector<StudyUnit>& units, std::size_t first,
                                                           const UnitSource& next) {
  const std::size_t index = units[first].index;
  std::optional<std::size_t> unit = first;
  bool is_taken = false;
  // Slabs of one lighting share a pass over all of them, as long as each comes behind the one before.
  const auto is_wanted = [&](std::size_t slab) {
    if (is_taken) unit = next();
    is_taken =
        unit && units[*unit].kind == StudyUnit::Kind::slab && units[*unit].index == index && units[*unit].part == slab;
    return is_taken;
  };
  const Lighting& lighting = study_.lightings[index];
  set_.refine_slabs(lighting, slabs_of(lighting, is_wanted));
  return is_taken ? next() : unit;
}

}  // namespace lobe
