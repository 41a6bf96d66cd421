#pragma once

#include <filesystem>
#include <functional>
#include <string>
#include <string_view>
#include <vector>

namespace lobe {

/// Writes a file so that it is either complete or absent: `write` fills an empty temporary file beside the target,
/// which is then flushed to the disk and takes the target's place, where overwrite is false only if nothing is there. A
/// file that is replaced leaves its mode and, where that is permitted, its owner; links are followed. Devices, pipes
/// and the process's own descriptors (/dev/stdout, /dev/fd/3) are written to and stay what they are. On any failure the
/// temporary file is removed, and so are those of processes that were killed.
/// \throws IoError when the target exists and overwrite is false, or on failure; what `write` throws passes through.
void write_atomically(const std::filesystem::path& target, bool overwrite,
                      const std::function<void(const std::filesystem::path& temporary)>& write);

/// Whether a path is written to as it is, and never replaced: a device, a pipe, a descriptor of this process.
[[nodiscard]] bool is_output_stream(const std::filesystem::path& path);

/// Gives a file that takes the place of another one its mode and, where that is permitted, its owner.
/// \throws IoError
void take_mode(const std::filesystem::path& file, const std::filesystem::path& replaced);

/// Flushes a file or a directory to the disk.
/// \throws IoError
void sync_to_disk(const std::filesystem::path& path);

/// write_atomically() of a text.
/// \throws as it.
void write_text(const std::filesystem::path& target, bool overwrite, const std::string& text);

/// The files that a shell pattern matches, in the order of their names; none where nothing matches.
[[nodiscard]] std::vector<std::filesystem::path> matching_files(const std::string& pattern);

/// A pattern that matches this text alone.
[[nodiscard]] std::string pattern_of(std::string_view literal);

/// \throws IoError when the file cannot be read.
[[nodiscard]] std::string read_text(const std::filesystem::path& path);

}  // namespace lobe
