#include "models/family/rough_diffuse.hpp"
#include "models/model_test.hpp"

namespace lobe::test {
namespace {

ModelCase eon(const std::string& roughness, const std::string& reflectance) {
  const Real r = std::stold(roughness);
  const Real rho = std::stold(reflectance);
  const auto f = [=](const Vector& l, const Vector& v) {
    const Real mean = fujii_normal(r) * (1 + (2.0L / 3 - 28 / (15 * kCircle)) * r);
    const Real first = rho / kCircle * fujii_normal(r) * (1 + r * fujii_ratio(l, v));
    if (r == 0) return first;
    const Real multiple = rho * rho * mean / (1 - rho * (1 - mean));
    return first + multiple / kCircle * (1 - fujii_albedo(l, r)) * (1 - fujii_albedo(v, r)) / (1 - mean);
  };
  return {"eon:r=" + roughness + ",rho=" + reflectance, f,
          [=](const Vector& l, const Vector& v) {
            return 1 + (1 + 1 / std::max(l.z, v.z)) * rho * fujii_normal(r) / (kCircle * std::max(f(l, v), 1e-10L));
          },
          1};
}

}  // namespace

ModelTest eon_test() {
  return {.budget = {8, 2.1, 8, 0.95}, .cases = {eon("0", "1"), eon("0.3", "1"), eon("1", "1"), eon("0.7", "0.4")}};
}

}  // namespace lobe::test
