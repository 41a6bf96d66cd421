#include "hemisphere/geometry.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <ostream>
#include <string>

#include "lobe/core/directions.hpp"
#include "reference/vector.hpp"
#include "support/names.hpp"

namespace lobe::test {
namespace {

using reference::Real;
using std::numbers::pi;
constexpr double kRelative = 2e-15;

/// What the reference loses in a square of differences: an ulp of the differences.
double cancelled(Real square) {
  return static_cast<double>(std::sqrt(square)) * 1e-18 + 1e-36;
}

struct Pair {
  std::string name;
  Directions directions;
};
std::ostream& operator<<(std::ostream& out, const Pair& pair) {
  return out << pair.name;
}

class Geometry : public ::testing::TestWithParam<Pair> {
 protected:
  void expect_relative(double value, Real expected) const {
    EXPECT_NEAR(value, static_cast<double>(expected), 8e-16 * static_cast<double>(std::abs(expected)));
  }
  reference::Vector light_ = reference::light_of(GetParam().directions);
  reference::Vector view_ = reference::view_of(GetParam().directions);
  reference::Vector half_ = reference::half_vector(light_, view_);
  NodeBlock::Node node_ = node_of_directions(GetParam().directions);
};

TEST_P(Geometry, CosinesKeepRelativeAccuracy) {
  expect_relative(node_[NodeBlock::cos_i], light_.z);
  expect_relative(node_[NodeBlock::cos_o], view_.z);
  expect_relative(node_[NodeBlock::cos_h], half_.z);
  expect_relative(node_[NodeBlock::cos_d], length(light_ + view_) / 2);
}

TEST_P(Geometry, SlopeOfTheHalfVectorKeepsRelativeAccuracy) {
  const Real expected = tan_squared_delta(half_);

  EXPECT_NEAR(node_[NodeBlock::tan2_h], static_cast<double>(expected),
              kRelative * static_cast<double>(expected) + cancelled(expected));
}

TEST_P(Geometry, LogarithmOfMirrorCosineKeepsRelativeAccuracy) {
  const auto difference = reference::mirrored(light_) - view_;
  const Real deficit = dot(difference, difference) / 2;

  if (deficit < 1) {
    const Real expected = std::log1p(-deficit);
    EXPECT_NEAR(node_[NodeBlock::log_rv], static_cast<double>(expected),
                kRelative * static_cast<double>(std::abs(expected) / (1 - deficit)) + cancelled(deficit));
  } else {
    EXPECT_LE(node_[NodeBlock::log_rv], -1e29);
  }
}

TEST_P(Geometry, TangentsAtAnAzimuthKeepTheAccuracyOfTheirLength) {
  Directions turned = GetParam().directions;
  turned.phi_in = 0.7;
  const auto tangents = tangents_of_directions(turned);

  const auto light = reference::light_of(turned);
  const auto half = reference::half_vector(light, reference::view_of(turned));
  const Real slope2 = tan_squared_delta(half);
  // The reference's own rounding of L + V, whose length along the normal is that of both cosines.
  const double lost = 1e-18 / node_[NodeBlock::cos_i];
  const double tolerance = kRelative * static_cast<double>(std::sqrt(slope2)) + lost;
  EXPECT_NEAR(tangents[NodeBlock::slope_x], static_cast<double>(half.x / half.z), tolerance);
  EXPECT_NEAR(tangents[NodeBlock::slope_y], static_cast<double>(half.y / half.z), tolerance);
  EXPECT_NEAR(tangents[NodeBlock::in_x], static_cast<double>(light.x), 4e-16);
  EXPECT_NEAR(tangents[NodeBlock::in_y], static_cast<double>(light.y), 4e-16);
}

INSTANTIATE_TEST_SUITE_P(
    hemisphere, Geometry,
    ::testing::Values(Pair{"normal", {0, 0, 0}}, Pair{"mirror_45", {45 * kDegree, 45 * kDegree, pi}},
                      Pair{"near_mirror_45", {45 * kDegree, 45.0001 * kDegree, pi}},
                      Pair{"beside_mirror_45", {45 * kDegree, 45 * kDegree, pi - 1e-6}},
                      Pair{"retro_60", {60 * kDegree, 60 * kDegree, 0}},
                      Pair{"mirror_grazing", {89.99 * kDegree, 89.99 * kDegree, pi}},
                      Pair{"near_mirror_grazing", {89.99 * kDegree, 89.9900001 * kDegree, pi - 1e-7}},
                      Pair{"retro_grazing", {89.99 * kDegree, 89.99 * kDegree, 0}},
                      Pair{"across", {20 * kDegree, 70 * kDegree, pi / 2}},
                      Pair{"normal_to_grazing", {0, 89.99 * kDegree, 1}}),
    ByName{});

}  // namespace
}  // namespace lobe::test
