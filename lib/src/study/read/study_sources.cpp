#include "study/read/study_sources.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <tuple>
#include <utility>

#include "core/files.hpp"
#include "study/read/keys.hpp"
#include "study/read/study_path.hpp"

namespace lobe {
namespace {

namespace fs = std::filesystem;
namespace reader = toml_reader;

constexpr std::array<std::string_view, 3> kOwnSettings = {"name", "title", "comment"};

/// Where a file is included.
struct Inclusion {
  fs::path file;
  std::string place;  ///< "FILE:LINE"
};

/// By which one and the same file is known, however it is written.
fs::path resolved(const fs::path& path) {
  std::error_code code;
  fs::path same = fs::weakly_canonical(path, code);
  return code ? path : same;
}

std::string place_text(const toml::node& node) {
  const toml::source_region& region = node.source();
  return fmt::format("{}:{}", region.path ? *region.path : "", region.begin.line);
}

void move_into(toml::table& table, const toml::key& key, toml::node& node) {
  table.erase(key.str());  // with the place of the key
  node.visit([&](auto& value) { table.insert(key, std::move(value)); });
}

class Reading {
 public:
  StudySources read(const fs::path& path) {
    read_file(path, path.filename().string());
    return std::move(sources_);
  }

 private:
  void read_file(const fs::path& path, const std::string& name) {
    StudySource source{name, path, read_text(path), {}};
    source.root = reader::parse(source.text, path);
    const bool is_included = depth_ > 0;
    reader::require_known_keys(source.root, names_of(kFileKeys), "a study file");
    ++depth_;
    if (const toml::node* node = source.root.get(kIncludeKey)) include(*node, path, name);
    --depth_;
    if (is_included) move_paths(source);
    if (toml::node* settings = source.root.get("study")) {
      (void)reader::table(*settings, "'study'");
      take_settings(*settings->as_table(), is_included);
    }
    sources_.files.push_back(std::move(source));
  }

  void include(const toml::node& node, const fs::path& path, const std::string& name) {
    chain_.push_back(resolved(path));
    for (const auto& entry : reader::array(node, kIncludeKey)) {
      const std::string written = reader::text(entry, "an entry of include");
      const fs::path file = path.parent_path() / expanded_path(entry, written);
      std::error_code ignored;
      if (!fs::is_regular_file(file, ignored)) {
        reader::fail(entry, fmt::format("there is no file '{}'; expected a path from the folder of the file that "
                                        "includes it",
                                        file.string()));
      }
      const fs::path same = resolved(file);
      if (std::ranges::find(chain_, same) != chain_.end()) {
        reader::fail(entry, fmt::format("'{}' includes itself{}; expected no circle", written,
                                        chain_.back() == same ? "" : " by way of this file"));
      }
      const auto earlier = std::ranges::find(included_, same, &Inclusion::file);
      if (earlier != included_.end()) {
        reader::fail(entry,
                     fmt::format("'{}' is included already, by {}; expected every file once", written, earlier->place));
      }
      included_.push_back({same, place_text(entry)});
      read_file(file, from_folder_of(name, written));
    }
    chain_.pop_back();
  }

  /// What an included file calls its files by, from the folder of the study file.
  static void move_paths(StudySource& source) {
    toml::array* tables = source.root["measured"].as_array();
    if (tables == nullptr) return;
    const auto move = [&](toml::node* node) {
      if (auto* text = node == nullptr ? nullptr : node->as_string()) *text = from_folder_of(source.name, text->get());
    };
    for (toml::node& entry : *tables) {
      toml::table* table = entry.as_table();
      if (table == nullptr) continue;
      move(table->get("file"));
      move(table->get("files"));
      if (toml::array* files = (*table)["files"].as_array()) {
        for (toml::node& file : *files) move(&file);
      }
    }
  }

  void take_settings(toml::table& given, bool is_included) {
    for (auto&& [key, node] : given) {
      const bool is_own = std::ranges::find(kOwnSettings, key.str()) != kOwnSettings.end();
      if (is_included && is_own) continue;
      if (key.str() == "references" && join_references(node)) continue;
      move_into(sources_.settings, key, node);
    }
  }

  /// Adds citations to those of the files before.
  /// \return false where there are none before, or no lists
  bool join_references(toml::node& node) {
    toml::array* given = node.as_array();
    toml::array* all = sources_.settings["references"].as_array();
    if (given == nullptr || all == nullptr) return false;
    for (toml::node& entry : *given) {
      const auto is_same = [&](const toml::node& other) {
        return entry.is_string() && other.is_string() && *entry.as_string() == *other.as_string();
      };
      if (std::ranges::any_of(*all, is_same)) continue;
      entry.visit([&](auto& value) { all->push_back(std::move(value)); });
    }
    return true;
  }

  StudySources sources_;
  std::vector<fs::path> chain_;  ///< files that are being read, each included by the one before
  std::vector<Inclusion> included_;
  std::size_t depth_ = 0;
};

}  // namespace

std::vector<const toml::table*> StudySources::tables(std::string_view key) const {
  std::vector<const toml::table*> found;
  for (const auto& file : files) {
    const toml::node* node = file.root.get(key);
    if (node == nullptr) continue;
    if (!node->is_array() || !node->is_array_of_tables()) {
      reader::fail(*node, fmt::format("'{0}' is {1}; expected tables headed [[{0}]]", key, reader::kind_of(*node)));
    }
    for (const auto& entry : *node->as_array()) found.push_back(entry.as_table());
  }
  return found;
}

std::vector<StudySources::Entry> StudySources::entries(std::span<const std::string_view> keys) const {
  std::vector<Entry> list;
  for (const auto key : keys) {
    for (const auto* table : tables(key)) list.push_back({key, table});
  }
  const auto rank = [&](const Entry& entry) {
    const toml::source_region& region = entry.table->source();
    const auto file = std::ranges::find_if(
        files, [&](const StudySource& source) { return region.path && source.path.string() == *region.path; });
    return std::tuple(file - files.begin(), region.begin.line, region.begin.column);
  };
  std::ranges::stable_sort(list, {}, rank);
  return list;
}

Origin StudySources::origin(const toml::source_region& region, const toml::table& table) const {
  Origin origin;
  for (const auto& file : files) {
    if (!region.path || *region.path != file.path.string()) continue;
    origin.file = file.name;
    origin.line = region.begin.line;
  }
  for (const auto& change : overrides) {
    if (change.table == &table) origin.overrides.push_back(change.key);
  }
  return origin;
}

Origin StudySources::origin_in_settings(std::string_view key, std::size_t entry) const {
  Origin origin;
  const toml::node* list = settings.get(key);
  if (list == nullptr) return origin;
  const toml::node* node = list->is_array() ? list->as_array()->get(entry) : nullptr;
  origin = this->origin((node != nullptr ? *node : *list).source(), settings);
  const std::string own = fmt::format("study.{}", key);
  std::erase_if(origin.overrides, [&](const std::string& name) { return !name.starts_with(own); });
  return origin;
}

StudySources read_study_sources(const std::filesystem::path& path) {
  return Reading().read(path);
}

}  // namespace lobe
