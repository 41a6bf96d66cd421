#include "study/run/shard_file.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstring>
#include <fstream>
#include <nlohmann/json.hpp>
#include <optional>
#include <system_error>
#include <utility>

#include "core/checksum.hpp"
#include "lobe/core/error.hpp"
#include "study/run/checkpoint_records.hpp"

namespace lobe {
namespace {

namespace fs = std::filesystem;

// The mark, two numbers (bytes that follow, and their checksum), then records as in a checkpoint, of which the first is
// the head.
constexpr std::string_view kKind = "lobe-shard/";
constexpr std::string_view kMark = "lobe-shard/1\n";
constexpr std::string_view kHead = "head";
constexpr std::size_t kNumber = sizeof(std::uint64_t);
constexpr std::size_t kBegin = kMark.size() + 2 * kNumber;

std::string bytes_of(std::uint64_t number) {
  std::string bytes(kNumber, '\0');
  std::memcpy(bytes.data(), &number, kNumber);
  return bytes;
}

std::uint64_t number_in(std::string_view bytes) {
  std::uint64_t number = 0;
  std::memcpy(&number, bytes.data(), kNumber);
  return number;
}

std::string json_of(const ShardHead& head) {
  const nlohmann::ordered_json json{{"study", head.study},          {"shard", head.shard.index},
                                    {"shards", head.shard.count},   {"version", head.identity.version},
                                    {"build", head.identity.build}, {"device", head.identity.device},
                                    {"plan", head.identity.plan},   {"request", head.request}};
  return json.dump(1, ' ', false, nlohmann::ordered_json::error_handler_t::replace) + "\n";
}

/// None where it is something else.
std::optional<ShardHead> head_from(const std::string& text) {
  const auto json = nlohmann::json::parse(text, nullptr, false);
  try {
    ShardHead head;
    head.study = json.at("study").get<std::string>();
    head.shard = {json.at("shard").get<std::size_t>(), json.at("shards").get<std::size_t>()};
    head.identity = {json.at("version").get<std::string>(), json.at("build").get<std::string>(),
                     json.at("device").get<std::string>(), json.at("plan").get<std::string>()};
    head.request = json.at("request").get<std::string>();
    if (head.shard.index < 1 || head.shard.index > head.shard.count) return {};
    return head;
  } catch (const nlohmann::json::exception&) {
    return {};
  }
}

[[noreturn]] void refuse(const fs::path& path, std::string_view what) {
  throw IoError(fmt::format("{} {}; remove it, and run its shard again", path.string(), what),
                {.fault = Fault::content, .path = path.string()});
}

/// A file that is read from a place on.
class Source {
 public:
  explicit Source(const fs::path& path) : path_(path) {
    std::error_code code;
    if (fs::is_directory(path, code)) code = std::make_error_code(std::errc::is_a_directory);
    errno = 0;
    if (!code) file_.open(path, std::ios::binary);
    if (!code && !file_) code = {errno != 0 ? errno : ENOENT, std::generic_category()};
    if (code) {
      throw IoError("cannot read " + path.string() + ": " + code.message(),
                    {.fault = fault_of(code), .path = path.string()});
    }
  }
  /// Fewer bytes at the end of the file.
  std::string read(std::uint64_t offset, std::uint64_t count) {
    std::string bytes(count, '\0');
    file_.clear();
    file_.seekg(static_cast<std::streamoff>(offset));
    file_.read(bytes.data(), static_cast<std::streamsize>(count));
    bytes.resize(static_cast<std::size_t>(std::max<std::streamsize>(file_.gcount(), 0)));
    return bytes;
  }
  [[nodiscard]] std::uint64_t size() const {
    std::error_code code;
    const std::uintmax_t bytes = fs::file_size(path_, code);
    return code ? 0 : bytes;
  }

 private:
  fs::path path_;
  std::ifstream file_;
};

}  // namespace

std::string shard_text(const ShardHead& head, const std::map<std::string, std::string, std::less<>>& records) {
  std::string body = checkpoint_record(kHead, json_of(head));
  for (const auto& [name, content] : records) body += checkpoint_record(name, content);
  Checksum sum;
  sum.add(body);
  return std::string(kMark) + bytes_of(body.size()) + bytes_of(sum.value()) + body;
}

bool is_shard_file(const fs::path& path) {
  std::error_code ignored;
  if (!fs::is_regular_file(path, ignored)) return false;
  std::ifstream file(path, std::ios::binary);
  std::string begin(kKind.size(), '\0');
  return file.read(begin.data(), static_cast<std::streamsize>(begin.size())) && begin == kKind;
}

ShardFile::ShardFile(fs::path path) : path_(std::move(path)) {
  Source source(path_);
  const std::string begin = source.read(0, kBegin);
  if (begin.size() < kMark.size() && kMark.starts_with(begin)) refuse(path_, "is truncated");
  if (!begin.starts_with(kKind)) refuse(path_, "is no shard of a study");
  if (!begin.starts_with(kMark)) refuse(path_, "was written by another version of lobe");
  if (begin.size() < kBegin) refuse(path_, "is truncated");
  const std::uint64_t expected = number_in(std::string_view(begin).substr(kMark.size()));
  const std::uint64_t there = source.size() - kBegin;
  if (there < expected) {
    refuse(path_, fmt::format("is truncated: it has {} bytes, and says {}", there + kBegin, expected + kBegin));
  }
  if (there > expected) refuse(path_, fmt::format("is damaged: it has {} bytes too many", there - expected));
  Checksum sum;
  constexpr std::uint64_t kPart = std::uint64_t{1} << 20U;
  for (std::uint64_t at = 0; at < there; at += kPart) sum.add(source.read(kBegin + at, std::min(kPart, there - at)));
  if (sum.value() != number_in(std::string_view(begin).substr(kMark.size() + kNumber))) {
    refuse(path_, "is damaged: its bytes do not have the checksum with which they were written");
  }

  // Sizes of names and contents say where the next one is.
  constexpr std::uint64_t kLongestName = 4096;
  for (std::uint64_t at = 0; at < there;) {
    const auto number = [&] {
      const std::string bytes = source.read(kBegin + at, kNumber);
      if (bytes.size() < kNumber || there - at < kNumber) refuse(path_, "is damaged");
      at += kNumber;
      return number_in(bytes);
    };
    const std::uint64_t name_size = number();
    if (name_size > kLongestName || name_size > there - at) refuse(path_, "is damaged");
    std::string name = source.read(kBegin + at, name_size);
    at += name_size;
    Place place;
    place.size = number();
    place.offset = kBegin + at;
    if (place.size > there - at) refuse(path_, "is damaged");
    at += place.size;
    place.checksum = number();
    places_.emplace(std::move(name), place);
  }
  if (!has(kHead)) refuse(path_, "is damaged: it does not say of what it is a shard");
  const auto head = head_from(content(kHead));
  if (!head) refuse(path_, "is damaged: it does not say of what it is a shard");
  head_ = *head;
  places_.erase(std::string(kHead));
}

std::string ShardFile::content(std::string_view name) const {
  const auto found = places_.find(name);
  if (found == places_.end()) return {};
  const Place& place = found->second;
  std::string text = Source(path_).read(place.offset, place.size);
  if (text.size() != place.size || record_checksum(name, text) != place.checksum) {
    refuse(path_, "has changed while it was read");
  }
  return text;
}

}  // namespace lobe
