#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <map>
#include <optional>
#include <utility>

#include "core/files.hpp"
#include "core/text.hpp"
#include "lobe/core/directions.hpp"
#include "lobe/core/error.hpp"
#include "lobe/formats/chosen_file.hpp"
#include "lobe/study/load_reflectance.hpp"
#include "lobe/study/study.hpp"
#include "metric/domain.hpp"
#include "model/terms.hpp"
#include "study/read/analysis_keys.hpp"
#include "study/read/chart_reader.hpp"
#include "study/read/family_reader.hpp"
#include "study/read/keys.hpp"
#include "study/read/material_reader.hpp"
#include "study/read/measured_reader.hpp"
#include "study/read/published_reader.hpp"
#include "study/read/study_override.hpp"
#include "study/read/study_path.hpp"
#include "study/read/study_sources.hpp"
#include "study/read/study_text.hpp"
#include "study/read/toml_reader.hpp"

namespace lobe {
namespace {

namespace reader = toml_reader;

/// A material, and where it stands.
struct Placed {
  StudyMaterial material;
  const toml::node* place;  ///< that its name comes from
  Origin origin;
};

Material read_material(const toml::table& table, const std::string& default_name, std::optional<std::size_t> channels) {
  static constexpr auto kKeys = names_of(kMaterialKeys);
  Material material;
  const toml::node* name = table.get("name");
  if (name == nullptr && default_name.empty()) (void)reader::require(table, "name", "[[material]]");
  material.name = name != nullptr ? reader::text(*name, "name") : default_name;
  if (has_control_characters(material.name)) {
    reader::fail(table, "the file's name has control characters; expected one without, or 'name' in the file");
  }
  material.terms = read_terms(table, {}, channels, kKeys, "[[material]]");
  material.adjustments = read_adjustments(table);
  const toml::node* family = table.get("family");
  material.family = family != nullptr ? reader::text(*family, "family") : family_of(material.terms);
  return material;
}

/// A name, or "material:FILE" with a path from the folder of the study.
/// \param files takes what file it is
Lighting read_lighting(const toml::node& entry, const std::string& name, const std::filesystem::path& directory,
                       std::vector<MaterialFile>& files) {
  constexpr std::string_view kMaterial = "material:";
  return located(entry, [&] {
    if (!name.starts_with(kMaterial)) return parse_lighting(name);
    const std::string written = name.substr(kMaterial.size());
    ChosenFile file = parse_file(written);
    file.path = directory / expanded_path(entry, file.path.string());
    std::error_code ignored;
    if (!std::filesystem::is_regular_file(file.path, ignored)) return parse_lighting(name);
    files.push_back({.path = file.path, .name = written, .options = file.options});
    return Lighting::material(load_reflectance(file), written);
  });
}

std::vector<Lighting> read_lightings(const toml::node& node, const std::filesystem::path& directory,
                                     std::vector<MaterialFile>& files) {
  std::vector<Lighting> lightings;
  for (const auto& entry : reader::array(node, "lightings")) {
    const std::string name = reader::text(entry, "an entry of lightings");
    const Lighting lighting = read_lighting(entry, name, directory, files);
    if (std::find(lightings.begin(), lightings.end(), lighting) != lightings.end()) {
      reader::fail(entry, fmt::format("lighting '{}' is listed twice; expected it once", name));
    }
    lightings.push_back(lighting);
  }
  if (lightings.empty()) reader::fail(node, "lightings is empty; expected \"point\", \"daylight\" or both");
  return lightings;
}

void read_channels(const toml::table& table, Study& study) {
  if (const toml::node* node = table.get("channels")) {
    study.channels = reader::texts(*node, "channels");
    if (study.channels.empty()) reader::fail(*node, "channels is empty; expected at least one name");
    for (std::size_t i = 1; i < study.channels.size(); ++i) {
      const auto end = study.channels.begin() + static_cast<std::ptrdiff_t>(i);
      if (std::find(study.channels.begin(), end, study.channels[i]) != end) {
        reader::fail(*node->as_array()->get(i), fmt::format("channel '{}' is listed twice; expected it once", *end));
      }
    }
  }
  const std::size_t count = study.channels.size();
  study.channel_weights.assign(count, 1.0 / static_cast<double>(count));
  if (const toml::node* node = table.get("channel_weights")) {
    study.channel_weights = reader::numbers(*node, "channel_weights");
    if (study.channel_weights.size() != count) {
      reader::fail(*node, fmt::format("channel_weights has {} values; expected {}, one per channel",
                                      study.channel_weights.size(), count));
    }
    const auto is_negative = [](double weight) { return weight < 0; };
    const auto& weights = study.channel_weights;
    if (std::any_of(weights.begin(), weights.end(), is_negative) ||
        std::all_of(weights.begin(), weights.end(), [](double weight) { return weight == 0; })) {
      reader::fail(*node, "channel_weights has a negative weight or only zeros; expected weights of at least 0");
    }
  }
}

/// A comment may have several lines.
std::string read_comment(const toml::node& node) {
  std::string comment = reader::long_text(node, "comment");
  std::string letters = comment;
  std::erase_if(letters, [](char c) { return c == '\n' || c == '\r' || c == '\t'; });
  if (has_control_characters(letters)) {
    reader::fail(node, "comment has control characters; expected a text, in several lines at most");
  }
  return comment;
}

/// The name becomes part of file names.
std::string read_study_name(const toml::node& node) {
  std::string name = reader::text(node, "name");
  if (name.find('/') != std::string::npos || name.starts_with('.') || name.starts_with('-')) {
    reader::fail(
        node,
        fmt::format("name '{}' is no stem of file names; expected no '/', and neither '.' nor '-' in front", name));
  }
  return name;
}

/// The domain of scalar products, which patch lights do not have.
void read_domain(const toml::table& table, Study& study) {
  const toml::node* node = table.get("domain_theta_max");
  if (node == nullptr) return;
  const double degrees = reader::number(*node, "domain_theta_max");
  if (!(degrees > 0 && degrees <= 90)) {
    reader::fail(*node, fmt::format("domain_theta_max is {}; expected degrees above 0, at most 90", shortest(degrees)));
  }
  if (degrees == 90) return;
  study.domain_theta_max = degrees * kDegree;
  located(*node, [&] {
    for (const auto& lighting : study.lightings) static_cast<void>(cos_of_domain(study.domain_theta_max, lighting));
    return true;
  });
}

/// A whole number of at least 1.
std::size_t read_count(const toml::node& node, std::string_view what) {
  const auto* count = node.as_integer();
  if (count == nullptr || count->get() < 1) {
    const std::string given = node.is_number() ? shortest(reader::number(node, what)) : reader::kind_of(node);
    reader::fail(node, fmt::format("{} is {}; expected a whole number of at least 1", what, given));
  }
  return static_cast<std::size_t>(count->get());
}

void read_settings(const toml::table& table, const std::filesystem::path& directory, Study& study) {
  reader::require_known_keys(table, names_of(kStudyKeys), "[study]");
  if (const toml::node* node = table.get("name")) study.name = read_study_name(*node);
  study.title = study.name;
  if (const toml::node* node = table.get("title")) study.title = reader::text(*node, "title");
  if (const toml::node* node = table.get("comment")) study.comment = read_comment(*node);
  if (const toml::node* node = table.get("references")) study.references = reader::texts(*node, "references");
  read_channels(table, study);
  if (const toml::node* node = table.get("lightings")) {
    study.lightings = read_lightings(*node, directory, study.lighting_files);
  }
  read_domain(table, study);
  study.tolerance = reader::tolerance(table, "tolerance").value_or(study.tolerance);
  study.patch_tolerance = reader::tolerance(table, "patch_tolerance").value_or(study.patch_tolerance);
  study.function_tolerance = reader::tolerance(table, "function_tolerance").value_or(study.function_tolerance);
  study.comparison_tolerance = reader::tolerance(table, "comparison_tolerance").value_or(study.comparison_tolerance);
  read_analyses(table, study);
  if (const toml::node* node = table.get("precision")) {
    const std::string precision = reader::text(*node, "precision");
    if (precision != "double" && precision != "single") {
      reader::fail(*node, fmt::format("precision is '{}'; expected \"double\" or \"single\"", precision));
    }
    study.precision = precision == "double" ? Precision::double_precision : Precision::single_precision;
  }
  if (const toml::node* node = table.get("grid")) {
    study.grid = located(*node, [&] { return HemisphereGrid::parse(reader::text(*node, "grid")); });
  }
  if (const toml::node* node = table.get("allow_unresolved")) {
    study.allow_unresolved = reader::truth(*node, "allow_unresolved");
  }
  if (const toml::node* node = table.get("clusters")) study.clustering.clusters = read_count(*node, "clusters");
  if (const toml::node* node = table.get("neighbours")) study.clustering.neighbours = read_count(*node, "neighbours");
}

/// There are no more clusters than materials.
void require_clusters(const toml::table& settings, const Study& study) {
  if (study.clustering.clusters <= study.materials.size()) return;
  reader::fail(*settings.get("clusters"), fmt::format("clusters is {}; expected at most {}, the number of materials",
                                                      study.clustering.clusters, study.materials.size()));
}

std::vector<Placed> read_materials(const StudySources& sources, std::size_t channels,
                                   const std::filesystem::path& directory) {
  constexpr std::array<std::string_view, 3> kKinds = {"family", "material", "measured"};
  std::vector<Placed> materials;
  const auto add = [&](StudyMaterial material, const toml::node* place, const toml::node& heading,
                       const toml::table& table, std::string swept = {}) {
    Origin origin = sources.origin(heading.source(), table);
    origin.swept = std::move(swept);
    materials.push_back({std::move(material), place, std::move(origin)});
  };
  for (const auto& [key, table] : sources.entries(kKinds)) {
    if (key == "family") {
      for (auto& [material, place, origin, swept] : read_family(*table, channels)) {
        add(std::move(material), place, *origin, *table, std::move(swept));
      }
    } else if (key == "measured") {
      for (auto& [name, family, file, place] : read_measured_table(*table, directory)) {
        add({{name, family}, std::move(file)}, place, *place, *table);
      }
    } else {
      add(read_material(*table, {}, channels), table->get("name"), *table, *table);
    }
  }
  return materials;
}

void require_distinct_names(const std::vector<Placed>& materials) {
  std::map<std::string_view, const Placed*> seen;
  for (const auto& placed : materials) {
    const auto [first, is_new] = seen.emplace(placed.material.name(), &placed);
    if (is_new) continue;
    const toml::source_region& place = placed.place->source();
    const toml::source_region& other = first->second->place->source();
    const bool is_same_file = place.path && other.path && *place.path == *other.path;
    const std::string where = is_same_file
                                  ? fmt::format("line {}", other.begin.line)
                                  : fmt::format("{}:{}", other.path ? *other.path : std::string(), other.begin.line);
    reader::fail(place, fmt::format("material '{}' exists already, from {}; expected distinct names",
                                    placed.material.name(), where));
  }
}

/// The places of a list's entries, as many as there are materials of them; of anything else its own.
std::vector<Origin> origins_of(const StudySources& sources, const toml::table& table, std::string_view key,
                               std::size_t count) {
  const toml::array* list = table[key].as_array();
  std::vector<Origin> origins;
  for (std::size_t i = 0; i < count; ++i) {
    const bool has_place = list != nullptr && i < list->size();
    const toml::node& node = has_place ? *list->get(i) : static_cast<const toml::node&>(table);
    origins.push_back(sources.origin(node.source(), table));
  }
  return origins;
}

void read_figures(const StudySources& sources, Study& study) {
  for (const auto* table : sources.tables("published")) {
    std::vector<PublishedFigure> figures = read_published(*table);
    for (auto& origin : origins_of(sources, *table, "rows", figures.size())) {
      study.origins.published.push_back(std::move(origin));
    }
    for (auto& figure : figures) study.published.push_back(std::move(figure));
  }
}

void read_charts(const StudySources& sources, Study& study) {
  for (const auto* table : sources.tables("chart")) {
    Chart chart = read_chart(*table);
    if (std::ranges::find(study.charts, chart.name, &Chart::name) != study.charts.end()) {
      reader::fail(*table->get("name"), fmt::format("chart '{}' exists already; expected distinct names", chart.name));
    }
    study.origins.charts.push_back(sources.origin(table->source(), *table));
    study.origins.curves.push_back(origins_of(sources, *table, "curves", chart.curves.size()));
    study.charts.push_back(std::move(chart));
  }
}

/// Refuses settings that need materials if there are none.
void require_no_metrics(const toml::table& settings) {
  for (const char* key : {"lightings", "comparison_metrics", "approximations", "clusters", "neighbours"}) {
    if (!settings.contains(key)) continue;
    reader::fail(
        reader::place_of(settings, key),
        fmt::format(
            "{} is given but the study has no material; expected at least one [[family]], [[material]] or [[measured]]",
            key));
  }
}

/// Materials of a family stand together, families in order of their first material.
void set_materials(Study& study, std::vector<Placed> materials) {
  const auto family = [](const Placed& placed) -> const std::string& { return placed.material.family(); };
  std::map<std::string, std::size_t> rank;
  for (const auto& placed : materials) rank.emplace(family(placed), rank.size());
  std::ranges::stable_sort(materials, {}, [&](const Placed& placed) { return rank.at(family(placed)); });
  for (auto& placed : materials) {
    study.materials.push_back(std::move(placed.material));
    study.origins.materials.push_back(std::move(placed.origin));
  }
}

/// The texts of a study, and where the metrics are asked for.
void set_provenance(const StudySources& sources, std::span<const std::string> overrides, Study& study) {
  study.overrides.assign(overrides.begin(), overrides.end());
  study.texts.push_back({sources.files.back().name, sources.files.back().text});
  for (std::size_t i = 0; i + 1 < sources.files.size(); ++i) {
    study.texts.push_back({sources.files[i].name, sources.files[i].text});
  }
  const bool says_all = study.texts.size() == 1 && overrides.empty();
  study.configuration = says_all ? study.texts.front().text : study_text(sources, study.name);
  if (study.grid) study.origins.grid = sources.origin_in_settings("grid", 0);
  for (std::size_t i = 0; i < study.lightings.size(); ++i) {
    study.origins.lightings.push_back(sources.origin_in_settings("lightings", i));
  }
  for (std::size_t i = 0; i < study.comparison_metrics.size(); ++i) {
    study.origins.comparison_metrics.push_back(sources.origin_in_settings("comparison_metrics", i));
  }
}

}  // namespace

Study load_study(const std::filesystem::path& path, std::span<const std::string> overrides) {
  StudySources sources = read_study_sources(path);
  for (const auto& text : overrides) apply_override(sources, text);
  Study study;
  study.name = path.stem().string();
  study.title = study.name;
  study.channels = {"value"};
  study.channel_weights = {1.0};
  study.lightings = {Lighting::point(), Lighting::daylight()};
  read_settings(sources.settings, path.parent_path(), study);
  read_figures(sources, study);
  read_charts(sources, study);
  std::vector<Placed> materials = read_materials(sources, study.channels.size(), path.parent_path());
  if (materials.empty()) {
    if (study.published.empty() && study.charts.empty()) {
      reader::fail(sources.files.back().root,
                   "study has no material; expected at least one [[family]], [[material]], [[measured]], [[published]] "
                   "or [[chart]]");
    }
    require_no_metrics(sources.settings);
    study.lightings.clear();
  }
  require_distinct_names(materials);
  set_materials(study, std::move(materials));
  require_clusters(sources.settings, study);
  set_provenance(sources, overrides, study);
  return study;
}

bool is_study_file(const std::filesystem::path& path) {
  const toml::table root = reader::parse(read_text(path), path);
  // 'family' is also a key of material files, where it is a text.
  return root.contains("study") || root.contains("material") || root.contains("measured") ||
         root.contains("published") || root.contains("chart") || root.contains(kIncludeKey) ||
         root["family"].is_array();
}

Material load_material_file(const std::filesystem::path& path) {
  const toml::table root = reader::parse(read_text(path), path);
  Material material = read_material(root, path.stem().string(), std::nullopt);
  const std::size_t channels = material.channels();
  for (const auto& term : material.terms) {
    if (term.weight.size() != 1 && term.weight.size() != channels) {
      reader::fail(
          reader::place_of(root, "terms"),
          fmt::format("scales have {} and {} values; expected as many for every term", term.weight.size(), channels));
    }
  }
  return material;
}

}  // namespace lobe
