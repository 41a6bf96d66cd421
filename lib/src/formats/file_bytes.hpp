#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <string>
#include <string_view>

#include "lobe/core/error.hpp"

namespace lobe {

/// The content of a file, shared with whatever is made of it. Complaints are IoErrors that name the file and the place.
class FileBytes {
 public:
  /// How much a compressed file, or a stream, may hold.
  static constexpr std::size_t kMostUnpacked = std::size_t{1} << 30;

  /// Reads a file. Content compressed by gzip, in any number of members, is unpacked; its size is known, and checked
  /// against the limit, before memory is allocated. Streams, and "-", which is standard input, are read once and kept.
  /// \throws IoError when the file cannot be read, and for compressed data that is damaged or cut short
  [[nodiscard]] static FileBytes read(const std::filesystem::path& path);
  /// The first bytes only, for recognising a format; size() is that of what was read.
  [[nodiscard]] static FileBytes read_head(const std::filesystem::path& path, std::size_t most);
  /// Unpacks content that is compressed by gzip.
  /// \param limit on the size of what comes out
  [[nodiscard]] static FileBytes unpack(const FileBytes& packed, std::size_t limit = kMostUnpacked);
  /// Content that is in memory already.
  /// \param path what complaints call it
  [[nodiscard]] static FileBytes copy(const std::filesystem::path& path, std::string_view content);

  [[nodiscard]] const std::filesystem::path& path() const { return path_; }
  /// The file's name without its endings, `.gz` among them; "stdin" for standard input.
  [[nodiscard]] std::string stem() const;
  [[nodiscard]] std::string_view content() const { return {data_.get(), size_}; }
  [[nodiscard]] std::size_t size() const { return size_; }
  /// Size of the whole file, even if only the head was read; for compressed files the size of their content.
  [[nodiscard]] std::uintmax_t file_size() const { return file_size_; }
  [[nodiscard]] bool is_compressed() const;

  /// Complaints may quote the file: control characters, which terminals obey, become question marks.
  /// \throws IoError "cannot read FILE: <complaint>"
  [[noreturn]] void refuse(std::string_view complaint, Fault fault = Fault::unspecified) const;
  /// \throws IoError "cannot read FILE: byte <offset>: <complaint>"
  [[noreturn]] void refuse_at(std::size_t offset, std::string_view complaint) const;
  /// \throws IoError "cannot read FILE: line <line>: <complaint>"; lines count from 1
  [[noreturn]] void refuse_line(std::size_t line, std::string_view complaint) const;
  /// Refuses a text that ends too early, naming its last line.
  /// \throws IoError
  [[noreturn]] void refuse_end(std::string_view complaint) const;

 private:
  FileBytes(std::filesystem::path path, std::size_t size, std::uintmax_t file_size);
  [[nodiscard]] static FileBytes read_packed(const std::filesystem::path& path, std::size_t most);

  std::filesystem::path path_;
  std::shared_ptr<char[]> data_;
  std::size_t size_ = 0;
  std::uintmax_t file_size_ = 0;
};

}  // namespace lobe
