#pragma once

#include <filesystem>
#include <variant>

#include "lobe/brdf_function.hpp"
#include "lobe/material.hpp"
#include "lobe/measured.hpp"
#include "lobe/table.hpp"

namespace lobe {

/// What a file may hold: a material by its formulas, a table, or a reflectance of another program.
using AnyMaterial = std::variant<Material, BrdfTable, BrdfFunction>;

/// Reads a file of any kind, recognised by content: tables of lobe, the formats of foreign_formats(), material files
/// (docs/study-files.md).
/// \param options of foreign formats, and the channels of tables
/// \throws as load_table(), load_measured() and load_material_file(); ArgumentError for options that a material file
///   cannot meet.
[[nodiscard]] AnyMaterial load_material(const std::filesystem::path& path, const ReadOptions& options = {});

}  // namespace lobe
