#include "fuzz/fuzz_shard.hpp"

#include <sys/mman.h>
#include <unistd.h>

#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <map>
#include <string_view>

#include "core/checksum.hpp"
#include "lobe/core/error.hpp"
#include "study/run/shard_file.hpp"

namespace lobe::test {
namespace {

using Records = std::map<std::string, std::string, std::less<>>;

constexpr std::string_view kMark = "lobe-shard/1\n";

[[noreturn]] void fail(std::string_view what) {
  std::fprintf(stderr, "lobe_fuzz: a shard: %.*s\n", static_cast<int>(what.size()), what.data());
  std::abort();
}

/// A file in memory.
class MemoryFile {
 public:
  explicit MemoryFile(std::string_view content) : descriptor_(::memfd_create("shard", 0)) {
    if (descriptor_ < 0) fail("no memory for a file");
    while (!content.empty()) {
      const ssize_t written = ::write(descriptor_, content.data(), content.size());
      if (written <= 0) fail("no memory for a file");
      content.remove_prefix(static_cast<std::size_t>(written));
    }
  }
  ~MemoryFile() { ::close(descriptor_); }
  MemoryFile(const MemoryFile&) = delete;
  MemoryFile& operator=(const MemoryFile&) = delete;

  [[nodiscard]] std::filesystem::path path() const { return "/proc/self/fd/" + std::to_string(descriptor_); }

 private:
  int descriptor_;
};

std::string bytes_of(std::uint64_t number) {
  std::string bytes(sizeof number, '\0');
  std::memcpy(bytes.data(), &number, sizeof number);
  return bytes;
}

std::string sealed(std::string_view body) {
  Checksum sum;
  sum.add(body);
  return std::string(kMark) + bytes_of(body.size()) + bytes_of(sum.value()) + std::string(body);
}

/// Records that can be read: each has a checksum of its own, which the file's says nothing about.
Records records_of(const ShardFile& file) {
  Records records;
  for (const auto& [name, place] : file.places()) {
    try {
      records[name] = file.content(name);
    } catch (const IoError&) {
    }
  }
  return records;
}

void expect_equal(const ShardHead& a, const ShardHead& b) {
  if (a.study != b.study || a.shard.index != b.shard.index || a.shard.count != b.shard.count ||
      a.identity.text() != b.identity.text() || a.request != b.request) {
    fail("a head is written as another one");
  }
}

}  // namespace

std::vector<std::string> shard_seeds() {
  const ShardHead head{
      .study = "metals", .shard = {2, 7}, .identity = {"0.1.0", "a build", "a device", "a plan"}, .request = "all"};
  const std::string text = shard_text(head, {{"lighting point 3", std::string("\0\1\2\3", 4)}, {"curve 1", "values"}});
  return {std::string(1, '\0') + text, "\1" + text.substr(kMark.size() + 2 * sizeof(std::uint64_t))};
}

void fuzz_shard(std::span<const std::uint8_t> data) {
  const std::string_view bytes(reinterpret_cast<const char*>(data.data()), data.size());
  if (bytes.empty()) return;
  const MemoryFile written(bytes[0] == 0 ? std::string(bytes.substr(1)) : sealed(bytes.substr(1)));
  try {
    const ShardFile file(written.path());
    if (file.head().shard.index < 1 || file.head().shard.index > file.head().shard.count) fail("a shard of no study");
    const Records records = records_of(file);
    const MemoryFile again(shard_text(file.head(), records));
    const ShardFile copy(again.path());
    expect_equal(file.head(), copy.head());
    if (records_of(copy) != records) fail("records are written as others");
  } catch (const IoError&) {
  }
}

}  // namespace lobe::test
