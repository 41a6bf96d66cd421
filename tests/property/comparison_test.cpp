// Metrics of the literature: against independent quadrature, closed forms, and what holds for all of them.
#include "lobe/compare/literature_metric.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <ostream>
#include <string>
#include <vector>

#include "lobe/core/error.hpp"
#include "lobe/reflectance/as_function.hpp"
#include "lobe/reflectance/tabulate.hpp"
#include "reference/comparison.hpp"
#include "reference/models.hpp"
#include "support/deviation.hpp"
#include "support/device.hpp"
#include "support/errors_hold.hpp"
#include "support/materials.hpp"
#include "support/names.hpp"

namespace lobe {

void PrintTo(const LiteratureMetric& comparison, std::ostream* out) {
  *out << to_string(comparison);
}

}  // namespace lobe

namespace lobe::test {
namespace {

using reference::Lobe;
using reference::Real;
using reference::Vector;
using std::numbers::pi;

constexpr double kLoose = 2e-2;  // where what is claimed is exact at any tolerance

LiteratureOptions to_tolerance(double tolerance) {
  LiteratureOptions options;
  options.tolerance = tolerance;
  return options;
}

/// A specification and the same by the reference.
struct Sample {
  std::string specification;
  Lobe lobe;
};

std::vector<Sample> samples() {
  return {{"lambert:scale=0.3", {[](const Vector& l, const Vector& v) { return 0.3L * reference::lambert(l, v); }, 1}},
          {"phong:n=20,scale=0.4",
           {[](const Vector& l, const Vector& v) { return 0.4L * reference::phong(l, v, 20); }, 0.2}},
          {"lambert:scale=0.2+ward:m=0.15,scale=0.3",
           {[](const Vector& l, const Vector& v) {
              return 0.2L * reference::lambert(l, v) + 0.3L * reference::ward(l, v, 0.15L);
            },
            0.1}},
          {"lambert:scale=0.25+ward:m=0.02,scale=0.1",
           {[](const Vector& l, const Vector& v) {
              return 0.25L * reference::lambert(l, v) + 0.1L * reference::ward(l, v, 0.02L);
            },
            0.014}}};
}

std::vector<Material> sample_materials() {
  std::vector<Material> materials;
  for (const auto& sample : samples()) materials.push_back(parse_material(sample.specification));
  return materials;
}

class EveryComparison : public ::testing::TestWithParam<LiteratureMetric> {
 protected:
  static LiteratureResult compare_all(const std::vector<std::string>& specifications,
                                      const LiteratureOptions& options = {}) {
    return compare(device(), parse_all(specifications), GetParam(), options);
  }
  static LiteratureMetric metric() { return GetParam(); }
  /// The power of a common factor with which distances grow; 0 where they do not do so by a power.
  static double degree() {
    switch (metric()) {
      case LiteratureMetric::ngan_l2:
      case LiteratureMetric::low_l2:
      case LiteratureMetric::bieron_l2:
      case LiteratureMetric::albedo_of_difference:
        return 1;
      case LiteratureMetric::cube_root:
      case LiteratureMetric::cube_root_l2:
        return 1.0 / 3;
      default:
        return 0;
    }
  }
};

INSTANTIATE_TEST_SUITE_P(property, EveryComparison,
                         ::testing::ValuesIn(literature_metrics().begin(), literature_metrics().end()),
                         [](const auto& instance) { return test_name(std::string(to_string(instance.param))); });

TEST_P(EveryComparison, AgreesWithTheReferenceWithinItsError) {
  const auto list = samples();
  const auto result = compare(device(), sample_materials(), metric());

  Deviation deviation;
  for (std::size_t i = 0; i < list.size(); ++i) {
    for (std::size_t j = 0; j < i; ++j) {
      const double theta_max = LiteratureOptions{}.theta_max;
      // The reference knows no kinks, and logarithms of what falls to zero at one have sharp ones.
      const int order = metric() == LiteratureMetric::log_relative ? 12 : 7;
      const double expected = reference::comparison(to_string(metric()), list[i].lobe, list[j].lobe, theta_max, order);
      const double coarse =
          reference::comparison(to_string(metric()), list[i].lobe, list[j].lobe, theta_max, order - 2);
      const double value = result.combined.distance(static_cast<Eigen::Index>(i), static_cast<Eigen::Index>(j));
      const double error = result.combined.distance_error(static_cast<Eigen::Index>(i), static_cast<Eigen::Index>(j));
      deviation.add(std::abs(value - expected), error + std::abs(expected - coarse),
                    list[i].specification + " and " + list[j].specification);
      EXPECT_LE(error, 1e-3 * value) << i << ' ' << j;
      EXPECT_NEAR(value, expected, 3e-3 * expected) << i << ' ' << j;  // of which the reference's kinks have two
    }
  }
  deviation.report("distance");
  EXPECT_LE(deviation.worst(), 1);
}

/// Those without kinks where two materials are equal, which alone converge so fast that a much finer run is quick.
class SmoothComparison : public EveryComparison {};

INSTANTIATE_TEST_SUITE_P(property, SmoothComparison,
                         ::testing::Values(LiteratureMetric::ngan_l2, LiteratureMetric::bieron_l2,
                                           LiteratureMetric::standard_log, LiteratureMetric::log_relative),
                         [](const auto& instance) { return test_name(std::string(to_string(instance.param))); });

// Among few pairs an error that is small by accident is not met: of lists like these, 3 % of the distances by bieron-l2
// were off by up to 5 of their errors, and 4 % of those by log-relative by up to 13.
TEST_P(SmoothComparison, StatesErrorsThatHoldForManyPairs) {
  const auto list = many_specifications();
  const bool is_slow = metric() == LiteratureMetric::log_relative;
  const auto fine = compare_all(list, to_tolerance(is_slow ? 1e-4 : 1e-5)).combined;
  for (const double tolerance : {1e-2, 1e-3}) {
    SCOPED_TRACE(tolerance);
    const auto coarse = compare_all(list, to_tolerance(tolerance)).combined;
    expect_errors_hold(coarse.distance, coarse.distance_error, fine.distance, fine.distance_error);
  }
}

TEST_P(EveryComparison, StatesNoSmallerErrorThanAFinerRunShows) {
  const std::vector<std::string> list{"lambert:scale=0.3",           "phong:n=5",           "metal_phong:n=20",
                                      "blinn_phong:n=1000,scale=.2", "ward:m=0.2",          "ward:m=0.03,scale=0.1",
                                      "cook_torrance:m=0.3",         "oren_nayar:sigma=0.5"};
  const auto coarse = compare_all(list, to_tolerance(2e-2)).combined;
  const auto fine = compare_all(list, to_tolerance(1e-3)).combined;

  const Eigen::ArrayXXd deviation = (coarse.distance - fine.distance).array().abs();
  const Eigen::ArrayXXd allowed = coarse.distance_error.array() + fine.distance_error.array();
  const double worst = (deviation > 0).select(deviation / allowed, 0.0).maxCoeff();
  RecordProperty("share", std::to_string(worst));
  EXPECT_LE(worst, 1);
}

TEST_P(EveryComparison, IsSymmetricZeroOnTheDiagonalAndPositiveElsewhere) {
  const auto matrix = compare_all({"lambert", "phong:n=20", "ward:m=0.2"}, to_tolerance(kLoose)).combined;

  EXPECT_EQ(matrix.distance, Eigen::MatrixXd(matrix.distance.transpose()));
  EXPECT_EQ(matrix.distance_error, Eigen::MatrixXd(matrix.distance_error.transpose()));
  EXPECT_EQ(matrix.distance.diagonal().cwiseAbs().maxCoeff(), 0);
  EXPECT_GT(matrix.distance(0, 1), 0);
  EXPECT_GT(matrix.distance(1, 2), 0);
}

TEST_P(EveryComparison, IsExactlyZeroForTheSameMaterialTwice) {
  const auto matrix = compare_all({"ward:m=0.2", "ward:m=0.2"}, to_tolerance(kLoose)).combined;

  EXPECT_EQ(matrix.distance(0, 1), 0);
  EXPECT_EQ(matrix.distance_error(0, 1), 0);
}

TEST_P(EveryComparison, GrowsWithACommonFactorAsItsFormulaDoes) {
  if (degree() == 0) return;  // logarithms do not
  const auto matrix = compare_all({"lambert", "phong:n=20"}).combined;
  const auto scaled = compare_all({"lambert:scale=0.1", "phong:n=20,scale=0.1"}).combined;

  // Nodes are the same, so only rounding and the cube root's 1e-8 differ.
  EXPECT_NEAR(scaled.distance(0, 1), std::pow(0.1, degree()) * matrix.distance(0, 1), 1e-7 * matrix.distance(0, 1));
}

TEST_P(EveryComparison, SizeIsTheDistanceFromBlack) {
  const auto matrix = compare_all({"phong:n=20", "phong:n=20,scale=0"}).combined;

  EXPECT_NEAR(matrix.size(0), matrix.distance(0, 1), 1e-12 * matrix.size(0));
  EXPECT_EQ(matrix.size(1), 0);
}

TEST_P(EveryComparison, IsProportionalToASmallChangeDownToItsRounding) {
  // f and (1 + e) f: the distance is e^degree times the size, for logarithms nearly e times something.
  const auto at = [&](const std::string& factor) {
    return compare_all({"lambert", "lambert:scale=" + factor}).combined.distance(0, 1);
  };
  const double power = metric() == LiteratureMetric::cube_root ? 1.0 / 3 : 1;
  EXPECT_NEAR(at("1.000000001") / at("1.000001"), std::pow(1e-3, power), 1e-6 * std::pow(1e-3, power));
}

TEST_P(EveryComparison, CombinesChannelsUnderTheRoot) {
  Material a = parse_material("lambert");
  Material b = parse_material("phong:n=20");
  a.terms[0].weight = {0.1, 0.2, 0.4};
  LiteratureOptions options = to_tolerance(kLoose);
  options.channel_weights = {0.5, 0.3, 0.2};
  const auto result = compare(device(), std::vector<Material>{a, b}, metric(), options);

  const bool is_root =
      metric() != LiteratureMetric::albedo_of_difference && metric() != LiteratureMetric::cube_root_log;
  double sum = 0;
  for (std::size_t c = 0; c < 3; ++c) {
    const double distance = result.channels[c].distance(0, 1);
    sum += options.channel_weights[c] * (is_root ? distance * distance : distance);
  }
  EXPECT_NEAR(result.combined.distance(0, 1), is_root ? std::sqrt(sum) : sum, 1e-14);
}

TEST_P(EveryComparison, OfTablesIsThatOfTheirMaterials) {
  const std::vector<std::string> list{"lambert:scale=0.3", "phong:n=5", "lambert:scale=0.2+ward:m=0.4,scale=0.3"};
  const auto expected = compare_all(list).combined;
  std::vector<BrdfTable> tables;
  for (const auto& material : parse_all(list))
    tables.push_back(tabulate(device(), material, HemisphereGrid::gauss(32, 64)));

  const auto found = compare(device(), tables, metric()).combined;

  Deviation deviation;
  for (Eigen::Index i = 0; i < 3; ++i) {
    SCOPED_TRACE(i);
    for (Eigen::Index j = 0; j < i; ++j) {
      deviation.add(std::abs(found.distance(i, j) - expected.distance(i, j)),
                    found.distance_error(i, j) + expected.distance_error(i, j), std::to_string(i) + std::to_string(j));
      EXPECT_LE(found.distance_error(i, j), 0.2 * found.distance(i, j)) << j;
    }
  }
  deviation.report("table");
  EXPECT_LE(deviation.worst(), 1);
}

// Logarithms fall far where these reflectances do, and converge less evenly than squares: without a factor of safety
// this distance was off by 2.1 of its errors.
TEST(LogRelative, HasAnErrorThatHoldsWhereLogarithmsFallFar) {
  const auto pair = parse_all({"minnaert:k=0.7101,scale=0.1189", "beckmann:m=0.0277,scale=0.6485"});
  const auto usual = compare(device(), pair, LiteratureMetric::log_relative).combined;
  const auto fine = compare(device(), pair, LiteratureMetric::log_relative, to_tolerance(1e-5)).combined;
  expect_errors_hold(usual.distance, usual.distance_error, fine.distance, fine.distance_error, 0.5);
}

// Differences of two rules cancelled between directions in 1 to 19 % of such pairs, and hid errors up to 370 times as
// large.
TEST_P(EveryComparison, OfManyTablesHasErrorsThatHold) {
  std::vector<std::string> list;
  std::vector<BrdfTable> tables;
  for (int k = 0; k < 8; ++k) {
    const std::string width = std::to_string(0.3 + 0.07 * k);
    list.push_back("ward:m=" + width);
    list.push_back("lambert:scale=0.3+cook_torrance:scale=0.5,m=" + width);
    list.push_back("lambert:scale=0.1+phong:scale=0.5,n=" + std::to_string(2 + k));
  }
  for (const auto& material : parse_all(list)) {
    tables.push_back(tabulate(device(), material, HemisphereGrid::gauss(16, 32)));
  }
  const auto of_formulas = compare_all(list).combined;
  const auto of_tables = compare(device(), tables, metric()).combined;
  expect_errors_hold(of_tables.distance, of_tables.distance_error, of_formulas.distance, of_formulas.distance_error);
}

TEST_P(EveryComparison, OfFunctionsIsThatOfTheirMaterials) {
  const std::vector<std::string> list{"lambert:scale=0.3", "phong:n=5", "lambert:scale=0.2+ward:m=0.05,scale=0.3"};
  const auto expected = compare_all(list).combined;
  std::vector<BrdfFunction> functions;
  for (const auto& material : parse_all(list)) functions.push_back(as_function(device(), material));

  const auto found = compare(device(), functions, metric(), to_tolerance(kLoose)).combined;

  Deviation deviation;
  for (Eigen::Index i = 0; i < 3; ++i) {
    SCOPED_TRACE(i);
    deviation.add(std::abs(found.size(i) - expected.size(i)), found.size_error(i) + expected.size_error(i),
                  "black" + std::to_string(i));
    for (Eigen::Index j = 0; j < i; ++j) {
      deviation.add(std::abs(found.distance(i, j) - expected.distance(i, j)),
                    found.distance_error(i, j) + expected.distance_error(i, j), std::to_string(i) + std::to_string(j));
      EXPECT_LE(found.distance_error(i, j), 0.1 * found.distance(i, j)) << j;
    }
  }
  deviation.report("function");
  EXPECT_LE(deviation.worst(), 1);
}

TEST_P(EveryComparison, OfGeneralTablesIsThatOfTheSameIsotropicOnes) {
  std::vector<BrdfTable> tables;
  for (const auto& material : parse_all({"lambert:scale=0.3", "phong:n=3"}))
    tables.push_back(tabulate(device(), material, HemisphereGrid::gauss(9, 12)));
  const std::vector<BrdfTable> general{to_general(tables[0]), to_general(tables[1])};

  if (metric() == LiteratureMetric::log_relative) {
    EXPECT_THROW((void)compare(device(), general, metric()), ArgumentError);
    return;
  }
  const auto isotropic = compare(device(), tables, metric()).combined;
  const auto dense = compare(device(), general, metric()).combined;

  const auto mixed = compare(device(), {general[0], tables[1]}, metric()).combined;

  // The same sum in another order.
  EXPECT_NEAR(dense.distance(0, 1), isotropic.distance(0, 1), 1e-12 * isotropic.distance(0, 1));
  EXPECT_EQ(mixed.distance(0, 1), dense.distance(0, 1));
}

/// Distance between albedos 0.8 and 0.3.
LiteratureMatrix lambert_pair(LiteratureMetric comparison, double theta_max) {
  LiteratureOptions options = to_tolerance(1e-6);
  options.theta_max = theta_max;
  return compare(device(), parse_all({"lambert:scale=0.8", "lambert:scale=0.3"}), comparison, options).combined;
}

TEST(LambertPair, NganIsElementary) {
  // (0.5/pi)^2 times integral of c^2 s = (1 - c_max^3)/3, of s = 1 - c_max, and 2 pi.
  const double c = std::cos(1.2);
  const double expected = 0.5 / pi * std::sqrt((1 - c * c * c) / 3 * (1 - c) * 2 * pi);
  EXPECT_NEAR(lambert_pair(LiteratureMetric::ngan_l2, 1.2).distance(0, 1), expected, 1e-6 * expected);
}

TEST(LambertPair, LowHasNoSineOfTheOtherDirection) {
  const double c = std::cos(1.2);
  const double expected = 0.5 / pi * std::sqrt((1 - c * c * c) / 3 * 1.2 * 2 * pi);
  EXPECT_NEAR(lambert_pair(LiteratureMetric::low_l2, 1.2).distance(0, 1), expected, 1e-6 * expected);
}

TEST(LambertPair, BieronHasTheCosineOfTheOtherDirection) {
  const double c = std::cos(1.2);
  const double expected = 0.5 / pi * std::sqrt((1 - c * c * c) / 3 * (1 - c * c) / 2 * 2 * pi);
  EXPECT_NEAR(lambert_pair(LiteratureMetric::bieron_l2, 1.2).distance(0, 1), expected, 1e-6 * expected);
}

TEST(LambertPair, CubeRootIsAMean) {
  // mean over theta of c^(2/3), by Simpson's rule over the smooth range [0, 1.2].
  const auto g = [](double theta) { return std::pow(std::cos(theta), 2.0 / 3); };
  double mean = 0;
  constexpr int kSteps = 200;
  for (int k = 0; k <= kSteps; ++k)
    mean += (k == 0 || k == kSteps ? 1 : k % 2 == 1 ? 4 : 2) * g(1.2 * k / kSteps) / (3 * kSteps);
  const double expected = std::cbrt(0.5 / pi) * std::sqrt(mean);
  EXPECT_NEAR(lambert_pair(LiteratureMetric::cube_root, 1.2).distance(0, 1), expected, 1e-6 * expected);
}

TEST(LambertPair, CubeRootsAreThoseOfTheAlbedos) {
  const double expected = std::cbrt(0.8 / pi) - std::cbrt(0.3 / pi);
  EXPECT_NEAR(lambert_pair(LiteratureMetric::cube_root_l2, 1.2).distance(0, 1), expected, 1e-6 * expected);
}

TEST(LambertPair, LogarithmOfCubeRootsIsAMean) {
  // Mean over both angles, by the midpoint rule, of a smooth function below 80 degrees.
  constexpr int kSteps = 400;
  double mean = 0;
  for (int a = 0; a < kSteps; ++a) {
    for (int b = 0; b < kSteps; ++b) {
      const double w = std::cos(1.2 * (a + 0.5) / kSteps) * std::cos(1.2 * (b + 0.5) / kSteps);
      mean += std::log((std::cbrt(0.8 / pi) * w + 1e-3) / (std::cbrt(0.3 / pi) * w + 1e-3)) / (kSteps * kSteps);
    }
  }
  EXPECT_NEAR(lambert_pair(LiteratureMetric::cube_root_log, 1.2).distance(0, 1), mean, 3e-6 * mean);
}

TEST(LambertPair, AlbedoOfTheDifferenceIsPiTimesThatOfTheAlbedos) {
  const auto matrix = lambert_pair(LiteratureMetric::albedo_of_difference, 1.2);
  EXPECT_NEAR(matrix.distance(0, 1), 0.5 * pi, 1e-6);
  EXPECT_NEAR(matrix.size(0), 0.8 * pi, 1e-6);
}

TEST(Comparisons, ComeByNameInTheOrderAskedFor) {
  const std::vector<std::string> names{"bieron-l2", "albedo-of-difference"};
  const auto results = compare(device(), parse_all({"lambert", "phong:n=5"}), names);

  ASSERT_EQ(results.size(), 2U);
  EXPECT_EQ(results[0].metric, LiteratureMetric::bieron_l2);
  EXPECT_EQ(results[1].metric, LiteratureMetric::albedo_of_difference);
}

TEST(Comparisons, RefuseNegativeReflectancesUnderALogarithm) {
  EXPECT_THROW((void)compare(device(), parse_all({"lambert", "lambert:scale=-5"}), LiteratureMetric::bieron_log),
               NumericError);
}

TEST(Comparisons, RefuseAnglesUpToTheHorizon) {
  LiteratureOptions options;
  options.theta_max = pi / 2;
  EXPECT_THROW((void)compare(device(), parse_all({"lambert"}), LiteratureMetric::ngan_l2, options), ArgumentError);
}

TEST(Comparisons, RefuseDeltaParts) {
  EXPECT_THROW((void)compare(device(), parse_all({"lambert", "mirror"}), LiteratureMetric::ngan_l2), NumericError);
}

TEST(Comparisons, StopWhenToldTo) {
  LiteratureOptions options;
  options.progress = [](std::string_view, double) { return false; };
  EXPECT_THROW((void)compare(device(), parse_all({"lambert"}), LiteratureMetric::ngan_l2, options), Cancelled);
}

TEST(Comparisons, NeedAReflectanceAndCheckAllNamesFirst) {
  EXPECT_THROW((void)compare(device(), std::vector<BrdfTable>{}, LiteratureMetric::ngan_l2), ArgumentError);
  EXPECT_THROW((void)compare(device(), parse_all({"lambert"}), std::vector<std::string>{"ngan-l2", "nothing"}),
               ArgumentError);
}

}  // namespace
}  // namespace lobe::test
