#include "formats/file_bytes.hpp"

#include <fmt/format.h>
#include <zlib.h>

#include <algorithm>
#include <fstream>
#include <new>
#include <span>
#include <utility>
#include <vector>

#include "core/streams.hpp"
#include "core/text.hpp"
#include "lobe/core/error.hpp"

namespace lobe {
namespace {

constexpr std::string_view kGzip = "\x1f\x8b";

/// Unpacks the members of a gzip file one after the other.
class Unpacker {
 public:
  explicit Unpacker(const FileBytes& packed) : packed_(packed), rest_(packed.content()) {
    constexpr int kGzipAlone = 16 + MAX_WBITS;
    if (inflateInit2(&stream_, kGzipAlone) != Z_OK) throw std::bad_alloc();
  }
  Unpacker(const Unpacker&) = delete;
  Unpacker& operator=(const Unpacker&) = delete;
  ~Unpacker() { (void)inflateEnd(&stream_); }

  /// Fills a place, or as much of it as there is to come.
  /// \throws IoError
  [[nodiscard]] std::size_t read(std::span<char> place) {
    std::size_t filled = 0;
    while (filled < place.size() && !is_done_) {
      constexpr std::size_t kMost = std::size_t{1} << 30;  // zlib counts in 32 bits
      const std::size_t input = std::min(rest_.size(), kMost);
      const std::size_t room = std::min(place.size() - filled, kMost);
      stream_.next_in = reinterpret_cast<Bytef*>(const_cast<char*>(rest_.data()));
      stream_.avail_in = static_cast<uInt>(input);
      stream_.next_out = reinterpret_cast<Bytef*>(place.data() + filled);
      stream_.avail_out = static_cast<uInt>(room);
      const int status = inflate(&stream_, Z_NO_FLUSH);
      rest_.remove_prefix(input - stream_.avail_in);
      filled += room - stream_.avail_out;
      if (status == Z_STREAM_END) {
        finish_member();
      } else if (status == Z_BUF_ERROR || (status == Z_OK && rest_.empty() && stream_.avail_out > 0)) {
        packed_.refuse_at(packed_.size(), "the file ends within its compressed data");
      } else if (status == Z_MEM_ERROR) {
        throw std::bad_alloc();
      } else if (status != Z_OK) {
        packed_.refuse_at(
            packed_.size() - rest_.size(),
            fmt::format("its compressed data is damaged ({})", stream_.msg == nullptr ? "no gzip data" : stream_.msg));
      }
    }
    return filled;
  }

 private:
  /// Another member may follow, or zeros, with which blocks of tapes are filled.
  void finish_member() {
    if (rest_.starts_with(kGzip)) {
      (void)inflateReset(&stream_);
      return;
    }
    if (rest_.find_first_not_of('\0') != std::string_view::npos) {
      packed_.refuse_at(packed_.size() - rest_.size(), "the file goes on after its compressed data");
    }
    is_done_ = true;
  }

  const FileBytes& packed_;
  std::string_view rest_;
  z_stream stream_{};
  bool is_done_ = false;
};

std::size_t unpacked_size(const FileBytes& packed, std::size_t limit) {
  std::vector<char> part(std::size_t{1} << 16);
  Unpacker unpacker(packed);
  std::size_t size = 0;
  for (std::size_t count = part.size(); count == part.size(); size += count) {
    count = unpacker.read(part);
    if (count > limit - size) {
      packed.refuse(fmt::format("byte 0: it unpacks to more than {} MiB, which is the limit", limit >> 20));
    }
  }
  return size;
}

}  // namespace

FileBytes::FileBytes(std::filesystem::path path, std::size_t size, std::uintmax_t file_size)
    : path_(std::move(path)), data_(new char[size]), size_(size), file_size_(file_size) {}

FileBytes FileBytes::read_packed(const std::filesystem::path& path, std::size_t most) {
  if (is_stream(path)) {
    const auto kept = stream_content(path, kMostUnpacked);
    FileBytes bytes = copy(path, std::string_view(*kept).substr(0, most));
    bytes.file_size_ = kept->size();
    return bytes;
  }
  std::error_code error;
  if (!std::filesystem::is_regular_file(path, error)) {
    throw IoError(fmt::format("cannot read {}: there is no such file", path.string()),
                  {.fault = Fault::missing_file, .path = path.string()});
  }
  const std::uintmax_t size = std::filesystem::file_size(path, error);
  std::ifstream file(path, std::ios::binary);
  if (error || !file) throw IoError(fmt::format("cannot read {}: cannot open it", path.string()));
  FileBytes bytes(path, static_cast<std::size_t>(std::min<std::uintmax_t>(size, most)), size);
  file.read(bytes.data_.get(), static_cast<std::streamsize>(bytes.size_));
  if (static_cast<std::size_t>(file.gcount()) != bytes.size_) bytes.refuse("it changed while it was read");
  return bytes;
}

FileBytes FileBytes::read(const std::filesystem::path& path) {
  FileBytes bytes = read_packed(path, static_cast<std::size_t>(-1));
  return bytes.is_compressed() ? unpack(bytes) : bytes;
}

FileBytes FileBytes::read_head(const std::filesystem::path& path, std::size_t most) {
  const FileBytes head = read_packed(path, most);
  if (!head.is_compressed()) return head;
  const FileBytes packed = read_packed(path, static_cast<std::size_t>(-1));
  const std::size_t size = unpacked_size(packed, kMostUnpacked);
  FileBytes bytes(path, std::min(size, most), size);
  (void)Unpacker(packed).read({bytes.data_.get(), bytes.size_});
  return bytes;
}

FileBytes FileBytes::unpack(const FileBytes& packed, std::size_t limit) {
  const std::size_t size = unpacked_size(packed, limit);
  FileBytes bytes(packed.path(), size, size);
  (void)Unpacker(packed).read({bytes.data_.get(), size});
  return bytes;
}

std::string FileBytes::stem() const {
  if (path_ == "-" || path_ == "/dev/stdin") return "stdin";
  return (path_.extension() == ".gz" ? path_.stem() : path_).stem().string();
}

bool FileBytes::is_compressed() const {
  return content().starts_with(kGzip);
}

FileBytes FileBytes::copy(const std::filesystem::path& path, std::string_view content) {
  FileBytes bytes(path, content.size(), content.size());
  std::ranges::copy(content, bytes.data_.get());
  return bytes;
}

void FileBytes::refuse(std::string_view complaint, Fault fault) const {
  std::string line(complaint);
  std::ranges::replace_if(
      line, [](unsigned char c) { return c < ' ' || c == 0x7f; }, '?');
  throw IoError(fmt::format("cannot read {}: {}", printable(path_.string()), printable(line)),
                {.fault = fault, .path = path_.string()});
}

void FileBytes::refuse_at(std::size_t offset, std::string_view complaint) const {
  refuse(fmt::format("byte {}: {}", offset, complaint), Fault::content);
}

void FileBytes::refuse_line(std::size_t line, std::string_view complaint) const {
  refuse(fmt::format("line {}: {}", line, complaint), Fault::content);
}

void FileBytes::refuse_end(std::string_view complaint) const {
  const auto ends = static_cast<std::size_t>(std::ranges::count(content(), '\n'));
  refuse_line(std::max<std::size_t>(ends + (content().ends_with('\n') ? 0 : 1), 1), complaint);
}

}  // namespace lobe
