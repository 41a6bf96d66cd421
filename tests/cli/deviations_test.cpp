// Effect of a file's standard deviations on the answers of commands.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <fstream>
#include <numbers>

#include "cli/command_test.hpp"

namespace lobe::test {
namespace {

using std::numbers::pi;
using ::testing::ContainsRegex;
using ::testing::HasSubstr;
using ::testing::Not;

/// A file of one sample, 0.2 +- 0.01 sr^-1: the same reflectance everywhere, of which every number is a known function.
class Deviations : public CommandTest {
 protected:
  void SetUp() override {
    std::ofstream(file("a.csv")) << "theta_in_deg,theta_out_deg,delta_phi_deg,red,red_std\n0,0,0,0.2,0.01\n";
    deviation_ = json({"eval", "a.csv", "--theta-in", "20", "--theta-out", "30", "--delta-phi",
                       "40"})["values"][0]["brdf_measurement"][0];
  }
  /// Linear propagation is exact: every deviation is that of the value times a known factor.
  void expect_times(const Json& figure, double factor) const {
    EXPECT_NEAR(figure["measurement"].get<double>(), factor * deviation_, 1e-3 * factor * deviation_) << figure;
    EXPECT_GE(figure["error"].get<double>(), 0) << figure;
  }

  double deviation_ = 0;  ///< of the value itself, as 100 replicates have it
};

TEST_F(Deviations, OfAValueAreThoseOfTheSample) {
  // 100 replicates know a standard deviation to 7 %.
  EXPECT_NEAR(deviation_, 0.01, 4 * 0.07 * 0.01);
}

// Lists of pairs had values alone.
TEST_F(Deviations, OfListsOfPairsStandInAColumnOfTheirOwn) {
  std::ofstream(file("pairs.csv")) << "theta_in,theta_out,delta_phi\n20,30,40\n";
  const Outcome outcome = make({"eval", "a.csv", "--pairs", "pairs.csv"});
  EXPECT_THAT(outcome.output, HasSubstr("delta_phi_deg,red,red_std\n20,30,40,0.2,"));
  EXPECT_DOUBLE_EQ(std::stod(outcome.output.substr(outcome.output.rfind(',') + 1)), deviation_);
}

TEST_F(Deviations, OfAlbedosAreTheirs) {
  const Json answer = json({"albedo", "a.csv", "--theta", "30", "--mean"});
  expect_times(answer["albedos"][0]["albedo"][0], pi);
  expect_times(answer["mean_albedo"][0], pi);
  expect_times(json({"mean-albedo", "a.csv"})["materials"][0]["mean_albedo"][0], pi);
}

TEST_F(Deviations, OfNormsAreTheirs) {
  expect_times(json({"norm", "a.csv"})["norm"], pi);
  // The root of the integral of the squared albedo, pi f.
  expect_times(json({"norm", "a.csv", "--lighting", "daylight"})["norm"], pi * std::sqrt(pi));
  expect_times(json({"norm", "a.csv", "--grid", "gauss:8x16"})["norm"], pi);
}

TEST_F(Deviations, OfPairsAreTheirs) {
  const Json answer = json({"distance", "a.csv", "lambert:scale=0.3"});
  expect_times(answer["distance"], pi);
  expect_times(answer["norm_a"], pi);
  expect_times(answer["product"], pi * 0.3);
  EXPECT_LT(answer["norm_b"]["measurement"].get<double>(), 1e-12);
  expect_times(json({"product", "a.csv", "lambert:scale=0.3"})["product"], pi * 0.3);
  EXPECT_EQ(json({"distance", "a.csv", "a.csv"})["distance"]["measurement"], 0);
}

TEST_F(Deviations, OfMatricesAreTheirs) {
  const Json answer = json({"gram", "a.csv", "lambert"})["lightings"][0];
  // f.f = pi^2 f^2 is not linear: twice the value times the deviation, to second order.
  EXPECT_NEAR(answer["gram_measurement"][0][0].get<double>(), 2 * pi * pi * 0.2 * deviation_, 0.05 * 4 * deviation_);
  EXPECT_NEAR(answer["gram_measurement"][0][1].get<double>(), pi * deviation_, 1e-3 * pi * deviation_);
  EXPECT_THAT(make({"distance-matrix", "a.csv", "lambert", "--csv"}).output,
              HasSubstr("point,combined,distance_measurement,a.csv,0,0.0"));
}

TEST_F(Deviations, OfCompositionsAreTheirs) {
  const Json answer = json({"compose", "a.csv", "lambert:scale=0.3", "--at", "30,40,50"})["values"][0];
  EXPECT_NEAR(answer["brdf_measurement"][0].get<double>(), 0.3 * deviation_, 1e-3 * deviation_);
}

TEST_F(Deviations, OfFittedValuesStandBesideTheirStandardErrors) {
  // The scale of a constant reflectance is pi times its value.
  const Json answer = json({"fit", "a.csv", "--family", "lambert"});
  EXPECT_NEAR(answer["values"][0]["measurement"].get<double>(), pi * deviation_, 1e-3 * deviation_);
  EXPECT_THAT(make({"fit", "a.csv", "--family", "lambert", "--lighting", "daylight"}).output,
              ContainsRegex("\\(fit\\) ± [0-9.]+ \\(measurement\\)"));
  EXPECT_THAT(run({"fit", "a.csv", "--family", "lambert", "--objective", "perceptual"}).error,
              HasSubstr("standard deviations of samples are followed by --objective l2"));
}

TEST_F(Deviations, StandBesideTheNumericalErrorInText) {
  const std::string both = "\\(numerical\\) ± [0-9.]+ \\(measurement\\)";
  EXPECT_THAT(make({"norm", "a.csv"}).output, ContainsRegex(both));
  EXPECT_THAT(make({"mean-albedo", "a.csv"}).output, ContainsRegex(both));
  EXPECT_THAT(make({"gram", "a.csv", "lambert"}).output, ContainsRegex(both));
  EXPECT_THAT(make({"compose", "a.csv", "lambert", "--at", "30,40,50"}).output, ContainsRegex(both));
  EXPECT_THAT(make({"eval", "a.csv", "--theta-in", "20", "--theta-out", "30", "--delta-phi", "40"}).output,
              ContainsRegex(both));
}

TEST_F(Deviations, AreNotToldWhereNoFileStatesAny) {
  EXPECT_FALSE(json({"norm", "phong:n=3"})["norm"].contains("measurement"));
  EXPECT_FALSE(json({"gram", "phong:n=3"})["lightings"][0].contains("gram_measurement"));
  EXPECT_THAT(make({"norm", "phong:n=3"}).output, Not(HasSubstr("measurement")));
}

}  // namespace
}  // namespace lobe::test
