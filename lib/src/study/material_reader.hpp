#pragma once

#include <array>
#include <functional>
#include <map>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "lobe/error.hpp"
#include "lobe/material.hpp"
#include "lobe/model.hpp"
#include "study/toml_reader.hpp"

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

/// The texts that stand for a row's cells in labels; lists have none.
using LabelTexts = std::map<std::string, std::string, std::less<>>;
[[nodiscard]] LabelTexts label_texts(const TableRow& row);

/// Replaces each {name} of a label by its text.
[[nodiscard]] std::string fill_label(const std::string& label, const LabelTexts& texts, const toml::node& place);

/// The model that the key `model` names.
[[nodiscard]] const Model& read_model(const toml::table& table, std::string_view where);

/// Checks that every key is a parameter of the model or one of those that have a meaning in this place.
void require_parameters(const toml::table& table, const Model& model, std::span<const std::string_view> own_keys);

/// A term of weight 1; a complaint about a value points at that value.
[[nodiscard]] Term checked_term(const Model& model, const std::vector<std::pair<std::string, double>>& values,
                                const std::map<std::string, const toml::node*>& places, const toml::node& model_place);

/// scale times factor: one weight, or one per channel.
/// \param channels how many a list must have; none: any number
[[nodiscard]] std::vector<double> read_weight(const toml::table& table, const TableRow* row,
                                              std::optional<std::size_t> channels);

inline constexpr std::array<std::string_view, 3> kTermKeys = {"model", "scale", "factor"};

/// A term from a table in which every parameter is a single number or a column.
/// \param own_keys further keys that stand in the same table and are no parameters
[[nodiscard]] Term read_term(const toml::table& table, const TableRow* row, std::optional<std::size_t> channels,
                             std::span<const std::string_view> own_keys, std::string_view where);

/// The terms of a material: a list under `terms`, or one written into the table itself.
[[nodiscard]] std::vector<Term> read_terms(const toml::table& table, const TableRow* row,
                                           std::optional<std::size_t> channels,
                                           std::span<const std::string_view> own_keys, std::string_view where);

}  // namespace lobe
