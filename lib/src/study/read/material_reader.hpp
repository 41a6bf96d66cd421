#pragma once

#include <array>
#include <functional>
#include <map>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "lobe/core/error.hpp"
#include "lobe/model/material.hpp"
#include "lobe/model/model.hpp"
#include "study/read/keys.hpp"
#include "study/read/toml_reader.hpp"

/// Materials in TOML: terms, weights, and rows of tables whose columns they name. Complaints are ArgumentErrors with
/// the place, as those of toml_reader.
namespace lobe {

/// Runs a library call and adds the place to its complaint.
template <typename Call>
auto located(const toml::node& place, const Call& call) {
  try {
    return call();
  } catch (const ArgumentError& error) {
    toml_reader::fail(place, error.what());
  }
}

/// A row of a table: what "$column" stands for.
struct TableRow {
  const std::vector<std::string>& columns;
  const toml::array& cells;
};

/// The rows of a table with the keys `columns` and `rows`, each with a cell per column; at least one.
/// \param columns names of the columns, kept by the rows
/// \param where what the table is, for messages
[[nodiscard]] std::vector<TableRow> read_rows(const toml::table& table, const std::vector<std::string>& columns,
                                              std::string_view where);

/// The node itself, or for a text "$column" the cell of that column.
[[nodiscard]] const toml::node& resolve(const toml::node& node, const TableRow* row);

/// The values that a sweep takes in turn, by the nodes that say so.
using ChosenValues = std::map<const toml::node*, double>;

/// Sources of the entries in a term.
struct Binding {
  const TableRow* row = nullptr;
  const ChosenValues* chosen = nullptr;

  /// The value that a sweep has in this place; none where nothing is swept.
  [[nodiscard]] std::optional<double> value_at(const toml::node& node) const;
  /// That value, or the number that stands there or in the column.
  /// \throws as toml_reader::number().
  [[nodiscard]] double number(const toml::node& node, std::string_view what) const;
};

/// The texts that stand for a row's cells in labels; lists have none.
using LabelTexts = std::map<std::string, std::string, std::less<>>;
[[nodiscard]] LabelTexts label_texts(const TableRow& row);

/// Replaces each {name} of a label by its text.
[[nodiscard]] std::string fill_label(const std::string& label, const LabelTexts& texts, const toml::node& place);

/// The model that the key `model` names: one from the catalogue, or with the key `formula` a written one.
struct TermModel {
  std::string name;
  std::vector<std::string> parameters;
  std::optional<Formula> formula;
};

/// Reads the model, and checks that every key is one of its parameters or one of those that have a meaning in this
/// place. Of a formula every other key is a parameter, and the formula has to use it.
/// \param own_keys keys of the table that are no parameters
[[nodiscard]] TermModel read_model(const toml::table& table, std::span<const std::string_view> own_keys,
                                   std::string_view where);

/// A term of weight 1; a complaint about a value points at that value.
[[nodiscard]] Term checked_term(const TermModel& model, const std::vector<NamedValue>& values,
                                const std::map<std::string, const toml::node*>& places, const toml::node& model_place);

/// The key `factors`: a list of tables {name = ..., parameter = value}. Empty without that key.
[[nodiscard]] std::vector<Factor> read_factors(const toml::table& table, const Binding& binding);

/// The key `scale`: one weight, or one per channel. Beside rows it may be a product of numbers and columns. The key
/// `factor` of older files multiplies it.
/// \param channels how many a list must have; none: any number
[[nodiscard]] std::vector<double> read_weight(const toml::table& table, const Binding& binding,
                                              std::optional<std::size_t> channels);

inline constexpr auto kTermNames = names_of(kTermKeys);

/// Whether a term is a curve by points: model "profile" or "mixture".
[[nodiscard]] bool is_curve(const toml::table& table);

/// A term from a table in which every parameter is a number, a list with one per channel, or a column: several terms
/// where values differ by channel.
/// \param own_keys further keys that stand in the same table and are no parameters
[[nodiscard]] std::vector<Term> read_term(const toml::table& table, const Binding& binding,
                                          std::optional<std::size_t> channels,
                                          std::span<const std::string_view> own_keys, std::string_view where);

/// The key `pumping`, a table {correction = ..., albedos = [[...], ...]} as lobe writes it; none without that key.
[[nodiscard]] std::optional<Pumping> read_pumping(const toml::table& table);

/// The key `adjustments`: a list of names. Empty without that key.
[[nodiscard]] std::vector<Adjustment> read_adjustments(const toml::table& table);

/// The terms of a material: a list under `terms`, or one written into the table itself.
[[nodiscard]] std::vector<Term> read_terms(const toml::table& table, const Binding& binding,
                                           std::optional<std::size_t> channels,
                                           std::span<const std::string_view> own_keys, std::string_view where);

}  // namespace lobe
