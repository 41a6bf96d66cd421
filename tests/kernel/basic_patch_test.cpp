#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "model/evaluate.hpp"
#include "models/model_test.hpp"
#include "support/device.hpp"

namespace lobe::test {
namespace {

TEST(BasicPatch, OfTheWholeBasePlaneIsLambertAlsoInTheGrazingRetroDirection) {
  const double theta = std::nextafter(std::acos(0.0), 0);
  const std::vector<Directions> retro{{theta, theta, 0}, {1.5, 1.5, 0}, {0, 0, 0}};

  EXPECT_EQ(evaluate(device(), parse_material("basic_patch:R=2"), retro),
            evaluate(device(), parse_material("lambert"), retro));
}

TEST(RetroPatch, OfTheWholeBasePlaneIsLambertAlsoInTheGrazingMirrorDirection) {
  const double theta = std::nextafter(std::acos(0.0), 0);
  const std::vector<Directions> mirror{{theta, theta, 2 * std::acos(0.0)}, {1.5, 1.5, 2 * std::acos(0.0)}, {0, 0, 0}};

  EXPECT_EQ(evaluate(device(), parse_material("retro_patch:R=2"), mirror),
            evaluate(device(), parse_material("lambert"), mirror));
}

TEST(RetroPatch, IsTheBasicPatchOfMirroredDirections) {
  const std::vector<Directions> pairs{{0.3, 0.5, 0.2}, {1.2, 1.1, 0.3}, {0.1, 1.4, 2}, {1.5, 1.5, 1e-3}};
  std::vector<Directions> mirrored;
  for (const auto& pair : pairs)
    mirrored.push_back({pair.theta_in, pair.theta_out, 2 * std::acos(0.0) - pair.delta_phi});

  EXPECT_EQ(evaluate(device(), parse_material("retro_patch:R=0.3"), pairs),
            evaluate(device(), parse_material("basic_patch:R=0.3"), mirrored));
}

}  // namespace
}  // namespace lobe::test
