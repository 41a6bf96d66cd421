#pragma once

#include "lobe/device/device.hpp"
#include "lobe/model/material.hpp"
#include "lobe/table/brdf_function.hpp"
#include "lobe/table/table.hpp"
#include "model/values.hpp"

namespace lobe {

// Overloads of as_function() for each kind of reflectance. They throw as the public function does.

/// \param material prepared
[[nodiscard]] BrdfFunction as_function(const Device& device, const Material& material,
                                       Precision precision = Precision::double_precision);
/// The same, with what it needs on the device made once and kept as long as it lives: for few functions at a time that
/// are asked often.
[[nodiscard]] BrdfFunction kept_function(const Device& device, const Material& material, Precision precision,
                                         NodeMaking making);
[[nodiscard]] BrdfFunction as_function(const BrdfTable& table);

}  // namespace lobe
