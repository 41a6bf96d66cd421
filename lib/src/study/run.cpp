#include <algorithm>
#include <string>

#include "core/stopwatch.hpp"
#include "lobe/error.hpp"
#include "lobe/study.hpp"

namespace lobe {
namespace {

constexpr int kDimensions = 2;

void append_stages(std::vector<StageTime>& stages, const Lighting& lighting, const Work& work) {
  const std::string& name = lighting.name();
  stages.push_back({name + ": nodes", work.seconds_nodes});
  stages.push_back({name + ": samples", work.seconds_samples});
  stages.push_back({name + ": products", work.seconds_gram});
  stages.push_back({name + ": materials", work.seconds_host});
}

/// A study made in code may leave its channels unnamed.
Study with_channels(Study study) {
  std::size_t count = 1;
  for (const auto& material : study.materials) count = std::max(count, material.channels());
  if (study.channels.empty()) {
    if (count == 1) study.channels = {"value"};
    for (std::size_t i = 1; count > 1 && i <= count; ++i) study.channels.push_back(std::to_string(i));
  }
  count = study.channels.size();
  if (study.channel_weights.empty()) study.channel_weights.assign(count, 1.0 / static_cast<double>(count));
  if (study.channel_weights.size() != count) {
    throw ArgumentError("study has " + std::to_string(count) + " channels and " +
                        std::to_string(study.channel_weights.size()) + " channel weights; expected as many");
  }
  return study;
}

/// Before anything is computed.
void require_clusters(const Study& study) {
  if (study.clustering.clusters <= study.materials.size()) return;
  throw ArgumentError("study has " + std::to_string(study.materials.size()) + " materials and asks for " +
                      std::to_string(study.clustering.clusters) + " clusters; expected at most as many");
}

}  // namespace

StudyResult run_study(const Device& device, const Study& study, const ProgressCallback& progress) {
  StudyResult result{with_channels(study), device.info(), {}, {}, {}, {}};
  require_clusters(study);
  MetricOptions options;
  options.tolerance = study.tolerance;
  options.precision = study.precision;
  options.channel_weights = result.study.channel_weights;
  options.progress = progress;
  for (const auto& lighting : study.lightings) {
    result.metrics.push_back(measure(device, study.materials, lighting, options));
    const MetricResult& metric = result.metrics.back();
    append_stages(result.stages, lighting, metric.work);
    Stopwatch stopwatch;
    const int dimensions = std::min(kDimensions, static_cast<int>(study.materials.size()));
    result.embeddings.push_back(classical_scaling(metric.combined.distance, dimensions));
    result.stages.push_back({lighting.name() + ": embedding", stopwatch.lap()});
    result.clusterings.push_back(cluster_materials(metric.combined, study.clustering));
    result.stages.push_back({lighting.name() + ": clustering", stopwatch.lap()});
  }
  return result;
}

}  // namespace lobe
