#pragma once

#include <zlib.h>

#include <algorithm>
#include <array>
#include <cstddef>
#include <filesystem>
#include <memory>
#include <string>

namespace lobe::test {

/// At most `most` bytes of a file, unpacked where it is compressed.
inline std::string read_unzipped(const std::filesystem::path& path, std::size_t most = std::size_t{1} << 30) {
  const std::unique_ptr<gzFile_s, decltype(&gzclose)> file(gzopen(path.c_str(), "rb"), gzclose);
  if (file == nullptr) return {};
  std::string content;
  std::array<char, 1U << 16> part{};
  for (int count = 1; count > 0 && content.size() < most;) {
    count = gzread(file.get(), part.data(), static_cast<unsigned>(std::min(part.size(), most - content.size())));
    content.append(part.data(), static_cast<std::size_t>(std::max(count, 0)));
  }
  return content;
}

}  // namespace lobe::test
