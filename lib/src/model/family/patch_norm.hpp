#pragma once

/// Norms of the base plane in which an anisotropic patch is a ball (Neumann 2001, eq. 4.32 and 4.38).

#include "model/catalogue.hpp"
#include "model/family/azimuths.hpp"
#include "model/family/base_plane.hpp"

namespace lobe {

[[nodiscard]] Parameter axes_ratio();
[[nodiscard]] Parameter norm_power();

/// The power of a norm is smooth along the axes, and its corners between them are wide enough for equal steps of
/// azimuth.
[[nodiscard]] bool is_smooth_norm(double p);

/// Aspect of a lobe with the parameters ratio and p in second and third place.
[[nodiscard]] double norm_aspect(Values v);

/// \param v R, ratio, p, rotation
[[nodiscard]] PatchEdge edge_of(Values v);

/// \param v R, ratio, p, rotation
[[nodiscard]] Coefficients patch_norm_coefficients(Values v);

/// How far an anisotropic patch reaches: its larger half axis, and for powers above 2 the corners beyond.
/// \param v R, ratio, p, rotation
[[nodiscard]] double reach_of_norm(Values v);

}  // namespace lobe
