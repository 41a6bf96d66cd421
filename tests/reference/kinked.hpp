#pragma once

/// Integrals of what is not smooth everywhere, between the places where it is not: by double-exponential quadrature
/// (Takahasi and Mori 1974), which does not mind powers at the ends. First of the isotropic Lafortune lobe max(0, c_xy
/// (L_x V_x + L_y V_y) + c_z L_z V_z)^n.

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

/// A function of one cosine that is not smooth where that is c.
enum class Kink {
  both_sides,  ///< |x - c|
  above,       ///< max(0, x - c)
  below,       ///< max(0, c - x)
  jump         ///< 1 above c, 0.2 below
};

struct KinkAt {
  Kink kink;
  double c;  ///< in (0, 1)
};

[[nodiscard]] double kinked_value(const KinkAt& at, double cosine);
/// Integral of f(N.X) dmu.
[[nodiscard]] double kinked_integral(const KinkAt& f);
/// Integral of f(N.X) g(N.X) dmu.
[[nodiscard]] double kinked_product(const KinkAt& f, const KinkAt& g);
/// Integral of f(R.X) (N.X)^power dmu for a direction R at the polar angle `tilt`.
[[nodiscard]] double tilted_kink(const KinkAt& f, double tilt, int power);
/// The mean of tilted_kink() with power 0 over all R, times pi: what mean_albedo() is of f(R.V) where R mirrors L.
[[nodiscard]] double mean_tilted_kink(const KinkAt& f);

}  // namespace lobe::reference
