#include "lobe/study/checkpoint.hpp"

#include <utility>

#include "metric/lighting_traits.hpp"
#include "study/run/checkpoint_implementation.hpp"
#include "study/run/checkpoint_records.hpp"
#include "study/run/study_channels.hpp"
#include "study/run/study_identity.hpp"

namespace lobe {
Checkpoint::Checkpoint(std::filesystem::path path)
    : implementation_(std::make_shared<Implementation>(Implementation{RecordFile(std::move(path))})) {}

const std::filesystem::path& Checkpoint::path() const {
  return implementation_->file.path();
}

std::size_t Checkpoint::kept() const {
  return implementation_->file.size();
}

void Checkpoint::open(const Study& study, const Device& device) {
  implementation_->file.open(checkpoint_identity(with_channels(study), device), study.materials.size());
}

std::optional<MetricResult> Checkpoint::find(const Lighting& lighting) const {
  if (traits_of(lighting).is_by_tables) return {};
  const std::string* record = implementation_->file.find(record_name(lighting));
  MetricResult result{.lighting = lighting, .combined = {}, .channels = {}, .unresolved = {}, .work = {}};
  if (record == nullptr || !read_result(*record, result)) return {};
  return result;
}

std::optional<LiteratureResult> Checkpoint::find(LiteratureMetric comparison) const {
  const std::string* record = implementation_->file.find(record_name(comparison));
  LiteratureResult result{.metric = comparison, .combined = {}, .channels = {}, .unresolved = {}, .work = {}};
  if (record == nullptr || !read_result(*record, result)) return {};
  return result;
}

void Checkpoint::keep(const MetricResult& result, double seconds) {
  if (traits_of(result.lighting).is_by_tables || seconds < kSecondsWorthKeeping) return;
  implementation_->file.keep(record_name(result.lighting), written_result(result));
}

void Checkpoint::keep(const LiteratureResult& result, double seconds) {
  if (seconds >= kSecondsWorthKeeping) implementation_->file.keep(record_name(result.metric), written_result(result));
}

void Checkpoint::remove() {
  implementation_->file.remove();
}

}  // namespace lobe
