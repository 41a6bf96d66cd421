#pragma once

#include <filesystem>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "lobe/study/study.hpp"
#include "study/read/toml_reader.hpp"

namespace lobe {

/// The key of a study file with paths of other ones.
inline constexpr std::string_view kIncludeKey = "include";

/// One of the files of a study.
struct StudySource {
  std::string name;            ///< as StudyText has it
  std::filesystem::path path;  ///< by which messages call it
  std::string text;
  toml::table root;  ///< without the keys of [study]
};

/// A change of the study from outside its files.
struct AppliedOverride {
  std::string key;                     ///< "family.Ward.m"
  const toml::table* table = nullptr;  ///< the entry that it changes
};

/// A study file and all that it includes.
struct StudySources {
  std::vector<StudySource> files;  ///< each one after those that it includes; the last one is the study file
  toml::table settings;            ///< [study] of all of them
  std::vector<AppliedOverride> overrides;

  /// The tables of [[key]], file by file.
  [[nodiscard]] std::vector<const toml::table*> tables(std::string_view key) const;
  /// Those of several keys, in the order in which they stand.
  struct Entry {
    std::string_view key;
    const toml::table* table;
  };
  [[nodiscard]] std::vector<Entry> entries(std::span<const std::string_view> keys) const;

  /// Where something stands, and what has changed it.
  /// \param table the entry that it belongs to
  [[nodiscard]] Origin origin(const toml::source_region& region, const toml::table& table) const;
  /// Origin of a key of [study], or of an entry in its list; defaults come from nowhere.
  [[nodiscard]] Origin origin_in_settings(std::string_view key, std::size_t entry) const;
};

/// Reads a study file and the files of its key `include`. Paths within included files become paths from the study
/// file's folder.
/// Settings are inherited: those of a file replace those of files that it includes, and the later of two included ones
/// those of the earlier. `name`, `title` and `comment` stay with their file, `references` are joined.
/// \throws IoError, ArgumentError with the place: also for a file that is included twice or by itself.
[[nodiscard]] StudySources read_study_sources(const std::filesystem::path& path);

}  // namespace lobe
