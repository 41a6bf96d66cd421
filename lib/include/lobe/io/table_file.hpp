#pragma once

#include <cstddef>
#include <filesystem>
#include <string>
#include <vector>

#include "lobe/table/table.hpp"

namespace lobe {

/// How a table is written.
struct TableFileOptions {
  bool dense = false;             ///< write an isotropic table in its general (4D) form
  bool compress = true;           ///< deflate; without it files are larger and quicker
  bool overwrite = false;         ///< replace a file that exists
  std::string command_line = {};  ///< recorded in the file
};

/// Writes a table as HDF5, schema lobe-table/1 (docs/file-formats.md), so that the file is complete or absent. The same
/// table and options give the same bytes, except for the time of writing (SOURCE_DATE_EPOCH fixes it). A read-back
/// table is equal to the last bit.
/// \throws IoError; ArgumentError where the table is inconsistent.
void save(const BrdfTable& table, const std::filesystem::path& path, const TableFileOptions& options = {});

/// Reads a table that save() wrote, or one of another program, which needs no more than a grid and values
/// (docs/file-formats.md): errors that are not there are unknown.
/// \throws IoError naming the file and the object in it that is missing, damaged or not as the schema says.
[[nodiscard]] BrdfTable load_table(const std::filesystem::path& path);

/// What a file holds without its values: `values` is empty.
[[nodiscard]] BrdfTable load_table_header(const std::filesystem::path& path);

/// The values of one row of L: isotropic [theta_out][k], general [node_out]; reads that part of the file only.
/// \throws IoError; ArgumentError for a channel or row that the table does not have.
[[nodiscard]] std::vector<double> load_table_row(const std::filesystem::path& path, std::size_t channel,
                                                 std::size_t row);

/// Whether a table states the standard deviations of its values, in a dataset brdf_std.
/// \throws IoError for what is no table
[[nodiscard]] bool states_deviations(const std::filesystem::path& path);

/// Standard deviations of the values of load_table(), in their order; empty where the file states none.
/// \throws IoError as load_table(), and for deviations below 0
[[nodiscard]] TableValues load_table_deviations(const std::filesystem::path& path);

/// Whether a file is a table of this schema, or has a grid and values without any; false for anything else, including
/// files that cannot be read.
/// \throws IoError for a file whose bytes have changed since it was written
[[nodiscard]] bool is_table_file(const std::filesystem::path& path);

}  // namespace lobe
