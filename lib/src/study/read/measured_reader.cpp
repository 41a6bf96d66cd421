#include "study/read/measured_reader.hpp"

#include <fmt/format.h>

#include <array>
#include <cstdint>

#include "core/files.hpp"
#include "core/text.hpp"
#include "lobe/core/error.hpp"
#include "lobe/formats/chosen_file.hpp"
#include "study/read/keys.hpp"
#include "study/read/material_reader.hpp"
#include "study/read/study_path.hpp"

namespace lobe {
namespace {

namespace fs = std::filesystem;
namespace reader = toml_reader;

/// A path or a pattern, and what is read of its files.
struct Entry {
  std::string written;
  ReadOptions options;
  bool is_pattern = false;
};

/// With the options that stand in brackets behind it, if any. Brackets without '=' are characters of a pattern.
Entry entry_of(const toml::node& place, const fs::path& directory, const std::string& written,
               const ReadOptions& options, bool is_pattern) {
  const std::size_t open = written.rfind('[');
  if (open == std::string::npos || (is_pattern && written.find('=', open) == std::string::npos)) {
    return {written, options, is_pattern};
  }
  std::error_code ignored;
  if (fs::exists(directory / expanded_path(place, written), ignored)) return {written, options, false};
  const ChosenFile file = located(place, [&] { return parse_file(written, options); });
  return {file.path.string(), file.options, is_pattern};
}

/// The files that a pattern matches, by name.
std::vector<fs::path> matches(const toml::node& place, const fs::path& directory, const std::string& written) {
  std::vector<fs::path> paths = matching_files(expanded_pattern(place, directory, written));
  if (paths.empty()) {
    reader::fail(place, fmt::format("no file matches '{}'; expected at least one",
                                    (directory / expanded_path(place, written)).string()));
  }
  return paths;
}

std::vector<fs::path> one_file(const toml::node& place, const fs::path& path) {
  std::error_code ignored;
  if (!fs::is_regular_file(path, ignored))
    reader::fail(
        place, fmt::format("there is no file '{}'; expected a path from the folder of this study file", path.string()));
  return {path};
}

/// Names of channels, or their numbers.
std::vector<std::string> read_channels(const toml::node& node) {
  std::vector<std::string> channels;
  for (const auto& entry : reader::array(node, "channels")) {
    const auto number = entry.value_exact<std::int64_t>();
    if (number && *number < 1) {
      reader::fail(entry, fmt::format("channels has the number {}; expected names, or numbers from 1 on", *number));
    }
    channels.push_back(number ? std::to_string(*number) : reader::text(entry, "an entry of channels"));
  }
  if (channels.empty()) reader::fail(node, "channels is empty; expected names, or numbers from 1 on");
  return channels;
}

ReadOptions read_options(const toml::table& table) {
  ReadOptions options;
  if (const auto* node = table.get("channels")) options.channels = read_channels(*node);
  if (const auto* node = table.get("wavelengths")) options.wavelengths = reader::numbers(*node, "wavelengths");
  if (const auto* node = table.get("luminance")) options.luminance = reader::text(*node, "luminance");
  if (const auto* node = table.get("component")) options.component = reader::text(*node, "component");
  if (const auto* node = table.get("srgb")) options.decode_srgb = reader::truth(*node, "srgb");
  if (const auto* node = table.get("entry")) options.entry = reader::text(*node, "entry");
  if (const auto* node = table.get("uniforms")) {
    for (const auto& entry : reader::array(*node, "uniforms")) {
      const std::string text = reader::text(entry, "an entry of uniforms");
      options.uniforms.push_back(located(entry, [&] { return parse_uniform(text); }));
    }
  }
  if (const auto* node = table.get("theta_max")) {
    const double degrees = reader::number(*node, "theta_max");
    options.theta_max = located(*node, [&] { return theta_max_of(degrees); });
  }
  return options;
}

}  // namespace

std::vector<PlacedFile> read_measured_table(const toml::table& table, const fs::path& directory) {
  reader::require_known_keys(table, names_of(kMeasuredKeys), "[[measured]]");
  if (table.contains("file") == table.contains("files")) {
    reader::fail(table, "[[measured]] has both 'file' and 'files' or none of them; expected one");
  }
  const bool is_single = table.contains("file");
  const toml::node& files = *table.get(is_single ? "file" : "files");
  const ReadOptions options = read_options(table);
  const toml::node* family = table.get("family");
  const toml::node* label = table.get(is_single ? "name" : "label");
  if (const toml::node* other = table.get(is_single ? "label" : "name")) {
    reader::fail(*other, is_single ? "'label' is for several 'files'; expected 'name'"
                                   : "'name' is for a single 'file'; expected 'label', a pattern with {name}");
  }
  const std::string family_name = family == nullptr ? "measured" : reader::text(*family, "family");
  const std::string pattern = label == nullptr ? "{name}" : reader::text(*label, is_single ? "name" : "label");

  std::vector<PlacedFile> list;
  const auto add = [&](const toml::node& node) {
    const auto [written, wanted, is_pattern] =
        entry_of(node, directory, reader::text(node, is_single ? "file" : "an entry of files"), options, !is_single);
    for (const auto& path :
         is_pattern ? matches(node, directory, written) : one_file(node, directory / expanded_path(node, written))) {
      const LabelTexts texts{{"name", path.stem().string()}, {"family", family_name}};
      const std::string name = fill_label(pattern, texts, label == nullptr ? node : *label);
      const std::string shown = (fs::path(written).parent_path() / path.filename()).string();
      list.push_back({name, family_name, {path, shown, wanted}, &node});
    }
  };
  if (const auto* several = files.as_array()) {
    for (const auto& node : *several) add(node);
    if (list.empty()) reader::fail(files, "files is empty; expected paths or patterns");
  } else {
    add(files);
  }
  return list;
}

}  // namespace lobe
