#pragma once

/// Integrals of the isotropic Lafortune lobe max(0, c_xy (L_x V_x + L_y V_y) + c_z L_z V_z)^n between the zeros of its
/// cosine, where it is analytic: by double-exponential quadrature (Takahasi and Mori 1974), which does not mind powers
/// at the ends.

namespace lobe::reference {

struct LafortuneLobe {
  double c_xy, c_z, n;
};

/// a(theta), eq. 1.13 of Neumann 2001.
[[nodiscard]] double lafortune_albedo(const LafortuneLobe& lobe, double theta);
/// Integral of a^2 dmu.
[[nodiscard]] double lafortune_daylight(const LafortuneLobe& lobe);
/// Integral of a dmu.
[[nodiscard]] double lafortune_light(const LafortuneLobe& lobe);
/// Integral of f^2 dmu dmu.
[[nodiscard]] double lafortune_point(const LafortuneLobe& lobe);

}  // namespace lobe::reference
