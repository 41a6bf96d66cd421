#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>

namespace [[gnu::visibility("default")]] lobe {

/// Kinds of files that verify_file() recognises.
enum class FileKind {
  table,          ///< a table from save(), or from another program, with a grid and values
  study_results,  ///< results from write_study()
  shard,          ///< a shard of a study, from run_shard()
  hdf5            ///< any other HDF5 file
};

/// A file that was read to its end.
struct VerifiedFile {
  FileKind kind = FileKind::hdf5;  ///< kind of content
  bool has_checksum = false;       ///< as lobe writes it; files written or changed by other programs have none
  std::size_t datasets = 0;        ///< number of datasets with numbers; of a shard, of its units
  std::uint64_t bytes = 0;         ///< size of their numbers in memory, 8 bytes for each; of a shard, of the file
};

/// Verifies a file by reading it to its end, a part at a time: the checksum of everything except chunks of numbers,
/// then every chunk (in files of lobe each has its own checksum), and whatever the file's kind requires beside numbers.
/// \throws IoError "cannot read FILE: ..." if the file is missing, damaged or neither HDF5 nor a shard
[[nodiscard]] VerifiedFile verify_file(const std::filesystem::path& path);

}  // namespace lobe
