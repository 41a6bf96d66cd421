#include "energy/pumping.hpp"

#include <fmt/format.h>

#include <cmath>
#include <numbers>
#include <string>
#include <utility>
#include <vector>

#include "core/text.hpp"
#include "hemisphere/albedo_curve.hpp"
#include "lobe/energy.hpp"
#include "lobe/error.hpp"
#include "lobe/prepare.hpp"
#include "model/terms.hpp"
#include "model/traits.hpp"

namespace lobe {
namespace {

constexpr double kPrecise = 5e-7;  // wanted of albedos
constexpr double kEnough = 1e-6;   // of what curves leave out

/// The albedo of a material of one channel as a curve. \param what cannot be done without it, for messages
std::vector<double> albedo_curve(const Device& device, const Material& material, std::string_view what) {
  const auto albedos = albedo(device, material, curve_angles(), {.tolerance = kPrecise}).front();
  std::vector<double> values;
  for (const Estimate& estimate : albedos) {
    if (!(estimate.value > 0)) {
      throw NumericError(fmt::format("'{}' cannot be {}: its albedo is {} somewhere; expected values above 0",
                                     material.name, what, shortest(estimate.value)));
    }
    values.push_back(estimate.value);
  }
  auto curve = curve_through(values);
  const double remainder = curve_remainder(curve, values);
  if (remainder > kEnough) {
    throw NumericError(fmt::format(
        "'{}' cannot be {}: its albedo, which is not smooth, becomes a curve of a relative error of {}; expected {}",
        material.name, what, shortest(remainder), shortest(kEnough)));
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

void require_isotropic(const Material& material) {
  for (const Term& term : material.terms) {
    if (!traits_of(term).isotropic) refuse_anisotropic(material.name, term.model);
  }
}

void require_pumpable(const Material& material, Correction correction) {
  require_isotropic(material);
  for (const Term& term : material.terms) {
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
      const auto curve = albedo_curve(device, one, "pumped up");
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

Material extended_by_mirror(const Device& device, const Material& material, const Adjustment& adjustment) {
  require_isotropic(material);
  const std::size_t channels = material.channels();
  const std::vector<Factor> boundary = boundary_of(adjustment);
  Material result = material;
  for (std::size_t channel = 0; channel < channels; ++channel) {
    const Material one = channel_of(material, channel);
    Term mirror = make_material("mirror").terms.front();
    mirror.factors = boundary;
    if (!one.terms.empty()) {
      mirror.complement_of = albedo_curve(device, one, "extended by a mirror");
      for (const double theta : curve_angles()) {
        const double albedo = curve_value(mirror.complement_of, std::cos(theta));
        if (albedo <= 1 + kAdjustmentError) continue;
        throw NumericError(
            fmt::format("'{}' cannot be extended by a mirror: its albedo is {} at {} degrees; expected at most 1, as "
                        "'normalise' makes it",
                        material.name, shortest(std::round(albedo * 1e4) / 1e4),
                        shortest(std::round(theta * 180 / std::numbers::pi * 1e4) / 1e4)));
      }
    }
    if (channels > 1) {
      mirror.weight.assign(channels, 0.0);
      mirror.weight[channel] = 1;
    }
    result.terms.push_back(std::move(mirror));
  }
  return result;
}

}  // namespace lobe
