#include "study/read/family_reader.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <string_view>
#include <utility>

#include "core/text.hpp"
#include "study/read/keys.hpp"
#include "study/read/material_reader.hpp"
#include "study/read/sweep.hpp"

namespace lobe {
namespace {

namespace reader = toml_reader;

constexpr auto kSweepNames = names_of(kSweepKeys);
constexpr auto kFitNames = names_of(kFitKeys);

/// The numbers of a family that may take several values, in the order in which they vary: term by term parameters of
/// the model, those of its factors, and the scale.
class SweptNumbers {
 public:
  explicit SweptNumbers(const toml::table& family) {
    if (!family.contains("terms")) {
      add_term(family, kSweepNames, "[[family]]", "");
      return;
    }
    const toml::array& terms = reader::array(*family.get("terms"), "terms");
    for (std::size_t i = 0; i < terms.size(); ++i) {
      const toml::table& term = reader::table(*terms.get(i), "an entry of terms");
      add_term(term, {}, "a term", fmt::format("terms.{}.", i));
    }
  }

  [[nodiscard]] const std::vector<Sweep>& sweeps() const { return sweeps_; }

  /// Which numbers a name means: the ones that vary where there are such.
  [[nodiscard]] std::vector<std::size_t> named(std::string_view name) const {
    std::vector<std::size_t> found;
    std::vector<std::size_t> varying;
    for (std::size_t k = 0; k < names_.size(); ++k) {
      if (std::ranges::find(names_[k], name) == names_[k].end()) continue;
      found.push_back(k);
      if (varies(k)) varying.push_back(k);
    }
    return varying.empty() ? found : varying;
  }

  /// Entry of a number in the family.
  [[nodiscard]] const toml::node* node(std::size_t number) const { return nodes_[number]; }

  [[nodiscard]] bool varies(std::size_t number) const { return sweeps_[number].values.size() > 1; }

  /// The shortest name that means this number alone.
  [[nodiscard]] const std::string& name(std::size_t number) const {
    for (const auto& name : names_[number]) {
      if (named(name) == std::vector{number}) return name;
    }
    return names_[number].back();
  }

  /// The names that mean one number, which labels may have.
  [[nodiscard]] LabelTexts texts(const std::vector<std::size_t>& choice) const {
    LabelTexts texts;
    for (std::size_t k = 0; k < names_.size(); ++k) {
      for (const auto& name : names_[k]) {
        if (named(name) == std::vector{k}) texts.emplace(name, sweeps_[k].texts[choice[k]]);
      }
    }
    return texts;
  }

 private:
  void add(const std::string& key, const std::string& owner, const std::string& path, const toml::node& node) {
    sweeps_.push_back(read_sweep(key, node));
    nodes_.push_back(&node);
    names_.push_back({key, owner + "." + key, path + key});
  }

  void add_term(const toml::table& term, std::span<const std::string_view> own_keys, std::string_view where,
                const std::string& path) {
    std::vector<std::string_view> keys(own_keys.begin(), own_keys.end());
    keys.insert(keys.end(), kTermNames.begin(), kTermNames.end());
    const std::string model = reader::text(reader::require(term, "model", where), "model");
    if (!is_curve(term)) {
      for (const auto& parameter : read_model(term, keys, where).parameters) {
        if (const toml::node* node = term.get(parameter)) add(parameter, model, path, *node);
      }
    }
    if (const toml::array* factors = term["factors"].as_array()) add_factors(*factors, path);
    // A list of scales is one per channel.
    const toml::node* scale = term.get("scale");
    if (scale != nullptr && !scale->is_array()) add("scale", model, path, *scale);
  }

  void add_factors(const toml::array& factors, const std::string& path) {
    for (std::size_t i = 0; i < factors.size(); ++i) {
      const toml::table* factor = factors.get(i)->as_table();
      const auto name = factor == nullptr ? std::nullopt : (*factor)["name"].value<std::string>();
      if (!name) continue;  // read_factors() complains
      for (const auto& [key, node] : *factor) {
        if (key.str() != "name") add(std::string(key.str()), *name, fmt::format("{}factors.{}.", path, i), node);
      }
    }
  }

  std::vector<Sweep> sweeps_;
  std::vector<const toml::node*> nodes_;
  std::vector<std::array<std::string, 3>> names_;  ///< "m", "ward.m", "terms.1.m"
};

std::size_t read_zipped(const toml::node& node, const SweptNumbers& numbers) {
  const std::string name = reader::text(node, "an entry of a group of zip");
  const auto found = numbers.named(name);
  if (found.size() == 1) return found.front();
  std::vector<std::string_view> known;
  if (found.empty()) {
    for (std::size_t k = 0; k < numbers.sweeps().size(); ++k) known.push_back(numbers.name(k));
    reader::fail(node, fmt::format("zip has '{}', which the family does not give{}", name, did_you_mean(name, known)));
  }
  for (const std::size_t k : found) known.push_back(numbers.name(k));
  reader::fail(node, fmt::format("zip has '{}', which may be {}; expected one of these", name, fmt::join(known, ", ")));
}

/// The groups of numbers that go together: all of `zip = true`, or those of a list of lists of names.
std::vector<std::vector<std::size_t>> read_zip(const toml::table& table, const SweptNumbers& numbers) {
  const toml::node* node = table.get("zip");
  if (node == nullptr) return {};
  std::vector<std::vector<std::size_t>> groups;
  if (!node->is_array()) {
    if (!node->is_boolean()) {
      reader::fail(*node, fmt::format("zip is {}; expected true, or groups of names, [[\"m\", \"scale\"]]",
                                      reader::kind_of(*node)));
    }
    if (!node->as_boolean()->get() || numbers.sweeps().empty()) return {};
    for (std::size_t k = 0; k < numbers.sweeps().size(); ++k) {
      if (k == 0) groups.emplace_back();
      groups.front().push_back(k);
    }
    return groups;
  }
  std::vector<std::size_t> taken;
  for (const auto& entry : *node->as_array()) {
    if (!entry.is_array()) {
      reader::fail(entry, fmt::format("an entry of zip is {}; expected a group of names, [[\"m\", \"scale\"]]",
                                      reader::kind_of(entry)));
    }
    auto& group = groups.emplace_back();
    for (const auto& name : *entry.as_array()) {
      group.push_back(read_zipped(name, numbers));
      if (std::ranges::find(taken, group.back()) != taken.end()) {
        reader::fail(name, fmt::format("'{}' is in zip twice; expected it once", *name.value<std::string>()));
      }
      taken.push_back(group.back());
    }
    if (group.size() < 2) reader::fail(entry, "a group of zip has less than two names; expected two or more");
  }
  return groups;
}

std::vector<PlacedMaterial> read_sweep_family(const toml::table& table, const std::string& family,
                                              std::size_t channels) {
  if (!table.contains("terms")) (void)reader::require(table, "model", "[[family]]");
  const SweptNumbers numbers(table);
  std::string pattern = "{family}";
  std::vector<std::size_t> varying;
  for (std::size_t k = 0; k < numbers.sweeps().size(); ++k) {
    if (!numbers.varies(k)) continue;
    pattern += fmt::format("{}{}={{{}}}", varying.empty() ? " " : ", ", numbers.name(k), numbers.name(k));
    varying.push_back(k);
  }
  const toml::node* label = table.get("label");
  if (label != nullptr) pattern = reader::text(*label, "label");
  const toml::node& place = label != nullptr ? *label : *table.get("name");
  const std::vector<Adjustment> adjustments = read_adjustments(table);

  std::vector<PlacedMaterial> materials;
  for (const auto& choice : combine(numbers.sweeps(), read_zip(table, numbers), table)) {
    ChosenValues chosen;
    for (std::size_t k = 0; k < choice.size(); ++k) {
      chosen.emplace(numbers.node(k), numbers.sweeps()[k].values[choice[k]]);
    }
    std::vector<std::string> swept;
    for (const std::size_t k : varying) {
      swept.push_back(fmt::format("{}={}", numbers.name(k), shortest(numbers.sweeps()[k].values[choice[k]])));
    }
    LabelTexts texts = numbers.texts(choice);
    texts.insert_or_assign("family", family);
    std::vector<Term> terms = read_terms(table, {.chosen = &chosen}, channels, kSweepNames, "[[family]]");
    materials.push_back({{fill_label(pattern, texts, place), family, std::move(terms), adjustments},
                         &place,
                         &table,
                         fmt::format("{}", fmt::join(swept, ", "))});
  }
  return materials;
}

std::vector<PlacedMaterial> read_table_family(const toml::table& table, const std::string& family,
                                              std::size_t channels) {
  const toml::node& columns_node = reader::require(table, "columns", "[[family]] with 'rows'");
  const std::vector<std::string> columns = reader::texts(columns_node, "columns");
  const auto name = std::find(columns.begin(), columns.end(), "name");
  if (name == columns.end()) reader::fail(columns_node, "columns has no \"name\"; expected one");
  const toml::node* label = table.get("label");
  const std::string pattern = label != nullptr ? reader::text(*label, "label") : "{family} {name}";

  const std::vector<Adjustment> adjustments = read_adjustments(table);
  std::vector<PlacedMaterial> materials;
  for (const TableRow& row : read_rows(table, columns, "[[family]] with 'columns'")) {
    (void)reader::text(*row.cells.get(static_cast<std::size_t>(name - columns.begin())), "name");
    LabelTexts texts = label_texts(row);
    texts.insert_or_assign("family", family);
    std::vector<Term> terms = read_terms(table, {.row = &row}, channels, kFitNames, "[[family]]");
    const toml::node& place = label != nullptr ? *label : row.cells;
    materials.push_back(
        {{fill_label(pattern, texts, place), family, std::move(terms), adjustments}, &row.cells, &row.cells, {}});
  }
  return materials;
}

}  // namespace

std::vector<PlacedMaterial> read_family(const toml::table& table, std::size_t channels) {
  const std::string family = reader::text(reader::require(table, "name", "[[family]]"), "name");
  if (table.contains("rows") || table.contains("columns")) return read_table_family(table, family, channels);
  return read_sweep_family(table, family, channels);
}

}  // namespace lobe
