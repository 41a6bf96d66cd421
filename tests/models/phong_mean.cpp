#include <cmath>

#include "models/family/phong_variants.hpp"
#include "models/model_test.hpp"

namespace lobe::test {
namespace {

ModelCase phong_mean(const std::string& n, const std::string& p) {
  const Real exponent = std::stold(n);
  const Real power = std::stold(p);
  return {"phong_mean:n=" + n + ",p=" + p,
          [=](const Vector& l, const Vector& v) { return reference::phong_mean(l, v, exponent, power); },
          [=](const Vector& l, const Vector& v) {
            return mirror_condition(exponent, l, v) + std::abs(std::log(l.z)) + std::abs(std::log(v.z));
          },
          static_cast<double>(1 / std::sqrt(exponent)), floor_of(exponent)};
}

}  // namespace

ModelTest phong_mean_test() {
  return {.budget = {8, 1.8, 1, 0.3},
          .cases = {phong_mean("1", "1"), phong_mean("20", "-1"), phong_mean("20", "0"), phong_mean("100", "8"),
                    phong_mean("20", "0.001")},
          .excess = AlbedoExcess{"phong_mean:n=20,p=1", 89.99, 1.0434}};
}

}  // namespace lobe::test
