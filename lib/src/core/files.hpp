#pragma once

#include <filesystem>
#include <string>
#include <string_view>

#include "lobe/core/files.hpp"

namespace lobe {

/// Gives a file that takes the place of another one its mode and, where that is permitted, its owner.
/// \throws IoError
void take_mode(const std::filesystem::path& file, const std::filesystem::path& replaced);

/// Flushes a file or a directory to the disk.
/// \throws IoError
void sync_to_disk(const std::filesystem::path& path);

/// A pattern that matches this text alone.
[[nodiscard]] std::string pattern_of(std::string_view literal);

}  // namespace lobe
