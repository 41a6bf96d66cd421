#pragma once

/// Parameters that several models have, and the widths of their lobes.

#include "lobe/model/model.hpp"

namespace lobe {

[[nodiscard]] Parameter exponent();            ///< n of a power of a cosine
[[nodiscard]] Parameter roughness();           ///< m of the Beckmann distribution
[[nodiscard]] Parameter facet_angle();         ///< m of the distribution of Torrance and Sparrow
[[nodiscard]] Parameter normal_reflectance();  ///< f0 of Schlick's approximation
[[nodiscard]] Parameter refractive_index();    ///< real part of the refractive index
[[nodiscard]] Parameter extinction();          ///< its imaginary part
[[nodiscard]] Parameter reflected_share();     ///< rho of an ideal mirror

/// Half-vector width of (R.V)^n, where the angle between R and V is twice that of H from N.
[[nodiscard]] double mirror_lobe_width(double n);
/// Width of (L.V)^n about the retro direction; below 1, which means none.
[[nodiscard]] double retro_lobe_width(double n);
/// Half-vector width of (N.H)^n.
[[nodiscard]] double half_lobe_width(double n);

}  // namespace lobe
