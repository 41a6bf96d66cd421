#include <algorithm>
#include <cmath>
#include <numbers>

#include "lobe/energy.hpp"
#include "lobe/error.hpp"

namespace lobe {
namespace {

constexpr std::size_t kFirstAngles = 91;  // a degree apart over the quarter circle
constexpr std::size_t kAngles = 9;        // of every refinement
constexpr int kRefinements = 3;

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

/// Searches between the neighbours of the highest of some angles, again and again. At a smooth maximum the last
/// refinement changes the value by sixteen times what is still missing.
AlbedoPeak refined(const Device& device, const Material& material, std::size_t channel, std::vector<double> angles,
                   std::vector<Estimate> albedos, const AlbedoOptions& options) {
  double change = 0;
  AlbedoPeak peak;
  for (int step = 0;; ++step) {
    const std::size_t at = highest(albedos);
    const double value = std::abs(albedos[at].value);
    change = step == 0 ? 0 : std::abs(value - peak.albedo.value);
    peak = {{value, albedos[at].error}, angles[at]};
    if (step == kRefinements) break;
    angles = equally_spaced(angles[at == 0 ? 0 : at - 1], angles[std::min(at + 1, angles.size() - 1)], kAngles);
    albedos = albedo(device, material, angles, options)[channel];
  }
  peak.albedo.error += change;
  return peak;
}

}  // namespace

std::vector<AlbedoPeak> largest_albedo(const Device& device, const Material& material, double theta_max,
                                       const AlbedoOptions& options) {
  if (!(theta_max > 0 && theta_max < std::numbers::pi / 2)) {
    throw ArgumentError(
        "the largest angle of a search for the largest albedo is out of range; expected a value in "
        "(0, pi/2) rad");
  }
  const auto angles = equally_spaced(0, theta_max, kFirstAngles);
  const auto albedos = albedo(device, material, angles, options);
  std::vector<AlbedoPeak> peaks;
  for (std::size_t channel = 0; channel < albedos.size(); ++channel) {
    peaks.push_back(refined(device, material, channel, angles, albedos[channel], options));
  }
  return peaks;
}

}  // namespace lobe
