#pragma once

#include <filesystem>

#include "lobe/formats/measured.hpp"
#include "lobe/table/reflectance.hpp"

namespace [[gnu::visibility("default")]] lobe {

/// Loads a reflectance from a file of any kind, recognised by content: tables of lobe, the formats of
/// measured_formats(), material files (docs/study-files.md).
/// \param options options for measured files, and the channels of tables
/// \throws as load_table(), load_measured() and load_material_file(); ArgumentError for options that a material file
///   cannot meet
[[nodiscard]] Reflectance load_reflectance(const std::filesystem::path& path, const ReadOptions& options = {});

}  // namespace lobe
