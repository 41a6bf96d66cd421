#include "study/study_path.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cstdlib>
#include <filesystem>

namespace lobe {

std::string expanded_path(const toml::node& place, const std::string& written) {
  if (!written.starts_with('$')) return written;
  const std::size_t end = std::min(written.find('/'), written.size());
  const std::string variable = written.substr(1, end - 1);
  const char* value = std::getenv(variable.c_str());
  if (value == nullptr || *value == '\0') {
    toml_reader::fail(
        place, fmt::format("environment variable {} of '{}' is not set; expected the folder with the files", variable,
                           written));
  }
  return value + written.substr(end);
}

std::string from_folder_of(const std::string& name, const std::string& written) {
  if (written.starts_with('$')) return written;
  return (std::filesystem::path(name).parent_path() / written).string();
}

}  // namespace lobe
