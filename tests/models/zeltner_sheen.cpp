#include <algorithm>
#include <cmath>
#include <numbers>
#include <string>

#include "models/model_test.hpp"

namespace lobe::test {
namespace {

using std::numbers::pi_v;

/// MaterialX, mx_zeltner_sheen_dir_albedo(): the Gaussian by its exponent, and what is added to it.
struct SheenShare {
  SheenShare(Real x, Real y) {
    const Real s = y * (0.0206607L + 1.58491L * y) / (0.0379424L + y * (1.32227L + y));
    const Real m = y * (-0.193854L + y * (-1.14885L + y * (1.7932L - 0.95943L * y * y))) / (0.046391L + y);
    exponent = std::pow((x - m) / s, 2.0L) / 2;
    gaussian = std::exp(-exponent) / (s * std::sqrt(2 * pi_v<Real>));
    offset = y * (0.000654023L + (-0.0207818L + 0.119681L * y) * y) / (1.26264L + y * (-1.92021L + y));
  }
  [[nodiscard]] Real value() const { return gaussian + std::max(0.0L, offset); }
  Real exponent, gaussian, offset;
};

/// mx_zeltner_sheen_ltc_aInv() and mx_zeltner_sheen_ltc_bInv().
Real a_inverse(Real x, Real y) {
  return (2.58126L * x + 0.813703L * y) * y / (1 + 0.310327L * x * x + 2.60994L * x * y);
}

Real b_inverse(Real x, Real y) {
  return std::sqrt(1 - x) * (y - 1) * y * y * y / (0.0000254053L + 1.71228L * x - 1.71506L * x * y + 1.34174L * y * y);
}

/// Density of a direction by the cosine that the inverse matrix makes of it: D(M^-1 w / |M^-1 w|) |M^-1| / |M^-1 w|^3
/// (Heitz et al. 2016, eq. 1), in the axes of the view.
Real transformed_cosine(const Vector& light, const Vector& view, Real a, Real b) {
  const Real sine = std::hypot(view.x, view.y);
  const Vector axis = sine > 0 ? Vector{view.x / sine, view.y / sine, 0} : Vector{1, 0, 0};
  const Real x = light.x * axis.x + light.y * axis.y;
  const Real y = light.y * axis.x - light.x * axis.y;
  const Vector original{a * x + b * light.z, a * y, light.z};
  const Real length = reference::length(original);
  return original.z / length / pi_v<Real> * (a * a) / (length * length * length);
}

ModelCase zeltner_sheen(const std::string& text) {
  const Real alpha = std::stold(text);
  return {"zeltner_sheen:alpha=" + text,
          [=](const Vector& l, const Vector& v) {
            return SheenShare(v.z, alpha).value() *
                   transformed_cosine(l, v, a_inverse(v.z, alpha), b_inverse(v.z, alpha)) / l.z;
          },
          // An ulp of the exponent.
          [=](const Vector&, const Vector& v) {
            const SheenShare share(v.z, alpha);
            return 1 + share.gaussian * share.exponent / share.value();
          },
          1};
}

}  // namespace

ModelTest zeltner_sheen_test() {
  return {.budget = {32, 6.3, 32, 6.1},
          .cases = {zeltner_sheen("0.01"), zeltner_sheen("0.08"), zeltner_sheen("0.5"), zeltner_sheen("1")},
          .excess = AlbedoExcess{"zeltner_sheen:alpha=0.1", 89.99, 4.415}};
}

}  // namespace lobe::test
