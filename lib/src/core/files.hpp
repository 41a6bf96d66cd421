#pragma once

#include <filesystem>
#include <functional>
#include <string>
#include <string_view>
#include <vector>

namespace lobe {

/// Writes a file so that it is either complete or absent: `write` fills a temporary file beside the target, which is
/// then flushed to the disk and renamed. On any failure the temporary file is removed.
/// \throws IoError when the target exists and overwrite is false, or on failure; what `write` throws passes through.
void write_atomically(const std::filesystem::path& target, bool overwrite,
                      const std::function<void(const std::filesystem::path& temporary)>& write);

/// The same for a text. \throws as write_atomically().
void write_text(const std::filesystem::path& target, bool overwrite, const std::string& text);

/// The files that a shell pattern matches, in the order of their names; none where nothing matches.
[[nodiscard]] std::vector<std::filesystem::path> matching_files(const std::string& pattern);

/// A pattern that matches this text alone.
[[nodiscard]] std::string pattern_of(std::string_view literal);

/// \throws IoError when the file cannot be read.
[[nodiscard]] std::string read_text(const std::filesystem::path& path);

}  // namespace lobe
