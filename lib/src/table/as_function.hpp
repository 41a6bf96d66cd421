#pragma once

#include "lobe/device/device.hpp"
#include "lobe/model/material.hpp"
#include "lobe/table/brdf_function.hpp"
#include "lobe/table/table.hpp"

namespace lobe {

// as_function() by what a reflectance is known as; \throws as that.

/// \param material prepared
[[nodiscard]] BrdfFunction as_function(const Device& device, const Material& material,
                                       Precision precision = Precision::double_precision);
[[nodiscard]] BrdfFunction as_function(const BrdfTable& table);

}  // namespace lobe
