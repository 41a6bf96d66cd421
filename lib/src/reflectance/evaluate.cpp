#include "lobe/reflectance/evaluate.hpp"

#include <cmath>
#include <numbers>

#include "core/text.hpp"
#include "lobe/core/error.hpp"
#include "lobe/reflectance/adjusted.hpp"
#include "model/delta.hpp"
#include "model/evaluate.hpp"
#include "table/evaluate.hpp"

namespace lobe {
namespace {

using Eigen::Index;

BrdfValues values_of(const BrdfTable& table, std::span<const Directions> directions) {
  const auto channels = evaluate(table, directions);
  BrdfValues values;
  values.value.resize(static_cast<Index>(directions.size()), static_cast<Index>(channels.size()));
  values.error.resizeLike(values.value);
  for (Index c = 0; c < values.value.cols(); ++c) {
    for (Index i = 0; i < values.value.rows(); ++i) {
      const Estimate& found = channels[static_cast<std::size_t>(c)][static_cast<std::size_t>(i)];
      values.value(i, c) = found.value;
      values.error(i, c) = found.error;
    }
  }
  return values;
}

/// As evaluating formulas and tables does.
void require_in_range(const Directions& pair) {
  const auto in_hemisphere = [](double theta) { return theta >= 0 && theta <= std::numbers::pi / 2; };
  if (in_hemisphere(pair.theta_in) && in_hemisphere(pair.theta_out) && std::isfinite(pair.delta_phi) &&
      std::isfinite(pair.phi_in)) {
    return;
  }
  throw ArgumentError("directions (" + shortest(pair.theta_in) + ", " + shortest(pair.theta_out) + ", " +
                      shortest(pair.delta_phi) + ") rad; expected both theta in [0, pi/2] and finite azimuths");
}

}  // namespace

BrdfValues evaluate(const Device& device, const Reflectance& reflectance, std::span<const Directions> directions,
                    const EvaluateOptions& options) {
  if (const BrdfFunction* function = reflectance.function()) {
    for (const Directions& pair : directions) require_in_range(pair);
    return function->at(directions);
  }
  if (const BrdfTable* table = reflectance.table()) return values_of(*table, directions);
  const Reflectance prepared = adjusted(device, reflectance);
  return {evaluate(device, smooth_part(*prepared.formula()), directions, options.precision), {}};
}

std::vector<std::vector<Estimate>> estimates(const BrdfValues& values) {
  std::vector<std::vector<Estimate>> channels;
  for (Index c = 0; c < values.value.cols(); ++c) {
    channels.emplace_back();
    for (Index i = 0; i < values.value.rows(); ++i) {
      channels.back().push_back({values.value(i, c), values.error.size() == 0 ? 0 : values.error(i, c)});
    }
  }
  return channels;
}

}  // namespace lobe
