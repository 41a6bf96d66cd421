#include <gtest/gtest.h>

#include <filesystem>
#include <numbers>
#include <string>
#include <string_view>
#include <vector>

#include "lobe/error.hpp"
#include "lobe/study.hpp"
#include "support/device.hpp"
#include "support/temporary_directory.hpp"

namespace lobe::test {
namespace {

Study lambert_and_phong() {
  Study study;
  study.name = "two";
  study.title = "Two";
  study.materials = {make_material("lambert"), make_material("phong", {{"n", 5}})};
  study.lightings = {Lighting::daylight(), Lighting::point()};
  return study;
}

TEST(RunStudy, MeasuresUnderEachLightingInOrder) {
  const StudyResult result = run_study(device(), lambert_and_phong());
  ASSERT_EQ(result.metrics.size(), 2U);
  EXPECT_EQ(result.metrics[0].lighting, Lighting::daylight());
  EXPECT_NEAR(result.metrics[0].combined.gram(0, 0), std::numbers::pi, 1e-6 * std::numbers::pi);
  EXPECT_NEAR(result.metrics[1].combined.gram(0, 0), 1, 1e-6);
  EXPECT_EQ(result.embeddings.size(), 2U);
  EXPECT_FALSE(result.stages.empty());
}

TEST(RunStudy, NamesTheChannelAndItsWeightWhereTheStudyDoesNot) {
  const StudyResult result = run_study(device(), lambert_and_phong());
  EXPECT_EQ(result.study.channels, std::vector<std::string>{"value"});
  EXPECT_EQ(result.study.channel_weights, std::vector<double>{1});
}

TEST(RunStudy, RefusesWeightsThatDoNotFitTheChannels) {
  Study study = lambert_and_phong();
  study.channels = {"r", "g"};
  study.channel_weights = {1};
  EXPECT_THROW((void)run_study(device(), study), ArgumentError);
}

TEST(RunStudy, ClustersTheMaterialsUnderEachLighting) {
  Study study = lambert_and_phong();
  study.materials.push_back(make_material("phong", {{"n", 5.1}}));
  study.clustering = {.clusters = 2, .neighbours = 1};
  const StudyResult result = run_study(device(), study);
  ASSERT_EQ(result.clusterings.size(), 2U);
  EXPECT_EQ(result.clusterings[1].medoids.cluster, (std::vector<std::size_t>{0, 1, 1}));
  EXPECT_EQ(result.clusterings[1].neighbours[1].front().material, 2U);
}

TEST(RunStudy, RefusesMoreClustersThanMaterials) {
  Study study = lambert_and_phong();
  study.clustering.clusters = 3;
  EXPECT_THROW((void)run_study(device(), study), ArgumentError);
}

TEST(RunStudy, StopsWhenAskedTo) {
  const auto stop = [](std::string_view, double) { return false; };
  EXPECT_THROW((void)run_study(device(), lambert_and_phong(), stop), Cancelled);
}

TEST(RunStudy, TakesASingleMaterialAllTheWay) {
  Study study = lambert_and_phong();
  study.materials.resize(1);
  const TemporaryDirectory directory;
  const StudyFiles files = write_study(run_study(device(), study), directory.path());
  EXPECT_EQ(files.note, "");
  EXPECT_TRUE(std::filesystem::exists(files.table));
}

}  // namespace
}  // namespace lobe::test
