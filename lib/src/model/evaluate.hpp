#pragma once

#include <Eigen/Core>
#include <span>

#include "lobe/core/directions.hpp"
#include "lobe/device/device.hpp"
#include "lobe/model/material.hpp"

namespace lobe {

/// f(L, V) in sr^-1 at the given pairs of directions; row per pair, column per channel. Zero at and below the horizon.
/// The azimuth phi_in counts for anisotropic models only.
/// \throws ArgumentError for an angle outside its range (see Directions); NumericError for a value that is no finite
///   number; DeviceError.
[[nodiscard]] Eigen::MatrixXd evaluate(const Device& device, const Material& material,
                                       std::span<const Directions> directions,
                                       Precision precision = Precision::double_precision);

}  // namespace lobe
