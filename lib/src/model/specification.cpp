#include "lobe/model/specification.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <vector>

#include "core/text.hpp"
#include "model/factors.hpp"

namespace lobe {
namespace {

/// ":key=value,...", or nothing where there are no values.
template <typename Name>
std::string values_text(const std::vector<Name>& names, const std::vector<double>& values) {
  std::vector<std::string> parts;
  for (std::size_t i = 0; i < values.size(); ++i) parts.push_back(fmt::format("{}={}", names[i], shortest(values[i])));
  return parts.empty() ? "" : fmt::format(":{}", fmt::join(parts, ","));
}

std::string term_text(const Term& term) {
  std::string text = term.model + values_text(parameter_names(term), term.values);
  std::vector<std::string> weights;
  for (const double weight : term.weight) weights.push_back(shortest(weight));
  const bool is_plain = term.weight.size() == 1 && term.weight.front() == 1;
  if (!is_plain) text += fmt::format("{}scale={}", term.values.empty() ? ":" : ",", fmt::join(weights, "/"));
  for (const Factor& factor : term.factors) {
    std::vector<std::string_view> names;
    for (const auto& parameter : find_factor(factor.name).parameters) names.push_back(parameter.name);
    text += "*" + factor.name + values_text(names, factor.values);
  }
  return text;
}

}  // namespace

std::optional<std::string> specification(const Material& material) {
  const auto cannot_be_written = [](const Term& term) {
    return term.formula || term.pumping || !term.complement_of.empty();
  };
  if (material.terms.empty() || std::ranges::any_of(material.terms, cannot_be_written)) return {};
  std::string text;
  for (const Term& term : material.terms) text += (text.empty() ? "" : "+") + term_text(term);
  for (const Adjustment& adjustment : material.adjustments) text += "@" + to_string(adjustment);
  return text;
}

}  // namespace lobe
