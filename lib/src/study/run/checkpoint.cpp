#include "lobe/study/checkpoint.hpp"

#include <dlfcn.h>
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <fstream>
#include <system_error>
#include <utility>

#include "core/files.hpp"
#include "core/text.hpp"
#include "lobe/core/error.hpp"
#include "lobe/core/version.hpp"
#include "metric/lighting_traits.hpp"
#include "study/run/checkpoint_records.hpp"
#include "study/run/study_channels.hpp"

namespace lobe {
namespace {

namespace fs = std::filesystem;

constexpr double kWorthKeeping = 1;  // s

/// Size and time of the file with this code: builds of sources that were not committed have nothing else of their own.
std::string build() {
  Dl_info where{};
  if (dladdr(reinterpret_cast<const void*>(&build), &where) == 0 || where.dli_fname == nullptr) return "";
  std::error_code code;
  const auto time = fs::last_write_time(where.dli_fname, code).time_since_epoch().count();
  return fmt::format("{} {}", fs::file_size(where.dli_fname, code), time);
}

std::string text_of(const ReadOptions& options) {
  return fmt::format("{} {} {} {} {} {}", fmt::join(options.channels, ","), fmt::join(options.wavelengths, ","),
                     options.luminance, options.theta_max, options.component, options.decode_srgb);
}

/// All that results depend on, as a text.
std::string identity_of(const Study& study, const Device& device) {
  const DeviceInfo info = device.info();
  std::string text = fmt::format("{} {} {}\n{} {} {} {}\n", version(), commit(), build(), info.selector,
                                 info.platform_version, info.name, info.driver);
  text += fmt::format("{} {} {} {} {} {} {} {} {}\n", shortest(study.tolerance), shortest(study.patch_tolerance),
                      shortest(study.function_tolerance), shortest(study.comparison_tolerance),
                      shortest(study.domain_theta_max), static_cast<int>(study.precision),
                      study.grid ? study.grid->name() : "", study.allow_unresolved, study.configuration);
  for (const double weight : study.channel_weights) text += shortest(weight) + "\n";
  for (std::size_t i = 0; i < study.materials.size(); ++i) {
    const bool is_file = !study.files.empty() && study.files[i];
    text += is_file ? study.files[i]->path.string() : to_json(study.materials[i]);
    std::error_code code;
    if (is_file) {
      const auto time = fs::last_write_time(study.files[i]->path, code).time_since_epoch().count();
      text +=
          fmt::format(" {} {} {}", fs::file_size(study.files[i]->path, code), time, text_of(study.files[i]->options));
    }
    text += "\n";
  }
  return text;
}

}  // namespace

void Checkpoint::open(const Study& study, const Device& device) {
  identity_ = identity_of(with_channels(study), device);
  records_.clear();
  is_ours_ = false;
  sound_bytes_.reset();
  std::error_code ignored;
  is_broken_ = fs::exists(path_, ignored) && !fs::is_regular_file(path_, ignored);
  if (!fs::is_regular_file(path_, ignored)) return;
  std::string text;
  try {
    text = read_text(path_);
  } catch (const IoError&) {
    is_broken_ = true;
    return;
  }
  CheckpointRecords found = read_checkpoint(text, identity_);
  is_broken_ = !found.is_checkpoint;
  is_ours_ = found.is_ours;
  if (!is_ours_) return;
  sound_bytes_ = found.sound_bytes;
  keep_results_of(study.materials.size(), found);
  records_ = std::move(found.contents);
}

std::optional<MetricResult> Checkpoint::find(const Lighting& lighting) const {
  if (traits_of(lighting).is_by_tables) return {};
  const auto record = records_.find(record_name(lighting));
  MetricResult result{.lighting = lighting, .combined = {}, .channels = {}, .unresolved = {}, .work = {}};
  if (record == records_.end() || !read_result(record->second, result)) return {};
  return result;
}

std::optional<LiteratureResult> Checkpoint::find(LiteratureMetric comparison) const {
  const auto record = records_.find(record_name(comparison));
  LiteratureResult result{.metric = comparison, .combined = {}, .channels = {}, .unresolved = {}, .work = {}};
  if (record == records_.end() || !read_result(record->second, result)) return {};
  return result;
}

void Checkpoint::keep(const MetricResult& result, double seconds) {
  if (traits_of(result.lighting).is_by_tables) return;
  keep(record_name(result.lighting), written_result(result), seconds);
}

void Checkpoint::keep(const LiteratureResult& result, double seconds) {
  keep(record_name(result.metric), written_result(result), seconds);
}

void Checkpoint::keep(const std::string& name, const std::string& content, double seconds) {
  if (seconds < kWorthKeeping || is_broken_) return;
  const bool is_new = !is_ours_;
  std::error_code ignored;
  if (sound_bytes_) fs::resize_file(path_, *std::exchange(sound_bytes_, {}), ignored);
  std::ofstream file(path_, std::ios::binary | (is_new ? std::ios::trunc : std::ios::app));
  is_ours_ = is_ours_ || file.is_open();
  if (is_new) file << checkpoint_head(identity_);
  file << checkpoint_record(name, content);
  if (!file.flush()) {
    file.close();
    remove();
    is_broken_ = true;
    return;
  }
  is_ours_ = true;
  records_.insert_or_assign(name, content);
}

void Checkpoint::remove() {
  records_.clear();
  std::error_code ignored;
  if (std::exchange(is_ours_, false)) fs::remove(path_, ignored);
}

}  // namespace lobe
