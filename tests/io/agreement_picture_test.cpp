#include "plot/agreement_picture.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <limits>
#include <string>
#include <vector>

#include "lobe/core/error.hpp"

namespace lobe::test {
namespace {

using ::testing::HasSubstr;
using ::testing::Not;

RankAgreement two_metrics(double rho, double tau) {
  RankAgreement agreement{Eigen::MatrixXd::Ones(2, 2), Eigen::MatrixXd::Ones(2, 2)};
  agreement.spearman(0, 1) = agreement.spearman(1, 0) = rho;
  agreement.kendall(0, 1) = agreement.kendall(1, 0) = tau;
  return agreement;
}

const std::vector<std::string> kNames{"point", "ngan-l2"};

TEST(AgreementPicture, HasSpearmanBelowAndKendallAboveTheDiagonal) {
  const auto picture = agreement_picture("a", "Title", kNames, two_metrics(0.75, 0.5));

  EXPECT_THAT(picture.script, HasSubstr("'0.75' at 0,1"));
  EXPECT_THAT(picture.script, HasSubstr("'0.50' at 1,0"));
  EXPECT_THAT(picture.data, HasSubstr("1 0.5\n0.75 1\n"));
}

TEST(AgreementPicture, NamesTheMetrics) {
  const auto picture = agreement_picture("a", "Title", kNames, two_metrics(0.75, 0.5));

  EXPECT_THAT(picture.script, HasSubstr("(\"ngan-l2\" 1)"));
  EXPECT_THAT(picture.data, HasSubstr("# 1: ngan-l2\n"));
}

TEST(AgreementPicture, LeavesCellsEmptyThatDoNotExist) {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  const auto picture = agreement_picture("a", "Title", kNames, two_metrics(nan, nan));

  EXPECT_THAT(picture.script, Not(HasSubstr("'nan'")));
}

TEST(AgreementPicture, NeedsANamePerMetric) {
  EXPECT_THROW((void)agreement_picture("a", "Title", {kNames.data(), 1}, two_metrics(1, 1)), ArgumentError);
}

}  // namespace
}  // namespace lobe::test
