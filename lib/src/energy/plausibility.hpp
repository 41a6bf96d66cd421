#pragma once

#include "lobe/energy/plausibility.hpp"

namespace lobe {

// Overloads of check_plausibility() for each kind of reflectance. They throw as the public function does.

/// \param material prepared
[[nodiscard]] Plausibility check_plausibility(const Device& device, const Material& material,
                                              const PlausibilityOptions& options = {});
[[nodiscard]] Plausibility check_plausibility(const BrdfTable& table);

}  // namespace lobe
