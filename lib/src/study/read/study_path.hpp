#pragma once

#include <filesystem>
#include <string>

#include "study/read/toml_reader.hpp"

/// Paths as study files have them: from the file's folder, absolute, or "$NAME/..." with the value of an environment
/// variable in front.
namespace lobe {

/// "$NAME/..." with the value in place of the name; other paths as they are.
/// \throws ArgumentError with the place for a variable that is not set.
[[nodiscard]] std::string expanded_path(const toml::node& place, const std::string& written);

/// A pattern of files from a folder, in which the folder and the variable's value match themselves alone.
/// \throws ArgumentError as expanded_path().
[[nodiscard]] std::string expanded_pattern(const toml::node& place, const std::filesystem::path& directory,
                                           const std::string& written);

/// Name of a file that another file includes, relative to the place from which the latter is called `name`.
[[nodiscard]] std::string from_folder_of(const std::string& name, const std::string& written);

}  // namespace lobe
