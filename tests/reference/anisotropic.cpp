#include <algorithm>
#include <cmath>
#include <functional>
#include <vector>

#include "reference/fresnel.hpp"
#include "reference/microfacets.hpp"
#include "reference/models.hpp"
#include "reference/quadrature.hpp"

namespace lobe::reference {
namespace {

/// cos^2 and sin^2 of the azimuth of a half-vector, 0 and 1 where it has none.
struct Azimuth {
  explicit Azimuth(const Vector& half) {
    const Real length = std::hypot(half.x, half.y);
    if (length == 0) return;
    cosine2 = (half.x / length) * (half.x / length);
    sine2 = (half.y / length) * (half.y / length);
  }
  Real cosine2 = 0;
  Real sine2 = 1;
};

/// Lambda of Heitz 2014, eq. 86, with the roughness in the direction of incidence.
Real lambda(const Vector& x, Real alpha_x, Real alpha_y) {
  const Azimuth azimuth(x);
  const Real alpha2 = azimuth.cosine2 * alpha_x * alpha_x + azimuth.sine2 * alpha_y * alpha_y;
  return (std::sqrt(1 + alpha2 * tan_squared_delta(x)) - 1) / 2;
}

/// Integral in panels that halve towards both ends, for roots, powers and steep flanks there.
Real graded_integral(const std::function<Real(Real)>& g, Real low, Real high) {
  constexpr int kPanels = 60;
  Real sum = 0;
  for (const Real end : {low, high}) {
    Real step = ((low + high) / 2 - end);
    for (int k = 0; k < kPanels; ++k, step /= 2) {
      const Real nearer = end + (k == kPanels - 1 ? 0 : step / 2);
      const Real part = smooth_integral(g, nearer, end + step);
      sum += end == low ? part : -part;
    }
  }
  return sum;
}

}  // namespace

Real ward_anisotropic(const Vector& light, const Vector& view, Real m_x, Real m_y, Real rotation) {
  const Vector half = from_axes(half_vector(light, view), rotation);
  const Azimuth azimuth(half);
  const Real spread = azimuth.cosine2 / (m_x * m_x) + azimuth.sine2 / (m_y * m_y);
  return std::exp(-tan_squared_delta(half) * spread) / (4 * kPi * m_x * m_y * std::sqrt(light.z * view.z));
}

Real schlick_anisotropic(const Vector& light, const Vector& view, Real r, Real p, Real rotation) {
  const Azimuth azimuth(from_axes(half_vector(light, view), rotation));
  return std::sqrt(p / (p * p + (1 - p * p) * azimuth.cosine2)) * schlick(light, view, r);
}

Real ggx_anisotropic(const Vector& light, const Vector& view, Real alpha_x, Real alpha_y, Real f0, Real rotation) {
  const Vector half = from_axes(half_vector(light, view), rotation);
  const Azimuth azimuth(half);
  const Real spread = azimuth.cosine2 / (alpha_x * alpha_x) + azimuth.sine2 / (alpha_y * alpha_y);
  const Real density =
      1 / (kPi * alpha_x * alpha_y * std::pow(half.z, 4.0L) * std::pow(1 + tan_squared_delta(half) * spread, 2.0L));
  const Real attenuation = 1 / (1 + lambda(from_axes(light, rotation), alpha_x, alpha_y) +
                                lambda(from_axes(view, rotation), alpha_x, alpha_y));
  return schlick_fresnel(cos_half_difference(light, view), f0) * density * attenuation / (4 * light.z * view.z);
}

Real ashikhmin_shirley_anisotropic(const Vector& light, const Vector& view, Real n_u, Real n_v, Real f0,
                                   Real rotation) {
  const Vector half = half_vector(light, view);
  const Azimuth azimuth(from_axes(half, rotation));
  const Real l_h = cos_half_difference(light, view);
  return std::sqrt((n_u + 1) * (n_v + 1)) / (8 * kPi) *
         cosine_power(kNormal, half, n_u * azimuth.cosine2 + n_v * azimuth.sine2) / (l_h * std::max(light.z, view.z)) *
         schlick_fresnel(l_h, f0);
}

Real lafortune_anisotropic(const Vector& light, const Vector& view, const Vector& c, Real n, Real rotation) {
  const Vector l = from_axes(light, rotation);
  const Vector v = from_axes(view, rotation);
  return std::pow(std::max(0.0L, c.x * l.x * v.x + c.y * l.y * v.y + c.z * l.z * v.z), n);
}

Real lafortune_matrix(const Vector& light, const Vector& view, const SymmetricMatrix& m, Real n) {
  const Vector turned{dot({m.xx, m.xy, m.xz}, light), dot({m.xy, m.yy, m.yz}, light), dot({m.xz, m.yz, m.zz}, light)};
  return std::pow(std::max(0.0L, dot(turned, view)), n);
}

Real patch_metric(const Vector& light, const Vector& view, const PatchNorm& norm) {
  const Vector z = from_axes(view - mirrored(light), norm.rotation);
  return std::pow(std::pow(norm.ratio * std::abs(z.x), norm.p) + std::pow(std::abs(z.y), norm.p), 1 / norm.p);
}

// Strips of the first quadrant along the second axis, each to the circle or the edge, whichever is nearer. The height
// of the edge is the convex function (R^p - (ratio x)^p)^(1/p), the circle's is sqrt(1 - x^2): they cross at most
// twice.
Real patch_norm_area(Real radius, const PatchNorm& norm) {
  const auto edge = [&](Real x) {
    const Real u = norm.ratio * x;
    return u < radius ? radius * std::pow(-std::expm1(norm.p * std::log(u / radius)), 1 / norm.p) : 0;
  };
  const auto circle = [](Real x) { return std::sqrt((1 - x) * (1 + x)); };
  const Real end = std::min(1.0L, radius / norm.ratio);
  std::vector<Real> limits{0};
  constexpr int kSteps = 4000;
  for (int k = 0; k < kSteps; ++k) {
    Real low = end * k / kSteps;
    Real high = end * (k + 1) / kSteps;
    const bool is_within = edge(low) < circle(low);
    if (k == kSteps - 1 || is_within == (edge(high) < circle(high))) continue;
    for (int halving = 0; halving < 60; ++halving) {
      const Real middle = (low + high) / 2;
      ((edge(middle) < circle(middle)) == is_within ? low : high) = middle;
    }
    limits.push_back(high);
  }
  limits.push_back(end);
  Real area = 0;
  for (std::size_t i = 0; i + 1 < limits.size(); ++i) {
    area += graded_integral([&](Real x) { return std::min(edge(x), circle(x)); }, limits[i], limits[i + 1]);
  }
  return 4 * area;
}

// In polar coordinates of the base plane, the integral over the radius in closed form. The norm has kinks or nearly so
// along the axes and where its shares are equal.
Real exponential_patch_constant(Real s, const PatchNorm& norm) {
  const auto sector = [&](Real phi) {
    const Real q =
        s *
        std::pow(std::pow(norm.ratio * std::abs(std::cos(phi)), norm.p) + std::pow(std::sin(phi), norm.p), 1 / norm.p);
    return (1 - (1 + q) * std::exp(-q)) / (q * q);
  };
  const Real corner = std::atan(norm.ratio);
  return 1 / (4 * (graded_integral(sector, 0, corner) + graded_integral(sector, corner, kPi / 2)));
}

Real metal_phong_anisotropic(const Vector& light, const Vector& view, Real n, const Vector& c, Real p, Real rotation) {
  return (n + 2) / (2 * kPi) * lafortune_anisotropic(mirrored(light), view, c, n, rotation) /
         std::pow(std::max(light.z, view.z), p);
}

}  // namespace lobe::reference
