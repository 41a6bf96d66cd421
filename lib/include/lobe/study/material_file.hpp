#pragma once

#include <filesystem>
#include <string>
#include <string_view>

#include "lobe/model/material.hpp"

namespace [[gnu::visibility("default")]] lobe {

/// Writes a material as the text of a material file (docs/study-files.md). load_material_file() restores model, values
/// and weights to the last bit.
/// \param comment text at the top, every line made a comment
/// \throws ArgumentError if a name has control characters, which cannot be read back, or if a term does not fit its
///   model
[[nodiscard]] std::string material_toml(const Material& material, std::string_view comment = {});

/// Writes a material file.
/// \throws IoError if the file exists and overwrite is false, or if it cannot be written
void save_material(const Material& material, const std::filesystem::path& path, bool overwrite = false,
                   std::string_view comment = {});

}  // namespace lobe
