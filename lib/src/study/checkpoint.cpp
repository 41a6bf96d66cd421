#include "lobe/checkpoint.hpp"

#include <dlfcn.h>
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <bit>
#include <cstdint>
#include <cstring>
#include <fstream>
#include <span>
#include <system_error>
#include <utility>

#include "core/files.hpp"
#include "core/text.hpp"
#include "lobe/any_material.hpp"
#include "lobe/error.hpp"
#include "lobe/version.hpp"

namespace lobe {
namespace {

namespace fs = std::filesystem;

// The file: the identity, then results in the order in which they came, each a record of its own: sizes of name and
// content, name, content, checksum. A record whose end is missing counts as not there.
constexpr std::string_view kMagic = "lobe-checkpoint/1\n";
constexpr double kWorthKeeping = 1;  // s

/// FNV-1a.
std::uint64_t checksum(std::string_view bytes) {
  std::uint64_t hash = 0xcbf29ce484222325U;
  for (const char byte : bytes) {
    hash ^= static_cast<unsigned char>(byte);
    hash *= 0x100000001b3U;
  }
  return hash;
}

class Writer {
 public:
  void put(std::uint64_t number) { put_bytes(&number, sizeof number); }
  void put(double number) { put(std::bit_cast<std::uint64_t>(number)); }
  void put(std::string_view text) {
    put(text.size());
    text_ += text;
  }
  template <typename Derived>
  void put(const Eigen::PlainObjectBase<Derived>& matrix) {
    put(static_cast<std::uint64_t>(matrix.rows()));
    put(static_cast<std::uint64_t>(matrix.cols()));
    put_bytes(matrix.data(), static_cast<std::size_t>(matrix.size()) * sizeof(double));
  }
  [[nodiscard]] const std::string& text() const { return text_; }

 private:
  void put_bytes(const void* bytes, std::size_t count) { text_.append(static_cast<const char*>(bytes), count); }

  std::string text_;
};

/// Reads what a Writer wrote; past the end, zeros.
class Reader {
 public:
  explicit Reader(std::string_view text) : rest_(text) {}

  [[nodiscard]] bool is_good() const { return is_good_; }
  [[nodiscard]] std::size_t left() const { return rest_.size(); }
  std::uint64_t count() {
    std::uint64_t number = 0;
    take(&number, sizeof number);
    return number;
  }
  double number() { return std::bit_cast<double>(count()); }
  std::string_view text() {
    const auto size = count();
    if (size > rest_.size()) return fail();
    const std::string_view text = rest_.substr(0, size);
    rest_.remove_prefix(size);
    return text;
  }
  template <typename Matrix>
  void matrix(Matrix& matrix) {
    const auto rows = count();
    const auto columns = count();
    constexpr std::uint64_t kMost = std::uint64_t{1} << 20U;
    if (rows > kMost || columns > kMost || rows * columns * sizeof(double) > rest_.size()) {
      static_cast<void>(fail());
      return;
    }
    matrix.resize(static_cast<Eigen::Index>(rows), static_cast<Eigen::Index>(columns));
    take(matrix.data(), rows * columns * sizeof(double));
  }

 private:
  std::string_view fail() {
    is_good_ = false;
    rest_ = {};
    return {};
  }
  void take(void* target, std::size_t count) {
    if (count > rest_.size()) {
      static_cast<void>(fail());
      return;
    }
    std::memcpy(target, rest_.data(), count);
    rest_.remove_prefix(count);
  }

  std::string_view rest_;
  bool is_good_ = true;
};

void put(Writer& writer, const std::vector<Unresolved>& unresolved, const Work& work) {
  writer.put(unresolved.size());
  for (const auto& pair : unresolved) {
    writer.put(pair.first);
    writer.put(pair.second);
    writer.put(pair.relative_error);
  }
  writer.put(work.nodes);
  writer.put(work.evaluations);
  for (const double seconds : {work.seconds_nodes, work.seconds_samples, work.seconds_gram, work.seconds_host}) {
    writer.put(seconds);
  }
}

void get(Reader& reader, std::vector<Unresolved>& unresolved, Work& work) {
  for (auto left = reader.count(); left > 0 && reader.is_good(); --left) {
    const auto first = reader.count();
    const auto second = reader.count();
    unresolved.push_back({first, second, reader.number()});
  }
  work.nodes = reader.count();
  work.evaluations = reader.count();
  for (double* seconds : {&work.seconds_nodes, &work.seconds_samples, &work.seconds_gram, &work.seconds_host}) {
    *seconds = reader.number();
  }
}

void put(Writer& writer, const Metric& metric) {
  writer.put(metric.gram);
  writer.put(metric.gram_error);
  writer.put(metric.norm);
  writer.put(metric.norm_error);
  writer.put(metric.distance);
  writer.put(metric.distance_error);
}

void get(Reader& reader, Metric& metric) {
  reader.matrix(metric.gram);
  reader.matrix(metric.gram_error);
  reader.matrix(metric.norm);
  reader.matrix(metric.norm_error);
  reader.matrix(metric.distance);
  reader.matrix(metric.distance_error);
}

void put(Writer& writer, const ComparisonMatrix& matrix) {
  writer.put(matrix.distance);
  writer.put(matrix.distance_error);
  writer.put(matrix.size);
  writer.put(matrix.size_error);
}

void get(Reader& reader, ComparisonMatrix& matrix) {
  reader.matrix(matrix.distance);
  reader.matrix(matrix.distance_error);
  reader.matrix(matrix.size);
  reader.matrix(matrix.size_error);
}

template <typename Result>
std::string written(const Result& result) {
  Writer writer;
  put(writer, result.combined);
  writer.put(result.channels.size());
  for (const auto& channel : result.channels) put(writer, channel);
  put(writer, result.unresolved, result.work);
  return writer.text();
}

/// \return whether the whole of it could be read
template <typename Result>
bool read(const std::string& content, Result& result) {
  Reader reader(content);
  get(reader, result.combined);
  for (auto left = reader.count(); left > 0 && reader.is_good(); --left) get(reader, result.channels.emplace_back());
  get(reader, result.unresolved, result.work);
  return reader.is_good() && reader.left() == 0;
}

std::string record_name(const Lighting& lighting) {
  return "lighting " + lighting.name();
}

std::string record_name(Comparison comparison) {
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
  text += fmt::format("{} {} {} {} {} {} {}\n", shortest(study.tolerance), shortest(study.patch_tolerance),
                      shortest(study.comparison_tolerance), static_cast<int>(study.precision),
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
  identity_ = identity_of(study, device);
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
  if (reader.text() != identity_) return;
  sound_bytes_ = text.size() - reader.left();
  while (reader.is_good() && reader.left() > 0) {
    const std::string_view name = reader.text();
    const std::string_view content = reader.text();
    const auto sum = reader.count();
    if (!reader.is_good() || sum != checksum(content)) break;
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

std::optional<ComparisonResult> Checkpoint::find(Comparison comparison) const {
  const auto record = records_.find(record_name(comparison));
  ComparisonResult result{.comparison = comparison, .combined = {}, .channels = {}, .unresolved = {}, .work = {}};
  if (record == records_.end() || !read(record->second, result)) return {};
  return result;
}

void Checkpoint::keep(const MetricResult& result, double seconds) {
  if (result.lighting.kind() == Lighting::Kind::table) return;
  keep(record_name(result.lighting), written(result), seconds);
}

void Checkpoint::keep(const ComparisonResult& result, double seconds) {
  keep(record_name(result.comparison), written(result), seconds);
}

void Checkpoint::keep(const std::string& name, const std::string& content, double seconds) {
  if (seconds < kWorthKeeping || is_broken_) return;
  Writer writer;
  writer.put(name);
  writer.put(content);
  writer.put(checksum(content));
  const bool is_new = !is_ours_;
  std::error_code ignored;
  if (sound_bytes_) fs::resize_file(path_, *std::exchange(sound_bytes_, {}), ignored);
  std::ofstream file(path_, std::ios::binary | (is_new ? std::ios::trunc : std::ios::app));
  is_ours_ = is_ours_ || file.is_open();
  if (is_new) {
    Writer head;
    head.put(identity_);
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
