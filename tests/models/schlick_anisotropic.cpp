#include <algorithm>
#include <cmath>
#include <string>

#include "models/model_test.hpp"

namespace lobe::test {
namespace {

/// Length of L + V along the base plane below which the reference loses the azimuth of H.
constexpr Real kLostAzimuth = 1e-3L;

/// Whether rounding of angles is all that parts V from the mirror direction of L.
bool is_mirrored(const Vector& l, const Vector& v) {
  const Vector sum = l + v;
  return std::max(std::abs(sum.x), std::abs(sum.y)) <= 4e-15L * (std::abs(l.x) + std::abs(l.y));
}

ModelCase schlick(const std::string& r, const std::string& p, const std::string& rotation) {
  const Real roughness = std::stold(r);
  const Real isotropy = std::stold(p);
  const Real turn = std::stod(rotation);
  return {"schlick_anisotropic:r=" + r + ",p=" + p + ",rotation=" + rotation,
          [=](const Vector& l, const Vector& v) {
            return is_mirrored(l, v) ? reference::schlick(l, v, roughness) / std::sqrt(isotropy)
                                     : reference::schlick_anisotropic(l, v, roughness, isotropy, turn);
          },
          [=](const Vector& l, const Vector& v) {
            const Vector sum = l + v;
            const Real across = std::hypot(sum.x, sum.y);
            return (across > 0 ? 1 + kLostAzimuth / across : 1) / isotropy;
          },
          static_cast<double>(2 * std::sqrt(roughness))};
}

}  // namespace

ModelTest schlick_anisotropic_test() {
  return {.budget = {16, 4, 16, 2.9},
          .cases = {schlick("0.2", "1", "0"), schlick("0.01", "0.3", "0"), schlick("0.0001", "0.1", "0.6")},
          .excess = AlbedoExcess{"schlick_anisotropic:r=0.01,p=0.5", 89.99, 4.02}};
}

}  // namespace lobe::test
