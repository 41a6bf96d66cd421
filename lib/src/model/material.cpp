#include "lobe/model/material.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <optional>
#include <span>

#include "core/text.hpp"
#include "lobe/core/directions.hpp"
#include "lobe/core/error.hpp"
#include "model/terms.hpp"

namespace lobe {
namespace {

std::string range_text(const Parameter& parameter) {
  return "[" + shortest(parameter.minimum) + ", " + shortest(parameter.maximum) + "]" +
         (parameter.unit == "1" ? "" : " " + std::string(parameter.unit));
}

/// Hint for an angle out of range that may have been meant in degrees.
std::string hint_of_degrees(const Parameter& parameter, double value) {
  const double radians = value * kDegree;
  if (parameter.unit != "rad" || !(radians >= parameter.minimum && radians <= parameter.maximum)) return "";
  return fmt::format(" ({} degrees are {:.6g})", shortest(value), radians);
}

/// One value per parameter, given or by default.
/// \param owner "model 'ward'", for messages
std::vector<double> fill_in(std::span<const Parameter> parameters, const std::vector<NamedValue>& given,
                            const std::string& owner) {
  std::vector<std::optional<double>> values(parameters.size());
  std::vector<std::string_view> known;
  for (const auto& parameter : parameters) known.push_back(parameter.name);
  for (const auto& [key, value] : given) {
    const auto found = std::find(known.begin(), known.end(), key);
    if (found == known.end()) {
      std::string message = owner + " has no parameter '" + key + "'";
      throw ArgumentError(known.empty() ? message + "; it takes none" : message + did_you_mean(key, known));
    }
    const auto index = static_cast<std::size_t>(found - known.begin());
    if (values[index]) throw ArgumentError("parameter '" + key + "' of " + owner + " is given twice");
    const Parameter& parameter = parameters[index];
    if (!(value >= parameter.minimum && value <= parameter.maximum)) {
      throw ArgumentError("parameter '" + key + "' of " + owner + " is " + shortest(value) + "; expected a value in " +
                          range_text(parameter) + hint_of_degrees(parameter, value));
    }
    values[index] = value;
  }
  std::vector<double> filled;
  for (std::size_t i = 0; i < values.size(); ++i) {
    const Parameter& parameter = parameters[i];
    if (!values[i] && !parameter.default_value) {
      throw ArgumentError(owner + " needs the parameter '" + std::string(parameter.name) + "', a value in " +
                          range_text(parameter) + "; give " + std::string(parameter.name) + "=VALUE");
    }
    filled.push_back(values[i] ? *values[i] : *parameter.default_value);
  }
  return filled;
}

Term make_term(const Model& model, const std::vector<NamedValue>& given) {
  return {std::string(model.name), fill_in(model.parameters, given, "model '" + std::string(model.name) + "'"), {1.0}};
}

using NamedValues = std::pair<std::string, std::vector<double>>;

/// "key=value" or "key=value/value/...", the latter one value per channel.
NamedValues parse_values(std::string_view part, std::string_view whole) {
  const std::size_t equals = part.find('=');
  NamedValues named{std::string(trim(part.substr(0, equals))), {}};
  if (equals == std::string_view::npos || named.first.empty()) {
    throw ArgumentError("cannot read '" + std::string(part) + "' in material '" + std::string(whole) +
                        "'; expected MODEL[:key=value,...]");
  }
  for (const auto text : split(part.substr(equals + 1), '/')) {
    double value = 0;
    if (!parse_number(trim(text), value)) {
      throw ArgumentError("value '" + std::string(trim(text)) + "' of '" + named.first + "' in material '" +
                          std::string(whole) + "' is no finite number; expected one without a unit, such as 20 or 0.5");
    }
    named.second.push_back(value);
  }
  return named;
}

/// Parses the parameters behind the colon of a model or factor.
std::vector<NamedValues> parse_parameters(std::string_view text, std::string_view whole) {
  std::vector<NamedValues> list;
  const std::size_t colon = text.find(':');
  if (colon == std::string_view::npos) return list;
  for (const auto part : split(text.substr(colon + 1), ',')) list.push_back(parse_values(part, whole));
  return list;
}

Factor parse_factor(std::string_view text, std::string_view whole) {
  std::vector<NamedValue> values;
  for (const auto& [key, list] : parse_parameters(text, whole)) {
    if (list.size() != 1) {
      throw ArgumentError("parameter '" + key + "' of a factor in material '" + std::string(whole) +
                          "' has several values; expected one");
    }
    values.emplace_back(key, list.front());
  }
  return make_factor(trim(text.substr(0, text.find(':'))), values);
}

/// The terms of MODEL[:...][*FACTOR[:...]]..., several where values differ by channel.
std::vector<Term> parse_terms(std::string_view text) {
  const auto parts = split(text, '*');
  const std::string_view name = trim(parts.front().substr(0, parts.front().find(':')));
  if (name.empty()) {
    throw ArgumentError("a material, or a part of one, is empty; expected MODEL[:key=value,...]");
  }
  if (name.find_first_of("(,= ") != std::string_view::npos) {
    throw ArgumentError("cannot read material '" + std::string(text) +
                        "'; expected MODEL[:key=value,...], such as phong:n=20");
  }
  if (name == kCustomModel) {
    throw ArgumentError("'custom' needs a formula, which cannot be written here; expected a material file with it");
  }
  std::vector<NamedValues> parameters = parse_parameters(parts.front(), text);
  std::vector<double> scale = {1.0};
  const auto is_scale = [](const NamedValues& entry) { return entry.first == "scale"; };
  const auto scales = std::ranges::count_if(parameters, is_scale);
  if (scales > 1)
    throw ArgumentError("'scale' is given twice in material '" + std::string(text) + "'", {.topic = Topic::materials});
  if (scales == 1) {
    const auto found = std::ranges::find_if(parameters, is_scale);
    scale = found->second;
    parameters.erase(found);
  }
  std::vector<Term> terms = make_terms(name, parameters);
  apply_weight(terms, scale);
  for (std::size_t k = 1; k < parts.size(); ++k) {
    for (Term& term : terms) term.factors.push_back(parse_factor(trim(parts[k]), text));
  }
  for (const Term& term : terms) require_consistent(term);
  return terms;
}

}  // namespace

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

std::size_t Material::channels() const {
  std::size_t count = 1;
  for (const auto& term : terms) count = std::max(count, term.weight.size());
  return count;
}

std::vector<std::string> parameter_names(const Term& term) {
  if (term.formula) return term.formula->parameters;
  std::vector<std::string> names;
  for (const auto& parameter : find_model(term.model).parameters) names.emplace_back(parameter.name);
  return names;
}

Factor make_factor(std::string_view name, const std::vector<NamedValue>& parameters) {
  const FactorModel& factor = find_factor(name);
  return {std::string(name), fill_in(factor.parameters, parameters, "factor '" + std::string(name) + "'")};
}

std::vector<Term> make_terms(std::string_view model, const std::vector<NamedValues>& values) {
  const Model& found = find_model(model);
  std::size_t channels = 1;
  for (const auto& [key, list] : values) channels = std::max(channels, list.size());
  std::vector<Term> terms;
  for (std::size_t c = 0; c < channels; ++c) {
    std::vector<NamedValue> of_channel;
    for (const auto& [key, list] : values) {
      if (list.size() != 1 && list.size() != channels) {
        throw ArgumentError("parameter '" + key + "' of model '" + std::string(model) + "' has " +
                            std::to_string(list.size()) + " values; expected one, or one for each of the " +
                            std::to_string(channels) + " channels");
      }
      of_channel.emplace_back(key, list[list.size() == 1 ? 0 : c]);
    }
    terms.push_back(make_term(found, of_channel));
  }
  return split_by_channel(std::move(terms));
}

Material make_material(std::string_view model, const std::vector<NamedValue>& parameters) {
  const Model& found = find_model(model);
  std::string name(model);
  for (std::size_t i = 0; i < parameters.size(); ++i) {
    name += (i == 0 ? ":" : ",") + parameters[i].first + "=" + shortest(parameters[i].second);
  }
  return {std::move(name), std::string(found.family), {make_term(found, parameters)}};
}

Material make_material(std::string_view model, std::initializer_list<std::pair<std::string_view, double>> parameters) {
  std::vector<NamedValue> list;
  for (const auto& [key, value] : parameters) list.emplace_back(std::string(key), value);
  return make_material(model, list);
}

Material parse_material(std::string_view specification) {
  const std::string_view text = trim(specification);
  if (text.empty()) throw ArgumentError("empty material; expected MODEL[:key=value,...]");
  if (has_control_characters(text)) {
    throw ArgumentError("material '" + excerpt(text) + "' has control characters; expected MODEL[:key=value,...]");
  }
  Material material{std::string(text), {}, {}};
  const auto parts = split(text, '@');
  for (std::size_t k = 1; k < parts.size(); ++k) material.adjustments.push_back(parse_adjustment(trim(parts[k])));
  for (const auto part : split_terms(parts.front())) {
    for (Term& term : parse_terms(trim(part))) material.terms.push_back(std::move(term));
  }
  material.family = family_of(material.terms);
  return material;
}

}  // namespace lobe
