#include "lut/parameter_places.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <limits>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "core/text.hpp"
#include "lobe/core/error.hpp"
#include "lobe/model/model.hpp"

namespace lobe {
namespace {

/// Where a value stands in a material.
struct Place {
  std::size_t term;
  std::optional<std::size_t> factor;  ///< none: the model's own
  std::size_t parameter;
  std::string owner;  ///< model or factor
};

const Material& formula_of(const Reflectance& reflectance, std::string_view name) {
  const Material* formula = reflectance.formula();
  if (formula == nullptr) {
    throw ArgumentError(fmt::format("'{}' is no formula and has no parameter '{}'; expected axis cos_theta or theta",
                                    reflectance.name(), excerpt(name)));
  }
  return *formula;
}

std::vector<Place> places_of(const Material& material, std::string_view name) {
  const std::size_t dot = name.find('.');
  const std::string_view owner = dot == std::string_view::npos ? std::string_view() : name.substr(0, dot);
  const std::string_view parameter = dot == std::string_view::npos ? name : name.substr(dot + 1);
  std::vector<Place> places;
  std::vector<std::string> known{"cos_theta", "theta"};
  const auto look = [&](std::size_t term, std::optional<std::size_t> factor, const std::string& whose,
                        const std::vector<std::string>& names) {
    for (std::size_t i = 0; i < names.size(); ++i) {
      if (std::ranges::find(known, names[i]) == known.end()) known.push_back(names[i]);
      if (names[i] != parameter || (!owner.empty() && owner != whose)) continue;
      places.push_back({term, factor, i, whose});
    }
  };
  for (std::size_t t = 0; t < material.terms.size(); ++t) {
    const Term& term = material.terms[t];
    look(t, std::nullopt, term.model, parameter_names(term));
    for (std::size_t f = 0; f < term.factors.size(); ++f) {
      std::vector<std::string> names;
      for (const Parameter& own : find_factor(term.factors[f].name).parameters) names.emplace_back(own.name);
      look(t, f, term.factors[f].name, names);
    }
  }
  if (places.empty()) {
    const std::vector<std::string_view> words(known.begin(), known.end());
    throw ArgumentError(
        fmt::format("'{}' has no parameter '{}'{}", material.name, excerpt(name), did_you_mean(name, words)),
        {.topic = Topic::models});
  }
  std::set<std::string> owners;
  for (const Place& place : places) owners.insert(place.owner);
  if (owners.size() > 1) {
    const std::string between = fmt::format(".{} or ", parameter);
    throw ArgumentError(fmt::format("several parts of '{}' have a parameter '{}'; expected {}.{}", material.name,
                                    parameter, fmt::join(owners, between), parameter));
  }
  return places;
}

}  // namespace

ParameterRange parameter_range(const Reflectance& reflectance, std::string_view name) {
  const Material& material = formula_of(reflectance, name);
  constexpr double kInfinity = std::numeric_limits<double>::infinity();
  const Place place = places_of(material, name).front();
  const Term& term = material.terms[place.term];
  if (!place.factor && term.formula) return {-kInfinity, kInfinity};
  const Parameter& parameter = place.factor ? find_factor(place.owner).parameters[place.parameter]
                                            : find_model(place.owner).parameters[place.parameter];
  return {parameter.minimum, parameter.maximum};
}

Reflectance with_parameter(const Reflectance& reflectance, std::string_view name, double value) {
  const Material& material = formula_of(reflectance, name);
  Material changed = material;
  for (const Place& place : places_of(material, name)) {
    Term& term = changed.terms[place.term];
    std::vector<NamedValue> values;
    if (place.factor) {
      Factor& factor = term.factors[*place.factor];
      factor.values[place.parameter] = value;
      const auto& parameters = find_factor(factor.name).parameters;
      for (std::size_t i = 0; i < parameters.size(); ++i) values.emplace_back(parameters[i].name, factor.values[i]);
      (void)make_factor(factor.name, values);  // complains of values out of range
      continue;
    }
    term.values[place.parameter] = value;
    if (term.formula) continue;
    const auto names = parameter_names(term);
    for (std::size_t i = 0; i < names.size(); ++i) values.emplace_back(names[i], term.values[i]);
    (void)make_material(term.model, values);
  }
  return changed;
}

}  // namespace lobe
