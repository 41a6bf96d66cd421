#include "study/run/nearest_models.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <sstream>
#include <string>
#include <vector>

namespace lobe::test {
namespace {

/// A file and models as vectors, whose products are those of doubles.
class NearestModels : public ::testing::Test {
 protected:
  void add(const char* name, const Eigen::Vector3d& vector, bool is_file = false) {
    const MaterialLabel label{name, "family"};
    study_.materials.push_back(is_file ? StudyMaterial(label, MaterialFile{}) : StudyMaterial(label));
    vectors_.push_back(vector);
  }

  [[nodiscard]] Metric metric() const {
    const auto n = static_cast<Eigen::Index>(vectors_.size());
    Metric metric{Eigen::MatrixXd(n, n), Eigen::MatrixXd(n, n), Eigen::VectorXd(n),
                  Eigen::VectorXd(n),    Eigen::MatrixXd(n, n), Eigen::MatrixXd(n, n)};
    constexpr double kEps = std::numeric_limits<double>::epsilon();
    for (Eigen::Index i = 0; i < n; ++i) {
      const auto& f = vectors_[static_cast<std::size_t>(i)];
      metric.norm(i) = f.norm();
      metric.norm_error(i) = norm_error_ + kEps * f.norm();
      for (Eigen::Index j = 0; j < n; ++j) {
        const auto& g = vectors_[static_cast<std::size_t>(j)];
        metric.gram(i, j) = f.dot(g);
        metric.gram_error(i, j) = kEps * f.norm() * g.norm();
        metric.distance(i, j) = (f - g).norm();
        metric.distance_error(i, j) = kEps * metric.distance(i, j);
      }
    }
    return metric;
  }

  /// The columns of the rows of one kind.
  [[nodiscard]] std::vector<std::vector<std::string>> rows(const std::string& by) const {
    std::vector<std::vector<std::string>> found;
    std::istringstream lines(nearest_models_csv(study_, metric()));
    for (std::string line; std::getline(lines, line);) {
      std::istringstream fields(line);
      std::vector<std::string> row;
      for (std::string field; std::getline(fields, field, ',');) row.push_back(field);
      if (row.at(1) == by) found.push_back(row);
    }
    return found;
  }

  Study study_;
  std::vector<Eigen::Vector3d> vectors_;
  double norm_error_ = 0;  ///< beyond rounding
};

enum Column { kModel = 3, kScale = 5, kDistance = 6, kError = 7, kRelative = 8 };

TEST_F(NearestModels, AreThoseAtTheSmallestDistance) {
  add("plate", {1, 0, 0}, true);
  add("far", {3, 0, 0});
  add("near", {1, 0.5, 0});

  const auto found = rows("distance");

  ASSERT_EQ(found.size(), 2);
  EXPECT_EQ(found[0][kModel], "near");
  EXPECT_EQ(found[0][kScale], "1");
  EXPECT_EQ(found[0][kDistance], "0.5");
  EXPECT_EQ(found[1][kModel], "far");
  EXPECT_EQ(found[1][kRelative], "2");
}

TEST_F(NearestModels, TimesAFactorAreAsFarAsTheyState) {
  add("plate", {1, 0, 0}, true);
  add("along", {2, 2, 0});
  add("orthogonal", {0, 1, 0});
  add("opposite", {-1, 0, 0});

  const auto found = rows("scaled");

  ASSERT_EQ(found.size(), 3);
  EXPECT_EQ(found[0][kModel], "along");
  EXPECT_NEAR(std::stod(found[0][kScale]), 0.25, 1e-15);
  EXPECT_NEAR(std::stod(found[0][kDistance]), std::sqrt(0.5), std::stod(found[0][kError]) + 1e-16);
  EXPECT_LE(std::stod(found[0][kError]), 1e-14);
  EXPECT_EQ(found[1][kDistance], "1");
  EXPECT_EQ(found[2][kDistance], "1");
  EXPECT_EQ(found[2][kScale], "0");
}

// By products 1e-8 would be left of it.
TEST_F(NearestModels, TimesAFactorAreKnownToRoundingWhereTheNormsAreAlike) {
  add("plate", {1, 0, 0}, true);
  add("neighbour", {1, 1e-9, 0});

  const auto found = rows("scaled");

  EXPECT_NEAR(std::stod(found.at(0)[kDistance]), 1e-9, std::stod(found.at(0)[kError]));
  EXPECT_LE(std::stod(found.at(0)[kError]), 1e-14);
}

// Only what is integrated as a difference is known better than that.
TEST_F(NearestModels, TimesALargeFactorStateWhatProductsLeaveUnknown) {
  add("plate", {1, 0, 0}, true);
  add("brighter", {2, 2e-9, 0});

  const auto found = rows("scaled");

  EXPECT_NEAR(std::stod(found.at(0)[kDistance]), 1e-9, std::stod(found.at(0)[kError]));
  EXPECT_LE(std::stod(found.at(0)[kError]), 1e-7);
}

TEST_F(NearestModels, OfANormThatIsUnknownStateThatDistancesAre) {
  add("plate", {1, 0, 0}, true);
  add("along", {2, 2, 0});
  norm_error_ = 1.5;

  const auto found = rows("scaled");

  EXPECT_NEAR(std::stod(found.at(0)[kScale]), 0.25, 1e-15);
  EXPECT_NEAR(std::stod(found.at(0)[kDistance]), std::sqrt(0.5), 1e-15);
  EXPECT_GE(std::stod(found.at(0)[kError]), 1);
}

TEST_F(NearestModels, OfNothingHaveNoRelativeDistance) {
  add("black", {0, 0, 0}, true);
  add("white", {1, 0, 0});

  EXPECT_EQ(rows("distance").at(0)[kDistance], "1");
  EXPECT_EQ(rows("distance").at(0)[kRelative], "");
  EXPECT_EQ(rows("scaled").at(0)[kDistance], "0");
}

}  // namespace
}  // namespace lobe::test
