#include <algorithm>
#include <cmath>

#include "kernel/microfacet_cases.hpp"

namespace lobe::test {
namespace {

Real distance(const Vector& l, const Vector& v) {
  return std::hypot(l.x + v.x, l.y + v.y);
}

ModelCase patch_power(const std::string& n) {
  const Real exponent = std::stold(n);
  return {"patch_power:n=" + n,
          [=](const Vector& l, const Vector& v) { return reference::patch_power(l, v, exponent); },
          // 1 + n / (1 - |V_P - L'_P|)
          [=](const Vector& l, const Vector& v) { return 1 + exponent / std::max(1 - distance(l, v), 1e-10L); },
          static_cast<double>(1 / (1 + exponent)),
          [=](Real eps) { return (exponent + 1) * (exponent + 2) * std::pow(8 * eps, exponent); }};
}

ModelCase generalised_lambert(const std::string& d) {
  const Real shape = std::stold(d);
  return {"generalised_lambert:d=" + d,
          [=](const Vector& l, const Vector& v) { return reference::generalised_lambert(l, v, shape, 1.9L); },
          // 1 + d / (1 - m^2/4), where the difference is at least that of the clip
          [=](const Vector& l, const Vector& v) {
            const Real half = std::min(distance(l, v), 1.9L) / 2;
            return 1 + shape / (1 - half * half);
          }};
}

ModelCase coated_metal(const std::string& s, const std::string& ior, const std::string& k) {
  const Real decay = std::stold(s);
  const Real index = std::stold(ior);
  const Real extinction = std::stold(k);
  return {"coated_metal:s=" + s + ",ior=" + ior + ",k=" + k,
          [=](const Vector& l, const Vector& v) { return reference::coated_metal(l, v, decay, index, extinction); },
          // 1 + s |V_P - L'_P|
          [=](const Vector& l, const Vector& v) {
            const Real sine = std::hypot(l.x - v.x, l.y - v.y) / 2;
            return 1 + decay * distance(l, v) +
                   condition_at([=](Real c) { return reference::fresnel(c, index, extinction); },
                                std::sqrt(1 - sine * sine));
          },
          static_cast<double>(1 / decay)};
}

ModelCase patch_character(const std::string& s, const std::string& alpha) {
  const Real decay = std::stold(s);
  const Real power = std::stold(alpha);
  return {"patch_character:s=" + s + ",alpha=" + alpha,
          [=](const Vector& l, const Vector& v) { return reference::patch_character(l, v, decay, power); },
          // 1 + s |V_P - L'_P| + |alpha ln N.B|
          [=](const Vector& l, const Vector& v) {
            return 1 + decay * distance(l, v) + std::abs(power * std::log(std::hypot(length(l + v), l.z - v.z) / 2));
          },
          static_cast<double>(1 / decay)};
}

ModelCase patch_frustum(const std::string& r, const std::string& inner) {
  const Real radius = std::stold(r);
  const Real share = std::stold(inner);
  return {"patch_frustum:R=" + r + ",inner=" + inner,
          [=](const Vector& l, const Vector& v) { return reference::patch_frustum(l, v, radius, share); },
          // 1 + R / (R - m) + 1 / (1 - r), where it falls
          [=](const Vector& l, const Vector& v) {
            const Real rest = radius - distance(l, v);
            return rest <= 0 ? 1 : 1 + 1 / (1 - share) + radius / rest;
          },
          static_cast<double>(radius / 3),
          // c eps / (1 - r), with c <= 3 / (pi min(1, R^2))
          [=](Real eps) { return 8 * eps / (1 - share) / std::min(1.0L, radius * radius); }};
}

ModelCase patch_band(const std::string& r, const std::string& inner, const std::string& rise) {
  const Real radius = std::stold(r);
  const Real share = std::stold(inner);
  const Real slope = std::stold(rise);
  const Real low = radius * share;
  // The value in the middle, of which the error is a multiple.
  const Real top = reference::patch_band({0, 0, 1}, {0, 0, 1}, radius, share, slope);
  return {"patch_band:R=" + r + ",inner=" + inner + ",rise=" + rise,
          [=](const Vector& l, const Vector& v) { return reference::patch_band(l, v, radius, share, slope); },
          [=](const Vector& l, const Vector& v) {
            const Real value = reference::patch_band(l, v, radius, share, slope);
            return value > 0 ? 1 + (1 + 1 / (1 - share)) * top / value : 1;
          },
          static_cast<double>(std::min(radius, 3 * low) / 3), [=](Real eps) { return 16 * eps / (1 - share) * top; }};
}

INSTANTIATE_TEST_SUITE_P(patch_frustum, ModelKernel,
                         ::testing::Values(patch_frustum("0.01", "0"), patch_frustum("0.5", "0.3"),
                                           patch_frustum("1.5", "0.9"), patch_frustum("2", "0"),
                                           patch_frustum("1.2", "0.5")),
                         ByName{});
INSTANTIATE_TEST_SUITE_P(patch_band, ModelKernel,
                         ::testing::Values(patch_band("0.01", "0.5", "0.5"), patch_band("0.5", "0.1", "0"),
                                           patch_band("0.5", "0.9", "1"), patch_band("1.5", "0.4", "0.2"),
                                           patch_band("2", "0.6", "0.5")),
                         ByName{});
INSTANTIATE_TEST_SUITE_P(patch_power, ModelKernel,
                         ::testing::Values(patch_power("1"), patch_power("20"), patch_power("5000")), ByName{});
INSTANTIATE_TEST_SUITE_P(generalised_lambert, ModelKernel,
                         ::testing::Values(generalised_lambert("0"), generalised_lambert("0.3"),
                                           generalised_lambert("1")),
                         ByName{});
INSTANTIATE_TEST_SUITE_P(coated_metal, ModelKernel,
                         ::testing::Values(coated_metal("2", "1.5", "0"), coated_metal("20", "0.331", "2.324"),
                                           coated_metal("500", "0.18", "3.64")),
                         ByName{});

INSTANTIATE_TEST_SUITE_P(patch_character, ModelKernel,
                         ::testing::Values(patch_character("2", "-1"), patch_character("50", "0"),
                                           patch_character("500", "-2"), patch_character("1", "2")),
                         ByName{});

}  // namespace
}  // namespace lobe::test
