#include "model/evaluate.hpp"

#include <gtest/gtest.h>

#include <limits>
#include <numbers>
#include <vector>

#include "lobe/core/error.hpp"
#include "reference/models.hpp"
#include "support/device.hpp"
#include "support/error_budget.hpp"
#include "support/scale.hpp"

namespace lobe::test {
namespace {

using std::numbers::pi;

std::vector<Directions> fan(std::size_t count) {
  std::vector<Directions> list(count);
  for (std::size_t i = 0; i < count; ++i) {
    const double t = static_cast<double>(i) / static_cast<double>(count);
    list[i] = {1.5 * t, 0.2 + 1.3 * t, pi * (1 - 0.7 * t)};
  }
  return list;
}

double reference_phong(const Directions& d, long double n) {
  return static_cast<double>(reference::phong(reference::light_of(d), reference::view_of(d), n));
}

class EvaluateSize : public ::testing::TestWithParam<std::size_t> {};

TEST_P(EvaluateSize, EachValueIsThatOfItsPairAlone) {
  const auto directions = fan(GetParam());
  const auto material = parse_material("ward:m=0.2");

  const auto together = evaluate(device(), material, directions);

  ASSERT_EQ(together.rows(), static_cast<Eigen::Index>(directions.size()));
  ASSERT_EQ(together.cols(), 1);
  for (const std::size_t i : {std::size_t{0}, directions.size() / 2, directions.size() - 1}) {
    if (directions.empty()) break;
    const auto alone = evaluate(device(), material, {&directions[i], 1});
    EXPECT_EQ(together(static_cast<Eigen::Index>(i), 0), alone(0, 0)) << "pair " << i;
  }
}

// One node, around a pack of eight lanes, a prime, and more than one block of nodes.
INSTANTIATE_TEST_SUITE_P(evaluate, EvaluateSize,
                         ::testing::Values(0, 1, 7, 8, 9, 127, scaled(1000, 130), scaled(4099, 131)),
                         ::testing::PrintToStringParamName());

class EvaluateTerms : public ::testing::TestWithParam<int> {};

TEST_P(EvaluateTerms, AddUpWithTheirWeights) {
  const int terms = GetParam();
  Material material{"sum", "", {}};
  for (int t = 0; t < terms; ++t) material.terms.push_back({"phong", {2.0 + t}, {1.0 / (1 + t)}});
  const auto directions = fan(9);

  const auto values = evaluate(device(), material, directions);

  for (std::size_t i = 0; i < directions.size(); ++i) {
    double expected = 0;
    for (int t = 0; t < terms; ++t) expected += reference_phong(directions[i], 2.0L + t) / (1 + t);
    EXPECT_NEAR(values(static_cast<Eigen::Index>(i), 0), expected, 200 * kDoubleEps * expected) << "pair " << i;
  }
}

// Lanes of a pack left empty, filled, and one more than filled.
INSTANTIATE_TEST_SUITE_P(evaluate, EvaluateTerms, ::testing::Values(1, 2, 7, 8, 9, 16, 17, 25),
                         ::testing::PrintToStringParamName());

TEST(Evaluate, MixesModelsOfDifferentKernels) {
  const auto directions = fan(9);

  const auto mixture = evaluate(device(), parse_material("lambert:scale=0.3+ward:m=0.2,scale=0.5"), directions);

  const auto lambert = evaluate(device(), parse_material("lambert"), directions);
  const auto ward = evaluate(device(), parse_material("ward:m=0.2"), directions);
  const Eigen::MatrixXd expected = 0.3 * lambert + 0.5 * ward;
  EXPECT_LE((mixture - expected).cwiseAbs().maxCoeff(), 4 * kDoubleEps * expected.maxCoeff());
}

TEST(Evaluate, GivesOneColumnPerChannel) {
  const Material material{"rgb", "", {{"lambert", {}, {0.1, 0.2, 0.3}}, {"phong", {20}, {0.5}}}};
  const auto directions = fan(9);

  const auto values = evaluate(device(), material, directions);

  ASSERT_EQ(values.cols(), 3);
  const auto phong = evaluate(device(), parse_material("phong:n=20"), directions);
  EXPECT_NEAR(values(4, 0), 0.1 / pi + 0.5 * phong(4, 0), 1e-15);
  EXPECT_NEAR(values(4, 2), 0.3 / pi + 0.5 * phong(4, 0), 1e-15);
}

TEST(Evaluate, IsEvenAndPeriodicInDeltaPhi) {
  const std::vector<Directions> directions{{0.7, 0.4, 2.0}, {0.7, 0.4, -2.0}, {0.7, 0.4, 2.0 - 2 * pi}};

  const auto values = evaluate(device(), parse_material("cook_torrance:m=0.3"), directions);

  EXPECT_EQ(values(0, 0), values(1, 0));
  EXPECT_NEAR(values(0, 0), values(2, 0), 1e-14 * values(0, 0));
}

struct BadDirections {
  std::string name;
  Directions directions;
};

class EvaluateRejects : public ::testing::TestWithParam<BadDirections> {};

TEST_P(EvaluateRejects, AnglesOutOfRange) {
  EXPECT_THROW((void)evaluate(device(), parse_material("lambert"), {&GetParam().directions, 1}), ArgumentError);
}

INSTANTIATE_TEST_SUITE_P(
    evaluate, EvaluateRejects,
    ::testing::Values(BadDirections{"negative_theta_in", {-0.1, 0, 0}}, BadDirections{"theta_out_below", {0, 1.6, 0}},
                      BadDirections{"theta_in_nan", {std::numeric_limits<double>::quiet_NaN(), 0, 0}},
                      BadDirections{"delta_phi_nan", {0, 0, std::numeric_limits<double>::quiet_NaN()}},
                      BadDirections{"delta_phi_infinite", {0, 0, std::numeric_limits<double>::infinity()}}),
    [](const auto& instance) { return instance.param.name; });

}  // namespace
}  // namespace lobe::test
