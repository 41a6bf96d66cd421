#pragma once

#include <cstddef>
#include <filesystem>
#include <memory>
#include <string>

namespace lobe {

/// Whether a path names what can be read only once: "-", which is standard input, or a pipe or device.
[[nodiscard]] bool is_stream(const std::filesystem::path& path);

/// All that a stream holds, kept for the rest of the process: whoever looks at the content first takes it from the
/// others.
/// \param most bytes that are read at most.
/// \throws IoError where it cannot be read or holds more
[[nodiscard]] std::shared_ptr<const std::string> stream_content(const std::filesystem::path& path, std::size_t most);

}  // namespace lobe
