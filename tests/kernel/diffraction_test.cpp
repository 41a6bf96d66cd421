#include <gtest/gtest.h>

#include <vector>

#include "model/evaluate.hpp"
#include "models/family/diffraction.hpp"
#include "models/model_test.hpp"
#include "support/device.hpp"

namespace lobe::test {
namespace {

// Beckmann's limit of rough surfaces, sum -> exp(-spread/g)/g: Cook-Torrance with Smith's attenuation. What is left is
// of the order 1/g, here 1/39.
TEST(HeTorrance, OfARoughSurfaceIsNearlyCookTorrance) {
  const auto half_turn = static_cast<double>(kPi);
  const std::vector<Directions> pairs{{0.2, 0.2, half_turn}, {0.2, 0.3, half_turn}, {0.5, 0.4, 3}};

  const auto wave = evaluate(device(), parse_material("he_torrance:sigma=0.5,tau=5,ior=1.5"), pairs);
  const auto ray = evaluate(device(), parse_material("cook_torrance_smith_fresnel:m=0.2,ior=1.5"), pairs);

  for (Eigen::Index i = 0; i < wave.rows(); ++i) EXPECT_NEAR(wave(i, 0), ray(i, 0), 2.0 / 39 * ray(i, 0)) << i;
}

}  // namespace
}  // namespace lobe::test
