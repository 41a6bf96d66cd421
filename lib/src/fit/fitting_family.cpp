#include <algorithm>
#include <array>
#include <optional>
#include <span>
#include <utility>

#include "core/text.hpp"
#include "lobe/core/error.hpp"
#include "lobe/fit/fit.hpp"
#include "model/terms.hpp"

namespace lobe {
namespace {

constexpr std::string_view kFree = "free";
constexpr std::string_view kScale = "scale";

/// A value inside a parameter's range that stands in for one to be found.
double stand_in(const Parameter& parameter) {
  return std::clamp(parameter.default_value.value_or(0.5), parameter.minimum, parameter.maximum);
}

/// A model or factor of a specification, with what is left open filled in.
struct Part {
  std::string name;
  std::string text;               ///< NAME:key=value,... for parse_material()
  std::vector<std::size_t> free;  ///< numbers of its open parameters
  bool has_scale = false;
};

/// \param parameters those that model or factor has
/// \param takes_scale whether `scale` is a key
Part complete(std::string_view text, std::span<const Parameter> parameters, bool takes_scale, std::string_view whole) {
  const std::size_t colon = text.find(':');
  Part part{std::string(trim(text.substr(0, colon))), {}, {}, false};
  std::vector<std::string> kept;
  std::vector<std::string_view> given;
  std::vector<std::string_view> open;
  const auto keys =
      colon == std::string_view::npos ? std::vector<std::string_view>{} : split(text.substr(colon + 1), ',');
  for (const std::string_view entry : keys) {
    const std::size_t equals = entry.find('=');
    const std::string_view key = trim(entry.substr(0, equals));
    const std::string_view value = equals == std::string_view::npos ? "" : trim(entry.substr(equals + 1));
    const bool is_scale = takes_scale && key == kScale;
    if (value == kFree) {
      if (is_scale) continue;
      open.push_back(key);
      continue;
    }
    if (!is_scale && value.find('/') != std::string_view::npos) {
      throw ArgumentError("parameter '" + std::string(key) + "' in family '" + std::string(whole) +
                          "' differs by channel; expected one value, as all channels share it");
    }
    part.has_scale = part.has_scale || is_scale;
    given.push_back(key);
    kept.emplace_back(trim(entry));
  }
  for (std::size_t i = 0; i < parameters.size(); ++i) {
    const Parameter& parameter = parameters[i];
    const bool is_open = std::ranges::find(open, parameter.name) != open.end();
    const bool is_given = std::ranges::find(given, parameter.name) != given.end();
    if (is_open ? is_given : is_given || parameter.default_value) continue;
    part.free.push_back(i);
    std::erase(open, parameter.name);
    kept.push_back(std::string(parameter.name) + "=" + shortest(stand_in(parameter)));
  }
  // Unknown names, and parameters both open and given: parse_material() finds the words for these.
  for (const std::string_view key : open) kept.push_back(std::string(key) + "=1");
  part.text = part.name;
  for (std::size_t i = 0; i < kept.size(); ++i) part.text += (i == 0 ? ":" : ",") + kept[i];
  return part;
}

/// Labels as short as they may be: "m", else "2.m", else "2.fresnel.k".
void label(std::vector<FreeParameter>& parameters, const std::vector<Term>& terms) {
  const auto short_name = [](const FreeParameter& parameter) { return std::string(parameter.range.name); };
  const auto name_in_term = [&](const FreeParameter& parameter) {
    return std::to_string(parameter.term + 1) + "." + short_name(parameter);
  };
  const auto whole_name = [&](const FreeParameter& parameter) {
    const Term& term = terms[parameter.term];
    return std::to_string(parameter.term + 1) + "." +
           (parameter.factor ? term.factors[*parameter.factor].name : term.model) + "." + short_name(parameter);
  };
  for (FreeParameter& parameter : parameters) {
    const auto is_unique = [&](const auto& name) {
      return std::ranges::count_if(parameters, [&](const auto& other) { return name(other) == name(parameter); }) == 1;
    };
    parameter.label = is_unique(short_name)     ? short_name(parameter)
                      : is_unique(name_in_term) ? name_in_term(parameter)
                                                : whole_name(parameter);
  }
}

}  // namespace

Family parse_family(std::string_view specification) {
  const std::string_view text = trim(specification);
  if (text.empty()) throw ArgumentError("empty family; expected MODEL[:key=value,...], such as lambert+ward");
  if (text.find('@') != std::string_view::npos) {
    throw ArgumentError("family '" + std::string(text) + "' has an adjustment; expected models and factors only");
  }
  Family family{std::string(text), {}, {}, {}};
  for (const std::string_view whole_term : split_terms(text)) {
    const std::size_t k = family.terms.size();
    std::string completed;
    const auto parts = split(whole_term, '*');
    bool has_scale = false;
    for (std::size_t p = 0; p < parts.size(); ++p) {
      const std::string_view name = trim(parts[p].substr(0, parts[p].find(':')));
      if (p == 0 && name == kCustomModel)
        throw ArgumentError("'custom' has no family; expected models of the catalogue");
      const auto& parameters = p == 0 ? find_model(name).parameters : find_factor(name).parameters;
      const Part part = complete(trim(parts[p]), parameters, p == 0, text);
      completed += (p == 0 ? "" : "*") + part.text;
      has_scale = has_scale || part.has_scale;
      for (const std::size_t i : part.free) {
        FreeParameter parameter{{}, k, std::nullopt, i, parameters[i]};
        if (p > 0) parameter.factor = p - 1;
        family.parameters.push_back(std::move(parameter));
      }
    }
    family.terms.push_back(parse_material(completed).terms.front());
    family.has_free_scale.push_back(!has_scale);
    if (traits_of(family.terms.back()).has_delta) {
      throw ArgumentError("model '" + family.terms.back().model + "' in family '" + std::string(text) +
                          "' is a delta part; expected models with values");
    }
  }
  label(family.parameters, family.terms);
  if (family.parameters.empty() && std::ranges::find(family.has_free_scale, true) == family.has_free_scale.end()) {
    throw ArgumentError("family '" + std::string(text) + "' leaves nothing to find; expected a parameter or a scale " +
                        "without value");
  }
  return family;
}

namespace {

constexpr std::array<std::string_view, 3> kObjectives{"l2", "log", "perceptual"};

}  // namespace

std::string_view to_string(FitObjective objective) {
  return kObjectives.at(static_cast<std::size_t>(objective));
}

FitObjective parse_fit_objective(std::string_view name) {
  const auto found = std::ranges::find(kObjectives, name);
  if (found != kObjectives.end()) return static_cast<FitObjective>(found - kObjectives.begin());
  throw ArgumentError("unknown objective '" + std::string(name) + "'" + did_you_mean(name, kObjectives));
}

}  // namespace lobe
