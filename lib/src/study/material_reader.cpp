#include "study/material_reader.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "core/text.hpp"

namespace lobe {
namespace {

namespace reader = toml_reader;

std::string cell_text(const toml::node& cell) {
  if (cell.is_number()) return shortest(*cell.value<double>());
  return cell.value<std::string>().value_or("");
}

}  // namespace

std::vector<TableRow> read_rows(const toml::table& table, const std::vector<std::string>& columns,
                                std::string_view where) {
  const toml::array& rows = reader::array(reader::require(table, "rows", where), "rows");
  if (rows.empty()) reader::fail(rows, "rows is empty; expected at least one row");
  std::vector<TableRow> list;
  for (const auto& entry : rows) {
    const toml::array& cells = reader::array(entry, "a row");
    if (cells.size() != columns.size()) {
      reader::fail(cells, fmt::format("row has {} entries; expected {}, one per column", cells.size(), columns.size()));
    }
    list.push_back({columns, cells});
  }
  return list;
}

LabelTexts label_texts(const TableRow& row) {
  LabelTexts texts;
  for (std::size_t k = 0; k < row.columns.size(); ++k) {
    const toml::node& cell = *row.cells.get(k);
    if (!cell.is_array()) texts.emplace(row.columns[k], cell_text(cell));
  }
  return texts;
}

const toml::node& resolve(const toml::node& node, const TableRow* row) {
  const auto* text = node.as_string();
  if (row == nullptr || text == nullptr || !text->get().starts_with('$')) return node;
  const std::string_view name = std::string_view(text->get()).substr(1);
  const std::vector<std::string_view> known(row->columns.begin(), row->columns.end());
  const auto found = std::find(known.begin(), known.end(), name);
  if (found == known.end()) {
    reader::fail(node, fmt::format("unknown column '{}'{}", name, did_you_mean(name, known)));
  }
  return *row->cells.get(static_cast<std::size_t>(found - known.begin()));
}

const Model& read_model(const toml::table& table, std::string_view where) {
  const toml::node& node = reader::require(table, "model", where);
  const std::string name = reader::text(node, "model");
  return *located(node, [&] { return &find_model(name); });
}

void require_parameters(const toml::table& table, const Model& model, std::span<const std::string_view> own_keys) {
  std::vector<std::string_view> known;
  for (const auto& parameter : model.parameters) known.push_back(parameter.name);
  known.insert(known.end(), own_keys.begin(), own_keys.end());
  for (const auto& [key, node] : table) {
    if (std::find(known.begin(), known.end(), key.str()) == known.end()) {
      reader::fail(key.source(), fmt::format("model '{}' has no parameter '{}'{}", model.name, key.str(),
                                             did_you_mean(key.str(), known)));
    }
  }
}

Term checked_term(const Model& model, const std::vector<std::pair<std::string, double>>& values,
                  const std::map<std::string, const toml::node*>& places, const toml::node& model_place) {
  try {
    return make_material(model.name, values).terms.front();
  } catch (const ArgumentError& error) {
    for (const auto& parameter : model.parameters) {
      const auto value =
          std::find_if(values.begin(), values.end(), [&](const auto& entry) { return entry.first == parameter.name; });
      if (value != values.end() && !(value->second >= parameter.minimum && value->second <= parameter.maximum)) {
        reader::fail(*places.at(value->first), error.what());
      }
    }
    reader::fail(model_place, error.what());
  }
}

std::vector<double> read_weight(const toml::table& table, const TableRow* row, std::optional<std::size_t> channels) {
  std::vector<double> weight = {1.0};
  if (const toml::node* given = table.get("scale")) {
    const toml::node& node = resolve(*given, row);
    weight = node.is_array() ? reader::numbers(node, "scale") : std::vector<double>{reader::number(node, "scale")};
    const bool fits = !node.is_array() || (channels ? weight.size() == *channels : !weight.empty());
    if (!fits) {
      reader::fail(node, fmt::format("scale has {} values; expected one number, or a list of {}", weight.size(),
                                     channels ? fmt::format("{}, one per channel of the study", *channels)
                                              : std::string("one per channel")));
    }
  }
  if (const toml::node* given = table.get("factor")) {
    const double factor = reader::number(resolve(*given, row), "factor");
    for (double& value : weight) value *= factor;
  }
  return weight;
}

Term read_term(const toml::table& table, const TableRow* row, std::optional<std::size_t> channels,
               std::span<const std::string_view> own_keys, std::string_view where) {
  const Model& model = read_model(table, where);
  require_parameters(table, model, own_keys);
  std::vector<std::pair<std::string, double>> values;
  std::map<std::string, const toml::node*> places;
  for (const auto& parameter : model.parameters) {
    const toml::node* given = table.get(parameter.name);
    if (given == nullptr) continue;
    const toml::node& node = resolve(*given, row);
    values.emplace_back(parameter.name, reader::number(node, fmt::format("'{}'", parameter.name)));
    places.emplace(parameter.name, &node);
  }
  Term term = checked_term(model, values, places, *table.get("model"));
  term.weight = read_weight(table, row, channels);
  return term;
}

std::vector<Term> read_terms(const toml::table& table, const TableRow* row, std::optional<std::size_t> channels,
                             std::span<const std::string_view> own_keys, std::string_view where) {
  if (!table.contains("terms")) {
    std::vector<std::string_view> keys(own_keys.begin(), own_keys.end());
    keys.insert(keys.end(), kTermKeys.begin(), kTermKeys.end());
    if (!table.contains("model"))
      reader::fail(table, fmt::format("{} has neither 'model' nor 'terms'; expected one", where));
    return {read_term(table, row, channels, keys, where)};
  }
  std::vector<std::string_view> keys(own_keys.begin(), own_keys.end());
  keys.push_back("terms");
  reader::require_known_keys(table, keys, fmt::format("{} with 'terms'", where));
  const toml::array& list = reader::array(*table.get("terms"), "terms");
  if (list.empty()) reader::fail(list, "terms is empty; expected at least one {model = ...}");
  std::vector<Term> terms;
  for (const auto& entry : list) {
    terms.push_back(read_term(reader::table(entry, "an entry of terms"), row, channels, kTermKeys, "a term"));
  }
  return terms;
}

std::string fill_label(const std::string& label, const LabelTexts& texts, const toml::node& place) {
  std::string filled;
  std::string_view rest = label;
  for (;;) {
    const std::size_t open = rest.find('{');
    filled += rest.substr(0, open);
    if (open == std::string_view::npos) return filled;
    const std::size_t close = rest.find('}', open);
    if (close == std::string_view::npos) reader::fail(place, "label has a '{' without '}'; expected {name}");
    const std::string_view name = rest.substr(open + 1, close - open - 1);
    const auto found = texts.find(name);
    if (found == texts.end()) {
      std::vector<std::string_view> known;
      known.reserve(texts.size());
      for (const auto& entry : texts) known.push_back(entry.first);
      reader::fail(place, fmt::format("unknown name '{{{}}}' in label{}", name, did_you_mean(name, known)));
    }
    filled += found->second;
    rest.remove_prefix(close + 1);
  }
}

}  // namespace lobe
