#include "io/formats/file_bytes.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <fstream>
#include <utility>

#include "lobe/error.hpp"

namespace lobe {

FileBytes::FileBytes(std::filesystem::path path, std::size_t size, std::uintmax_t file_size)
    : path_(std::move(path)), data_(new char[size]), size_(size), file_size_(file_size) {}

FileBytes FileBytes::read(const std::filesystem::path& path) {
  return read_head(path, static_cast<std::size_t>(-1));
}

FileBytes FileBytes::read_head(const std::filesystem::path& path, std::size_t most) {
  std::error_code error;
  if (!std::filesystem::is_regular_file(path, error)) {
    throw IoError(fmt::format("cannot read {}: there is no such file", path.string()));
  }
  const std::uintmax_t size = std::filesystem::file_size(path, error);
  std::ifstream file(path, std::ios::binary);
  if (error || !file) throw IoError(fmt::format("cannot read {}: cannot open it", path.string()));
  FileBytes bytes(path, static_cast<std::size_t>(std::min<std::uintmax_t>(size, most)), size);
  file.read(bytes.data_.get(), static_cast<std::streamsize>(bytes.size_));
  if (static_cast<std::size_t>(file.gcount()) != bytes.size_) bytes.refuse("it changed while it was read");
  return bytes;
}

FileBytes FileBytes::copy(const std::filesystem::path& path, std::string_view content) {
  FileBytes bytes(path, content.size(), content.size());
  std::ranges::copy(content, bytes.data_.get());
  return bytes;
}

void FileBytes::refuse(std::string_view complaint) const {
  std::string line(complaint);
  std::ranges::replace_if(
      line, [](unsigned char c) { return c < ' ' || c == 0x7f; }, '?');
  throw IoError(fmt::format("cannot read {}: {}", path_.string(), line));
}

void FileBytes::refuse_at(std::size_t offset, std::string_view complaint) const {
  refuse(fmt::format("byte {}: {}", offset, complaint));
}

void FileBytes::refuse_line(std::size_t line, std::string_view complaint) const {
  refuse(fmt::format("line {}: {}", line, complaint));
}

void FileBytes::refuse_end(std::string_view complaint) const {
  const auto ends = static_cast<std::size_t>(std::ranges::count(content(), '\n'));
  refuse_line(std::max<std::size_t>(ends + (content().ends_with('\n') ? 0 : 1), 1), complaint);
}

}  // namespace lobe
