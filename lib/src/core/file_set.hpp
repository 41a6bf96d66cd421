#pragma once

#include <filesystem>
#include <string>

#include "lobe/core/file_set.hpp"

namespace lobe {

/// Whether a process has left the set with some of its files moved and some not, which finish_killed() and FileSet put
/// right.
[[nodiscard]] bool is_half_moved(const std::filesystem::path& directory, const std::string& name);

/// \throws IoError when there is such a file.
void require_absent(const std::filesystem::path& path);

/// Makes a directory where there is none.
/// \throws IoError
void make_directory(const std::filesystem::path& directory);

}  // namespace lobe
