#pragma once

#include "reference/vector.hpp"

/// Parts of microfacet models as their publications have them: f = F D G / (4 (N.L) (N.V)).
namespace lobe::reference {

/// L.H = V.H as half the length of L + V: the dot product with H loses digits at grazing angles.
[[nodiscard]] inline Real cos_half_difference(const Vector& light, const Vector& view) {
  return length(light + view) / 2;
}

/// D G / (4 (N.L) (N.V)) with the attenuation of V-cavities (Neumann 2001, eq. 1.37).
[[nodiscard]] Real with_v_cavities(const Vector& light, const Vector& view, Real distribution);

/// Densities of facets whose projection is normalised, by the half-vector.
[[nodiscard]] Real beckmann_facets(const Vector& half, Real m);
[[nodiscard]] Real blinn_facets(const Vector& half, Real n);
[[nodiscard]] Real torrance_facets(const Vector& half, Real m);
[[nodiscard]] Real trowbridge_facets(const Vector& half, Real q);

}  // namespace lobe::reference
