#include <cmath>

#include "models/family/fresnel_condition.hpp"
#include "models/model_test.hpp"

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

}  // namespace

ModelTest low_microfacet_test() {
  return {.budget = {4, 0.86, 2, 0.53},
          .cases = {low_microfacet("1", "0", "1", "1.5"), low_microfacet("1190", "255868", "1.08", "1.475"),
                    low_microfacet("0.5", "34", "1.02", "1.67"), low_microfacet("0.74", "16122", "0.217", "1.81")},
          .excess = AlbedoExcess{"low_microfacet:A=100,B=34,C=1.02,ior=1.67", 0, 2.8426}};
}

}  // namespace lobe::test
