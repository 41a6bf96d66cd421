#include <nlohmann/json.hpp>
#include <string>
#include <utility>
#include <vector>

#include "core/text.hpp"
#include "lobe/core/error.hpp"
#include "lobe/model/material.hpp"
#include "model/terms.hpp"

namespace lobe {
namespace {

using Json = nlohmann::ordered_json;

template <typename Name>
Json named_values(const std::vector<Name>& names, const std::vector<double>& values) {
  Json json = Json::object();
  for (std::size_t i = 0; i < names.size(); ++i) json[std::string(names[i])] = values.at(i);
  return json;
}

std::vector<NamedValue> read_values(const Json& json) {
  std::vector<NamedValue> values;
  for (const auto& [name, value] : json.items()) values.emplace_back(name, value.get<double>());
  return values;
}

Json term_json(const Term& term) {
  Json json;
  json["model"] = term.model;
  if (term.formula) {
    json["formula"] = {
        {"text", term.formula->text}, {"width", term.formula->width}, {"reciprocal", term.formula->reciprocal}};
  }
  json["parameters"] = named_values(parameter_names(term), term.values);
  json["weight"] = term.weight;
  for (const Factor& factor : term.factors) {
    std::vector<std::string_view> names;
    for (const auto& parameter : find_factor(factor.name).parameters) names.push_back(parameter.name);
    json["factors"].push_back({{"name", factor.name}, {"parameters", named_values(names, factor.values)}});
  }
  if (term.pumping) {
    json["pumping"] = {{"correction", to_string(term.pumping->correction)}, {"albedos", term.pumping->albedos}};
  }
  if (!term.complement_of.empty()) json["complement_of"] = term.complement_of;
  return json;
}

/// A name, which comes into pictures, tables and onto terminals.
std::string read_name(const Json& json, const char* key) {
  auto name = json.at(key).get<std::string>();
  if (has_control_characters(name)) {
    throw ArgumentError("cannot read a material from JSON: its " + std::string(key) + " '" + excerpt(name) +
                        "' has control characters; expected a text in one line");
  }
  return name;
}

Term custom_term(const Json& json, const std::vector<NamedValue>& given) {
  Formula formula;
  formula.text = json.at("text").get<std::string>();
  formula.width = json.at("width").get<double>();
  formula.reciprocal = json.at("reciprocal").get<bool>();
  std::vector<double> values;
  for (const auto& [name, value] : given) {
    formula.parameters.push_back(name);
    values.push_back(value);
  }
  return make_custom_term(std::move(formula), values);
}

Term term_from_json(const Json& json) {
  const auto model = json.at("model").get<std::string>();
  const auto given = read_values(json.at("parameters"));
  Term term =
      json.contains("formula") ? custom_term(json.at("formula"), given) : make_material(model, given).terms.front();
  term.weight = json.at("weight").get<std::vector<double>>();
  if (term.weight.empty()) throw ArgumentError("cannot read a material from JSON: a term has no weight");
  if (json.contains("factors")) {
    for (const Json& factor : json.at("factors")) {
      term.factors.push_back(make_factor(factor.at("name").get<std::string>(), read_values(factor.at("parameters"))));
    }
  }
  if (json.contains("pumping")) {
    const Json& pumping = json.at("pumping");
    term.pumping = make_pumping(pumping.at("correction").get<std::string>(),
                                pumping.at("albedos").get<std::vector<std::vector<double>>>());
  }
  if (json.contains("complement_of")) term.complement_of = json.at("complement_of").get<std::vector<double>>();
  require_consistent(term);
  return term;
}

}  // namespace

std::string to_json(const Material& material) {
  Json json;
  json["name"] = material.name;
  json["family"] = material.family;
  json["terms"] = Json::array();
  for (const auto& term : material.terms) json["terms"].push_back(term_json(term));
  for (const Adjustment& adjustment : material.adjustments) json["adjustments"].push_back(to_string(adjustment));
  // Bytes that are no UTF-8, as in a name from the command line, are replaced rather than refused.
  return json.dump(-1, ' ', false, Json::error_handler_t::replace);
}

Material material_from_json(std::string_view text) {
  try {
    const auto json = Json::parse(text);
    Material material{read_name(json, "name"), read_name(json, "family"), {}};
    for (const auto& entry : json.at("terms")) material.terms.push_back(term_from_json(entry));
    if (material.terms.empty()) throw ArgumentError("cannot read a material from JSON: it has no terms");
    if (json.contains("adjustments")) {
      for (const auto& name : json.at("adjustments")) {
        material.adjustments.push_back(parse_adjustment(name.get<std::string>()));
      }
    }
    return material;
  } catch (const nlohmann::json::exception& error) {
    throw ArgumentError(std::string("cannot read a material from JSON: ") + error.what());
  }
}

}  // namespace lobe
