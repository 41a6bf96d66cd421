#include "study/read/material_reader.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "core/text.hpp"
#include "lobe/model/profile.hpp"
#include "model/factors.hpp"
#include "model/formula.hpp"
#include "model/terms.hpp"

namespace lobe {
namespace {

namespace reader = toml_reader;

/// Names of patch-based models given by curves.
constexpr std::string_view kProfile = "profile";
constexpr std::string_view kMixture = "mixture";

std::string cell_text(const toml::node& cell) {
  if (cell.is_number()) return shortest(*cell.value<double>());
  reader::require_one_line(cell, "an entry of a row");
  return cell.value<std::string>().value_or("");
}

/// \param channels how many there must be; none: any number but 0
/// \param remark what else the writer may have meant
void require_channels(const toml::node& node, std::string_view what, std::size_t count,
                      std::optional<std::size_t> channels, std::string_view remark = {}) {
  if (channels ? count == *channels : count > 0) return;
  const std::string expected = channels ? fmt::format("{}, one per channel", *channels) : "one per channel";
  reader::fail(node,
               fmt::format("{} has {} values; expected one number, or a list of {}{}", what, count, expected, remark));
}

/// Where the text of a TOML string begins in its file. A backslash at the end of a line, which TOML takes away with the
/// line break, is not found.
void place_formula(const toml::node& node, Formula& formula) {
  constexpr unsigned kLongQuotes = 3;
  const toml::source_region& region = node.source();
  const auto lines = static_cast<std::size_t>(std::ranges::count(formula.text, '\n'));
  // A newline right after three quotes is not in the text.
  const bool begins_below = region.end.line > region.begin.line + lines;
  const bool has_long_quotes = lines > 0 || region.end.line > region.begin.line ||
                               region.end.column >= region.begin.column + formula.text.size() + 2 * kLongQuotes;
  formula.file = region.path ? *region.path : std::string();
  if (formula.file.starts_with(reader::kOverride)) return;  // places are those in the formula
  formula.line = region.begin.line + (begins_below ? 1 : 0);
  formula.column = begins_below ? 1 : region.begin.column + (has_long_quotes ? kLongQuotes : 1);
}

void read_formula(const toml::table& table, std::span<const std::string_view> own_keys, TermModel& model) {
  constexpr auto kKeys = names_of(kFormulaKeys);
  const toml::node& node = reader::require(table, "formula", "model \"custom\"");
  Formula formula;
  formula.text = reader::long_text(node, "formula");
  place_formula(node, formula);
  if (const toml::node* width = table.get("width")) formula.width = reader::number(*width, "width");
  if (const toml::node* given = table.get("reciprocal")) formula.reciprocal = reader::truth(*given, "reciprocal");
  const auto is_own = [&](std::string_view key) {
    return std::ranges::find(own_keys, key) != own_keys.end() || std::ranges::find(kKeys, key) != kKeys.end();
  };
  for (const auto& [key, value] : table) {
    if (!is_own(key.str())) formula.parameters.emplace_back(key.str());
  }
  try {
    require_valid(formula);
  } catch (const ArgumentError& error) {
    // Mistakes in the text have their places already.
    if (std::string_view(error.what()).starts_with(printable(formula.file) + ":")) throw;
    reader::fail(node, error.what());
  }
  model.parameters = formula.parameters;
  model.formula = std::move(formula);
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

namespace {

/// The cell of a column by its name.
const toml::node& cell_of(const toml::node& place, std::string_view name, const TableRow& row) {
  const std::vector<std::string_view> known(row.columns.begin(), row.columns.end());
  const auto found = std::find(known.begin(), known.end(), name);
  if (found == known.end()) {
    reader::fail(place, fmt::format("unknown column '{}'{}", name, did_you_mean(name, known)));
  }
  return *row.cells.get(static_cast<std::size_t>(found - known.begin()));
}

}  // namespace

const toml::node& resolve(const toml::node& node, const TableRow* row) {
  const auto* text = node.as_string();
  if (row == nullptr || text == nullptr || !text->get().starts_with('$')) return node;
  return cell_of(node, std::string_view(text->get()).substr(1), *row);
}

std::optional<double> Binding::value_at(const toml::node& node) const {
  if (chosen == nullptr) return std::nullopt;
  const auto found = chosen->find(&node);
  return found == chosen->end() ? std::nullopt : std::optional(found->second);
}

double Binding::number(const toml::node& node, std::string_view what) const {
  const auto value = value_at(node);
  return value ? *value : reader::number(resolve(node, row), what);
}

TermModel read_model(const toml::table& table, std::span<const std::string_view> own_keys, std::string_view where) {
  const toml::node& node = reader::require(table, "model", where);
  TermModel model{reader::text(node, "model"), {}, std::nullopt};
  if (model.name == kCustomModel) {
    read_formula(table, own_keys, model);
    return model;
  }
  const Model& found = *located(node, [&] { return &find_model(model.name); });
  for (const auto& parameter : found.parameters) model.parameters.emplace_back(parameter.name);
  std::vector<std::string_view> known(model.parameters.begin(), model.parameters.end());
  known.insert(known.end(), own_keys.begin(), own_keys.end());
  for (const auto& [key, value] : table) {
    if (std::find(known.begin(), known.end(), key.str()) == known.end()) {
      reader::fail(key.source(), fmt::format("model '{}' has no parameter '{}'{}", model.name, key.str(),
                                             did_you_mean(key.str(), known)));
    }
  }
  return model;
}

Term checked_term(const TermModel& model, const std::vector<NamedValue>& values,
                  const std::map<std::string, const toml::node*>& places, const toml::node& model_place) {
  if (model.formula) {
    std::vector<double> numbers;
    for (const auto& [name, value] : values) numbers.push_back(value);
    return located(model_place, [&] { return make_custom_term(*model.formula, numbers); });
  }
  const Model& found = find_model(model.name);
  try {
    return make_material(model.name, values).terms.front();
  } catch (const ArgumentError& error) {
    for (const auto& parameter : found.parameters) {
      const auto value =
          std::find_if(values.begin(), values.end(), [&](const auto& entry) { return entry.first == parameter.name; });
      if (value != values.end() && !(value->second >= parameter.minimum && value->second <= parameter.maximum)) {
        reader::fail(*places.at(value->first), error.what());
      }
    }
    reader::fail(model_place, error.what());
  }
}

std::vector<Factor> read_factors(const toml::table& table, const Binding& binding) {
  std::vector<Factor> factors;
  const toml::node* node = table.get("factors");
  if (node == nullptr) return factors;
  for (const auto& entry : reader::array(*node, "factors")) {
    const toml::table& given = reader::table(entry, "an entry of factors");
    const toml::node& name = reader::require(given, "name", "an entry of factors");
    std::vector<NamedValue> values;
    for (const auto& [key, value] : given) {
      if (key.str() == "name") continue;
      values.emplace_back(std::string(key.str()), binding.number(value, fmt::format("'{}'", key.str())));
    }
    factors.push_back(located(entry, [&] { return make_factor(reader::text(name, "name"), values); }));
  }
  if (factors.size() > kMaxFactors) {
    reader::fail(*node, fmt::format("factors has {} entries; expected at most {}", factors.size(), kMaxFactors));
  }
  return factors;
}

std::optional<Pumping> read_pumping(const toml::table& table) {
  const toml::node* node = table.get("pumping");
  if (node == nullptr) return std::nullopt;
  const toml::table& given = reader::table(*node, "pumping");
  reader::require_known_keys(given, names_of(kPumpingKeys), "pumping");
  const std::string correction = reader::text(reader::require(given, "correction", "pumping"), "correction");
  std::vector<std::vector<double>> albedos;
  for (const auto& curve : reader::array(reader::require(given, "albedos", "pumping"), "albedos")) {
    albedos.push_back(reader::numbers(curve, "an entry of albedos"));
  }
  return located(*node, [&] { return make_pumping(correction, std::move(albedos)); });
}

std::vector<Adjustment> read_adjustments(const toml::table& table) {
  std::vector<Adjustment> adjustments;
  const toml::node* node = table.get("adjustments");
  if (node == nullptr) return adjustments;
  for (const auto& entry : reader::array(*node, "adjustments")) {
    const std::string name = reader::text(entry, "an entry of adjustments");
    adjustments.push_back(located(entry, [&] { return parse_adjustment(name); }));
  }
  return adjustments;
}

namespace {

/// A number for all channels, or one for each.
std::vector<double> read_scale(const toml::node& node, std::optional<std::size_t> channels) {
  if (!node.is_array()) return {reader::number(node, "scale")};
  std::vector<double> scale = reader::numbers(node, "scale");
  require_channels(node, "scale", scale.size(), channels);
  return scale;
}

/// Multiplies by a scale; a single number counts for all channels.
void multiply(std::vector<double>& weight, const std::vector<double>& scale) {
  if (weight.size() == 1) weight.resize(scale.size(), weight.front());
  for (std::size_t c = 0; c < weight.size(); ++c) weight[c] *= scale[scale.size() == 1 ? 0 : c];
}

/// Whether a scale is a product of numbers and columns, "1.27 * $ks".
bool is_product(const toml::node& node, const TableRow* row) {
  const auto* text = node.as_string();
  return row != nullptr && text != nullptr && text->get().find('*') != std::string::npos;
}

std::vector<double> read_product(const toml::node& node, const TableRow& row, std::optional<std::size_t> channels) {
  std::vector<double> weight = {1};
  for (const std::string_view part : split(node.as_string()->get(), '*')) {
    const std::string_view word = trim(part);
    double number = 0;
    if (word.starts_with('$')) {
      const std::vector<double> scale = read_scale(cell_of(node, word.substr(1), row), channels);
      if (weight.size() > 1 && scale.size() > 1 && weight.size() != scale.size()) {
        reader::fail(node, fmt::format("scale multiplies lists of {} and {} values; expected as many", weight.size(),
                                       scale.size()));
      }
      multiply(weight, scale);
    } else if (parse_number(word, number)) {
      multiply(weight, {number});
    } else {
      reader::fail(node, fmt::format("scale has '{}'; expected a product of numbers and columns, such as 0.5 * $ks",
                                     printable(std::string(word))));
    }
  }
  return weight;
}

}  // namespace

std::vector<double> read_weight(const toml::table& table, const Binding& binding, std::optional<std::size_t> channels) {
  std::vector<double> weight = {1.0};
  if (const toml::node* given = table.get("scale")) {
    if (const auto value = binding.value_at(*given)) {
      weight = {*value};
    } else if (is_product(*given, binding.row)) {
      weight = read_product(*given, *binding.row, channels);
    } else {
      weight = read_scale(resolve(*given, binding.row), channels);
    }
  }
  if (const toml::node* given = table.get("factor")) {
    multiply(weight, {binding.number(*given, "factor (which is part of 'scale' now)")});
  }
  return weight;
}

bool is_curve(const toml::table& table) {
  const auto name = table["model"].value<std::string_view>();
  return name == kProfile || name == kMixture;
}

namespace {

std::vector<CurvePoint> read_points(const toml::node& node) {
  std::vector<CurvePoint> points;
  for (const auto& entry : reader::array(node, "points")) {
    const auto pair = reader::numbers(entry, "a point");
    if (pair.size() != 2) {
      reader::fail(entry, fmt::format("a point has {} numbers; expected two, [distance, value]", pair.size()));
    }
    points.push_back({pair[0], pair[1]});
  }
  return points;
}

/// Terms of a model whose parameters are the points of a curve.
std::vector<Term> read_curve_terms(const toml::table& table, std::span<const std::string_view> own_keys) {
  const std::string name = *table.get("model")->value<std::string>();
  std::vector<std::string_view> known(own_keys.begin(), own_keys.end());
  known.emplace_back("points");
  const std::string what = fmt::format("model '{}'", name);
  reader::require_known_keys(table, known, what);
  const toml::node& node = reader::require(table, "points", what);
  const auto points = read_points(node);
  return located(node, [&] { return name == kProfile ? make_profile(points) : make_mixture(points); });
}

/// Terms of weight 1.
std::vector<Term> read_models(const toml::table& table, const Binding& binding, std::optional<std::size_t> channels,
                              std::span<const std::string_view> own_keys, std::string_view where) {
  constexpr std::string_view kSweep = " (a [[family]] sweeps)";
  const TermModel model = read_model(table, own_keys, where);
  std::vector<std::pair<std::string, std::vector<double>>> values;
  std::map<std::string, const toml::node*> places;
  std::size_t count = 1;
  for (const auto& parameter : model.parameters) {
    const toml::node* given = table.get(parameter);
    if (given == nullptr) continue;
    const toml::node& node = resolve(*given, binding.row);
    places.emplace(parameter, &node);
    const std::string what = fmt::format("'{}'", parameter);
    if (const auto value = binding.value_at(*given)) {
      values.emplace_back(parameter, std::vector{*value});
      continue;
    }
    values.emplace_back(parameter,
                        node.is_array() ? reader::numbers(node, what) : std::vector{reader::number(node, what)});
    const std::size_t size = values.back().second.size();
    if (node.is_array()) require_channels(node, what, size, count > 1 ? count : channels, kSweep);
    count = std::max(count, size);
  }
  std::vector<Term> terms;
  for (std::size_t c = 0; c < count; ++c) {
    std::vector<NamedValue> of_channel;
    for (const auto& [name, list] : values) of_channel.emplace_back(name, list[list.size() == 1 ? 0 : c]);
    terms.push_back(checked_term(model, of_channel, places, *table.get("model")));
  }
  return split_by_channel(std::move(terms));
}

}  // namespace

std::vector<Term> read_term(const toml::table& table, const Binding& binding, std::optional<std::size_t> channels,
                            std::span<const std::string_view> own_keys, std::string_view where) {
  std::vector<Term> terms =
      is_curve(table) ? read_curve_terms(table, own_keys) : read_models(table, binding, channels, own_keys, where);
  const std::vector<double> weight = read_weight(table, binding, channels);
  located(table, [&] { apply_weight(terms, weight); });
  for (Term& term : terms) {
    term.factors = read_factors(table, binding);
    term.pumping = read_pumping(table);
  }
  return terms;
}

std::vector<Term> read_terms(const toml::table& table, const Binding& binding, std::optional<std::size_t> channels,
                             std::span<const std::string_view> own_keys, std::string_view where) {
  if (!table.contains("terms")) {
    std::vector<std::string_view> keys(own_keys.begin(), own_keys.end());
    keys.insert(keys.end(), kTermNames.begin(), kTermNames.end());
    if (!table.contains("model"))
      reader::fail(table, fmt::format("{} has neither 'model' nor 'terms'; expected one", where));
    return read_term(table, binding, channels, keys, where);
  }
  std::vector<std::string_view> keys(own_keys.begin(), own_keys.end());
  keys.push_back("terms");
  reader::require_known_keys(table, keys, fmt::format("{} with 'terms'", where));
  const toml::array& list = reader::array(*table.get("terms"), "terms");
  if (list.empty()) reader::fail(list, "terms is empty; expected at least one {model = ...}");
  std::vector<Term> terms;
  for (const auto& entry : list) {
    for (Term& term : read_term(reader::table(entry, "an entry of terms"), binding, channels, kTermNames, "a term")) {
      terms.push_back(std::move(term));
    }
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
