#include "lobe/material.hpp"

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>
#include <optional>

#include "core/text.hpp"
#include "lobe/error.hpp"
#include "lobe/model.hpp"

namespace lobe {
namespace {

std::string range_text(const Parameter& parameter) {
  return "[" + shortest(parameter.minimum) + ", " + shortest(parameter.maximum) + "]" +
         (parameter.unit == "1" ? "" : " " + std::string(parameter.unit));
}

Term make_term(const Model& model, const std::vector<std::pair<std::string, double>>& given) {
  std::vector<std::optional<double>> values(model.parameters.size());
  std::vector<std::string_view> known;
  for (const auto& parameter : model.parameters) known.push_back(parameter.name);
  for (const auto& [key, value] : given) {
    const auto found = std::find(known.begin(), known.end(), key);
    if (found == known.end()) {
      std::string message = "model '" + std::string(model.name) + "' has no parameter '" + key + "'";
      throw ArgumentError(known.empty() ? message + "; it takes none" : message + did_you_mean(key, known));
    }
    const auto index = static_cast<std::size_t>(found - known.begin());
    if (values[index])
      throw ArgumentError("parameter '" + key + "' of model '" + std::string(model.name) + "' is given twice");
    const Parameter& parameter = model.parameters[index];
    if (!(value >= parameter.minimum && value <= parameter.maximum)) {
      throw ArgumentError("parameter '" + key + "' of model '" + std::string(model.name) + "' is " + shortest(value) +
                          "; expected a value in " + range_text(parameter));
    }
    values[index] = value;
  }
  Term term{std::string(model.name), {}, {1.0}};
  for (std::size_t i = 0; i < values.size(); ++i) {
    const Parameter& parameter = model.parameters[i];
    if (!values[i] && !parameter.default_value) {
      throw ArgumentError("model '" + std::string(model.name) + "' needs the parameter '" +
                          std::string(parameter.name) + "', a value in " + range_text(parameter));
    }
    term.values.push_back(values[i] ? *values[i] : *parameter.default_value);
  }
  return term;
}

Term parse_term(std::string_view text) {
  const std::size_t colon = text.find(':');
  const Model& model = find_model(trim(text.substr(0, colon)));
  std::vector<std::pair<std::string, double>> parameters;
  std::optional<double> scale;
  if (colon != std::string_view::npos) {
    for (const auto part : split(text.substr(colon + 1), ',')) {
      const std::size_t equals = part.find('=');
      const std::string key(trim(part.substr(0, equals)));
      double value = 0;
      if (equals == std::string_view::npos || key.empty()) {
        throw ArgumentError("cannot read '" + std::string(part) + "' in material '" + std::string(text) +
                            "'; expected MODEL[:key=value,...]");
      }
      if (!parse_number(trim(part.substr(equals + 1)), value)) {
        throw ArgumentError("value '" + std::string(trim(part.substr(equals + 1))) + "' of '" + key +
                            "' in material '" + std::string(text) + "' is no finite number");
      }
      if (key == "scale") {
        if (scale) throw ArgumentError("'scale' is given twice in material '" + std::string(text) + "'");
        scale = value;
      } else {
        parameters.emplace_back(key, value);
      }
    }
  }
  Term term = make_term(model, parameters);
  term.weight = {scale.value_or(1)};
  return term;
}

/// Splits at '+' between terms, not in exponents such as 1e+3.
std::vector<std::string_view> split_terms(std::string_view text) {
  std::vector<std::string_view> terms;
  std::size_t start = 0;
  for (std::size_t i = 0; i < text.size(); ++i) {
    const bool in_number = i >= 2 && (text[i - 1] == 'e' || text[i - 1] == 'E') &&
                           (std::isdigit(static_cast<unsigned char>(text[i - 2])) != 0 || text[i - 2] == '.');
    const bool after_sign = i >= 1 && text[i - 1] == '=';
    if (text[i] == '+' && !in_number && !after_sign) {
      terms.push_back(text.substr(start, i - start));
      start = i + 1;
    }
  }
  terms.push_back(text.substr(start));
  return terms;
}

Term term_from_json(const nlohmann::ordered_json& json) {
  const auto model = json.at("model").get<std::string>();
  std::vector<std::pair<std::string, double>> parameters;
  for (const auto& [name, value] : json.at("parameters").items()) parameters.emplace_back(name, value.get<double>());
  Term term = make_term(find_model(model), parameters);
  term.weight = json.at("weight").get<std::vector<double>>();
  if (term.weight.empty()) throw ArgumentError("cannot read a material from JSON: a term has no weight");
  return term;
}

}  // namespace

std::size_t Material::channels() const {
  std::size_t count = 1;
  for (const auto& term : terms) count = std::max(count, term.weight.size());
  return count;
}

Material make_material(std::string_view model, const std::vector<std::pair<std::string, double>>& parameters) {
  const Model& found = find_model(model);
  std::string name(model);
  for (std::size_t i = 0; i < parameters.size(); ++i) {
    name += (i == 0 ? ":" : ",") + parameters[i].first + "=" + shortest(parameters[i].second);
  }
  return {std::move(name), std::string(found.family), {make_term(found, parameters)}};
}

Material make_material(std::string_view model, std::initializer_list<std::pair<std::string_view, double>> parameters) {
  std::vector<std::pair<std::string, double>> list;
  for (const auto& [key, value] : parameters) list.emplace_back(std::string(key), value);
  return make_material(model, list);
}

Material parse_material(std::string_view specification) {
  const std::string_view text = trim(specification);
  if (text.empty()) throw ArgumentError("empty material; expected MODEL[:key=value,...]");
  Material material{std::string(text), {}, {}};
  for (const auto term : split_terms(text)) material.terms.push_back(parse_term(trim(term)));
  material.family =
      material.terms.size() == 1 ? std::string(find_model(material.terms.front().model).family) : "mixture";
  return material;
}

std::string to_json(const Material& material) {
  nlohmann::ordered_json json;
  json["name"] = material.name;
  json["family"] = material.family;
  json["terms"] = nlohmann::ordered_json::array();
  for (const auto& term : material.terms) {
    nlohmann::ordered_json entry;
    entry["model"] = term.model;
    entry["parameters"] = nlohmann::ordered_json::object();
    const Model& model = find_model(term.model);
    for (std::size_t i = 0; i < model.parameters.size(); ++i) {
      entry["parameters"][std::string(model.parameters[i].name)] = term.values[i];
    }
    entry["weight"] = term.weight;
    json["terms"].push_back(std::move(entry));
  }
  // Bytes that are no UTF-8, as in a name from the command line, are replaced rather than refused.
  return json.dump(-1, ' ', false, nlohmann::ordered_json::error_handler_t::replace);
}

Material material_from_json(std::string_view text) {
  try {
    const auto json = nlohmann::ordered_json::parse(text);
    Material material{json.at("name").get<std::string>(), json.at("family").get<std::string>(), {}};
    for (const auto& entry : json.at("terms")) material.terms.push_back(term_from_json(entry));
    if (material.terms.empty()) throw ArgumentError("cannot read a material from JSON: it has no terms");
    return material;
  } catch (const nlohmann::json::exception& error) {
    throw ArgumentError(std::string("cannot read a material from JSON: ") + error.what());
  }
}

}  // namespace lobe
