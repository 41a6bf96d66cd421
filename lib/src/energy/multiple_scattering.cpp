#include "energy/multiple_scattering.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <span>
#include <string_view>
#include <utility>
#include <vector>

#include "core/text.hpp"
#include "energy/albedo.hpp"
#include "energy/channel_albedo.hpp"
#include "hemisphere/albedo_curve.hpp"
#include "hemisphere/gauss.hpp"
#include "lobe/core/directions.hpp"
#include "lobe/core/error.hpp"
#include "model/catalogue.hpp"
#include "model/factors.hpp"
#include "model/family/parameters.hpp"
#include "model/traits.hpp"

namespace lobe {
namespace {

// Ways to give back what facets scatter more than once, by their authors.
constexpr std::string_view kKullaConty = "Kulla and Conty";
constexpr std::string_view kTurquin = "Turquin";

[[noreturn]] void refuse(const Material& material, std::string_view by, std::string_view why) {
  throw ArgumentError(fmt::format("'{}' has no multiple scattering after {}: {}", material.name, by, why));
}

/// Whether a model's parameter is f0 of Schlick's approximation on L.H.
bool is_normal_reflectance(const Parameter& parameter) {
  const Parameter schlick = normal_reflectance();
  return parameter.name == schlick.name && parameter.description == schlick.description;
}

/// Integral of a function over a panel that is halved until it is smooth enough.
template <typename Function>
double integral(const Function& f, double low, double high, int depth) {
  constexpr double kTolerance = 1e-13;
  const KronrodRule& rule = kronrod_rule();
  double fine = 0;
  double coarse = 0;
  for (std::size_t i = 0; i < KronrodRule::kNodes; ++i) {
    const double value = f(low + (high - low) * rule.nodes[i]) * (high - low);
    fine += rule.weights[i] * value;
    coarse += rule.coarse_weights[i] * value;
  }
  if (depth == 0 || std::abs(fine - coarse) <= kTolerance) return fine;
  const double middle = (low + high) / 2;
  return integral(f, low, middle, depth - 1) + integral(f, middle, high, depth - 1);
}

/// Mean of a Fresnel term over cos(theta) dmu / pi.
double mean_fresnel(const FactorEntry& entry, const std::vector<double>& values) {
  constexpr int kHalvings = 40;
  return integral([&](double cosine) { return 2 * cosine * entry.fresnel(values, cosine); }, 0, 1, kHalvings);
}

/// A term of weight 1 that reflects all light at its facets, and the mean of its Fresnel term over cos(theta) dmu / pi
/// and at the normal.
struct WhiteFacets {
  Term term;
  double mean_fresnel = 1;
  double normal_fresnel = 1;
};

WhiteFacets white_facets(const Material& material, const Term& term, std::string_view by) {
  constexpr double kSchlickMean = 1.0 / 21;  // of (1 - x)^5, twice its integral with x
  WhiteFacets white{term};
  white.term.weight = {1.0};
  if (term.pumping) refuse(material, by, "it is pumped up; expected one or the other");
  const FactorEntry* fresnel = term.factors.size() == 1 ? &find_factor_entry(term.factors.front().name) : nullptr;
  if (fresnel != nullptr && fresnel->fresnel == nullptr) fresnel = nullptr;
  if (fresnel != nullptr) {
    white.mean_fresnel = mean_fresnel(*fresnel, term.factors.front().values);
    white.normal_fresnel = fresnel->fresnel(term.factors.front().values, 1);
    white.term.factors.clear();
  }
  if (term.formula) return white;
  if (fresnel == nullptr && !term.factors.empty()) {
    refuse(material, by, "it has factors; expected a model alone, or times a Fresnel term, fresnel or f82");
  }
  const auto& parameters = find_entry(term.model).model.parameters;
  for (std::size_t k = 0; k < parameters.size(); ++k) {
    if (parameters[k].name == "ior")
      refuse(material, by, "its Fresnel term is not Schlick's; expected a model with f0");
    if (!is_normal_reflectance(parameters[k])) continue;
    if (fresnel != nullptr) {
      if (term.values[k] < 1) refuse(material, by, "it has two Fresnel terms; expected f0 = 1 beside the factor");
      continue;
    }
    white.mean_fresnel = term.values[k] + (1 - term.values[k]) * kSchlickMean;
    white.normal_fresnel = term.values[k];
    white.term.values[k] = 1;
  }
  return white;
}

/// A material of one model that reflects all light at its facets.
struct WhiteChannel {
  WhiteFacets facets;
  Material material;
  std::vector<double> albedo;  ///< a curve
};

/// \param one a material of one channel
WhiteChannel white_channel(const Device& device, const Material& material, const Material& one, std::string_view by) {
  if (one.terms.size() > 1) refuse(material, by, "it is a sum; expected one model, before it is added to others");
  WhiteChannel white{white_facets(material, one.terms.front(), by), {material.name, material.family, {}}, {}};
  white.material.terms = {white.facets.term};
  white.albedo = albedo_curve(device, white.material, "given its multiple scattering");
  for (const double theta : curve_angles(white.albedo)) {
    const double value = curve_value(white.albedo, std::cos(theta));
    if (value <= 1 + kAdjustmentError) continue;
    throw NumericError(fmt::format(
        "'{}' loses no light by multiple scattering: its albedo is {} at {} degrees; "
        "expected at most 1",
        material.name, shortest(std::round(value * 1e4) / 1e4), shortest(std::round(to_degrees(theta) * 1e4) / 1e4)));
  }
  return white;
}

/// a / (a + F (1 - a)) for an albedo that is a curve.
std::vector<double> share_of_single_scattering(const std::vector<double>& albedo, double fresnel) {
  constexpr double kEnough = kAdjustmentError / 2;
  if (fresnel == 1) return albedo;
  const auto values_at = [&](std::span<const double> angles) {
    std::vector<double> values;
    for (const double theta : angles) {
      const double a = curve_value(albedo, std::cos(theta));
      values.push_back(a / (a + fresnel * (1 - a)));
    }
    return values;
  };
  auto [curve, remainder] = fit_curve(values_at, kEnough);
  if (remainder > kEnough) {
    throw NumericError(
        fmt::format("a share of single scattering becomes a curve of a relative error of {}; expected {}",
                    shortest(remainder), shortest(kEnough)));
  }
  return curve;
}

}  // namespace

Material with_multiple_scattering(const Device& device, const Material& material) {
  constexpr double kNothing = 1e-5;  // a loss that errors of the albedo may cause
  require_isotropic(material, "the adjustment 'kulla_conty'");
  const std::size_t channels = material.channels();
  Material result = material;
  for (std::size_t channel = 0; channel < channels; ++channel) {
    const Material one = channel_of(material, channel);
    if (one.terms.empty()) continue;
    WhiteChannel white = white_channel(device, material, one, kKullaConty);
    const double mean =
        mean_albedo(device, white.material, {.tolerance = kAdjustmentError / 4, .missed = refuse_missed_tolerance})
            .front()
            .value;
    if (1 - mean < kNothing) continue;
    const double fresnel = white.facets.mean_fresnel;
    Term later = make_material("lambert").terms.front();
    later.pumping = Pumping{Correction::complement, {std::move(white.albedo)}};
    const double weight =
        one.terms.front().weight.front() * fresnel * fresnel * mean / ((1 - fresnel * (1 - mean)) * (1 - mean));
    later.weight.assign(channels, 0.0);
    later.weight[channel] = weight;
    result.terms.push_back(std::move(later));
  }
  return result;
}

Material scaled_for_viewers(const Device& device, const Material& material) {
  require_isotropic(material, "the adjustment 'turquin'");
  if (!is_reciprocal(material)) refuse(material, kTurquin, "it is not reciprocal; expected a model that is");
  const std::size_t channels = material.channels();
  Material result{material.name, material.family, {}};
  for (std::size_t channel = 0; channel < channels; ++channel) {
    const Material one = channel_of(material, channel);
    if (one.terms.empty()) continue;
    const WhiteChannel white = white_channel(device, material, one, kTurquin);
    Term scaled = one.terms.front();
    scaled.pumping =
        Pumping{Correction::viewer, {share_of_single_scattering(white.albedo, white.facets.normal_fresnel)}};
    const double weight = scaled.weight.front();
    scaled.weight.assign(channels, 0.0);
    scaled.weight[channel] = weight;
    result.terms.push_back(std::move(scaled));
  }
  if (result.terms.empty()) refuse(material, kTurquin, "it is black; expected a model that reflects");
  return result;
}

}  // namespace lobe
