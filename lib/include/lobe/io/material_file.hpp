#pragma once

#include <filesystem>
#include <string>
#include <string_view>

#include "lobe/model/material.hpp"

namespace lobe {

/// The material as the text of a material file (docs/study-files.md): load_material_file() gives the same model, values
/// and weights to the last bit.
/// \param comment text in front, every line made a comment
/// \throws ArgumentError where a name has control characters, which are not read, or a term does not fit its model
[[nodiscard]] std::string material_toml(const Material& material, std::string_view comment = {});

/// Writes a material file.
/// \throws IoError when the file exists and overwrite is false, or cannot be written.
void save_material(const Material& material, const std::filesystem::path& path, bool overwrite = false,
                   std::string_view comment = {});

}  // namespace lobe
