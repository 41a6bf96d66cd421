#include "lobe/study/material_curves.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <span>
#include <utility>

#include "energy/adaptive_albedo.hpp"
#include "lobe/core/directions.hpp"
#include "lobe/core/error.hpp"
#include "lobe/energy/albedo.hpp"
#include "lobe/reflectance/adjusted.hpp"
#include "lobe/reflectance/evaluate.hpp"
#include "model/values.hpp"

namespace lobe {
namespace {

using std::numbers::pi;

constexpr double kLobeWidth = 0.02;  // of functions, radians: curves are for the eye, and errors say what it costs

/// Rounding of models in double precision: a few hundred times what their files state.
constexpr double kRounding = 1e-12;

using Reflectances = std::vector<std::vector<std::vector<Estimate>>>;

std::vector<Directions> pairs_of(const CurveAngles& angles) {
  std::vector<Directions> pairs;
  for (const double in : angles.theta_in) {
    for (const double out : angles.theta_out) pairs.push_back({in, std::abs(out), out < 0 ? 0 : pi});
  }
  return pairs;
}

/// By channel and angles.
/// \param at (pair, channel) -> Estimate, for pairs as those of pairs_of()
template <typename At>
Reflectances by_angles(const CurveAngles& angles, std::size_t channels, const At& at) {
  Reflectances reflectances(channels);
  for (std::size_t c = 0; c < channels; ++c) {
    std::size_t pair = 0;
    for (std::size_t i = 0; i < angles.theta_in.size(); ++i) {
      auto& slice = reflectances[c].emplace_back();
      for (std::size_t o = 0; o < angles.theta_out.size(); ++o) slice.push_back(at(pair++, c));
    }
  }
  return reflectances;
}

Estimate entry(const BrdfValues& values, std::size_t pair, std::size_t channel) {
  const auto i = static_cast<Eigen::Index>(pair);
  const auto c = static_cast<Eigen::Index>(channel);
  const double value = values.value(i, c);
  return {value, values.error.size() > 0 ? values.error(i, c) : kRounding * std::abs(value)};
}

std::vector<std::vector<Estimate>> albedos_of(const Device& device, const Material& material,
                                              std::span<const double> theta) {
  constexpr std::size_t kMostNodes = 100'000;  // of each; the errors say what that leaves
  constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();
  std::vector<IncidentNode> incident;
  for (const double angle : theta) incident.push_back({pi / 2 - angle, 1, 0});
  AdaptiveAlbedo integral(device, material, Precision::double_precision);
  const auto outcomes = integral.within(incident, kCurveAlbedoTolerance, kMostNodes);
  std::vector<std::vector<Estimate>> albedos(material.channels(), std::vector<Estimate>(theta.size(), {kNaN, kNaN}));
  if (!std::ranges::all_of(outcomes, &AlbedoOutcome::is_finite)) return albedos;
  for (std::size_t k = 0; k < theta.size(); ++k) {
    for (std::size_t c = 0; c < albedos.size(); ++c) albedos[c][k] = outcomes[k].values[c];
  }
  return albedos;
}

MaterialCurves curves_of(const Device& device, const Material& material, const CurveAngles& angles) {
  MaterialCurves curves;
  curves.albedo = albedos_of(device, material, angles.theta);
  Material smooth = material;
  curves.has_delta = std::erase_if(smooth.terms, [](const Term& term) { return traits_of(term).has_delta; }) > 0;
  const auto pairs = pairs_of(angles);
  BrdfValues values{
      Eigen::MatrixXd::Zero(static_cast<Eigen::Index>(pairs.size()), static_cast<Eigen::Index>(material.channels())),
      {}};
  // The smooth part may have fewer channels, in which case one serves all.
  if (!smooth.terms.empty()) values.value = unchecked_values(device, smooth, pairs);
  const auto known = static_cast<std::size_t>(values.value.cols());
  curves.reflectance = by_angles(angles, material.channels(), [&](std::size_t pair, std::size_t channel) {
    return entry(values, pair, std::min(channel, known - 1));
  });
  return curves;
}

}  // namespace

CurveAngles CurveAngles::usual() {
  CurveAngles angles;
  for (int degree = 0; degree <= 80; degree += 10) angles.theta.push_back(degree * kDegree);
  for (const int degree : {85, 88, 89}) angles.theta.push_back(degree * kDegree);
  for (const int degree : {20, 45, 70}) angles.theta_in.push_back(degree * kDegree);
  for (int degree = -89; degree <= 89; ++degree) angles.theta_out.push_back(degree * kDegree);
  return angles;
}

MaterialCurves material_curves(const Device& device, const Reflectance& reflectance, const CurveAngles& angles) {
  if (reflectance.formula() != nullptr) {
    return curves_of(device, *adjusted(device, reflectance).formula(), angles);
  }
  MaterialCurves curves;
  curves.albedo = albedo(device, reflectance, angles.theta, {.lobe_width = kLobeWidth});
  const BrdfValues values = evaluate(device, reflectance, pairs_of(angles));
  curves.reflectance = by_angles(angles, reflectance.channels(),
                                 [&](std::size_t pair, std::size_t channel) { return entry(values, pair, channel); });
  curves.has_delta = reflectance.has_delta();
  return curves;
}

}  // namespace lobe
