#pragma once

/// The catalogue by kinds of models; one file each.

#include <span>
#include <vector>

#include "model/catalogue.hpp"

namespace lobe {

using Values = std::span<const double>;
using Entries = std::vector<CatalogueEntry>;

void add_diffuse_models(Entries& entries);      ///< Lambert and what is as wide
void add_cosine_lobes(Entries& entries);        ///< Phong, Blinn, Lafortune
void add_microfacet_models(Entries& entries);   ///< Ward, Cook-Torrance, GGX
void add_patch_models(Entries& entries);        ///< functions of the base-plane distance from the mirror direction
void add_anisotropic_models(Entries& entries);  ///< what sees azimuths
void add_delta_parts(Entries& entries);         ///< ideal mirrors

// Parameters that several models have.

[[nodiscard]] Parameter exponent();            ///< n of a power of a cosine
[[nodiscard]] Parameter roughness();           ///< m of the Beckmann distribution
[[nodiscard]] Parameter normal_reflectance();  ///< f0 of Schlick's approximation
[[nodiscard]] Parameter refractive_index();    ///< real part of the refractive index
[[nodiscard]] Parameter extinction();          ///< its imaginary part

/// Half-vector width of (R.V)^n, where the angle between R and V is twice that of H from N.
[[nodiscard]] double mirror_lobe_width(double n);
/// The same of (L.V)^n about the retro direction; below 1, which stands for none.
[[nodiscard]] double retro_lobe_width(double n);
/// Of (N.H)^n.
[[nodiscard]] double half_lobe_width(double n);

}  // namespace lobe
