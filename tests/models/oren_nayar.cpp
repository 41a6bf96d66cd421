#include <algorithm>

#include "models/model_test.hpp"

namespace lobe::test {
namespace {

ModelCase oren_nayar(const std::string& sigma, const std::string& a_denominator) {
  const Real slope = std::stold(sigma);
  const Real denominator = std::stold(a_denominator);
  return {"oren_nayar:sigma=" + sigma + ",a_denominator=" + a_denominator,
          [=](const Vector& l, const Vector& v) { return reference::oren_nayar(l, v, slope, denominator); },
          // 1 + 1/max(N.L, N.V): the difference L.V - N.L N.V has an absolute error of an ulp
          [=](const Vector& l, const Vector& v) { return 1 + 1 / std::max(l.z, v.z); }, 1};
}

}  // namespace

ModelTest oren_nayar_test() {
  return {.budget = {4, 1.4, 4, 0.9},
          .cases = {oren_nayar("0", "0.33"), oren_nayar("0.2", "0.33"), oren_nayar("0.5", "0.33"),
                    oren_nayar("0.5", "0.5"), oren_nayar("1.5", "0.33")},
          .excess = AlbedoExcess{"oren_nayar:sigma=0.2", 89.99, 1.015}};
}

}  // namespace lobe::test
