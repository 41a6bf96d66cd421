#pragma once

#include <Eigen/Core>
#include <functional>
#include <span>
#include <string>
#include <vector>

#include "energy/albedo_integrator.hpp"
#include "lobe/core/estimate.hpp"
#include "lobe/device/device.hpp"
#include "lobe/energy/albedo.hpp"
#include "lobe/model/material.hpp"
#include "model/lobes.hpp"

namespace lobe {

/// Relative error of a sum of samples beside that of the quadrature: that of the samples, and that of the edges of
/// patches, angles near pi/2 that are known to an ulp.
[[nodiscard]] double albedo_rounding(Precision precision, const LobeSet& lobes);

/// Albedos of one material at incident directions, channels x directions.
class MaterialAlbedo {
 public:
  MaterialAlbedo(const Device& device, const Material& material, Precision precision, Given given = Given::light);

  /// Relative error beside that of the quadrature.
  [[nodiscard]] double rounding() const { return rounding_; }
  [[nodiscard]] const AlbedoRule& rule() const { return integrator_.rule(); }
  [[nodiscard]] bool hides_jumps() const { return lobes_.has_hidden_jumps(); }

  [[nodiscard]] Eigen::MatrixXd at(std::span<const IncidentNode> incident, int level);

 private:
  LobeSet lobes_;
  AlbedoIntegrator integrator_;
  double rounding_;
  WorkDone work_;
};

/// Values by channel and whether their relative errors are below a tolerance.
struct Refined {
  std::vector<Estimate> values;
  double worst = 0;  ///< largest relative error
  bool is_reached = false;
};

/// Refines values of all channels until the worst relative error is below the tolerance. An error is twice the
/// difference of the last two levels, or of a tenth of the one before, because two levels may agree by accident; and
/// rounding.
/// \param at_level values per channel by level of refinement
/// \param what what the values are, for the message
/// \param floor relative error beside that of the quadrature
/// \param levels at most, from 2 to kLevels
/// \throws NumericError where values are no finite numbers
[[nodiscard]] Refined refine(const std::function<Eigen::ArrayXd(int)>& at_level, const std::string& what,
                             const Material& material, double floor, double tolerance, int levels);

}  // namespace lobe
