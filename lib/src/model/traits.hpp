#pragma once

#include "lobe/material.hpp"

namespace lobe {

/// f(L,V) = f(V,L) for all models of a material.
[[nodiscard]] bool is_reciprocal(const Material& material);

}  // namespace lobe
