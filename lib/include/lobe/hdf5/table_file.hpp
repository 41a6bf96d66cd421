#pragma once

#include <cstddef>
#include <filesystem>
#include <string>
#include <vector>

#include "lobe/table/table.hpp"

namespace [[gnu::visibility("default")]] lobe {

/// Options for writing a table.
struct TableFileOptions {
  bool dense = false;             ///< write an isotropic table in its general (4D) form
  bool compress = true;           ///< deflate; without it files are larger but faster
  bool overwrite = false;         ///< replace a file that exists
  std::string command_line = {};  ///< recorded in the file
};

/// Writes a table as HDF5, schema lobe-table/1 (docs/file-formats.md), in a file that is complete or absent. The same
/// table and options give the same bytes, except for the time of writing (SOURCE_DATE_EPOCH fixes it). The table read
/// back is equal to the last bit.
/// \throws IoError; ArgumentError if the table is inconsistent
void save(const BrdfTable& table, const std::filesystem::path& path, const TableFileOptions& options = {});

/// Reads a table from save() or from another program, which need only write a grid and values (docs/file-formats.md);
/// errors that are missing are unknown.
/// \throws IoError naming the file and the object in it that is missing, damaged or not as in the schema
[[nodiscard]] BrdfTable load_table(const std::filesystem::path& path);

/// Reads a table without its values: `values` is empty.
/// \throws IoError as load_table()
[[nodiscard]] BrdfTable load_table_header(const std::filesystem::path& path);

/// Reads the values of one row of L: isotropic [theta_out][k], general [node_out]. Only that part of the file is read.
/// \throws IoError; ArgumentError for a channel or row that the table does not have
[[nodiscard]] std::vector<double> load_table_row(const std::filesystem::path& path, std::size_t channel,
                                                 std::size_t row);

/// Whether a table states the standard deviations of its values, in a dataset brdf_std.
/// \throws IoError if the file is not a table
[[nodiscard]] bool states_deviations(const std::filesystem::path& path);

/// Reads standard deviations for the values of load_table(), in their order; empty if the file states none.
/// \throws IoError as load_table(), and for deviations below 0
[[nodiscard]] TableValues load_table_deviations(const std::filesystem::path& path);

/// Whether a file is a table of this schema, or has a grid and values without a schema; false for anything else,
/// including files that cannot be read.
/// \throws IoError for a file whose bytes have changed since it was written
[[nodiscard]] bool is_table_file(const std::filesystem::path& path);

}  // namespace lobe
