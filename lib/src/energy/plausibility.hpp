#pragma once

#include "lobe/energy/plausibility.hpp"
#include "lobe/table/brdf_function.hpp"

namespace lobe {

// Overloads of check_plausibility() for each kind of reflectance. They throw as the public function does.

/// \param material prepared
[[nodiscard]] Plausibility check_plausibility(const Device& device, const Material& material,
                                              const PlausibilityOptions& options = {});
/// \param function without delta parts
[[nodiscard]] Plausibility check_plausibility(const BrdfFunction& function, const PlausibilityOptions& options = {});
[[nodiscard]] Plausibility check_plausibility(const BrdfTable& table);

}  // namespace lobe
