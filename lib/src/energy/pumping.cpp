#include "energy/pumping.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <string>
#include <utility>
#include <vector>

#include "core/text.hpp"
#include "energy/albedo.hpp"
#include "energy/channel_albedo.hpp"
#include "energy/prepare.hpp"
#include "energy/repair.hpp"
#include "energy/repair_checks.hpp"
#include "hemisphere/albedo_curve.hpp"
#include "lobe/core/error.hpp"
#include "model/delta.hpp"
#include "model/evaluate.hpp"
#include "model/traits.hpp"
#include "model/values.hpp"

namespace lobe {
namespace {

constexpr int kPumpSteps = 10;  // that a material keeps

void require_pumpable(const Material& material, Correction correction) {
  require_isotropic(material, "the adjustment 'pump'; of others, tables can be pumped up");
  for (const Term& term : material.terms) {
    if (term.pumping && term.pumping->correction != correction) {
      throw NumericError("'" + material.name + "' was pumped up by " +
                         std::string(to_string(term.pumping->correction)) + "; expected the same correction again");
    }
  }
}

/// The largest change of an albedo by the last step but one.
double last_change(const Material& material) {
  double change = 0;
  for (const Term& term : material.terms) {
    const auto& albedos = term.pumping->albedos;
    for (const double angle : curve_angles(albedos.back())) {
      const double cosine = std::cos(angle);
      change = std::max(
          change, std::abs(curve_value(albedos.back(), cosine) - curve_value(albedos[albedos.size() - 2], cosine)));
    }
  }
  return change;
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

PumpedMaterial pump(const Device& device, const Material& material, Correction correction, const PumpOptions& options) {
  require_valid(options);
  if (options.times.value_or(1) > kPumpSteps) {
    throw ArgumentError(
        fmt::format("pumping-up a material {} times; expected at most {}, or a table", *options.times, kPumpSteps));
  }
  const Adjustment once{Adjustment::Kind::pump, correction, 1};
  PumpedMaterial result{{prepare(device, material)}, false, {}};
  // One step more than wanted: it begins with the albedos after the last one.
  const int limit = options.times.value_or(std::min(options.limit, kPumpSteps)) + (options.times ? 0 : 1);
  for (int k = 0; k < limit; ++k) {
    if (options.progress && !options.progress("pumping up", static_cast<double>(k) / limit)) {
      throw Cancelled("cancelled");
    }
    try {
      result.steps.push_back(pumped(device, result.steps.back(), once));
    } catch (const NumericError& error) {
      if (options.times || k == 0) throw;
      result.obstacle = error.what();
      return result;
    }
    if (options.times || k == 0 || last_change(result.steps.back()) > options.tolerance) continue;
    result.is_converged = true;
    break;
  }
  if (!options.times) {
    result.steps.pop_back();
    if (!result.is_converged) result.obstacle = std::to_string(limit - 1) + " steps did not suffice";
  }
  return result;
}

std::vector<PumpStep> pump_curves(const Device& device, const PumpedMaterial& pumped, std::span<const double> theta_in,
                                  double tolerance) {
  constexpr double kRounding = 1e-12;  // of models in double precision
  std::vector<Directions> mirror;
  for (const double theta : theta_in) mirror.push_back({theta, theta, std::numbers::pi});
  std::vector<PumpStep> steps;
  for (const Material& material : pumped.steps) {
    double relative = 0;
    for (const Term& term : material.terms) {
      if (term.pumping)
        relative = std::max(relative, kAdjustmentError * static_cast<double>(term.pumping->albedos.size()));
    }
    PumpStep step{albedo(device, material, theta_in, {.tolerance = tolerance}), {}};
    for (auto& channel : step.albedo) {
      for (Estimate& value : channel) value.error += relative * std::abs(value.value);
    }
    const Material smooth = split_delta(material).smooth;
    const Eigen::MatrixXd values = smooth.terms.empty()
                                       ? Eigen::MatrixXd::Zero(static_cast<Eigen::Index>(mirror.size()), 1)
                                       : unchecked_values(device, smooth, mirror);
    for (Eigen::Index c = 0; c < values.cols(); ++c) {
      auto& channel = step.mirror_radiance.emplace_back();
      for (std::size_t k = 0; k < theta_in.size(); ++k) {
        const double radiance = values(static_cast<Eigen::Index>(k), c) * std::cos(theta_in[k]);
        channel.push_back({radiance, (relative + kRounding) * std::abs(radiance)});
      }
    }
    steps.push_back(std::move(step));
  }
  return steps;
}

}  // namespace lobe
