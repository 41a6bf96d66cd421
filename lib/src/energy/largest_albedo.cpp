#include <algorithm>
#include <cmath>
#include <functional>
#include <numbers>

#include "energy/albedo.hpp"
#include "energy/function_bound.hpp"
#include "energy/known_as.hpp"
#include "lobe/core/error.hpp"
#include "lobe/model/model.hpp"
#include "model/traits.hpp"

namespace lobe {
namespace {

constexpr std::size_t kFirstAngles = 91;  // a degree apart over the quarter circle
constexpr std::size_t kAngles = 9;        // of every refinement
constexpr int kRefinements = 3;
constexpr double kRough = 1e-3;  // relative error of albedos that only tell where to look

std::vector<double> equally_spaced(double from, double to, std::size_t count) {
  std::vector<double> angles(count);
  for (std::size_t i = 0; i < count; ++i) {
    angles[i] = from + (to - from) * static_cast<double>(i) / static_cast<double>(count - 1);
  }
  return angles;
}

/// Place of the largest absolute value.
std::size_t highest(const std::vector<Estimate>& albedos) {
  const auto found = std::ranges::max_element(albedos, {}, [](const Estimate& a) { return std::abs(a.value); });
  return static_cast<std::size_t>(found - albedos.begin());
}

/// Albedos at angles of incidence, [channel][angle].
using AlbedosAt =
    std::function<std::vector<std::vector<Estimate>>(std::span<const double> angles, const AlbedoOptions& options)>;

/// The albedos at some angles, roughly but where the largest one of a channel may be.
std::vector<std::vector<Estimate>> first_albedos(const AlbedosAt& albedos_at, const std::vector<double>& angles,
                                                 const AlbedoOptions& options) {
  AlbedoOptions rough = options;
  rough.tolerance = std::max(options.tolerance, kRough);
  rough.missed = {};
  auto albedos = albedos_at(angles, rough);
  std::vector<std::size_t> candidates;
  for (std::size_t k = 0; k < angles.size(); ++k) {
    const auto may_be_largest = [&](const std::vector<Estimate>& channel) {
      const Estimate& top = channel[highest(channel)];
      return std::abs(channel[k].value) + channel[k].error >= std::abs(top.value) - top.error;
    };
    if (std::ranges::any_of(albedos, may_be_largest)) candidates.push_back(k);
  }
  std::vector<double> places;
  for (const auto k : candidates) places.push_back(angles[k]);
  const auto precise = albedos_at(places, options);
  for (std::size_t c = 0; c < albedos.size(); ++c) {
    for (std::size_t i = 0; i < candidates.size(); ++i) albedos[c][candidates[i]] = precise[c][i];
  }
  return albedos;
}

/// Searches between the neighbours of the highest of some angles, again and again. At a smooth maximum the last
/// refinement changes the value by sixteen times what is still missing; an albedo that is less certain may be larger.
AlbedoPeak refined(const AlbedosAt& albedos_at, std::size_t channel, std::vector<double> angles,
                   std::vector<Estimate> albedos, const AlbedoOptions& options) {
  double change = 0;
  double upper = 0;
  AlbedoPeak peak;
  for (int step = 0;; ++step) {
    const std::size_t at = highest(albedos);
    const double value = std::abs(albedos[at].value);
    for (const Estimate& albedo : albedos) upper = std::max(upper, std::abs(albedo.value) + albedo.error);
    change = step == 0 ? 0 : std::abs(value - peak.albedo.value);
    peak = {{value, albedos[at].error}, angles[at]};
    if (step == kRefinements) break;
    angles = equally_spaced(angles[at == 0 ? 0 : at - 1], angles[std::min(at + 1, angles.size() - 1)], kAngles);
    albedos = albedos_at(angles, options)[channel];
  }
  peak.albedo.error = std::max(peak.albedo.error, upper - peak.albedo.value) + change;
  return peak;
}

std::vector<AlbedoPeak> largest_of(const AlbedosAt& albedos_at, double theta_max, const AlbedoOptions& options) {
  const auto angles = equally_spaced(0, theta_max, kFirstAngles);
  const auto albedos = first_albedos(albedos_at, angles, options);
  std::vector<AlbedoPeak> peaks;
  for (std::size_t channel = 0; channel < albedos.size(); ++channel) {
    peaks.push_back(refined(albedos_at, channel, angles, albedos[channel], options));
  }
  return peaks;
}

std::vector<AlbedoPeak> largest_of(const BrdfFunction& function, double theta_max, const AlbedoOptions& options) {
  const FunctionBounds bounds = albedo_bounds(
      function,
      {.least_elevation = std::numbers::pi / 2 - theta_max, .lobe_width = options.lobe_width, .of_absolute = true});
  std::vector<AlbedoPeak> peaks;
  for (const AlbedoBound& bound : bounds.channels) peaks.push_back({bound.largest, bound.at.theta});
  return peaks;
}

void require_in_range(double theta_max) {
  if (theta_max > 0 && theta_max < std::numbers::pi / 2) return;
  throw ArgumentError(
      "the largest angle of a search for the largest albedo is out of range; expected a value in "
      "(0, pi/2) rad");
}

}  // namespace

std::vector<AlbedoPeak> largest_albedo(const Device& device, const Material& material, double theta_max,
                                       const AlbedoOptions& options) {
  require_in_range(theta_max);
  for (const Term& term : material.terms) {
    if (!traits_of(term).isotropic) {
      refuse_anisotropic(material.name, term.model, "a largest albedo; of others there are albedos by direction");
    }
  }
  return largest_of(
      [&](std::span<const double> angles, const AlbedoOptions& how) { return albedo(device, material, angles, how); },
      theta_max, options);
}

std::vector<AlbedoPeak> largest_albedo(const Device& device, const Reflectance& reflectance, double theta_max,
                                       const AlbedoOptions& options) {
  require_in_range(theta_max);
  if (reflectance.formula() == nullptr && !reflectance.is_isotropic()) {
    throw NumericError("'" + reflectance.name() +
                       "' is anisotropic; expected an isotropic reflectance for its largest albedo");
  }
  return known_as(device, reflectance,
                  Cases{[&](const Material& formula) { return largest_albedo(device, formula, theta_max, options); },
                        [&](const BrdfFunction& function) { return largest_of(function, theta_max, options); },
                        [&](const BrdfTable&) {
                          return largest_of(
                              [&](std::span<const double> angles, const AlbedoOptions& how) {
                                return albedo(device, reflectance, angles, how);
                              },
                              theta_max, options);
                        }});
}

}  // namespace lobe
