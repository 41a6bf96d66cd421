#include "lobe/study/checkpoint.hpp"

#include <dlfcn.h>
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <concepts>
#include <cstdint>
#include <cstring>
#include <fstream>
#include <span>
#include <system_error>
#include <type_traits>
#include <utility>

#include "core/files.hpp"
#include "core/text.hpp"
#include "lobe/core/error.hpp"
#include "lobe/core/version.hpp"
#include "study/run/study_channels.hpp"

namespace lobe {
namespace {

namespace fs = std::filesystem;

// The file: the identity, then results in the order in which they came, each a record of its own: sizes of name and
// content, name, content, checksum. A record whose end is missing counts as not there.
constexpr std::string_view kMagic = "lobe-checkpoint/2\n";
constexpr double kWorthKeeping = 1;  // s

/// FNV-1a, of name and content.
std::uint64_t checksum(std::string_view name, std::string_view content) {
  std::uint64_t hash = 0xcbf29ce484222325U;
  for (const std::string_view bytes : {name, std::string_view("\0", 1), content}) {
    for (const char byte : bytes) {
      hash ^= static_cast<unsigned char>(byte);
      hash *= 0x100000001b3U;
    }
  }
  return hash;
}

/// Numbers and texts one after the other, as bytes.
class Writer {
 public:
  void take(std::uint64_t number) { append(&number, sizeof number); }
  void take(double number) { append(&number, sizeof number); }
  void take(std::string_view text) {
    take(text.size());
    text_ += text;
  }
  template <typename Derived>
  void take(const Eigen::PlainObjectBase<Derived>& matrix) {
    take(static_cast<std::uint64_t>(matrix.rows()));
    take(static_cast<std::uint64_t>(matrix.cols()));
    append(matrix.data(), static_cast<std::size_t>(matrix.size()) * sizeof(double));
  }
  template <typename Item>
  void take(const std::vector<Item>& items) {
    take(items.size());
    for (const auto& item : items) take_fields(*this, item);
  }
  [[nodiscard]] const std::string& text() const { return text_; }

 private:
  void append(const void* bytes, std::size_t count) { text_.append(static_cast<const char*>(bytes), count); }

  std::string text_;
};

/// Reads what a Writer wrote; past the end, zeros.
class Reader {
 public:
  explicit Reader(std::string_view text) : rest_(text) {}

  [[nodiscard]] bool is_good() const { return is_good_; }
  [[nodiscard]] std::size_t left() const { return rest_.size(); }
  void take(std::uint64_t& number) { extract(&number, sizeof number); }
  void take(double& number) { extract(&number, sizeof number); }
  void take(std::string_view& text) {
    std::uint64_t size = 0;
    take(size);
    if (size > rest_.size()) return fail();
    text = rest_.substr(0, size);
    rest_.remove_prefix(size);
  }
  template <typename Derived>
  void take(Eigen::PlainObjectBase<Derived>& matrix) {
    std::uint64_t rows = 0;
    std::uint64_t columns = 0;
    take(rows);
    take(columns);
    constexpr std::uint64_t kMost = std::uint64_t{1} << 20U;
    if (rows > kMost || columns > kMost || rows * columns * sizeof(double) > rest_.size()) return fail();
    matrix.resize(static_cast<Eigen::Index>(rows), static_cast<Eigen::Index>(columns));
    extract(matrix.data(), rows * columns * sizeof(double));
  }
  template <typename Item>
  void take(std::vector<Item>& items) {
    std::uint64_t left = 0;
    for (take(left); left > 0 && is_good_; --left) take_fields(*this, items.emplace_back());
  }

 private:
  void fail() {
    is_good_ = false;
    rest_ = {};
  }
  void extract(void* target, std::size_t count) {
    if (count > rest_.size()) return fail();
    std::memcpy(target, rest_.data(), count);
    rest_.remove_prefix(count);
  }

  std::string_view rest_;
  bool is_good_ = true;
};

// The members of each type, for writing (of a const object) and reading.
template <typename Value, typename Type>
concept Of = std::same_as<std::remove_const_t<Value>, Type>;

void take_fields(auto& stream, Of<Unresolved> auto& pair) {
  stream.take(pair.first);
  stream.take(pair.second);
  stream.take(pair.relative_error);
}

void take_fields(auto& stream, Of<WorkDone> auto& work) {
  stream.take(work.nodes);
  stream.take(work.evaluations);
  stream.take(work.seconds_nodes);
  stream.take(work.seconds_samples);
  stream.take(work.seconds_gram);
  stream.take(work.seconds_host);
}

void take_fields(auto& stream, Of<Metric> auto& metric) {
  stream.take(metric.gram);
  stream.take(metric.gram_error);
  stream.take(metric.norm);
  stream.take(metric.norm_error);
  stream.take(metric.distance);
  stream.take(metric.distance_error);
}

void take_fields(auto& stream, Of<LiteratureMatrix> auto& matrix) {
  stream.take(matrix.distance);
  stream.take(matrix.distance_error);
  stream.take(matrix.size);
  stream.take(matrix.size_error);
}

void take_result(auto& stream, auto& result) {
  take_fields(stream, result.combined);
  stream.take(result.channels);
  stream.take(result.unresolved);
  take_fields(stream, result.work);
}

std::string written(const auto& result) {
  Writer writer;
  take_result(writer, result);
  return writer.text();
}

/// \return whether the whole of it could be read
bool read(const std::string& content, auto& result) {
  Reader reader(content);
  take_result(reader, result);
  return reader.is_good() && reader.left() == 0;
}

std::string record_name(const Lighting& lighting) {
  return "lighting " + lighting.name();
}

std::string record_name(LiteratureMetric comparison) {
  return fmt::format("comparison {}", to_string(comparison));
}

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
  is_broken_ = !text.starts_with(kMagic);
  if (is_broken_) return;
  Reader reader(std::string_view(text).substr(kMagic.size()));
  std::string_view identity;
  reader.take(identity);
  if (identity != identity_) return;
  sound_bytes_ = text.size() - reader.left();
  while (reader.is_good() && reader.left() > 0) {
    std::string_view name;
    std::string_view content;
    std::uint64_t sum = 0;
    reader.take(name);
    reader.take(content);
    reader.take(sum);
    if (!reader.is_good() || sum != checksum(name, content)) break;
    records_.insert_or_assign(std::string(name), std::string(content));
    sound_bytes_ = text.size() - reader.left();
  }
  is_ours_ = true;
}

std::optional<MetricResult> Checkpoint::find(const Lighting& lighting) const {
  if (lighting.kind() == Lighting::Kind::table) return {};
  const auto record = records_.find(record_name(lighting));
  MetricResult result{.lighting = lighting, .combined = {}, .channels = {}, .unresolved = {}, .work = {}};
  if (record == records_.end() || !read(record->second, result)) return {};
  return result;
}

std::optional<LiteratureResult> Checkpoint::find(LiteratureMetric comparison) const {
  const auto record = records_.find(record_name(comparison));
  LiteratureResult result{.metric = comparison, .combined = {}, .channels = {}, .unresolved = {}, .work = {}};
  if (record == records_.end() || !read(record->second, result)) return {};
  return result;
}

void Checkpoint::keep(const MetricResult& result, double seconds) {
  if (result.lighting.kind() == Lighting::Kind::table) return;
  keep(record_name(result.lighting), written(result), seconds);
}

void Checkpoint::keep(const LiteratureResult& result, double seconds) {
  keep(record_name(result.metric), written(result), seconds);
}

void Checkpoint::keep(const std::string& name, const std::string& content, double seconds) {
  if (seconds < kWorthKeeping || is_broken_) return;
  Writer writer;
  writer.take(name);
  writer.take(content);
  writer.take(checksum(name, content));
  const bool is_new = !is_ours_;
  std::error_code ignored;
  if (sound_bytes_) fs::resize_file(path_, *std::exchange(sound_bytes_, {}), ignored);
  std::ofstream file(path_, std::ios::binary | (is_new ? std::ios::trunc : std::ios::app));
  is_ours_ = is_ours_ || file.is_open();
  if (is_new) {
    Writer head;
    head.take(identity_);
    file << kMagic << head.text();
  }
  file << writer.text();
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
