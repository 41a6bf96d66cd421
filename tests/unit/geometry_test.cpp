#include "hemisphere/geometry.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <numbers>
#include <ostream>
#include <string>
#include <vector>

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

/// Elevations of two directions above the horizon, and the azimuth from the mirror side.
struct Place {
  double in, out, psi;
};

/// How far nodes may lie apart, relatively: vector functions are right to four ulps, the sine enters squared, and the
/// logarithm adds its own; the rest is for the steps between.
constexpr double kOfSeveral = 16 * 2.3e-16;

void expect_same_node(const NodeBlock::Node& node, const NodeBlock::Node& expected, const std::string& where) {
  for (const auto row : {NodeBlock::cos_i, NodeBlock::cos_o, NodeBlock::factor}) {
    EXPECT_EQ(node[row], expected[row]) << where << ", row " << row;
  }
  for (const auto row : {NodeBlock::cos_h, NodeBlock::cos_d, NodeBlock::tan2_h, NodeBlock::log_cos_h}) {
    EXPECT_NEAR(node[row], expected[row], kOfSeveral * std::abs(expected[row])) << where << ", row " << row;
  }
  const double log_rv = expected[NodeBlock::log_rv];
  constexpr double kRounded = -30;  // R.V is 0 but for rounding
  if (log_rv < kRounded) {
    EXPECT_LT(node[NodeBlock::log_rv], kRounded) << where;
    return;
  }
  // 1 - R.V is as accurate; its logarithm is far from 1 where R.V is small.
  const double deficit = -std::expm1(log_rv);
  const double tolerance = kOfSeveral * std::max(std::abs(log_rv), deficit / (1 - deficit));
  EXPECT_NEAR(node[NodeBlock::log_rv], log_rv, tolerance) << where << ", ln(R.V)";
}

NodeBlock::Node node_in(const NodeBlock& block, std::size_t column) {
  NodeBlock::Node node;
  for (std::size_t row = 0; row < NodeBlock::kRows; ++row) node[row] = block.data()[row * block.capacity() + column];
  return node;
}

TEST(CompleteNodes, AreThoseThatAreMadeOneByOne) {
  std::vector<Place> places;
  // Both elevations nearly the same, far apart, at the horizon and at the normal; psi on both sides of the mirror
  // direction, which is also at 2 pi, across and behind, and where R.V is nearly 0.
  for (const double in : {1e-9, 1e-3, 0.4, pi / 4, 1.2, pi / 2}) {
    for (const double out : {in, in * (1 + 1e-9), 1e-8, 0.3, 1.1, pi / 2}) {
      for (const double psi :
           {0.0, 1e-12, -1e-9, 1e-4, 0.02, 0.5, 1.0, pi / 2, 2.5, pi, 4.0, 2 * pi - 0.3, 2 * pi, -pi}) {
        places.push_back({in, out, psi});
      }
    }
  }
  NodeBlock block(places.size());
  std::vector<NodeBlock::Node> expected;
  for (const auto& [in, out, psi] : places) {
    const double factor = 0.5 + 0.001 * static_cast<double>(expected.size());
    place_node(block, elevation_pair(in, out), psi, factor);
    expected.push_back(node_of_elevations(in, out, psi, factor));
  }
  ASSERT_EQ(block.size(), places.size());
  complete_nodes(block, 0, block.size());
  std::size_t behind = 0;
  for (std::size_t k = 0; k < places.size(); ++k) {
    const auto& [in, out, psi] = places[k];
    expect_same_node(node_in(block, k), expected[k], ::testing::PrintToString(std::vector{in, out, psi}));
    if (expected[k][NodeBlock::log_rv] == kNoMirrorCosine) ++behind;
  }
  EXPECT_GT(behind, places.size() / 10);
  EXPECT_LT(behind, places.size() / 2);
}

TEST(CompleteNodes, LeaveOtherColumnsAlone) {
  constexpr std::size_t kColumns = 24;
  const ElevationPair pair = elevation_pair(0.7, 0.9);
  for (const std::size_t count : {0U, 1U, 2U, 3U, 4U, 7U, 8U, 9U, 15U, 17U}) {
    NodeBlock block(kColumns);
    for (std::size_t k = 0; k < kColumns; ++k) place_node(block, pair, 0.1 * static_cast<double>(k), 1);
    const std::vector<double> before(block.data().begin(), block.data().end());
    complete_nodes(block, 3, count);
    for (std::size_t k = 0; k < kColumns; ++k) {
      const bool is_made = k >= 3 && k < 3 + count;
      const std::size_t at = NodeBlock::log_rv * kColumns + k;
      EXPECT_EQ(block.data()[at] != before[at], is_made) << k << " of " << count;
      if (is_made) {
        const std::string where = std::to_string(k) + " of " + std::to_string(count);
        expect_same_node(node_in(block, k), node_of_azimuth(pair, 0.1 * static_cast<double>(k), 1), where);
      } else {
        for (std::size_t row = 0; row < NodeBlock::kRows; ++row) {
          EXPECT_EQ(block.data()[row * kColumns + k], before[row * kColumns + k])
              << row << ", " << k << " of " << count;
        }
      }
    }
  }
}

TEST(CompleteNodes, DoNotDependOnThoseBesideThem) {
  constexpr std::size_t kColumns = 29;
  const ElevationPair pair = elevation_pair(0.2, 1.3);
  NodeBlock together(kColumns);
  for (std::size_t k = 0; k < kColumns; ++k) place_node(together, pair, 0.21 * static_cast<double>(k), 1);
  complete_nodes(together, 0, kColumns);
  for (std::size_t k = 0; k < kColumns; ++k) {
    NodeBlock alone(1);
    place_node(alone, pair, 0.21 * static_cast<double>(k), 1);
    complete_nodes(alone, 0, 1);
    EXPECT_EQ(node_in(alone, 0), node_in(together, k)) << k;
  }
}

/// Pairs of directions of all kinds: near each other, near the mirror direction, at the normal and towards the horizon.
std::vector<Directions> many_directions() {
  std::vector<Directions> found;
  for (const double in : {0.0, 1e-9, 0.3, 1.1, 89.99 * kDegree, pi / 2 - 1e-9}) {
    for (const double out : {in, in * (1 - 1e-9), 0.0, 0.4, 1.2, 89.9999 * kDegree}) {
      for (const double delta_phi : {0.0, pi, pi - 1e-7, -pi + 1e-3, 1.0, 3.3, 2 * pi, 9.0, -20.0}) {
        const double turn = 0.37 * static_cast<double>(found.size());
        found.push_back({in, out, delta_phi, turn});
      }
    }
  }
  return found;
}

std::string told(const Directions& pair) {
  return ::testing::PrintToString(std::vector{pair.theta_in, pair.theta_out, pair.delta_phi, pair.phi_in});
}

class CompleteDirections : public ::testing::TestWithParam<bool> {
 protected:
  static NodeBlock block_of(const std::vector<Directions>& pairs) {
    NodeBlock block(std::max<std::size_t>(pairs.size(), 1), GetParam());
    for (std::size_t k = 0; k < pairs.size(); ++k) place_directions(block, pairs[k], factor_of(k));
    complete_directions(block, 0, block.size());
    return block;
  }
  static double factor_of(std::size_t k) { return 0.5 + 0.001 * static_cast<double>(k); }
};

// Vector functions are right to four ulps, here of angles and cosines; differences of angles are exact.
TEST_P(CompleteDirections, AreThoseThatAreMadeOneByOne) {
  const std::vector<Directions> pairs = many_directions();
  const NodeBlock block = block_of(pairs);
  ASSERT_EQ(block.size(), pairs.size());
  for (std::size_t k = 0; k < pairs.size(); ++k) {
    NodeBlock::Node expected = node_of_directions(pairs[k]);
    const NodeBlock::Node found = node_in(block, k);
    EXPECT_EQ(found[NodeBlock::factor], factor_of(k)) << told(pairs[k]);
    for (const auto row : {NodeBlock::cos_i, NodeBlock::cos_o}) {
      EXPECT_NEAR(found[row], expected[row], kOfSeveral * expected[row]) << told(pairs[k]) << ", row " << row;
      expected[row] = found[row];
    }
    expected[NodeBlock::factor] = found[NodeBlock::factor];
    expect_same_node(found, expected, told(pairs[k]));
    if (!GetParam()) continue;
    const auto tangents = tangents_of_directions(pairs[k]);
    const double slope = std::sqrt(expected[NodeBlock::tan2_h]);
    for (std::size_t row = 0; row < NodeBlock::kTangentRows; ++row) {
      const double size = row < NodeBlock::in_x ? slope : std::sin(pairs[k].theta_in);
      const double value = block.data()[(NodeBlock::kRows + row) * block.capacity() + k];
      EXPECT_NEAR(value, tangents[row], kOfSeveral * size) << told(pairs[k]) << ", tangent " << row;
    }
  }
}

TEST_P(CompleteDirections, DoNotDependOnThoseBesideThem) {
  const std::vector<Directions> pairs = many_directions();
  const NodeBlock together = block_of(pairs);
  for (std::size_t k = 0; k < pairs.size(); k += 7) {
    const NodeBlock alone = block_of({pairs[k]});
    for (std::size_t row = 0; row < together.rows(); ++row) {
      if (row == NodeBlock::factor) continue;
      EXPECT_EQ(alone.data()[row], together.data()[row * together.capacity() + k]) << told(pairs[k]) << ", " << row;
    }
  }
}

INSTANTIATE_TEST_SUITE_P(hemisphere, CompleteDirections, ::testing::Bool(),
                         [](const auto& test) { return test.param ? "WithTangents" : "Alone"; });

}  // namespace
}  // namespace lobe::test
