#include "fit/fit_space.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "core/numbers.hpp"
#include "core/text.hpp"
#include "lobe/core/error.hpp"

namespace lobe {
namespace {

void require_in_range(const FitRange& range, const Parameter& parameter) {
  if (range.minimum < range.maximum && range.minimum >= parameter.minimum && range.maximum <= parameter.maximum) return;
  throw ArgumentError("range " + shortest(range.minimum) + ":" + shortest(range.maximum) + " of '" + range.label +
                      "' is no part of its own; expected a part of " + shortest(parameter.minimum) + ":" +
                      shortest(parameter.maximum));
}

}  // namespace

SearchScale SearchScale::of(double minimum, double maximum) {
  constexpr double kDecades = 100;
  constexpr double kLongRange = 20;
  if (minimum > 0 && maximum / minimum >= kDecades) return {true, 0};
  if (maximum - minimum > kLongRange) return {true, 1 - minimum};
  return {};
}

double SearchScale::coordinate(double value) const {
  return is_logarithmic ? std::log(value + offset) : value;
}

double SearchScale::value(double coordinate) const {
  return is_logarithmic ? std::exp(coordinate) - offset : coordinate;
}

double SearchScale::slope(double coordinate) const {
  return is_logarithmic ? std::exp(coordinate) : 1;
}

FitSpace::FitSpace(const Family& family, std::size_t channels, std::span<const FitRange> ranges)
    : family_(family), channels_(channels) {
  const std::size_t terms = family_.terms.size();
  for (std::size_t k = 0; k < terms; ++k) {
    const std::vector<double>& weight = family_.terms[k].weight;
    if (!family_.has_free_scale[k] && weight.size() != 1 && weight.size() != channels) {
      throw ArgumentError("family '" + family_.name + "' has a scale of " + std::to_string(weight.size()) +
                          " channels and the target " + std::to_string(channels) + "; expected as many, or one number");
    }
    for (std::size_t c = 0; family_.has_free_scale[k] && c < channels; ++c) {
      Axis axis{.label = terms == 1 ? "scale" : std::to_string(k + 1) + ".scale",
                .is_scale = true,
                .term = k,
                .index = c,
                .maximum = kInfinity};
      if (channels > 1) axis.channel = c;
      axes_.push_back(std::move(axis));
    }
  }
  scales_ = axes_.size();
  for (std::size_t i = 0; i < family_.parameters.size(); ++i) {
    const FreeParameter& parameter = family_.parameters[i];
    axes_.push_back({.label = parameter.label,
                     .term = parameter.term,
                     .index = i,
                     .minimum = parameter.range.minimum,
                     .maximum = parameter.range.maximum,
                     .scale = SearchScale::of(parameter.range.minimum, parameter.range.maximum)});
  }
  for (const FitRange& range : ranges) {
    Axis& axis = axes_[find_parameter(range.label)];
    require_in_range(range, family_.parameters[axis.index].range);
    axis.minimum = range.minimum;
    axis.maximum = range.maximum;
  }
  for (std::size_t j = scales_; j < axes_.size(); ++j) axes_[j].unit = std::min(1.0, upper(j) - lower(j));
}

double FitSpace::lower(std::size_t j) const {
  return axes_[j].scale.coordinate(axes_[j].minimum);
}

double FitSpace::upper(std::size_t j) const {
  return axes_[j].scale.coordinate(axes_[j].maximum);
}

std::size_t FitSpace::find_parameter(std::string_view label) const {
  std::vector<std::string_view> known;
  for (std::size_t j = scales_; j < axes_.size(); ++j) {
    if (axes_[j].label == label) return j;
    known.push_back(axes_[j].label);
  }
  const std::string message = "family '" + family_.name + "' has no free parameter '" + std::string(label) + "'";
  throw ArgumentError(known.empty() ? message + "; it has none" : message + did_you_mean(label, known));
}

Term FitSpace::term_with(std::size_t k, std::span<const double> parameters) const {
  Term term = family_.terms[k];
  for (std::size_t i = 0; i < family_.parameters.size(); ++i) {
    const FreeParameter& parameter = family_.parameters[i];
    if (parameter.term != k) continue;
    std::vector<double>& values = parameter.factor ? term.factors[*parameter.factor].values : term.values;
    values[parameter.index] = parameters[i];
  }
  return term;
}

Material FitSpace::member(std::size_t term, std::span<const double> parameters) const {
  Term alone = term_with(term, parameters);
  alone.weight = {1.0};
  return {alone.model, "fit", {std::move(alone)}};
}

Material FitSpace::material(const Eigen::VectorXd& x) const {
  const std::vector<double> parameters = parameter_values(x);
  Material sum{"fit of " + family_.name, "fit", {}};
  for (std::size_t k = 0; k < family_.terms.size(); ++k) {
    sum.terms.push_back(term_with(k, parameters));
    if (family_.has_free_scale[k]) sum.terms.back().weight.assign(channels_, 0.0);
  }
  for (std::size_t j = 0; j < scales_; ++j) {
    sum.terms[axes_[j].term].weight[axes_[j].index] = x(static_cast<Eigen::Index>(j));
  }
  return sum;
}

std::vector<double> FitSpace::parameter_values(const Eigen::VectorXd& x) const {
  std::vector<double> values;
  for (std::size_t j = scales_; j < size(); ++j) {
    // The logarithm of a bound may lie an ulp beyond it.
    values.push_back(std::clamp(value(j, x(static_cast<Eigen::Index>(j))), axes_[j].minimum, axes_[j].maximum));
  }
  return values;
}

Eigen::VectorXd FitSpace::point(const Eigen::MatrixXd& scales, std::span<const double> parameters) const {
  Eigen::VectorXd x(static_cast<Eigen::Index>(size()));
  for (std::size_t j = 0; j < size(); ++j) {
    const Axis& axis = axes_[j];
    x(static_cast<Eigen::Index>(j)) =
        axis.is_scale ? scales(static_cast<Eigen::Index>(axis.term), static_cast<Eigen::Index>(axis.index))
                      : axis.scale.coordinate(parameters[axis.index]);
  }
  return x;
}

std::vector<std::size_t> FitSpace::parameters_of(std::size_t term) const {
  std::vector<std::size_t> numbers;
  for (std::size_t i = 0; i < family_.parameters.size(); ++i) {
    if (family_.parameters[i].term == term) numbers.push_back(i);
  }
  return numbers;
}

}  // namespace lobe
