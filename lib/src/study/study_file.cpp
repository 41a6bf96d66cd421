#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <map>
#include <optional>
#include <tuple>

#include "core/files.hpp"
#include "core/text.hpp"
#include "lobe/error.hpp"
#include "lobe/study.hpp"
#include "model/terms.hpp"
#include "study/analysis_keys.hpp"
#include "study/chart_reader.hpp"
#include "study/keys.hpp"
#include "study/material_reader.hpp"
#include "study/measured_reader.hpp"
#include "study/published_reader.hpp"
#include "study/sweep.hpp"
#include "study/toml_reader.hpp"

namespace lobe {
namespace {

namespace reader = toml_reader;

/// A material and the place that its name comes from.
struct Placed {
  Material material;
  const toml::node* place = nullptr;
  std::optional<MaterialFile> file = {};
};

std::vector<Placed> read_sweep_family(const toml::table& table, const std::string& family, std::size_t channels) {
  static constexpr auto kKeys = names_of(kSweepKeys);
  const TermModel model = read_model(table, kKeys, "[[family]]");
  std::vector<Sweep> sweeps;
  std::map<std::string, const toml::node*> places;
  for (const auto& parameter : model.parameters) {
    if (const toml::node* node = table.get(parameter)) {
      sweeps.push_back(read_sweep(parameter, *node));
      places.emplace(parameter, node);
    }
  }
  const toml::node* zip = table.get("zip");
  const toml::node* label = table.get("label");
  std::string pattern = "{family}";
  for (const auto& sweep : sweeps) {
    if (sweep.values.size() > 1)
      pattern += fmt::format("{}{}={{{}}}", pattern == "{family}" ? " " : ", ", sweep.parameter, sweep.parameter);
  }
  if (label != nullptr) pattern = reader::text(*label, "label");
  const std::vector<double> weight = read_weight(table, nullptr, channels);
  const std::vector<Factor> factors = read_factors(table, nullptr);
  const std::vector<Adjustment> adjustments = read_adjustments(table);

  std::vector<Placed> materials;
  for (const auto& choice : combine(sweeps, zip != nullptr && reader::truth(*zip, "zip"), table)) {
    std::vector<NamedValue> values;
    LabelTexts texts = {{"family", family}};
    for (std::size_t k = 0; k < sweeps.size(); ++k) {
      values.emplace_back(sweeps[k].parameter, sweeps[k].values[choice[k]]);
      texts.emplace(sweeps[k].parameter, sweeps[k].texts[choice[k]]);
    }
    Term term = checked_term(model, values, places, *table.get("model"));
    term.weight = weight;
    term.factors = factors;
    const toml::node& place = label != nullptr ? *label : *table.get("name");
    materials.push_back({{fill_label(pattern, texts, place), family, {std::move(term)}, adjustments}, &place});
  }
  return materials;
}

std::vector<Placed> read_table_family(const toml::table& table, const std::string& family, std::size_t channels) {
  static constexpr auto kKeys = names_of(kFitKeys);
  const toml::node& columns_node = reader::require(table, "columns", "[[family]] with 'rows'");
  const std::vector<std::string> columns = reader::texts(columns_node, "columns");
  const auto name = std::find(columns.begin(), columns.end(), "name");
  if (name == columns.end()) reader::fail(columns_node, "columns has no \"name\"; expected one");
  const toml::node* label = table.get("label");
  const std::string pattern = label != nullptr ? reader::text(*label, "label") : "{family} {name}";

  const std::vector<Adjustment> adjustments = read_adjustments(table);
  std::vector<Placed> materials;
  for (const TableRow& row : read_rows(table, columns, "[[family]] with 'columns'")) {
    (void)reader::text(*row.cells.get(static_cast<std::size_t>(name - columns.begin())), "name");
    LabelTexts texts = label_texts(row);
    texts.insert_or_assign("family", family);
    std::vector<Term> terms = read_terms(table, &row, channels, kKeys, "[[family]]");
    const toml::node& place = label != nullptr ? *label : row.cells;
    materials.push_back({{fill_label(pattern, texts, place), family, std::move(terms), adjustments}, &row.cells});
  }
  return materials;
}

std::vector<Placed> read_family(const toml::table& table, std::size_t channels) {
  const std::string family = reader::text(reader::require(table, "name", "[[family]]"), "name");
  if (table.contains("rows") || table.contains("columns")) return read_table_family(table, family, channels);
  if (table.contains("terms")) {
    reader::fail(reader::place_of(table, "terms"),
                 "[[family]] has 'terms' but no 'columns' and 'rows'; expected those, or 'model' instead of 'terms'");
  }
  return read_sweep_family(table, family, channels);
}

Material read_material(const toml::table& table, const std::string& default_name, std::optional<std::size_t> channels) {
  static constexpr auto kKeys = names_of(kMaterialKeys);
  Material material;
  const toml::node* name = table.get("name");
  if (name == nullptr && default_name.empty()) (void)reader::require(table, "name", "[[material]]");
  material.name = name != nullptr ? reader::text(*name, "name") : default_name;
  material.terms = read_terms(table, nullptr, channels, kKeys, "[[material]]");
  material.adjustments = read_adjustments(table);
  const toml::node* family = table.get("family");
  material.family = family != nullptr ? reader::text(*family, "family") : family_of(material.terms);
  return material;
}

std::vector<Lighting> read_lightings(const toml::node& node) {
  std::vector<Lighting> lightings;
  for (const auto& entry : reader::array(node, "lightings")) {
    const std::string name = reader::text(entry, "an entry of lightings");
    const Lighting lighting = located(entry, [&] { return parse_lighting(name); });
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

/// The name becomes part of file names.
std::string read_study_name(const toml::node& node) {
  std::string name = reader::text(node, "name");
  const auto is_control = [](char c) { return static_cast<unsigned char>(c) < 0x20 || c == 0x7f; };
  if (name.find('/') != std::string::npos || name.starts_with('.') || name.starts_with('-') ||
      std::any_of(name.begin(), name.end(), is_control)) {
    reader::fail(
        node,
        fmt::format("name '{}' is no stem of file names; expected no '/', and neither '.' nor '-' in front", name));
  }
  return name;
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

void read_study_table(const toml::table& table, Study& study) {
  reader::require_known_keys(table, names_of(kStudyKeys), "[study]");
  if (const toml::node* node = table.get("name")) study.name = read_study_name(*node);
  study.title = study.name;
  if (const toml::node* node = table.get("title")) study.title = reader::text(*node, "title");
  if (const toml::node* node = table.get("comment")) study.comment = reader::text(*node, "comment");
  if (const toml::node* node = table.get("references")) study.references = reader::texts(*node, "references");
  read_channels(table, study);
  if (const toml::node* node = table.get("lightings")) study.lightings = read_lightings(*node);
  study.tolerance = reader::tolerance(table, "tolerance").value_or(study.tolerance);
  study.patch_tolerance = reader::tolerance(table, "patch_tolerance").value_or(study.patch_tolerance);
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
void require_clusters(const toml::table& root, const Study& study) {
  if (study.clustering.clusters <= study.materials.size()) return;
  reader::fail(*root["study"]["clusters"].node(),
               fmt::format("clusters is {}; expected at most {}, the number of materials", study.clustering.clusters,
                           study.materials.size()));
}

/// The tables of [[key]], in file order.
std::vector<const toml::table*> tables_of(const toml::table& root, std::string_view key) {
  std::vector<const toml::table*> tables;
  const toml::node* node = root.get(key);
  if (node == nullptr) return tables;
  if (!node->is_array() || !node->is_array_of_tables()) {
    reader::fail(*node, fmt::format("'{0}' is {1}; expected tables headed [[{0}]]", key, reader::kind_of(*node)));
  }
  for (const auto& entry : *node->as_array()) tables.push_back(entry.as_table());
  return tables;
}

std::vector<Placed> read_materials(const toml::table& root, std::size_t channels,
                                   const std::filesystem::path& directory) {
  enum class Kind { family, material, measured };
  struct Entry {
    const toml::table* table;
    Kind kind;
  };
  std::vector<Entry> entries;
  for (const auto* table : tables_of(root, "family")) entries.push_back({table, Kind::family});
  for (const auto* table : tables_of(root, "material")) entries.push_back({table, Kind::material});
  for (const auto* table : tables_of(root, "measured")) entries.push_back({table, Kind::measured});
  std::sort(entries.begin(), entries.end(), [](const Entry& a, const Entry& b) {
    const auto& first = a.table->source().begin;
    const auto& second = b.table->source().begin;
    return std::tie(first.line, first.column) < std::tie(second.line, second.column);
  });
  std::vector<Placed> materials;
  for (const auto& [table, kind] : entries) {
    if (kind == Kind::family) {
      for (auto& placed : read_family(*table, channels)) materials.push_back(std::move(placed));
    } else if (kind == Kind::measured) {
      for (auto& [name, family, file, place] : read_measured_table(*table, directory)) {
        materials.push_back({{name, family, {}, {}}, place, std::move(file)});
      }
    } else {
      Material material = read_material(*table, {}, channels);
      materials.push_back({std::move(material), table->get("name")});
    }
  }
  return materials;
}

void require_distinct_names(const std::vector<Placed>& materials) {
  std::map<std::string_view, const toml::node*> seen;
  for (const auto& [material, place, file] : materials) {
    const auto [first, is_new] = seen.emplace(material.name, place);
    if (!is_new) {
      reader::fail(*place, fmt::format("material '{}' exists already, from line {}; expected distinct names",
                                       material.name, first->second->source().begin.line));
    }
  }
}

std::vector<Chart> read_charts(const toml::table& root) {
  std::vector<Chart> charts;
  for (const auto* table : tables_of(root, "chart")) {
    Chart chart = read_chart(*table);
    if (std::ranges::find(charts, chart.name, &Chart::name) != charts.end()) {
      reader::fail(*table->get("name"), fmt::format("chart '{}' exists already; expected distinct names", chart.name));
    }
    charts.push_back(std::move(chart));
  }
  return charts;
}

/// What is computed of materials needs some.
void require_no_metrics(const toml::table& root) {
  const toml::table* study = root["study"].as_table();
  if (study == nullptr) return;
  for (const char* key : {"lightings", "comparison_metrics", "approximations", "clusters", "neighbours"}) {
    if (!study->contains(key)) continue;
    reader::fail(
        reader::place_of(*study, key),
        fmt::format(
            "{} is given but the study has no material; expected at least one [[family]], [[material]] or [[measured]]",
            key));
  }
}

/// Materials of a family stand together, families in order of their first material.
void set_materials(Study& study, std::vector<Placed> materials) {
  std::map<std::string, std::size_t> rank;
  for (const auto& placed : materials) rank.emplace(placed.material.family, rank.size());
  std::stable_sort(materials.begin(), materials.end(), [&](const Placed& a, const Placed& b) {
    return rank.at(a.material.family) < rank.at(b.material.family);
  });
  const bool has_files = std::ranges::any_of(materials, [](const Placed& placed) { return placed.file.has_value(); });
  for (auto& placed : materials) {
    study.materials.push_back(std::move(placed.material));
    if (has_files) study.files.push_back(std::move(placed.file));
  }
}

}  // namespace

Study load_study(const std::filesystem::path& path) {
  Study study;
  study.configuration = read_text(path);
  study.name = path.stem().string();
  study.title = study.name;
  study.channels = {"value"};
  study.channel_weights = {1.0};
  study.lightings = {Lighting::point(), Lighting::daylight()};
  const toml::table root = reader::parse(study.configuration, path);
  reader::require_known_keys(root, names_of(kFileKeys), "a study file");
  if (const toml::node* node = root.get("study")) read_study_table(reader::table(*node, "'study'"), study);
  for (const auto* table : tables_of(root, "published")) {
    for (auto& figure : read_published(*table)) study.published.push_back(std::move(figure));
  }
  study.charts = read_charts(root);
  std::vector<Placed> materials = read_materials(root, study.channels.size(), path.parent_path());
  if (materials.empty()) {
    if (study.published.empty() && study.charts.empty()) {
      reader::fail(root,
                   "study has no material; expected at least one [[family]], [[material]], [[measured]], [[published]] "
                   "or [[chart]]");
    }
    require_no_metrics(root);
    study.lightings.clear();
  }
  require_distinct_names(materials);
  set_materials(study, std::move(materials));
  require_clusters(root, study);
  return study;
}

bool is_study_file(const std::filesystem::path& path) {
  const toml::table root = reader::parse(read_text(path), path);
  // 'family' is also a key of material files, where it is a text.
  return root.contains("study") || root.contains("material") || root.contains("measured") ||
         root.contains("published") || root.contains("chart") || root["family"].is_array();
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
