#include "energy/pumping.hpp"

#include <string>
#include <vector>

#include "core/text.hpp"
#include "hemisphere/albedo_curve.hpp"
#include "lobe/energy.hpp"
#include "lobe/error.hpp"
#include "model/traits.hpp"

namespace lobe {
namespace {

constexpr double kPrecise = 5e-7;  // wanted of albedos
constexpr double kEnough = 1e-6;   // of what curves leave out

/// The albedo of a material of one channel as a curve.
std::vector<double> albedo_curve(const Device& device, const Material& material) {
  const auto albedos = albedo(device, material, curve_angles(), {.tolerance = kPrecise}).front();
  std::vector<double> values;
  for (const Estimate& estimate : albedos) {
    if (!(estimate.value > 0)) {
      throw NumericError("'" + material.name + "' cannot be pumped up: its albedo is " + shortest(estimate.value) +
                         " somewhere; expected values above 0");
    }
    values.push_back(estimate.value);
  }
  auto curve = curve_through(values);
  const double remainder = curve_remainder(curve, values);
  if (remainder > kEnough) {
    throw NumericError("'" + material.name +
                       "' cannot be pumped up: its albedo, which is not smooth, becomes a curve of "
                       "a relative error of " +
                       shortest(remainder) + "; expected " + shortest(kEnough));
  }
  return curve;
}

/// One channel of a material; terms without weight in it are left out.
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

void require_pumpable(const Material& material, Correction correction) {
  for (const Term& term : material.terms) {
    const Traits traits = traits_of(term);
    if (!traits.isotropic) refuse_anisotropic(material.name, term.model);
    if (traits.has_delta) {
      throw NumericError("'" + material.name + "' cannot be pumped up: it contains the delta part '" + term.model +
                         "'; expected values in sr^-1");
    }
    if (term.pumping && term.pumping->correction != correction) {
      throw NumericError("'" + material.name + "' was pumped up by " +
                         std::string(to_string(term.pumping->correction)) + "; expected the same correction again");
    }
  }
}

}  // namespace

Material pumped(const Device& device, const Material& material, const Adjustment& adjustment) {
  require_pumpable(material, adjustment.correction);
  const std::size_t channels = material.channels();
  Material result{material.name, material.family, {}};
  for (std::size_t channel = 0; channel < channels; ++channel) {
    Material one = channel_of(material, channel);
    for (int step = 0; step < adjustment.times && !one.terms.empty(); ++step) {
      const auto curve = albedo_curve(device, one);
      for (Term& term : one.terms) {
        if (!term.pumping) term.pumping = Pumping{adjustment.correction, {}};
        term.pumping->albedos.push_back(curve);
      }
    }
    for (Term& term : one.terms) {
      const double weight = term.weight.front();
      if (channels > 1) {
        term.weight.assign(channels, 0.0);
        term.weight[channel] = weight;
      }
      result.terms.push_back(std::move(term));
    }
  }
  if (result.terms.empty()) throw NumericError("'" + material.name + "' cannot be pumped up: its albedo is 0");
  return result;
}

}  // namespace lobe
