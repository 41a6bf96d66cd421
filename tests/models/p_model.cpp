#include <algorithm>
#include <cmath>

#include "models/family/phong_variants.hpp"
#include "models/model_test.hpp"

namespace lobe::test {
namespace {

ModelCase p_model(const std::string& n, const std::string& p) {
  const Real exponent = std::stold(n);
  const Real share = std::stold(p);
  return {"p_model:n=" + n + ",p=" + p,
          [=](const Vector& l, const Vector& v) { return reference::p_model(l, v, exponent, share); },
          [=](const Vector& l, const Vector& v) {
            return mirror_condition(exponent, l, v) + std::abs(std::log(std::max(l.z, v.z)));
          },
          static_cast<double>(1 / std::sqrt(exponent)), floor_of(exponent)};
}

}  // namespace

ModelTest p_model_test() {
  return {.budget = {8, 1.7, 1, 0.3},
          .cases = {p_model("1", "0.5"), p_model("20", "0"), p_model("20", "0.5"), p_model("5000", "1")},
          .excess = AlbedoExcess{"p_model:n=0.5,p=1", 30, 1.0106}};
}

}  // namespace lobe::test
