#pragma once

/// Densities of importance sampling in sr^-1 and random numbers, written from the publications.

#include <array>
#include <cstdint>

#include "reference/vector.hpp"

namespace lobe::reference {

/// Neumann 2001, eq. 3.19, about any axis.
[[nodiscard]] Real power_density(const Vector& axis, const Vector& view, Real n);
/// Walter 2005, Notes on the Ward BRDF, eq. 9.
[[nodiscard]] Real ward_density(const Vector& light, const Vector& view, Real m_x, Real m_y, Real rotation);
/// Ashikhmin and Shirley 2000, eq. 8: of the half-vector over 4 L.H.
[[nodiscard]] Real ashikhmin_density(const Vector& light, const Vector& view, Real n_u, Real n_v, Real rotation);
/// Heitz 2018, eq. 1 to 3 and 17: visible normals of GGX, over 4 L.H.
[[nodiscard]] Real visible_density(const Vector& light, const Vector& view, Real a_x, Real a_y, Real rotation);
/// Neumann 2001, 4.2.4: evenly in what a disc about the mirror image of L has in common with the unit disc.
[[nodiscard]] Real patch_density(const Vector& light, const Vector& view, Real radius);
/// The same with Russian roulette (4.18).
[[nodiscard]] Real roulette_density(const Vector& light, const Vector& view, Real radius);

/// Philox4x32-10 (Salmon et al. 2011).
[[nodiscard]] std::array<std::uint32_t, 4> philox(std::array<std::uint32_t, 4> counter,
                                                  std::array<std::uint32_t, 2> key);

}  // namespace lobe::reference
