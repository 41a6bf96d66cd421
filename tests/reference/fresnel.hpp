#pragma once

#include "reference/vector.hpp"

namespace lobe::reference {

/// Neumann 2001, eq. 1.41 to 1.43 for the complex index n - ik, by complex arithmetic; unpolarised light.
[[nodiscard]] Real fresnel(Real cos_incidence, Real n, Real k);
/// Schlick 1994.
[[nodiscard]] Real schlick_fresnel(Real cos_incidence, Real f0);

}  // namespace lobe::reference
