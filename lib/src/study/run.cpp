#include <fmt/format.h>

#include <algorithm>
#include <optional>
#include <span>
#include <string>
#include <utility>

#include "core/stopwatch.hpp"
#include "lobe/checkpoint.hpp"
#include "lobe/error.hpp"
#include "lobe/function_metric.hpp"
#include "lobe/prepare.hpp"
#include "lobe/study.hpp"
#include "lobe/table_metric.hpp"
#include "study/agreement.hpp"
#include "study/study_channels.hpp"
#include "study/study_operands.hpp"

namespace lobe {
namespace {

constexpr int kDimensions = 2;
constexpr double kToleranceOfFunctions = 0.05;  // a tighter one would have all refined for the sharpest of them

void append_stages(std::vector<StageTime>& stages, const std::string& name, const Work& work) {
  stages.push_back({name + ": nodes", work.seconds_nodes});
  stages.push_back({name + ": samples", work.seconds_samples});
  stages.push_back({name + ": products", work.seconds_gram});
  stages.push_back({name + ": materials", work.seconds_host});
}

/// Before anything is computed.
void require_clusters(const Study& study) {
  if (study.clustering.clusters <= study.materials.size()) return;
  throw ArgumentError("study has " + std::to_string(study.materials.size()) + " materials and asks for " +
                      std::to_string(study.clustering.clusters) + " clusters; expected at most as many");
}

/// By the materials' formulas; where files are among them by all of them as functions, or by their tables.
MetricResult measure_study(const Device& device, const Study& study, const StudyOperands& operands,
                           const Lighting& lighting, const MetricOptions& options) {
  if (!operands.functions.empty() && !takes_tables(lighting)) {
    return measure(operands.functions, lighting,
                   {.tolerance = kToleranceOfFunctions,
                    .channel_weights = options.channel_weights,
                    .theta_max = options.theta_max,
                    .progress = options.progress});
  }
  if (operands.tables.empty()) return measure(device, study.materials, lighting, options);
  return measure(
      device, operands.tables, lighting,
      {.channel_weights = options.channel_weights, .theta_max = options.theta_max, .progress = options.progress});
}

void add_lighting(StudyResult& result, const Device& device, const StudyOperands& operands, const Lighting& lighting,
                  const MetricOptions& options, Checkpoint* checkpoint) {
  const Study& study = result.study;
  Stopwatch stopwatch;
  auto kept = checkpoint == nullptr ? std::nullopt : checkpoint->find(lighting);
  const bool is_new = !kept;
  result.metrics.push_back(is_new ? measure_study(device, study, operands, lighting, options) : std::move(*kept));
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

void add_comparison(StudyResult& result, const Device& device, std::span<const BrdfTable> tables, Comparison comparison,
                    const ComparisonOptions& options, Checkpoint* checkpoint) {
  Stopwatch stopwatch;
  auto kept = checkpoint == nullptr ? std::nullopt : checkpoint->find(comparison);
  const bool is_new = !kept;
  result.comparisons.push_back(!is_new          ? std::move(*kept)
                               : tables.empty() ? compare(device, result.study.materials, comparison, options)
                                                : compare(tables, comparison, options));
  if (is_new && checkpoint != nullptr) checkpoint->keep(result.comparisons.back(), stopwatch.lap());
  append_stages(result.stages, std::string(to_string(comparison)), result.comparisons.back().work);
}

/// What materials are like themselves. Those that are files stand among the operands.
void add_curves(StudyResult& result, const Device& device, const StudyOperands& operands,
                const ProgressCallback& progress) {
  const Study& study = result.study;
  result.curve_angles = CurveAngles::usual();
  for (std::size_t i = 0; i < study.materials.size(); ++i) {
    const double done = static_cast<double>(i) / static_cast<double>(study.materials.size());
    if (progress && !progress("curves", done)) throw Cancelled("cancelled");
    if (study.files.empty() || !study.files[i]) {
      result.curves.push_back(material_curves(device, study.materials[i], result.curve_angles));
    } else if (!operands.functions.empty()) {
      result.curves.push_back(material_curves(operands.functions[i], result.curve_angles));
    } else {
      result.curves.push_back(material_curves(operands.tables[i], result.curve_angles));
    }
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
  const StudyOperands operands = study_operands(device, result.study, progress);
  if (!operands.files.empty()) {
    result.files = operands.files;
    result.stages.push_back({"reading", stopwatch.lap()});
  }
  MetricOptions options = metric_options(result.study);
  options.progress = progress;
  for (const auto& lighting : study.lightings) add_lighting(result, device, operands, lighting, options, checkpoint);

  ComparisonOptions comparison_options;
  comparison_options.tolerance = study.comparison_tolerance;
  comparison_options.precision = study.precision;
  comparison_options.channel_weights = options.channel_weights;
  comparison_options.progress = progress;
  for (const auto comparison : study.comparison_metrics) {
    add_comparison(result, device, operands.tables, comparison, comparison_options, checkpoint);
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
