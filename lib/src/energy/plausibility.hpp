#pragma once

#include "lobe/energy/plausibility.hpp"

namespace lobe {

// check_plausibility() by what a reflectance is known as; \throws as that.

/// \param material prepared
[[nodiscard]] Plausibility check_plausibility(const Device& device, const Material& material,
                                              const PlausibilityOptions& options = {});
[[nodiscard]] Plausibility check_plausibility(const BrdfTable& table);

}  // namespace lobe
