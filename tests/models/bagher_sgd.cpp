#include <algorithm>
#include <cmath>
#include <vector>

#include "models/family/bagher_sgd.hpp"
#include "models/family/fresnel_condition.hpp"
#include "models/model_test.hpp"

namespace lobe::test {
namespace {

/// Where the projection of L + V is as short as that, the reference itself loses digits of x: it is a difference of
/// sines, with the 2^-11 of an ulp that its arithmetic has.
constexpr Real kLostProjection = 1e-4L;

std::vector<ModelCase> cases() {
  std::vector<ModelCase> list;
  for (const auto& [parameters, fit, normalisation, rate] : kPublished) {
    const Real constant = fit.normalisation();
    list.push_back(
        {"bagher_sgd:" + parameters,
         [fit = fit, constant](const Vector& l, const Vector& v) { return reference::bagher_sgd(l, v, fit, constant); },
         // 1 + x + p (1 + |ln x|) + (1 + f0 + |f1| + |F'|) / F
         [fit = fit](const Vector& l, const Vector& v) {
           const Real cosine = length(l + v) / 2;
           const Real x = fit.alpha + tan_squared_delta(half_vector(l, v)) / fit.alpha;
           const Real across = std::hypot(l.x + v.x, l.y + v.y);
           const Real lost = across > 0 ? kLostProjection / across : 0;
           return 1 + x + fit.p * (1 + std::abs(std::log(x)) + lost) +
                  condition_at([&](Real c) { return fit.reflectance(c); }, cosine) +
                  (fit.f0 + std::abs(fit.f1)) / fit.reflectance(cosine);
         },
         static_cast<double>(std::min(1.0L, 2 * fit.alpha))});
  }
  return list;
}

}  // namespace

ModelTest bagher_sgd_test() {
  return {
      .budget = {16, 3.6, 4, 1.2}, .cases = cases(), .excess = AlbedoExcess{"bagher_sgd:alpha=0.1,p=0.5", 0, 1.2722}};
}

}  // namespace lobe::test
