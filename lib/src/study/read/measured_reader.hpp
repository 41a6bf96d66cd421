#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "lobe/study/study.hpp"
#include "study/read/toml_reader.hpp"

namespace lobe {

/// A material that is a file, and where it stands.
struct PlacedFile {
  std::string name;
  std::string family;
  MaterialFile file;
  const toml::node* place = nullptr;
};

/// The materials of a table [[measured]]. Whether the files can be read shows when the study is run.
/// \param directory of the study file, which relative paths start from
/// \throws ArgumentError with the place, also for patterns that no file matches and unknown environment variables.
[[nodiscard]] std::vector<PlacedFile> read_measured_table(const toml::table& table,
                                                          const std::filesystem::path& directory);

}  // namespace lobe
