#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "lobe/lut/lut.hpp"

namespace lobe {

/// Content of an HDF5 file of schema lobe-lut/1: a dataset of doubles for each column, and for its errors, along axes
/// that are datasets, too.
/// \param lines the header that text files have
[[nodiscard]] std::string lut_hdf5(const Lut& lut, const std::optional<LutErrors>& errors,
                                   const std::vector<std::string>& lines);

/// Numbers of a file's datasets, by the names of the columns; those that it lacks behind the first are left out.
/// \throws IoError where there is no first, and where an axis has other values than the definition
[[nodiscard]] std::vector<double> read_lut_hdf5(const std::filesystem::path& path, const LutRequest& request,
                                                const std::vector<std::string>& columns);

}  // namespace lobe
