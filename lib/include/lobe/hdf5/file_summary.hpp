#pragma once

#include <cstddef>
#include <filesystem>
#include <string>
#include <utility>
#include <vector>

namespace [[gnu::visibility("default")]] lobe {

/// Numbers in a file, as the file describes them.
struct DatasetSummary {
  std::string name;                     ///< name in the file, without its slash
  std::string description;              ///< "long_name" of the dataset; may be empty
  std::string unit;                     ///< "units" of the dataset; "1": pure numbers
  std::vector<std::size_t> shape = {};  ///< how many numbers there are along each axis
  double least = 0;                     ///< smallest number
  double largest = 0;                   ///< largest number
};

/// Description that a file of azimuthal modes or a lookup table, written by modes_file() or lut_file() as HDF5, has.
struct FileSummary {
  std::string schema;  ///< "lobe-modes/1" or "lobe-lut/1"
  /// Names and values of what holds for the whole file, such as "material", "convention", "tolerance".
  std::vector<std::pair<std::string, std::string>> attributes = {};
  std::vector<std::string> channels = {};     ///< names of channels, if the file has some
  std::vector<DatasetSummary> datasets = {};  ///< axes and values
};

/// Whether a file is HDF5 of azimuthal modes or a lookup table.
/// \throws IoError for files that are damaged since they were written
[[nodiscard]] bool is_summarised_file(const std::filesystem::path& path);

/// Reads all numbers of a file for its summary.
/// \throws IoError for files of other kinds, and as above
[[nodiscard]] FileSummary load_file_summary(const std::filesystem::path& path);

}  // namespace lobe
