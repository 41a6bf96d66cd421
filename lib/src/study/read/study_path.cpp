#include "study/read/study_path.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <utility>

#include "core/files.hpp"

namespace lobe {
namespace {

/// The value of the environment variable that a path begins with, and what follows it.
std::pair<std::string, std::string> split_variable(const toml::node& place, const std::string& written) {
  const std::size_t end = std::min(written.find('/'), written.size());
  const std::string variable = written.substr(1, end - 1);
  const char* value = std::getenv(variable.c_str());
  if (value == nullptr || *value == '\0') {
    toml_reader::fail(
        place, fmt::format("environment variable {} of '{}' is not set; expected the folder with the files", variable,
                           written));
  }
  return {value, written.substr(end)};
}

}  // namespace

std::string expanded_path(const toml::node& place, const std::string& written) {
  if (!written.starts_with('$')) return written;
  const auto [folder, rest] = split_variable(place, written);
  return folder + rest;
}

std::string expanded_pattern(const toml::node& place, const std::filesystem::path& directory,
                             const std::string& written) {
  if (written.starts_with('$')) {
    const auto [folder, rest] = split_variable(place, written);
    return pattern_of((std::filesystem::path(folder).is_absolute() ? "" : directory / "").string() + folder) + rest;
  }
  if (std::filesystem::path(written).is_absolute()) return written;
  return pattern_of((directory / "").string()) + written;
}

std::string from_folder_of(const std::string& name, const std::string& written) {
  if (written.starts_with('$')) return written;
  return (std::filesystem::path(name).parent_path() / written).string();
}

}  // namespace lobe
