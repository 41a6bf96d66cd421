#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <optional>
#include <span>
#include <vector>

#include "device/evaluate_lobes.hpp"
#include "lobe/device/device.hpp"
#include "model/lobes.hpp"

namespace lobe {

/// Reflectance of delta parts by angle of incidence: their factors and pumping on the device, as for other lobes.
class DeltaShares {
 public:
  DeltaShares(const Device& device, std::span<const DeltaLobe> deltas);

  /// Share of the light from these elevations, in (0, pi/2] above the horizon, that each delta part reflects; deltas x
  /// elevations.
  /// \throws DeviceError
  [[nodiscard]] Eigen::MatrixXd at(std::span<const double> elevations);

 private:
  /// One with factors or pumping, by its without_delta().
  struct Varying {
    std::size_t delta;
    LobeEvaluator evaluator;
  };

  std::vector<DeltaLobe> deltas_;
  std::vector<Varying> varying_;
};

/// Light that the delta parts of a material reflect, channels x elevations.
struct DeltaParts {
  Eigen::MatrixXd mirror;
  Eigen::MatrixXd retro;
};

/// \param deltas a material of delta parts alone, or of no terms: zeros
/// \param channels of the material it is a part of
/// \throws DeviceError
[[nodiscard]] DeltaParts delta_parts(const Device& device, const Material& deltas, std::size_t channels,
                                     std::span<const double> elevations);

}  // namespace lobe
