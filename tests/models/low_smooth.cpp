#include <cmath>

#include "models/family/fresnel_condition.hpp"
#include "models/model_test.hpp"

namespace lobe::test {
namespace {

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

}  // namespace

ModelTest low_smooth_test() {
  return {.budget = {4, 1, 4, 0.93},
          .cases = {low_smooth("1", "0", "1", "1.5"), low_smooth("164.16745", "16711.814477", "0.663506", "1.56082"),
                    low_smooth("0.9966", "7.105873", "0.04552", "1.34257"),
                    low_smooth("778.91415", "75544.810541", "1.045481", "6.59476")},
          .excess = AlbedoExcess{"low_smooth:A=100,B=34,C=1.02,ior=1.67", 80, 2.4976}};
}

}  // namespace lobe::test
