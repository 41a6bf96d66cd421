#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <string>

#include "hdf5/hdf5.hpp"

namespace lobe::hdf5 {

class Sink;

/// The bytes of an HDF5 file whose root group `fill` writes, without a checksum behind them; the same calls give the
/// same bytes.
/// \throws IoError when a call fails; what `fill` throws passes through.
[[nodiscard]] std::string file_image(const std::function<void(hid_t root)>& fill);

/// An HDF5 file of any size that goes straight to the disk. HDF5 1.10 crashes when a write fails while it closes a
/// file, so none fails for it: the file's driver remembers the first failure and drops what is written after it;
/// check() and close() report it.
class OutputFile {
 public:
  /// \param name what messages call the file
  /// \throws IoError when the file cannot be created.
  OutputFile(const std::filesystem::path& path, std::string name);
  ~OutputFile();
  OutputFile(const OutputFile&) = delete;
  OutputFile& operator=(const OutputFile&) = delete;

  [[nodiscard]] hid_t root() const { return root_->id(); }

  /// To be called now and then: a full disk need not be found at the end only.
  /// \throws IoError when a write failed.
  void check_writes() const;

  /// Writes one chunk as its filters leave it (encode_chunk()), with its checksum.
  /// \param offset of its first element
  void write_chunk(const Dataset& dataset, std::span<const hsize_t> offset, std::span<const unsigned char> bytes);

  /// Completes the file, and puts the checksum of file_digest.hpp behind it; without it what was written is of no use.
  /// Nothing in it may be open.
  /// \throws IoError when anything could not be written.
  void close();

 private:
  QuietErrors quiet_;
  std::string name_;
  std::unique_ptr<Sink> sink_;
  std::optional<File> file_;
  std::optional<Group> root_;
};

}  // namespace lobe::hdf5
