#pragma once

/// Lobes max(0, L^T M V)^n (Neumann 2001, eq. 1.65 and 1.66).

#include <vector>

#include "model/catalogue.hpp"

namespace lobe {

// Isotropic: c_xy, c_z, n.

[[nodiscard]] std::vector<Parameter> lafortune_parameters();
[[nodiscard]] double lafortune_width(Values v);
[[nodiscard]] double lafortune_retro_width(Values v);
/// Where the cosine passes 0.
[[nodiscard]] std::vector<Kink> lafortune_kinks(Values v);
[[nodiscard]] draw::Parts lafortune_draws(Values v, const draw::Scene& scene);

// Anisotropic.

/// C L^T M V with coefficients along the axes of the lobe, for kernels/models/lafortune_anisotropic.clh.
[[nodiscard]] Coefficients matrix_coefficients(double constant, double c_x, double c_y, double c_z, double n, double p,
                                               double azimuth);

/// Where L^T M V passes 0.
/// \param c as kernels/models/lafortune_anisotropic.clh takes them
[[nodiscard]] std::vector<Kink> matrix_kinks(const Coefficients& c);

/// \param c as kernels/models/lafortune_anisotropic.clh takes them
[[nodiscard]] draw::Parts matrix_draws(const Coefficients& c, const UnitVector& light);

}  // namespace lobe
