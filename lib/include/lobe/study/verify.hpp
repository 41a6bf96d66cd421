#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>

namespace lobe {

/// What a file is that verify_file() has found sound.
enum class FileKind {
  table,          ///< of save(), or of another program with a grid and values
  study_results,  ///< of write_study()
  hdf5            ///< of another kind
};

/// A file of HDF5 that was read to its end.
struct VerifiedFile {
  FileKind kind = FileKind::hdf5;  ///< of what it holds
  bool has_checksum = false;       ///< of lobe; files of other programs, and those that these have changed, have none
  std::size_t datasets = 0;        ///< of numbers
  std::uint64_t bytes = 0;         ///< of their numbers in memory, 8 for each
};

/// Reads a file to its end, a part at a time: the checksum of all but chunks of numbers, then every chunk, each of
/// which has a checksum of its own in files of lobe, and what the file's kind has to state beside numbers.
/// \throws IoError "cannot read FILE: ..." for what is missing, damaged or no HDF5
[[nodiscard]] VerifiedFile verify_file(const std::filesystem::path& path);

}  // namespace lobe
