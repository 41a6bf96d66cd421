#pragma once

#include <filesystem>
#include <functional>
#include <string>
#include <vector>

namespace [[gnu::visibility("default")]] lobe {

/// Writes a file so that it is either complete or absent: `write` fills an empty temporary file beside the target,
/// which is then flushed to the disk and takes the target's place. A file that is replaced passes on its mode and, if
/// that is permitted, its owner; links are followed. Devices, pipes and the process's own descriptors (/dev/stdout,
/// /dev/fd/3) are written to and stay as they are. After any failure the temporary file is removed, and so are those of
/// processes that were killed.
/// \throws IoError if the target exists and overwrite is false, or after a failure; exceptions of `write` pass through
void write_atomically(const std::filesystem::path& target, bool overwrite,
                      const std::function<void(const std::filesystem::path& temporary)>& write);

/// Whether a path is written to as it is, and never replaced: a device, a pipe, a descriptor of this process.
[[nodiscard]] bool is_output_stream(const std::filesystem::path& path);

/// Writes a text with write_atomically().
/// \throws as write_atomically()
void write_text(const std::filesystem::path& target, bool overwrite, const std::string& text);

/// Files that match a shell pattern, in the order of their names; empty if there are none.
[[nodiscard]] std::vector<std::filesystem::path> matching_files(const std::string& pattern);

/// Reads a file as text.
/// \throws IoError if the file cannot be read
[[nodiscard]] std::string read_text(const std::filesystem::path& path);

/// Removes all files that are being written, for a process that has to end at once.
void remove_unfinished();

}  // namespace lobe
