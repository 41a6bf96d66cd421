#include <fmt/format.h>

#include <algorithm>
#include <optional>
#include <span>
#include <string>
#include <utility>

#include "compare/compare.hpp"
#include "core/stopwatch.hpp"
#include "energy/prepare.hpp"
#include "lobe/core/error.hpp"
#include "lobe/study/checkpoint.hpp"
#include "lobe/study/study.hpp"
#include "metric/routed_set.hpp"
#include "study/run/agreement.hpp"
#include "study/run/study_channels.hpp"
#include "study/run/study_operands.hpp"

namespace lobe {
namespace {

constexpr int kDimensions = 2;

void append_stages(std::vector<StageTime>& stages, const std::string& name, const WorkDone& work) {
  stages.push_back({name + ": nodes", work.seconds_nodes});
  stages.push_back({name + ": values", work.seconds_values});
  stages.push_back({name + ": products", work.seconds_gram});
  stages.push_back({name + ": materials", work.seconds_host});
}

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

void add_lighting(StudyResult& result, RoutedSet& set, const Lighting& lighting, const MetricOptions& options,
                  Checkpoint* checkpoint) {
  const Study& study = result.study;
  Stopwatch stopwatch;
  auto kept = checkpoint == nullptr ? std::nullopt : checkpoint->find(lighting);
  const bool is_new = !kept;
  const auto measure = [&] { return is_new ? set.measure(lighting) : std::move(*kept); };
  result.metrics.push_back(with_place(study, study.origins.lightings, result.metrics.size(), measure));
  if (is_new && checkpoint != nullptr) checkpoint->keep(result.metrics.back(), stopwatch.lap());
  result.metrics.back().theta_max = options.theta_max;
  const MetricResult& metric = result.metrics.back();
  append_stages(result.stages, lighting.name(), metric.work);
  static_cast<void>(stopwatch.lap());
  const int dimensions = std::min(kDimensions, static_cast<int>(study.materials.size()));
  result.embeddings.push_back(classical_scaling(metric.combined.distance, dimensions));
  result.stages.push_back({lighting.name() + ": embedding", stopwatch.lap()});
  result.clusterings.push_back(cluster_materials(metric.combined, study.clustering));
  result.stages.push_back({lighting.name() + ": clustering", stopwatch.lap()});
  for (const FamilyFit fit : study.approximations) {
    result.residuals.push_back(
        family_residuals(metric, study.materials, fit == FamilyFit::non_negative, study.channel_weights));
    result.stages.push_back({fmt::format("{}: {} approximations", lighting.name(), to_string(fit)), stopwatch.lap()});
  }
}

void add_comparison(StudyResult& result, RoutedSet& set, LiteratureMetric comparison, const LiteratureOptions& options,
                    Checkpoint* checkpoint) {
  Stopwatch stopwatch;
  auto kept = checkpoint == nullptr ? std::nullopt : checkpoint->find(comparison);
  const bool is_new = !kept;
  const auto& origins = result.study.origins.comparison_metrics;
  const auto compute = [&] { return is_new ? compare(set, comparison, options) : std::move(*kept); };
  result.comparisons.push_back(with_place(result.study, origins, result.comparisons.size(), compute));
  if (is_new && checkpoint != nullptr) checkpoint->keep(result.comparisons.back(), stopwatch.lap());
  append_stages(result.stages, std::string(to_string(comparison)), result.comparisons.back().work);
}

/// Adds curves that describe the materials themselves.
void add_curves(StudyResult& result, const Device& device, const StudyOperands& operands,
                const ProgressCallback& progress) {
  result.curve_angles = CurveAngles::usual();
  const std::size_t count = operands.reflectances.size();
  for (std::size_t i = 0; i < count; ++i) {
    const double done = static_cast<double>(i) / static_cast<double>(count);
    if (progress && !progress("curves", done)) throw Cancelled("cancelled");
    result.curves.push_back(material_curves(device, operands.reflectances[i], result.curve_angles));
  }
}

/// \param checkpoint none: nothing is kept
StudyResult computed(const Device& device, const Study& study, Checkpoint* checkpoint,
                     const ProgressCallback& progress) {
  StudyResult result;
  result.study = with_channels(study);
  result.device = device.info();
  require_clusters(study);
  if (checkpoint != nullptr) checkpoint->open(result.study, device);
  Stopwatch stopwatch;
  const auto needs = [](const Material& material) { return needs_preparation(material); };
  if (std::ranges::any_of(study.materials, needs)) {
    for (Material& material : result.study.materials) material = prepare(device, std::move(material));
    result.stages.push_back({"preparation", stopwatch.lap()});
  }
  const StudyOperands operands = study_operands(result.study, progress);
  if (!operands.files.empty()) {
    result.files = operands.files;
    result.stages.push_back({"reading", stopwatch.lap()});
  }
  MetricOptions options = metric_options(result.study);
  options.progress = progress;
  RoutedSet set(device, operands.reflectances, options);
  for (const auto& lighting : study.lightings) add_lighting(result, set, lighting, options, checkpoint);

  LiteratureOptions comparison_options;
  comparison_options.tolerance = study.comparison_tolerance;
  comparison_options.precision = study.precision;
  comparison_options.channel_weights = options.channel_weights;
  comparison_options.progress = progress;
  comparison_options.grid = study.grid;
  comparison_options.allow_unresolved = study.allow_unresolved;
  for (const auto comparison : study.comparison_metrics) {
    add_comparison(result, set, comparison, comparison_options, checkpoint);
  }
  (void)stopwatch.lap();
  add_curves(result, device, operands, progress);
  if (!result.curves.empty()) result.stages.push_back({"curves", stopwatch.lap()});
  if (!study.published.empty()) {
    result.published = check_published(device, study.published, study.tolerance, progress);
    result.stages.push_back({"published figures", stopwatch.lap()});
  }
  for (const auto& chart : study.charts) {
    const auto note = [&](MissedTolerance missed) {
      missed.quantity = "chart " + chart.name + ": " + missed.quantity;
      result.missed.push_back(std::move(missed));
    };
    result.charts.push_back(compute_chart(device, chart, study.tolerance, progress, note));
    result.stages.push_back({"chart " + chart.name, stopwatch.lap()});
  }
  result.agreement = metric_agreement(result);
  if (!result.agreement.metrics.empty()) result.stages.push_back({"rank agreement", stopwatch.lap()});
  return result;
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

StudyResult run_study(const Device& device, const Study& study, const ProgressCallback& progress) {
  return computed(device, study, nullptr, progress);
}

StudyResult run_study(const Device& device, const Study& study, Checkpoint& checkpoint,
                      const ProgressCallback& progress) {
  return computed(device, study, &checkpoint, progress);
}

}  // namespace lobe
