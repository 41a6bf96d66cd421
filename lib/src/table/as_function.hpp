#pragma once

#include "lobe/device/device.hpp"
#include "lobe/model/material.hpp"
#include "lobe/table/brdf_function.hpp"
#include "lobe/table/table.hpp"

namespace lobe {

// Overloads of as_function() for each kind of reflectance. They throw as the public function does.

/// \param material prepared
[[nodiscard]] BrdfFunction as_function(const Device& device, const Material& material,
                                       Precision precision = Precision::double_precision);
[[nodiscard]] BrdfFunction as_function(const BrdfTable& table);

}  // namespace lobe
