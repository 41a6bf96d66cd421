// Files of tests/golden/former, which lobe wrote at 680e70f, before its first release, and the numbers that it gave.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <span>
#include <sstream>
#include <string>
#include <vector>

#include "core/files.hpp"
#include "core/text.hpp"
#include "lobe/core/directions.hpp"
#include "lobe/hdf5/table_file.hpp"
#include "lobe/model/specification.hpp"
#include "lobe/reflectance/evaluate.hpp"
#include "lobe/study/report_page.hpp"
#include "lobe/study/study.hpp"
#include "lobe/study/study_results.hpp"
#include "support/device.hpp"
#include "support/temporary_directory.hpp"
#include "support/unzipped.hpp"

namespace lobe::test {
namespace {

namespace fs = std::filesystem;
using ::testing::ElementsAre;

class FormerFiles : public ::testing::Test {
 protected:
  [[nodiscard]] static fs::path stored(const std::string& name) {
    return fs::path(LOBE_GOLDEN_DIRECTORY) / "former" / name;
  }

  /// An HDF5 file, which is stored compressed.
  [[nodiscard]] fs::path unpacked(const std::string& name) const {
    const fs::path path = directory_.path() / name;
    write_text(path, true, read_unzipped(stored(name + ".gz")));
    return path;
  }

  /// Numbers of a table of comma-separated values: rows below the head, without their first `texts` cells.
  [[nodiscard]] static std::vector<std::vector<double>> numbers(const std::string& name, std::size_t texts) {
    std::istringstream lines(read_text(stored(name)));
    std::vector<std::vector<double>> rows;
    std::string line;
    for (std::getline(lines, line); std::getline(lines, line);) {
      auto& row = rows.emplace_back();
      const auto cells = split(line, ',');
      for (std::size_t k = texts; k < cells.size(); ++k) row.push_back(std::stod(std::string(cells[k])));
    }
    return rows;
  }

 private:
  TemporaryDirectory directory_;
};

TEST_F(FormerFiles, StudiesHaveTheirFactorsInTheirScales) {
  const Study study = load_study(stored("former.toml"));
  ASSERT_EQ(study.materials.size(), 3U);
  EXPECT_THAT(study.materials[0].formula()->terms.at(0).weight, ElementsAre(0.4));
  EXPECT_THAT(study.materials[1].formula()->terms.at(0).weight, ElementsAre(0.4));
  ASSERT_EQ(study.materials[2].formula()->terms.size(), 2U);
  EXPECT_THAT(study.materials[2].formula()->terms[0].weight, ElementsAre(0.15));
  EXPECT_THAT(study.materials[2].formula()->terms[1].weight, ElementsAre(0.25));
  ASSERT_EQ(study.charts.size(), 1U);
}

void expect_distances(const Eigen::MatrixXd& found, const std::vector<std::vector<double>>& expected) {
  ASSERT_EQ(static_cast<std::size_t>(found.rows()), expected.size());
  for (std::size_t i = 0; i < expected.size(); ++i) {
    for (std::size_t j = 0; j < expected.size(); ++j) {
      // The table has all digits.
      EXPECT_EQ(found(static_cast<Eigen::Index>(i), static_cast<Eigen::Index>(j)), expected[i].at(j)) << i << ' ' << j;
    }
  }
}

TEST_F(FormerFiles, ResultsHaveTheirDistancesAndCharts) {
  const StudyResult result = load_study_results(unpacked("former.h5"));
  EXPECT_EQ(result.study.title, "A study of a former version");
  ASSERT_EQ(result.metrics.size(), 2U);
  expect_distances(result.metrics[0].combined.distance, numbers("former.point.distance.csv", 1));
  expect_distances(result.metrics[1].combined.distance, numbers("former.daylight.distance.csv", 1));
  ASSERT_EQ(result.comparisons.size(), 1U);
  expect_distances(result.comparisons[0].combined.distance, numbers("former.ngan-l2.distance.csv", 1));

  ASSERT_EQ(result.charts.size(), 1U);
  ASSERT_EQ(result.charts[0].size(), 1U);
  const auto chart = numbers("former.chart.gloss.csv", 1);
  ASSERT_EQ(result.charts[0][0].size(), chart.size());
  for (std::size_t k = 0; k < chart.size(); ++k) {
    EXPECT_EQ(result.charts[0][0][k].value, chart[k].at(1)) << k;
    EXPECT_EQ(result.charts[0][0][k].error, chart[k].at(2)) << k;
  }
}

TEST_F(FormerFiles, ResultsHaveTheMaterialsOfTheirStudy) {
  const StudyResult result = load_study_results(unpacked("former.h5"));
  const Study study = load_study(stored("former.toml"));
  ASSERT_EQ(result.study.materials.size(), study.materials.size());
  for (std::size_t i = 0; i < study.materials.size(); ++i) {
    SCOPED_TRACE(i);
    EXPECT_EQ(result.study.materials[i].name(), study.materials[i].name());
    EXPECT_EQ(specification(*result.study.materials[i].formula()), specification(*study.materials[i].formula()));
  }
}

TEST_F(FormerFiles, ResultsCanBeReported) {
  EXPECT_THAT(report_page(load_study_results(unpacked("former.h5"))),
              ::testing::HasSubstr("A study of a former version"));
}

TEST_F(FormerFiles, StudiesGiveTheNumbersOfTheirResultsAgain) {
  const StudyResult former = load_study_results(unpacked("former.h5"));
  const StudyResult again = run_study(device(), load_study(stored("former.toml")));
  ASSERT_EQ(again.metrics.size(), former.metrics.size());
  for (std::size_t k = 0; k < former.metrics.size(); ++k) {
    const Metric& expected = former.metrics[k].combined;
    const Metric& found = again.metrics[k].combined;
    for (Eigen::Index i = 0; i < 3; ++i) {
      for (Eigen::Index j = 0; j < i; ++j) {
        EXPECT_NEAR(found.distance(i, j), expected.distance(i, j),
                    found.distance_error(i, j) + expected.distance_error(i, j))
            << k << ' ' << i << ' ' << j;
      }
    }
  }
}

TEST_F(FormerFiles, TablesHaveTheirValues) {
  const BrdfTable table = load_table(unpacked("former-table.h5"));
  EXPECT_EQ(table.grid.name(), "gauss:8x16");
  // `lobe eval`: theta_in, theta_out, delta_phi in degrees and the value, of which rounding may change the last digits.
  for (const auto& row : numbers("former-table.csv", 0)) {
    const Directions pair{row.at(0) * kDegree, row.at(1) * kDegree, row.at(2) * kDegree};
    const BrdfValues found = evaluate(device(), table, std::span(&pair, 1));
    EXPECT_NEAR(found.value(0, 0), row.at(3), 1e-12 * row.at(3)) << row.at(0) << ' ' << row.at(1) << ' ' << row.at(2);
  }
}

}  // namespace
}  // namespace lobe::test
