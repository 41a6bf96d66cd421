#include <algorithm>

#include "models/model_test.hpp"

namespace lobe::test {
namespace {

ModelCase oren_nayar_full(const std::string& sigma, const std::string& rho) {
  const Real slope = std::stold(sigma);
  const Real reflectance = std::stold(rho);
  return {"oren_nayar_full:sigma=" + sigma + ",rho=" + rho,
          [=](const Vector& l, const Vector& v) { return reference::oren_nayar_full(l, v, slope, reflectance, 0.33L); },
          // Tangents of an angle whose cosine is off by an ulp, in terms that may all but cancel: (1 + tan) (1 + rho/f)
          [=](const Vector& l, const Vector& v) {
            const Real f = reference::oren_nayar_full(l, v, slope, reflectance, 0.33L);
            return (1 + 1 / std::max(l.z, v.z)) * (1 + reflectance / f);
          },
          1};
}

}  // namespace

ModelTest oren_nayar_full_test() {
  return {.budget = {2, 0.27, 4, 0.87},
          .cases = {oren_nayar_full("0", "1"), oren_nayar_full("0.3", "0.9"), oren_nayar_full("0.5", "0.1"),
                    oren_nayar_full("1.5", "1")},
          .excess = AlbedoExcess{"oren_nayar_full:sigma=0.25", 89.99, 1.048}};
}

}  // namespace lobe::test
