#pragma once

/// Reference implementation of every reflectance model, f(L, V) in sr^-1 for unit vectors L, V above the horizon.
/// Written from the publications in vector form, not from the kernels; one file per model.

#include "reference/vector.hpp"

namespace lobe::reference {

/// Neumann 2001, eq. 4.2 and 4.7.
[[nodiscard]] Real basic_patch(const Vector& light, const Vector& view, Real radius);
/// Area common to two discs of the base plane: with that of radius 1, the albedo of a patch but for its constant (4.8).
[[nodiscard]] Real lens_area(Real radius, Real other_radius, Real distance);
/// Neumann 2001, eq. 1.34, with the constant that makes the albedo at normal incidence 1.
[[nodiscard]] Real blinn(const Vector& light, const Vector& view, Real n);
[[nodiscard]] Real blinn_constant(Real n);
/// Ngan, Durand, Matusik 2005.
[[nodiscard]] Real blinn_phong(const Vector& light, const Vector& view, Real n);
/// Eq. 2.9 with 2.10 and Schlick's Fresnel factor; f0 = 1 means F = 1.
[[nodiscard]] Real cook_torrance(const Vector& light, const Vector& view, Real m, Real f0);
/// Eq. 4.46.
[[nodiscard]] Real exponential_patch(const Vector& light, const Vector& view, Real s);
/// Eq. 1.66, isotropic, positive part.
[[nodiscard]] Real lafortune(const Vector& light, const Vector& view, Real c_xy, Real c_z, Real n);
/// Ngan, Durand, Matusik 2005: eq. 1.66 normalised.
[[nodiscard]] Real lafortune_ngan(const Vector& light, const Vector& view, Real c_xy, Real c_z, Real n);
/// Eq. 1.28 with albedo 1.
[[nodiscard]] Real lambert(const Vector& light, const Vector& view);
/// Eq. 3.7.
[[nodiscard]] Real metal_phong(const Vector& light, const Vector& view, Real n);
/// Eq. 1.32.
[[nodiscard]] Real minnaert(const Vector& light, const Vector& view, Real k);
/// Eq. 1.56 with the sign of (N.L)(N.V) corrected; A = 1 - sigma^2/2 / (sigma^2 + a_denominator).
[[nodiscard]] Real oren_nayar(const Vector& light, const Vector& view, Real sigma, Real a_denominator);
/// Eq. 1.33 with the constant (n+2)/(2 pi).
[[nodiscard]] Real phong(const Vector& light, const Vector& view, Real n);
/// Eq. 3.35 with C_max = 1.
[[nodiscard]] Real ward(const Vector& light, const Vector& view, Real m);

}  // namespace lobe::reference
