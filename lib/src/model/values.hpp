#pragma once

#include <Eigen/Core>
#include <span>
#include <string>

#include "lobe/core/directions.hpp"
#include "lobe/device/device.hpp"
#include "lobe/model/material.hpp"

namespace lobe {

/// As evaluate(), whatever the values are.
[[nodiscard]] Eigen::MatrixXd unchecked_values(const Device& device, const Material& material,
                                               std::span<const Directions> directions,
                                               Precision precision = Precision::double_precision);

/// \throws NumericError naming the first pair with a value that is no finite number
void require_finite(const Eigen::MatrixXd& values, const std::string& name, std::span<const Directions> directions);

}  // namespace lobe
