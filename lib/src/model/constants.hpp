#pragma once

namespace lobe {

/// Constant of the Blinn model that makes its largest albedo, at normal incidence, 1: the closed form
/// 1 / (8 pi [2/(n+4) (1 - 2^-(n+4)/2) - 1/(n+2) (1 - 2^-(n+2)/2)]).
[[nodiscard]] double blinn_constant(double n);

/// (n+2) / (2 pi), which makes the largest albedo of a cosine lobe about the mirror direction 1.
[[nodiscard]] double cosine_lobe_constant(double n);

/// s^2 / (2 pi (1 - (1+s) e^-s)) of the exponential patch (Neumann 2001, eq. 4.46), without cancellation for small s.
[[nodiscard]] double exponential_patch_constant(double s);

/// C of C exp(-s ((ratio |x|)^p + |y|^p)^(1/p)) that makes its integral over the unit disc, the albedo at normal
/// incidence of a patch with that norm (Neumann 2001, eq. 4.32 and 4.38), 1. 0 < ratio <= 1, p >= 1.
[[nodiscard]] double exponential_norm_constant(double s, double ratio, double p);

/// 1 over the area of the unit disc within ((ratio |x|)^p + |y|^p)^(1/p) <= radius (Neumann 2001, eq. 4.36).
/// 0 < ratio <= 1, p >= 1.
[[nodiscard]] double patch_norm_constant(double radius, double ratio, double p);

/// Constant of facets of density exp(-delta^2 / m^2), delta the angle from the normal in radians:
/// 1 / (8 pi int_0^(pi/2) exp(-delta^2/m^2) cos(delta) sin(delta) ddelta).
[[nodiscard]] double gaussian_facets_constant(double m);

/// Constant of (N.H)^n / max(N.L, N.V) that makes its largest albedo 1 (Neumann 2001, Table 3.1); n >= 1.
[[nodiscard]] double blinn_metal_constant(double n);

/// C of exp(-tan^2 delta / m^2) C / (4 pi m^2 max(N.L, N.V)) that makes the albedo at normal incidence 1 (Neumann 2001,
/// Table 3.2): 1/C = int_0^(1/m^2) e^-x (1 - m^2 x) / (1 + m^2 x)^3 dx.
[[nodiscard]] double ward_metal_constant(double m);

/// C of (1 - min(m, clip)^2/4)^(-d/2) that makes the albedo at grazing incidence 1 (Neumann 2001, Table 4.3), from the
/// area of the unit disc within m of a point of its edge: 1/C = int_0^2 2 arccos(m/2) m xi(m) dm.
[[nodiscard]] double generalised_lambert_constant(double d, double clip);

/// 1 / (2 pi int_0^1 x^n sqrt((1+x)/2) dx): the albedo at grazing incidence of a cosine lobe over the cosine of the
/// bisector of R and V (Neumann 2001, eq. 5.17) is 1 with it.
[[nodiscard]] double phong_bisector_constant(double n);

/// 1 / (alpha Gamma(1-p, alpha)), Gamma the upper incomplete gamma function: K of Bagher et al. 2012, which normalises
/// the shifted-gamma distribution K e^-x / (pi x^p cos^4), x = alpha + tan^2/alpha.
[[nodiscard]] double shifted_gamma_constant(double alpha, double p);

/// Terms of sum over m of e^-g g^m / (m! m) after which what is left is below an ulp of the sum, for all phases up to g
/// (He et al. 1991, eq. 78).
[[nodiscard]] int roughness_terms(double g);

}  // namespace lobe
