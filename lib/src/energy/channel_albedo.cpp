#include "energy/channel_albedo.hpp"

#include <fmt/format.h>

#include "core/text.hpp"
#include "energy/albedo.hpp"
#include "hemisphere/albedo_curve.hpp"
#include "lobe/core/error.hpp"
#include "model/traits.hpp"

namespace lobe {
namespace {

constexpr double kChannelPrecise = 5e-7;  // wanted of albedos
constexpr double kChannelEnough = 1e-6;   // of what curves leave out

}  // namespace

std::vector<double> albedo_curve(const Device& device, const Material& material, std::string_view what) {
  const auto values_at = [&](std::span<const double> angles) {
    const auto albedos =
        albedo(device, material, angles, {.tolerance = kChannelPrecise, .missed = refuse_missed_tolerance}).front();
    std::vector<double> values;
    for (const Estimate& estimate : albedos) {
      if (!(estimate.value > 0)) {
        throw NumericError(fmt::format("'{}' cannot be {}: its albedo is {} somewhere; expected values above 0",
                                       material.name, what, shortest(estimate.value)));
      }
      values.push_back(estimate.value);
    }
    return values;
  };
  auto [curve, remainder] = fit_curve(values_at, kChannelEnough);
  if (remainder > kChannelEnough) {
    throw NumericError(fmt::format(
        "'{}' cannot be {}: its albedo, which is not smooth, becomes a curve of a relative error of {}; expected {}",
        material.name, what, shortest(remainder), shortest(kChannelEnough)));
  }
  return curve;
}

Material channel_of(const Material& material, std::size_t channel) {
  Material one{material.name, material.family, {}};
  for (const Term& term : material.terms) {
    const double weight = term.weight[term.weight.size() == 1 ? 0 : channel];
    if (weight == 0) continue;
    one.terms.push_back(term);
    one.terms.back().weight = {weight};
  }
  return one;
}

void require_isotropic(const Material& material, std::string_view what) {
  for (const Term& term : material.terms) {
    if (!traits_of(term).isotropic) refuse_anisotropic(material.name, term.model, what);
  }
}

}  // namespace lobe
