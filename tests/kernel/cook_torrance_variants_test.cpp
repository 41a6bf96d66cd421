#include <algorithm>
#include <cmath>

#include "kernel/microfacet_cases.hpp"

namespace lobe::test {
namespace {

ModelCase blinn(const std::string& n, const std::string& f0) {
  const Real exponent = std::stold(n);
  const Real at_normal = std::stold(f0);
  return {"cook_torrance_blinn:n=" + n + ",f0=" + f0,
          [=](const Vector& l, const Vector& v) { return reference::cook_torrance_blinn(l, v, exponent, at_normal); },
          // 1 + n |ln N.H|
          [=](const Vector& l, const Vector& v) {
            return 1 + exponent * std::log1p(tan_squared_delta(half_vector(l, v))) / 2 +
                   schlick_condition(at_normal, l, v);
          },
          static_cast<double>(1 / std::sqrt(exponent))};
}

ModelCase fresnel(const std::string& m, const std::string& n, const std::string& k) {
  const Real roughness = std::stold(m);
  const Real index = std::stold(n);
  const Real extinction = std::stold(k);
  return {"cook_torrance_fresnel:m=" + m + ",ior=" + n + ",k=" + k,
          [=](const Vector& l, const Vector& v) {
            return reference::cook_torrance_fresnel(l, v, roughness, index, extinction);
          },
          [=](const Vector& l, const Vector& v) {
            return 1 + tan_squared_delta(half_vector(l, v)) / (roughness * roughness) +
                   fresnel_condition([=](Real c) { return reference::fresnel(c, index, extinction); }, l, v);
          },
          static_cast<double>(2 * roughness)};
}

/// Of the angle from the normal; the kernel has it from the cosine.
Real sine(const Vector& x) {
  return std::max(std::hypot(x.x, x.y), 1e-12L);
}

ModelCase smith(const std::string& m, const std::string& f0) {
  const Real roughness = std::stold(m);
  const Real at_normal = std::stold(f0);
  return {"cook_torrance_smith:m=" + m + ",f0=" + f0,
          [=](const Vector& l, const Vector& v) { return reference::cook_torrance_smith(l, v, roughness, at_normal); },
          [=](const Vector& l, const Vector& v) {
            return 1 + tan_squared_delta(half_vector(l, v)) / (roughness * roughness) +
                   schlick_condition(at_normal, l, v) + roughness / sine(l) + roughness / sine(v);
          },
          static_cast<double>(2 * roughness)};
}

ModelCase torrance(const std::string& m, const std::string& f0) {
  const Real width = std::stold(m);
  const Real at_normal = std::stold(f0);
  return {"cook_torrance_torrance:m=" + m + ",f0=" + f0,
          [=](const Vector& l, const Vector& v) { return reference::cook_torrance_torrance(l, v, width, at_normal); },
          // 1 + delta^2 / m^2
          [=](const Vector& l, const Vector& v) {
            const Real delta = std::atan(std::sqrt(tan_squared_delta(half_vector(l, v))));
            return 1 + delta * delta / (width * width) + schlick_condition(at_normal, l, v);
          },
          static_cast<double>(2 * width)};
}

ModelCase trowbridge(const std::string& q, const std::string& f0) {
  const Real width = std::stold(q);
  const Real at_normal = std::stold(f0);
  return {"cook_torrance_trowbridge:q=" + q + ",f0=" + f0,
          [=](const Vector& l, const Vector& v) { return reference::cook_torrance_trowbridge(l, v, width, at_normal); },
          [=](const Vector& l, const Vector& v) { return 1 + schlick_condition(at_normal, l, v); },
          static_cast<double>(2 * width)};
}

/// A case with f0 = 1, where F = 1, times Fresnel's equations.
ModelCase with_fresnel(ModelCase plain, const std::string& n, const std::string& k) {
  const Real index = std::stold(n);
  const Real extinction = std::stold(k);
  const auto reflectance = [=](Real cosine) { return reference::fresnel(cosine, index, extinction); };
  plain.name.insert(plain.name.find(':'), "_fresnel");
  plain.name.replace(plain.name.find(",f0=1"), 5, ",ior=" + n + ",k=" + k);
  plain.f = [=, f = plain.f](const Vector& l, const Vector& v) { return f(l, v) * reflectance(length(l + v) / 2); };
  plain.condition = [=, condition = plain.condition](const Vector& l, const Vector& v) {
    return condition(l, v) + fresnel_condition(reflectance, l, v);
  };
  return plain;
}

INSTANTIATE_TEST_SUITE_P(cook_torrance_blinn, ModelKernel,
                         ::testing::Values(blinn("1", "1"), blinn("20", "0.04"), blinn("5000", "1")), ByName{});
INSTANTIATE_TEST_SUITE_P(cook_torrance_fresnel, ModelKernel,
                         ::testing::Values(fresnel("0.05", "0.331", "2.324"), fresnel("0.3", "1.5", "0"),
                                           fresnel("0.2", "0.18", "3.64"), fresnel("0.5", "0.7", "0"),
                                           fresnel("0.5", "2.97", "4.58")),
                         ByName{});
INSTANTIATE_TEST_SUITE_P(cook_torrance_smith, ModelKernel,
                         ::testing::Values(smith("0.01", "1"), smith("0.3", "0.04"), smith("1", "1")), ByName{});
INSTANTIATE_TEST_SUITE_P(cook_torrance_torrance, ModelKernel,
                         ::testing::Values(torrance("0.01", "1"), torrance("0.3", "0.04"), torrance("2", "1")),
                         ByName{});
INSTANTIATE_TEST_SUITE_P(cook_torrance_trowbridge, ModelKernel,
                         ::testing::Values(trowbridge("0.01", "1"), trowbridge("0.3", "0.04"), trowbridge("1", "1")),
                         ByName{});

INSTANTIATE_TEST_SUITE_P(cook_torrance_blinn_fresnel, ModelKernel,
                         ::testing::Values(with_fresnel(blinn("20", "1"), "1.5", "0"),
                                           with_fresnel(blinn("5000", "1"), "0.331", "2.324")),
                         ByName{});
INSTANTIATE_TEST_SUITE_P(cook_torrance_smith_fresnel, ModelKernel,
                         ::testing::Values(with_fresnel(smith("0.3", "1"), "1.5", "0"),
                                           with_fresnel(smith("0.01", "1"), "0.331", "2.324")),
                         ByName{});
INSTANTIATE_TEST_SUITE_P(cook_torrance_torrance_fresnel, ModelKernel,
                         ::testing::Values(with_fresnel(torrance("0.3", "1"), "1.5", "0"),
                                           with_fresnel(torrance("0.01", "1"), "0.331", "2.324")),
                         ByName{});
INSTANTIATE_TEST_SUITE_P(cook_torrance_trowbridge_fresnel, ModelKernel,
                         ::testing::Values(with_fresnel(trowbridge("0.3", "1"), "1.5", "0"),
                                           with_fresnel(trowbridge("0.01", "1"), "0.331", "2.324")),
                         ByName{});

}  // namespace
}  // namespace lobe::test
