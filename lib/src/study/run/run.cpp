#include <fmt/format.h>

#include <algorithm>
#include <set>
#include <string>
#include <utility>

#include "compare/comparison_tiles.hpp"
#include "core/stopwatch.hpp"
#include "lobe/study/checkpoint.hpp"
#include "lobe/study/study.hpp"
#include "metric/lighting_traits.hpp"
#include "study/run/agreement.hpp"
#include "study/run/checkpoint_implementation.hpp"
#include "study/run/checkpoint_records.hpp"
#include "study/run/completed_study.hpp"
#include "study/run/kept_units.hpp"
#include "study/run/record_file.hpp"
#include "study/run/study_computation.hpp"
#include "study/run/study_units.hpp"

namespace lobe {
namespace {

constexpr int kDimensions = 2;

void append_stages(std::vector<StageTime>& stages, const std::string& name, const WorkDone& work) {
  stages.push_back({name + ": nodes", work.seconds_nodes});
  stages.push_back({name + ": values", work.seconds_values});
  stages.push_back({name + ": products", work.seconds_gram});
  stages.push_back({name + ": materials", work.seconds_host});
}

void add_lighting(StudyResult& result, StudyComputation& computation, std::size_t index) {
  const Study& study = result.study;
  result.metrics.push_back(computation.lighting(index));
  const MetricResult& metric = result.metrics.back();
  const Lighting& lighting = metric.lighting;
  append_stages(result.stages, lighting.name(), metric.work);
  Stopwatch stopwatch;
  const int dimensions = std::min(kDimensions, static_cast<int>(study.materials.size()));
  result.embeddings.push_back(classical_scaling(metric.combined.distance, dimensions));
  result.stages.push_back({lighting.name() + ": embedding", stopwatch.lap()});
  result.clusterings.push_back(cluster_materials(metric.combined, study.clustering));
  result.stages.push_back({lighting.name() + ": clustering", stopwatch.lap()});
  for (const FamilyFit fit : study.approximations) {
    result.residuals.push_back(
        family_residuals(metric, labels(study), fit == FamilyFit::non_negative, study.channel_weights));
    result.stages.push_back({fmt::format("{}: {} approximations", lighting.name(), to_string(fit)), stopwatch.lap()});
  }
}

void add_chart(StudyResult& result, const StudyComputation& computation, std::size_t index) {
  const Chart& chart = result.study.charts[index];
  ChartValues values;
  for (std::size_t curve = 0; curve < chart.curves.size(); ++curve) {
    ChartCurveValues found = computation.chart_curve(index, curve);
    values.push_back(std::move(found.values));
    for (MissedTolerance& missed : found.missed) {
      missed.quantity = "chart " + chart.name + ": " + missed.quantity;
      result.missed.push_back(std::move(missed));
    }
  }
  result.charts.push_back(std::move(values));
}

/// A run without ranks keeps results of whole lightings and metrics and tiles of these, and goes on from any units.
UnitStore store_of(const Study& study, RecordFile& file) {
  std::set<std::string> names;
  for (const auto& lighting : study.lightings) {
    if (!traits_of(lighting).is_by_tables) names.insert(record_name(lighting));
  }
  for (const auto comparison : study.comparison_metrics) {
    names.insert(record_name(comparison));
    const std::size_t tiles = comparison_tiles(study.materials.size()).size();
    for (std::size_t tile = 0; tile < tiles; ++tile) names.insert(tile_name(comparison, tile));
  }
  const auto find = [kept = KeptNames(study), &file](const std::string& name) {
    const std::string kept_name = kept.of(name);
    return kept_name.empty() ? nullptr : file.find(kept_name);
  };
  return {
      .has = [find](const std::string& name) { return find(name) != nullptr; },
      .get = [find](const std::string& name) { return *find(name); },
      .is_worth_keeping = [names](const std::string& name,
                                  double seconds) { return seconds >= kSecondsWorthKeeping && names.contains(name); },
      .keep = [&file](const std::string& name, const std::string& content) { file.keep(name, content); }};
}

}  // namespace

MetricOptions metric_options(const Study& study) {
  MetricOptions options;
  options.tolerance = study.tolerance;
  options.patch_tolerance = study.patch_tolerance;
  options.theta_max = study.domain_theta_max;
  options.precision = study.precision;
  options.channel_weights = study.channel_weights;
  options.grid = study.grid;
  options.allow_unresolved = study.allow_unresolved;
  options.function_tolerance = study.function_tolerance;
  return options;
}

StudyResult completed_study(const Device& device, StudyComputation& computation) {
  const Study& study = computation.study();
  StudyResult result;
  result.study = study;
  result.device = device.info();
  result.stages = computation.stages();
  result.files = computation.operands().files;
  for (std::size_t i = 0; i < study.lightings.size(); ++i) add_lighting(result, computation, i);
  for (std::size_t i = 0; i < study.comparison_metrics.size(); ++i) {
    result.comparisons.push_back(computation.comparison(i));
    append_stages(result.stages, std::string(to_string(study.comparison_metrics[i])), result.comparisons.back().work);
  }
  Stopwatch stopwatch;
  result.curve_angles = CurveAngles::usual();
  for (std::size_t i = 0; i < study.materials.size(); ++i) result.curves.push_back(computation.curves(i));
  if (!result.curves.empty()) result.stages.push_back({"curves", stopwatch.lap()});
  for (std::size_t i = 0; i < study.published.size(); ++i) result.published.push_back(computation.figure(i));
  if (!study.published.empty()) result.stages.push_back({"published figures", stopwatch.lap()});
  for (std::size_t i = 0; i < study.charts.size(); ++i) {
    add_chart(result, computation, i);
    result.stages.push_back({"chart " + study.charts[i].name, stopwatch.lap()});
  }
  result.agreement = metric_agreement(result);
  if (!result.agreement.metrics.empty()) result.stages.push_back({"rank agreement", stopwatch.lap()});
  return result;
}

StudyResult run_study(const Device& device, const Study& study, const ProgressCallback& progress) {
  StudyComputation computation(device, study, UnitStore::none(), progress);
  return completed_study(device, computation);
}

StudyResult run_study(const Device& device, const Study& study, Checkpoint& checkpoint,
                      const ProgressCallback& progress) {
  checkpoint.open(study, device);
  StudyComputation computation(device, study, store_of(study, checkpoint.implementation_->file), progress);
  return completed_study(device, computation);
}

}  // namespace lobe
