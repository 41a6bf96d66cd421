// Results that a study keeps for a run that continues it.
#include "lobe/study/checkpoint.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cstdint>
#include <cstring>
#include <fstream>
#include <set>
#include <sstream>
#include <string>
#include <utility>

#include "study/run/checkpoint_records.hpp"
#include "support/device.hpp"
#include "support/temporary_directory.hpp"

namespace lobe::test {
namespace {

using ::testing::Contains;
using ::testing::Not;

class Checkpoints : public ::testing::Test {
 protected:
  Checkpoints() {
    std::ofstream(directory_.path() / "s.toml")
        << "[study]\nlightings = [\"point\", \"daylight\"]\ncomparison_metrics = [\"cube-root\"]\n"
           "channels = [\"r\", \"g\"]\n[[family]]\nname = \"Ward\"\nmodel = \"ward\"\nm = [0.2, 0.3, 0.4]\n"
           "scale = [0.5, 0.7]\n[[material]]\nname = \"grey\"\nmodel = \"lambert\"\n";
    study_ = load_study(directory_.path() / "s.toml");
    result_ = run_study(device_, study_);
  }
  [[nodiscard]] std::filesystem::path path() const { return directory_.path() / "s.checkpoint"; }
  /// A file with the results of daylight and of the comparison metric.
  void keep_two() const {
    Checkpoint checkpoint(path());
    checkpoint.open(result_.study, device_);
    checkpoint.keep(result_.metrics.at(1), kLongStudy);
    checkpoint.keep(result_.comparisons.at(0), kLongStudy);
  }
  /// How many results a study finds in the file.
  [[nodiscard]] std::size_t found(const Study& study) const {
    Checkpoint checkpoint(path());
    checkpoint.open(study, device_);
    return checkpoint.kept();
  }

  static constexpr double kLongStudy = 10;  // s, that the computation is said to have taken
  TemporaryDirectory directory_;
  const Device& device_ = device();
  Study study_;
  StudyResult result_;
};

TEST_F(Checkpoints, GiveTheSameResultWithoutTheWork) {
  keep_two();
  Checkpoint checkpoint(path());
  std::set<std::string> stages;
  const auto result = run_study(device_, study_, checkpoint, [&](std::string_view stage, double) {
    stages.emplace(stage);
    return true;
  });

  EXPECT_THAT(stages, Contains("point"));
  EXPECT_THAT(stages, Not(Contains("daylight")));
  const MetricResult& kept = result.metrics.at(1);
  const MetricResult& computed = result_.metrics.at(1);
  EXPECT_EQ(kept.lighting, computed.lighting);
  EXPECT_EQ(kept.combined.gram, computed.combined.gram);
  EXPECT_EQ(kept.combined.norm_error, computed.combined.norm_error);
  ASSERT_EQ(kept.channels.size(), 2U);
  EXPECT_EQ(kept.channels[1].distance, computed.channels.at(1).distance);
  EXPECT_EQ(kept.channels[1].distance_error, computed.channels.at(1).distance_error);
  EXPECT_EQ(kept.work.nodes, computed.work.nodes);
  EXPECT_EQ(result.comparisons.at(0).combined.distance, result_.comparisons.at(0).combined.distance);
  EXPECT_EQ(result.comparisons.at(0).combined.size_error, result_.comparisons.at(0).combined.size_error);
  EXPECT_EQ(result.comparisons.at(0).unresolved.size(), result_.comparisons.at(0).unresolved.size());
}

// Grids that measure() has chosen, and what they do not resolve, were lost.
TEST_F(Checkpoints, KeepRouteGridAndWhatIsCoarse) {
  std::ofstream(directory_.path() / "coarse.toml")
      << "[study]\nlightings = [\"material:lambert:scale=0.5\", \"point\"]\ncomparison_metrics = [\"cube-root\"]\n"
         "[[material]]\nname = \"gloss\"\nmodel = \"ward\"\nm = 0.05\n"
         "[[material]]\nname = \"cone\"\nmodel = \"ward\"\nm = 0.5\n";
  Study study = load_study(directory_.path() / "coarse.toml");
  const StudyResult first = run_study(device_, study);
  study.grid = HemisphereGrid::gauss(8, 16);
  study.allow_unresolved = true;
  const StudyResult coarse = run_study(device_, study);
  ASSERT_THAT(coarse.metrics.at(1).coarse, ::testing::ElementsAre(0));
  for (const StudyResult* result : {&first, &coarse}) {
    Checkpoint checkpoint(path());
    checkpoint.open(result->study, device_);
    for (const auto& metric : result->metrics) checkpoint.keep(metric, kLongStudy);
    for (const auto& comparison : result->comparisons) checkpoint.keep(comparison, kLongStudy);

    const auto again = run_study(device_, result->study, checkpoint, {});

    for (std::size_t i = 0; i < 2; ++i) {
      EXPECT_EQ(again.metrics[i].route, result->metrics[i].route) << i;
      EXPECT_EQ(again.metrics[i].grid, result->metrics[i].grid) << i;
      EXPECT_EQ(again.metrics[i].coarse, result->metrics[i].coarse) << i;
      EXPECT_EQ(again.metrics[i].tolerance, result->metrics[i].tolerance) << i;
    }
    EXPECT_EQ(again.comparisons.at(0).route, result->comparisons.at(0).route)
        << (result == &first ? "first" : "coarse");
    EXPECT_EQ(again.comparisons.at(0).grid, result->comparisons.at(0).grid) << (result == &first ? "first" : "coarse");
    checkpoint.remove();
  }
}

TEST_F(Checkpoints, AreNotTakenByAnotherStudy) {
  keep_two();
  Study other = result_.study;
  EXPECT_EQ(found(other), 2U);
  other.tolerance *= 2;
  EXPECT_EQ(found(other), 0U);
  other = result_.study;
  other.materials.pop_back();
  EXPECT_EQ(found(other), 0U);
  other = result_.study;
  other.grid = HemisphereGrid::gauss(8, 16);
  EXPECT_EQ(found(other), 0U);
  EXPECT_EQ(found(result_.study), 2U) << "looking at it has changed it";
}

TEST_F(Checkpoints, AreNotTakenByAStudyWithOtherValuesFromOutside) {
  keep_two();
  const auto study = [&](const std::vector<std::string>& overrides) {
    return load_study(directory_.path() / "s.toml", overrides);
  };
  EXPECT_EQ(found(study({})), 2U);
  const Study changed = study({"family.Ward.m=[0.2, 0.3, 0.5]"});
  EXPECT_EQ(found(changed), 0U);
  Checkpoint checkpoint(path());
  checkpoint.open(changed, device_);
  checkpoint.keep(result_.metrics.at(1), kLongStudy);
  EXPECT_EQ(found(study({"family.Ward.m=[0.2, 0.3, 0.5]"})), 1U);
  EXPECT_EQ(found(study({"family.Ward.m=[0.2, 0.3, 0.6]"})), 0U);
  EXPECT_EQ(found(study({})), 0U);
}

TEST_F(Checkpoints, AreRemovedByTheirStudyOnly) {
  keep_two();
  Study other = result_.study;
  other.tolerance *= 2;
  Checkpoint(path()).remove();
  Checkpoint other_study(path());
  other_study.open(other, device_);
  other_study.remove();
  EXPECT_TRUE(std::filesystem::exists(path()));

  Checkpoint own(path());
  own.open(result_.study, device_);
  own.remove();
  EXPECT_FALSE(std::filesystem::exists(path()));
}

TEST_F(Checkpoints, LoseADamagedEndOnly) {
  keep_two();
  std::filesystem::resize_file(path(), std::filesystem::file_size(path()) - 3);
  EXPECT_EQ(found(result_.study), 1U);
  // Later files are readable again.
  Checkpoint checkpoint(path());
  checkpoint.open(result_.study, device_);
  checkpoint.keep(result_.metrics.at(0), kLongStudy);
  EXPECT_EQ(found(result_.study), 2U);
}

/// Under a checksum that fits them: what is computed with has the sizes of the study all the same.
TEST_F(Checkpoints, LoseForgedResultsOfOtherSizes) {
  keep_two();
  std::ostringstream text;
  text << std::ifstream(path(), std::ios::binary).rdbuf();
  const std::string whole = std::move(text).str();
  const std::string name = record_name(Lighting::daylight());
  const std::string before = whole.substr(0, whole.find(name) - sizeof(std::uint64_t));
  MetricResult forged = result_.metrics.at(1);
  const auto kept_with = [&](const MetricResult& result) {
    std::ofstream(path(), std::ios::binary) << before << checkpoint_record(name, written_result(result));
    return found(result_.study);
  };
  EXPECT_EQ(kept_with(forged), 1U);
  forged.channels[1].norm.conservativeResize(1);
  EXPECT_EQ(kept_with(forged), 0U);
  forged = result_.metrics.at(1);
  forged.unresolved.push_back({0, result_.study.materials.size(), 1});
  EXPECT_EQ(kept_with(forged), 0U);
  Metric& two = forged.combined;
  two = {two.gram.topLeftCorner(2, 2), two.gram_error.topLeftCorner(2, 2), two.norm.head(2),
         two.norm_error.head(2),       two.distance.topLeftCorner(2, 2),   two.distance_error.topLeftCorner(2, 2)};
  forged.channels.clear();
  forged.unresolved.clear();
  EXPECT_EQ(kept_with(forged), 0U);
}

/// A vector that is said to have two columns.
TEST_F(Checkpoints, LoseForgedVectorsWithTwoColumns) {
  const MetricResult& result = result_.metrics.at(1);
  const std::string content = written_result(result);
  const auto size_of = [](const Eigen::MatrixXd& matrix) {
    return 2 * sizeof(std::uint64_t) + static_cast<std::size_t>(matrix.size()) * sizeof(double);
  };
  std::string forged = content;
  const std::uint64_t two = 2;
  std::memcpy(forged.data() + 2 * size_of(result.combined.gram) + sizeof two, &two, sizeof two);
  MetricResult read = result;
  EXPECT_TRUE(read_result(content, read));
  EXPECT_FALSE(read_result(forged, read));
}

TEST_F(Checkpoints, LeaveWhatIsSomethingElseAlone) {
  std::ofstream(path()) << "notes";
  Checkpoint checkpoint(path());
  checkpoint.open(result_.study, device_);
  checkpoint.keep(result_.metrics.at(0), kLongStudy);
  EXPECT_EQ(checkpoint.kept(), 0U);
  checkpoint.remove();
  EXPECT_EQ(std::filesystem::file_size(path()), 5U);
}

TEST_F(Checkpoints, AreNotWrittenOfQuickWork) {
  Checkpoint checkpoint(path());
  checkpoint.open(result_.study, device_);
  checkpoint.keep(result_.metrics.at(0), 0.1);
  EXPECT_FALSE(std::filesystem::exists(path()));
}

TEST_F(Checkpoints, AreGivenUpWhereTheyCannotBeWritten) {
  Checkpoint checkpoint(directory_.path() / "absent" / "s.checkpoint");
  checkpoint.open(result_.study, device_);
  checkpoint.keep(result_.metrics.at(0), kLongStudy);
  EXPECT_EQ(checkpoint.kept(), 0U);
}

}  // namespace
}  // namespace lobe::test
