#include <cmath>

#include "kernel/microfacet_cases.hpp"

namespace lobe::test {
namespace {

ModelCase low_microfacet(const std::string& a, const std::string& b, const std::string& c, const std::string& ior) {
  const Real peak = std::stold(a);
  const Real sharpness = std::stold(b);
  const Real decay = std::stold(c);
  const Real index = std::stold(ior);
  return {
      "low_microfacet:A=" + a + ",B=" + b + ",C=" + c + ",ior=" + ior,
      [=](const Vector& l, const Vector& v) { return reference::low_microfacet(l, v, peak, sharpness, decay, index); },
      // 1 + C (1 + ln(1 + B (1 - N.H)))
      [=](const Vector& l, const Vector& v) {
        const Real away = 1 - 1 / std::sqrt(1 + tan_squared_delta(half_vector(l, v)));
        return 1 + decay * (1 + std::log1p(sharpness * away)) +
               fresnel_condition([=](Real cosine) { return reference::fresnel(cosine, index, 0); }, l, v);
      },
      static_cast<double>(1 / std::sqrt(1 + sharpness))};
}

ModelCase low_smooth(const std::string& a, const std::string& b, const std::string& c, const std::string& ior) {
  const Real peak = std::stold(a);
  const Real sharpness = std::stold(b);
  const Real decay = std::stold(c);
  const Real index = std::stold(ior);
  return {"low_smooth:A=" + a + ",B=" + b + ",C=" + c + ",ior=" + ior,
          [=](const Vector& l, const Vector& v) { return reference::low_smooth(l, v, peak, sharpness, decay, index); },
          // 1 + C (1 + ln(1 + B |V_P - L'_P|^2))
          [=](const Vector& l, const Vector& v) {
            const Real distance = std::hypot(l.x + v.x, l.y + v.y);
            const Real sine = std::hypot(l.x - v.x, l.y - v.y) / 2;
            return 1 + decay * (1 + std::log1p(sharpness * distance * distance)) +
                   condition_at([=](Real cosine) { return reference::fresnel(cosine, index, 0); },
                                std::sqrt((1 - sine) * (1 + sine)));
          },
          static_cast<double>(1 / std::sqrt(1 + sharpness))};
}

INSTANTIATE_TEST_SUITE_P(low_microfacet, ModelKernel,
                         ::testing::Values(low_microfacet("1", "0", "1", "1.5"),
                                           low_microfacet("1190", "255868", "1.08", "1.475"),
                                           low_microfacet("0.5", "34", "1.02", "1.67"),
                                           low_microfacet("0.74", "16122", "0.217", "1.81")),
                         ByName{});

INSTANTIATE_TEST_SUITE_P(low_smooth, ModelKernel,
                         ::testing::Values(low_smooth("1", "0", "1", "1.5"),
                                           low_smooth("164.16745", "16711.814477", "0.663506", "1.56082"),
                                           low_smooth("0.9966", "7.105873", "0.04552", "1.34257"),
                                           low_smooth("778.91415", "75544.810541", "1.045481", "6.59476")),
                         ByName{});

}  // namespace
}  // namespace lobe::test
