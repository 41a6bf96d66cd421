#include "lobe/study/study_schema.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <initializer_list>
#include <map>
#include <nlohmann/json.hpp>
#include <span>
#include <string_view>
#include <vector>

#include "core/text.hpp"
#include "lobe/compare/literature_metric.hpp"
#include "lobe/core/written_form.hpp"
#include "lobe/model/material.hpp"
#include "lobe/model/model.hpp"
#include "lobe/study/chart.hpp"
#include "lobe/study/published.hpp"
#include "lobe/study/study.hpp"
#include "model/factors.hpp"
#include "study/read/keys.hpp"
#include "study/read/material_reader.hpp"
#include "study/read/sweep.hpp"
#include "study/read/toml_reader.hpp"

namespace lobe {
namespace {

using Json = nlohmann::ordered_json;
using Names = std::vector<std::string_view>;

constexpr const char* kColumn = "^\\$.";
constexpr const char* kProduct = "^\\$.|\\*";  // "$ks", "1.27 * $ks"
constexpr std::string_view kNumber = "(\\d+\\.?\\d*|\\.\\d+)([eE][-+]?\\d+)?";

/// Where values stand, and so how they may be written.
enum class Place {
  plain,   ///< a number, or one per channel
  rows,    ///< also a column "$name"
  family,  ///< also the values of a sweep
};

Json reference(std::string_view definition) {
  return {{"$ref", fmt::format("#/definitions/{}", definition)}};
}

Json one_of(std::span<const std::string_view> names) {
  return {{"enum", Names(names.begin(), names.end())}};
}

Json text() {
  return {{"type", "string"}, {"pattern", "\\S"}};
}

Json text_like(std::string pattern) {
  return {{"type", "string"}, {"pattern", std::move(pattern)}};
}

Json number(double minimum, double maximum) {
  return {{"type", "number"}, {"minimum", minimum}, {"maximum", maximum}};
}

Json list_of(Json items, std::size_t least = 0) {
  Json list{{"type", "array"}, {"items", std::move(items)}};
  if (least > 0) list["minItems"] = least;
  return list;
}

Json distinct(Json list) {
  list["uniqueItems"] = true;
  return list;
}

Json pair_of_numbers() {
  return {{"type", "array"}, {"items", {{"type", "number"}}}, {"minItems", 2}, {"maxItems", 2}};
}

/// Values of one kind or another; a kind says nothing of values of the other.
Json either(Json one, Json other) {
  return {{"anyOf", {std::move(one), std::move(other)}}};
}

/// Also a column of a table.
Json or_column(Json value, Place place) {
  return place == Place::rows ? either(std::move(value), text_like(kColumn)) : value;
}

/// A number, and what else may stand in its place. Words on numbers do not concern other kinds of values.
/// \param by_channel whether lists are numbers of channels; in families they are sweeps
Json number_at(Place place, bool by_channel) {
  const bool may_be_list = by_channel || place == Place::family;
  Json types = Json::array({"number"});
  if (may_be_list) types.push_back("array");
  if (place == Place::rows) types.push_back("string");
  if (place == Place::family) types.push_back("object");
  Json value{{"type", std::move(types)}};
  if (may_be_list) {
    value["items"] = {{"type", "number"}};
    value["minItems"] = 1;
  }
  if (place == Place::rows) value["pattern"] = kColumn;
  if (place == Place::family) value["allOf"] = Json::array({reference("range")});
  return value;
}

/// Pattern for forms such as "patch:R", where R stands for a number. Materials have a grammar of their own.
std::string pattern_of(const WrittenForm& form) {
  if (form.word == "material") return "^material:[^\\s].*$";
  const auto values = form.written.substr(form.word.size());
  const std::string pair = fmt::format("{0}={0}", kNumber);
  if (values.find('=') == std::string_view::npos) return fmt::format("^{}:{}$", form.word, kNumber);
  return fmt::format("^{}:{}(,{})*$", form.word, pair, pair);
}

Json lighting() {
  Json forms = Json::array();
  for (const WrittenForm& form : lighting_forms()) {
    if (form.word == "table") continue;  // on command lines only
    Json value = form.word == form.written ? one_of({&form.word, 1}) : text_like(pattern_of(form));
    value["description"] = fmt::format("{}: {}", form.written, form.meaning);
    forms.push_back(std::move(value));
  }
  return {{"anyOf", std::move(forms)}};
}

Json grid() {
  Json value = text_like("^(((gauss|uniform|cells):)?\\d+x\\d*[02468]|shirley-chiu:\\d+|klems:(145|77|73|41))$");
  value["examples"] = Json::array();
  for (const WrittenForm& form : grid_forms()) value["examples"].push_back(form.written);
  return value;
}

constexpr std::array<std::string_view, 5> kCorrections{"g1", "g2", "controlled", "complement", "viewer"};

Json adjustment() {
  const std::string pump = "(correction=(g1|g2|controlled)|times=\\d+)";
  const std::string mirror = fmt::format("(ior|k)={}", kNumber);
  std::map<std::string_view, std::string> parameters{
      {"normalise", ""}, {"pump", pump}, {"mirror", mirror}, {"kulla_conty", ""}, {"turquin", ""}};
  Json forms = Json::array();
  for (const WrittenForm& form : adjustment_forms()) {
    const std::string& list = parameters.at(form.word);
    const std::string rest = list.empty() ? "" : fmt::format("(:{0}(,{0})*)?", list);
    Json value = text_like(fmt::format("^{}{}$", form.word, rest));
    value["description"] = fmt::format("{}: {}", form.written, form.meaning);
    value["examples"] = {form.word};
    forms.push_back(std::move(value));
  }
  return {{"anyOf", std::move(forms)}};
}

/// Infinite bounds are none.
Json range_of(const Parameter& parameter) {
  Json range = Json::object();
  if (std::isfinite(parameter.minimum)) range["minimum"] = parameter.minimum;
  if (std::isfinite(parameter.maximum)) range["maximum"] = parameter.maximum;
  return range;
}

std::string unit_text(const Parameter& parameter) {
  return parameter.unit == "1" ? "" : fmt::format(", {}", parameter.unit);
}

/// Schema of a parameter's value, a number or the numbers in a list, from the catalogue. How it may be written depends
/// on the place.
Json parameter_value(const Parameter& parameter) {
  const Json range = range_of(parameter);
  Json value{{"description", fmt::format("{}{}", parameter.description, unit_text(parameter))}};
  value.update(range);
  if (!range.empty()) value["items"] = range;
  if (parameter.default_value) value["default"] = *parameter.default_value;
  return value;
}

/// Condition that applies if a key has a value.
Json when(std::string_view key, std::string_view value, Json then) {
  Json condition{{"properties", {{key, {{"const", value}}}}}, {"required", {key}}};
  return {{"if", std::move(condition)}, {"then", std::move(then)}};
}

Names required_of(std::span<const Parameter> parameters) {
  Names names;
  for (const auto& parameter : parameters) {
    if (!parameter.default_value) names.push_back(parameter.name);
  }
  return names;
}

void add_names(Names& names, std::span<const std::string_view> more) {
  for (const auto name : more) {
    if (std::ranges::find(names, name) == names.end()) names.push_back(name);
  }
}

/// The keys beside parameters of all tables that may hold a model.
const Names& own_keys() {
  static const Names kNames = [] {
    Names names;
    add_names(names, kTermNames);
    add_names(names, names_of(kMaterialKeys));
    add_names(names, names_of(kSweepKeys));
    add_names(names, names_of(kFitKeys));
    add_names(names, names_of(kPublishedKeys));
    add_names(names, names_of(kCurveKeys));
    return names;
  }();
  return kNames;
}

bool is_parameter(std::string_view name) {
  return std::ranges::any_of(catalogue(), [&](const Model& model) {
    return std::ranges::find(model.parameters, name, &Parameter::name) != model.parameters.end();
  });
}

/// Allows a model's parameters, and no other keys except those of the table.
Json parameters_of(std::span<const Parameter> parameters, std::span<const std::string_view> own) {
  Json properties = Json::object();
  for (const auto& parameter : parameters) properties[parameter.name] = parameter_value(parameter);
  return {{"properties", std::move(properties)},
          {"patternProperties", {{fmt::format("^({})$", fmt::join(own, "|")), true}}},
          {"additionalProperties", false}};
}

constexpr std::array<std::string_view, 2> kCurveModels{"profile", "mixture"};

/// The names that the key `model` takes, and keys of models, for completion; what each model takes, for checking.
Json models() {
  Names names;
  std::map<std::string_view, std::string> meanings;
  for (const auto& model : catalogue()) {
    names.push_back(model.name);
    for (const auto& parameter : model.parameters) {
      std::string& meaning = meanings[parameter.name];
      meaning += fmt::format("{}{}: {}{}", meaning.empty() ? "" : "; ", model.name, parameter.description,
                             unit_text(parameter));
    }
  }
  names.push_back(kCustomModel);
  add_names(names, kCurveModels);
  Json properties{{"model", one_of(names)}};
  for (const auto& [name, meaning] : meanings) properties[name] = {{"description", meaning}};

  Json conditions = Json::array();
  for (const auto& model : catalogue()) {
    Json then{{"description", fmt::format("{} ({})", model.formula, model.source)}};
    then.update(parameters_of(model.parameters, own_keys()));
    conditions.push_back(when("model", model.name, std::move(then)));
  }
  Json formula{{"formula", text()},
               {"width", {{"type", "number"}, {"exclusiveMinimum", 0}, {"maximum", 1}}},
               {"reciprocal", {{"type", "boolean"}}}};
  for (const Key& key : kFormulaKeys) formula[key.name]["description"] = key.meaning;
  conditions.push_back(
      when("model", kCustomModel, {{"properties", std::move(formula)}, {"required", {kFormulaKeys.front().name}}}));
  for (const auto name : kCurveModels) {
    const Key& points = kCurveModelKeys.front();
    Json curve = parameters_of({}, own_keys());
    curve["properties"][points.name] = list_of(pair_of_numbers(), 1);
    curve["properties"][points.name]["description"] = points.meaning;
    curve["required"] = {points.name};
    conditions.push_back(when("model", name, std::move(curve)));
  }
  return {{"properties", std::move(properties)}, {"allOf", std::move(conditions)}};
}

/// Parameters without a default are given. Not so where a chart gives one of them.
Json complete_models() {
  Json conditions = Json::array();
  for (const auto& model : catalogue()) {
    const Names names = required_of(model.parameters);
    if (!names.empty()) conditions.push_back(when("model", model.name, {{"required", names}}));
  }
  return {{"allOf", std::move(conditions)}};
}

Json factor(Place place) {
  Names names;
  Json conditions = Json::array();
  constexpr std::array<std::string_view, 1> kOwn{"name"};
  for (const auto& each : factors()) {
    names.push_back(each.name);
    Json then{{"description", fmt::format("{} ({})", each.formula, each.source)}};
    then.update(parameters_of(each.parameters, kOwn));
    if (const Names given = required_of(each.parameters); !given.empty()) then["required"] = given;
    conditions.push_back(when("name", each.name, std::move(then)));
  }
  return {{"type", "object"},
          {"properties", {{"name", one_of(names)}}},
          {"required", {"name"}},
          {"additionalProperties", number_at(place, false)},
          {"allOf", std::move(conditions)}};
}

Json pumping() {
  Json properties = Json::object();
  for (const Key& key : kPumpingKeys) {
    properties[key.name] =
        key.value == KeyValue::correction ? one_of(kCorrections) : list_of(list_of({{"type", "number"}}), 1);
    properties[key.name]["description"] = key.meaning;
  }
  return {{"type", "object"},
          {"properties", std::move(properties)},
          {"required", names_of(kPumpingKeys)},
          {"additionalProperties", false}};
}

Json described(Json value, std::string_view meaning) {
  Json all{{"description", meaning}};
  if (value.contains("$ref")) {  // beside which other words do not count
    all["allOf"] = Json::array({std::move(value)});
  } else {
    all.update(value);
  }
  return all;
}

std::string place_suffix(Place place) {
  constexpr std::array<std::string_view, 3> kSuffixes{"", "_of_row", "_of_family"};
  return std::string(kSuffixes.at(static_cast<std::size_t>(place)));
}

Json value_of(KeyValue kind, Place place) {
  constexpr double kHorizon = 90;
  switch (kind) {
    case KeyValue::text:
      return text();
    case KeyValue::texts:
      return list_of(text());
    case KeyValue::truth:
      return {{"type", "boolean"}};
    case KeyValue::number:
      return number_at(place == Place::family ? Place::plain : place, false);
    case KeyValue::stem:
      return text_like("^(?=.*\\S)[^./\\-\\x00-\\x1f\\x7f][^/\\x00-\\x1f\\x7f]*$");
    case KeyValue::plain_name:
      return text_like("^[^/\\x00-\\x20\\x7f]+$");
    case KeyValue::channels:
      return distinct(list_of(text(), 1));
    case KeyValue::columns:
      return list_of(text(), 1);
    case KeyValue::channel_choice:
      return list_of(either(text(), {{"type", "integer"}, {"minimum", 1}}), 1);
    case KeyValue::weights: {
      Json list = list_of({{"type", "number"}, {"minimum", 0}}, 1);
      list["contains"] = {{"exclusiveMinimum", 0}};
      return list;
    }
    case KeyValue::lightings:
      return distinct(list_of(reference("lighting"), 1));
    case KeyValue::comparisons: {
      Names names;
      for (const LiteratureMetric comparison : literature_metrics()) names.push_back(to_string(comparison));
      return distinct(list_of(one_of(names)));
    }
    case KeyValue::fits:
      return distinct(list_of(one_of(std::array{to_string(FamilyFit::linear), to_string(FamilyFit::non_negative)})));
    case KeyValue::tolerance:
      return number(toml_reader::kSmallestTolerance, toml_reader::kLargestTolerance);
    case KeyValue::count:
      return {{"type", "integer"}, {"minimum", 1}};
    case KeyValue::precision:
      return one_of(std::array<std::string_view, 2>{"double", "single"});
    case KeyValue::grid:
      return grid();
    case KeyValue::files:
      return either(text(), list_of(text(), 1));
    case KeyValue::luminance:
      return one_of(std::array<std::string_view, 2>{"rec709", "photopic"});
    case KeyValue::degrees:
      return {{"type", "number"}, {"exclusiveMinimum", 0}, {"maximum", kHorizon}};
    case KeyValue::wavelengths:
      return list_of({{"type", "number"}, {"exclusiveMinimum", 0}}, 1);
    case KeyValue::model:
      return {{"type", "string"}};  // which ones, says `models`
    case KeyValue::weight: {
      Json scale = number_at(place, true);
      if (place == Place::rows) scale["pattern"] = kProduct;
      return scale;
    }
    case KeyValue::factors: {
      Json list = list_of(reference("factor" + place_suffix(place)));
      list["maxItems"] = kMaxFactors;
      return list;
    }
    case KeyValue::adjustments:
      return list_of(reference("adjustment"));
    case KeyValue::pumping:
      return reference("pumping");
    case KeyValue::zip:
      return either({{"type", "boolean"}}, list_of(list_of(text(), 2)));
    case KeyValue::rows:
      return list_of(list_of(Json::object()), 1);
    case KeyValue::terms:
      return list_of(reference("term" + place_suffix(place)), 1);
    case KeyValue::term:
      return reference("term" + place_suffix(place));
    case KeyValue::curves:
      return list_of(reference("curve"), 1);
    case KeyValue::chart_quantity:
      return one_of(chart_quantities());
    case KeyValue::published_quantity:
      return or_column(one_of(published_quantities()), place);
    case KeyValue::angle:
      return or_column({{"type", "number"}, {"minimum", 0}, {"exclusiveMaximum", kHorizon}}, place);
    case KeyValue::directions: {
      Json angles = Json::array();
      for (const double limit : {kHorizon, kHorizon, 4 * kHorizon}) {
        angles.push_back({{"type", "number"}, {"minimum", 0}, {"exclusiveMaximum", limit}});
      }
      return or_column(list_of({{"type", "array"}, {"items", angles}, {"minItems", 3}, {"maxItems", 3}}, 1), place);
    }
    case KeyValue::numbers:
      return or_column(list_of({{"type", "number"}}, 1), place);
    case KeyValue::printed:
      return or_column(text_like(fmt::format("^[-+]?{}$", kNumber)), place);
    case KeyValue::corrected:
      return or_column(text_like(fmt::format("^([-+]?{})?$", kNumber)), place);
    case KeyValue::abscissae: {
      Json list = list_of({{"type", "number"}}, 2);
      Json range{{"type", "object"}};
      range["allOf"] = Json::array({reference("range")});
      return either(std::move(list), std::move(range));
    }
    case KeyValue::range:
      return pair_of_numbers();
    case KeyValue::correction:
    case KeyValue::albedos:
    case KeyValue::formula_width:
    case KeyValue::points:
    case KeyValue::table:
    case KeyValue::tables:
      break;  // made where they stand
  }
  return Json::object();
}

template <std::size_t N>
Json properties_of(const std::array<Key, N>& keys, Place place = Place::plain) {
  Json properties = Json::object();
  for (const Key& key : keys) properties[key.name] = described(value_of(key.value, place), key.meaning);
  return properties;
}

/// A table with these keys and no others.
template <std::size_t N>
Json closed_table(const std::array<Key, N>& keys, Names required) {
  Json table{{"type", "object"}, {"properties", properties_of(keys)}};
  if (!required.empty()) table["required"] = std::move(required);
  table["additionalProperties"] = false;
  return table;
}

/// What holds of a model in a table with further keys: what its parameters may look like there, and that keys of other
/// tables are none of this one. A formula of one's own may have any parameters.
/// \param complete parameters without a default have to be there
Json model_in(Names own, Place place, bool complete) {
  Json types{{"properties", Json::object()}, {"additionalProperties", number_at(place, true)}};
  Names beside = own;
  add_names(beside, names_of(kFormulaKeys));
  add_names(beside, names_of(kCurveModelKeys));
  for (const auto name : beside) types["properties"][name] = true;
  Json others = Json::object();
  for (const auto name : own_keys()) {
    if (std::ranges::find(own, name) == own.end() && !is_parameter(name)) others[name] = false;
  }
  Json all = Json::array({reference("model"), std::move(types)});
  if (complete) all.push_back(reference("complete_model"));
  if (!others.empty()) {
    Json condition{{"properties", {{"model", {{"const", kCustomModel}}}}}, {"required", {"model"}}};
    all.push_back({{"if", std::move(condition)}, {"else", {{"properties", std::move(others)}}}});
  }
  return {{"required", {"model"}}, {"allOf", std::move(all)}};
}

Json term(Place place) {
  Json table{{"type", "object"}, {"properties", properties_of(kTermKeys, place)}};
  const auto names = names_of(kTermKeys);
  table.update(model_in(Names(names.begin(), names.end()), place, true));
  return table;
}

/// A table that holds terms, or the keys of a single one.
template <std::size_t N>
Json table_of_terms(const std::array<Key, N>& keys, Names required, Place place, bool complete = true) {
  Json properties = properties_of(keys, place);
  properties.update(properties_of(kTermKeys, place));
  properties[kTermsKey] = described(value_of(KeyValue::terms, place), "materials are sums of terms");
  const auto own = names_of(keys);
  Names with_terms(own.begin(), own.end());
  with_terms.push_back(kTermsKey);
  Names with_model(own.begin(), own.end());
  add_names(with_model, kTermNames);
  Json table{{"type", "object"}, {"properties", std::move(properties)}};
  if (!required.empty()) table["required"] = std::move(required);
  table["if"] = {{"required", {kTermsKey}}};
  table["then"] = {{"propertyNames", one_of(with_terms)}};
  table["else"] = model_in(std::move(with_model), place, complete);
  return table;
}

Json family() {
  Json rows{{"anyOf", {{{"required", {"rows"}}}, {{"required", {"columns"}}}}}};
  return {{"type", "object"},
          {"required", {"name"}},
          {"if", std::move(rows)},
          {"then", reference("fit_family")},
          {"else", reference("sweep_family")}};
}

Json measured() {
  Json table = closed_table(kMeasuredKeys, {});
  table["oneOf"] = {{{"required", {"file"}}}, {{"required", {"files"}}}};
  table["dependencies"] = {{"name", {"file"}}, {"label", {"files"}}};
  return table;
}

/// Keys that only some quantities have.
Json only_for(std::string_view key, std::initializer_list<std::string_view> quantities, bool is_required) {
  const Names names(quantities);
  Json condition{{"properties", {{"quantity", one_of(names)}}}, {"required", {"quantity"}}};
  Json rule{{"if", condition}};
  if (is_required) rule["then"] = {{"required", {key}}};
  // A column may hold any quantity.
  rule["else"] = {{"if", {{"properties", {{"quantity", {{"pattern", kColumn}}}}}}},
                  {"else", {{"properties", {{key, false}}}}}};
  return rule;
}

Json published() {
  Json table = table_of_terms(kPublishedKeys, {"title", "quantity"}, Place::rows);
  table["dependencies"] = {{"columns", {"rows"}}, {"rows", {"columns"}}};
  Json given{{"required", {"printed"}}};
  Json column{{"required", {"columns"}}, {"properties", {{"columns", {{"contains", {{"const", "printed"}}}}}}}};
  table["anyOf"] = {std::move(given), std::move(column)};
  table["allOf"] = {only_for("at", {"reflectance"}, true), only_for("coefficients", {"reflectance"}, false),
                    only_for("theta", {"albedo"}, true)};
  return table;
}

Json chart() {
  Json table = closed_table(kChartKeys, {"name", "quantity", "curves"});
  const Json viewed = one_of(std::array{to_string(ChartQuantity::reflectance), to_string(ChartQuantity::radiance)});
  const Json with_angle{
      {"properties", {{"curves", {{"items", {{"required", {"theta_in"}}}}}}, {"log_x", {{"const", false}}}}}};
  const Json without{{"properties", {{"curves", {{"items", {{"properties", {{"theta_in", false}}}}}}}}}};
  Json angles{{"if", {{"properties", {{"quantity", viewed}}}, {"required", {"quantity"}}}},
              {"then", with_angle},
              {"else", without}};
  Json means = only_for("parameter", {to_string(ChartQuantity::mean_albedo)}, true);
  means["then"]["required"].push_back("x");
  means["else"]["properties"] = {{"curves", {{"items", reference("complete_curve")}}}};
  table["allOf"] = {std::move(angles), std::move(means)};
  return table;
}

/// A curve whose model has all of its parameters.
Json complete_curve() {
  return {{"if", {{"required", {"model"}}}}, {"then", reference("complete_model")}};
}

Json range() {
  Json table = closed_table(kRangeKeys, {});
  table.erase("type");  // says nothing of numbers and lists
  table["properties"]["values"]["minItems"] = 1;
  table["properties"]["logspace"]["items"] = {{"type", "number"}, {"exclusiveMinimum", 0}};
  table["properties"]["count"]["minimum"] = 2;
  table["properties"]["count"]["maximum"] = kLargestSweep;
  table["oneOf"] = Json::array();
  table["oneOf"].push_back({{"required", {"values"}}, {"properties", {{"count", false}}}});
  for (const auto* kind : {"linspace", "logspace"}) table["oneOf"].push_back({{"required", {kind, "count"}}});
  return {{"if", {{"type", "object"}}}, {"then", std::move(table)}};
}

Json file() {
  Json properties = Json::object();
  Json some = Json::array();  // of which there is one at least
  for (const Key& key : kFileKeys) {
    const bool is_table = key.value == KeyValue::table || key.value == KeyValue::tables;
    Json value = is_table ? reference(key.name) : value_of(key.value, Place::plain);
    if (key.value == KeyValue::tables) value = list_of(std::move(value), 1);
    properties[key.name] = described(std::move(value), key.meaning);
    if (key.value != KeyValue::table) some.push_back({{"required", {key.name}}});
  }
  return {{"$schema", "http://json-schema.org/draft-07/schema#"},
          {"title", "Study of lobe"},
          {"description", "materials and what to compute of them (docs/study-files.md)"},
          {"type", "object"},
          {"properties", std::move(properties)},
          {"additionalProperties", false},
          {"anyOf", std::move(some)}};
}

}  // namespace

std::string study_schema() {
  Json schema = file();
  Json& definitions = schema["definitions"];
  definitions["study"] = closed_table(kStudyKeys, {});
  definitions["family"] = family();
  definitions["sweep_family"] = table_of_terms(kSweepKeys, {"name"}, Place::family);
  definitions["fit_family"] = table_of_terms(kFitKeys, {"name", "columns", "rows"}, Place::rows);
  definitions["fit_family"]["properties"]["columns"]["contains"] = {{"const", "name"}};
  definitions["material"] = table_of_terms(kMaterialKeys, {"name"}, Place::plain);
  definitions["measured"] = measured();
  definitions["published"] = published();
  definitions["chart"] = chart();
  definitions["curve"] = table_of_terms(kCurveKeys, {"label"}, Place::plain, false);
  definitions["complete_curve"] = complete_curve();
  for (const Place place : {Place::plain, Place::rows, Place::family}) {
    definitions["term" + place_suffix(place)] = term(place);
    definitions["factor" + place_suffix(place)] = factor(place);
  }
  definitions["model"] = models();
  definitions["complete_model"] = complete_models();
  definitions["pumping"] = pumping();
  definitions["adjustment"] = adjustment();
  definitions["lighting"] = lighting();
  definitions["range"] = range();
  return schema.dump(1) + "\n";
}

}  // namespace lobe
