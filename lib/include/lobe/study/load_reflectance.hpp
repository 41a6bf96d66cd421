#pragma once

#include <filesystem>
#include <span>

#include "lobe/formats/chosen_file.hpp"
#include "lobe/formats/measured.hpp"
#include "lobe/table/reflectance.hpp"

namespace [[gnu::visibility("default")]] lobe {

/// Loads a reflectance from a file of any kind, recognised by content: tables of lobe, the formats of
/// measured_formats(), material files (docs/study-files.md).
/// \param options options for measured files, and the channels of tables
/// \throws as load_table(), load_measured() and load_material_file(); ArgumentError for options that a material file
///   cannot meet
[[nodiscard]] Reflectance load_reflectance(const std::filesystem::path& path, const ReadOptions& options = {});

/// Adds adjustments, such as those behind the name of a material file, to the material's own, and to its name.
[[nodiscard]] Material with_adjustments(Material material, std::span<const Adjustment> adjustments);

/// Loads a reflectance from a file as parse_file() understands it, with the adjustments of a material file.
/// \throws as above; ArgumentError for adjustments of other files
[[nodiscard]] Reflectance load_reflectance(const ChosenFile& file);

}  // namespace lobe
