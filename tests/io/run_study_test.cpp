#include <gtest/gtest.h>

#include <filesystem>
#include <numbers>
#include <string>
#include <string_view>
#include <vector>

#include "lobe/core/directions.hpp"
#include "lobe/core/error.hpp"
#include "lobe/study/study.hpp"
#include "lobe/study/study_results.hpp"
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

TEST(RunStudy, MeasuresUpToTheLargestAngleOfItsDomainAndSaysSo) {
  Study study = lambert_and_phong();
  study.domain_theta_max = std::numbers::pi / 3;
  const StudyResult result = run_study(device(), study);
  EXPECT_NEAR(result.metrics[1].combined.gram(0, 0), 9.0 / 16, 1e-6);
  EXPECT_EQ(result.metrics[1].theta_max, study.domain_theta_max);
  const TemporaryDirectory directory;
  const StudyResult read = load_study_results(write_study(result, directory.path()).table);
  EXPECT_NEAR(to_degrees(read.study.domain_theta_max), 60, 1e-12);
  EXPECT_EQ(read.metrics[1].theta_max, read.study.domain_theta_max);
  study.lightings = {Lighting::patch(0.5)};
  EXPECT_THROW((void)run_study(device(), study), ArgumentError);
}

TEST(RunStudy, NamesTheChannelAndItsWeightWhereTheStudyDoesNot) {
  const StudyResult result = run_study(device(), lambert_and_phong());
  EXPECT_EQ(result.study.channels, std::vector<std::string>{"value"});
  EXPECT_EQ(result.study.channel_weights, std::vector<double>{1});
}

TEST(RunStudy, TakesGreyMaterialsForAnyChannels) {
  Study study = lambert_and_phong();
  study.channels = {"r", "g"};
  study.channel_weights = {0.25, 0.75};
  const StudyResult result = run_study(device(), study);
  ASSERT_EQ(result.metrics[1].channels.size(), 2U);
  EXPECT_EQ(result.metrics[1].channels[0].distance, result.metrics[1].channels[1].distance);
  EXPECT_NEAR(result.metrics[1].combined.gram(0, 0), 1, 1e-6);
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

/// Three materials in two families, with all that a study can ask for.
Study analysed() {
  Study study = lambert_and_phong();
  study.materials.push_back(make_material("phong", {{"n", 20}}));
  study.lightings = {Lighting::point(), Lighting::patch(0.5)};
  study.tolerance = 1e-4;
  study.patch_tolerance = 0.02;
  study.comparison_metrics = {LiteratureMetric::bieron_l2, LiteratureMetric::log_relative};
  study.comparison_tolerance = 1e-2;
  study.approximations = {FamilyFit::linear, FamilyFit::non_negative};
  return study;
}

TEST(RunStudy, ComparesAsCompareDoes) {
  const StudyResult result = run_study(device(), analysed());
  LiteratureOptions options;
  options.tolerance = 1e-2;
  const auto expected = compare(device(), formulas(result.study), LiteratureMetric::log_relative, options);
  ASSERT_EQ(result.comparisons.size(), 2U);
  EXPECT_EQ(result.comparisons[0].metric, LiteratureMetric::bieron_l2);
  EXPECT_EQ(result.comparisons[1].combined.distance, expected.combined.distance);
  EXPECT_EQ(result.comparisons[1].combined.distance_error, expected.combined.distance_error);
}

TEST(RunStudy, RanksPairsByAllMetrics) {
  const StudyResult result = run_study(device(), analysed());
  EXPECT_EQ(result.agreement.metrics, (std::vector<std::string>{"point", "patch:0.5", "bieron-l2", "log-relative"}));
  const std::vector<Eigen::MatrixXd> distances{result.metrics[0].combined.distance,
                                               result.comparisons[1].combined.distance};
  EXPECT_EQ(result.agreement.all_pairs.spearman(0, 3), rank_agreement(distances).spearman(0, 1));
  EXPECT_EQ(result.agreement.within_families.spearman.size(), 0);  // no family of three
}

TEST(RunStudy, ApproximatesEveryMaterialByEveryFamilyUnderEachLighting) {
  const StudyResult result = run_study(device(), analysed());
  ASSERT_EQ(result.residuals.size(), 4U);
  EXPECT_EQ(result.residuals[1].lighting, Lighting::point());
  EXPECT_TRUE(result.residuals[1].non_negative);
  EXPECT_FALSE(result.residuals[2].non_negative);
  const auto expected = family_residuals(result.metrics[1], labels(result.study));
  EXPECT_EQ(result.residuals[2].families, expected.families);
  EXPECT_EQ(result.residuals[2].relative_residual(0, 1), expected.relative_residual(0, 1));
}

TEST(RunStudy, RefinesPatchLightsToTheirOwnTolerance) {
  Study study = analysed();
  study.comparison_metrics.clear();
  study.tolerance = 1e-6;
  const auto coarse = run_study(device(), study).metrics[1];
  study.patch_tolerance = 1e-6;
  const auto fine = run_study(device(), study).metrics[1];
  EXPECT_TRUE(coarse.unresolved.empty());
  EXPECT_TRUE(fine.unresolved.empty());
  EXPECT_LT(coarse.work.nodes, fine.work.nodes);
}

TEST(RunStudy, StopsWhenAskedTo) {
  const auto stop = [](std::string_view, double) { return false; };
  EXPECT_THROW((void)run_study(device(), lambert_and_phong(), stop), Cancelled);
}

TEST(RunStudy, TakesASingleMaterialAllTheWay) {
  Study study = lambert_and_phong();
  study.materials.erase(study.materials.begin() + 1, study.materials.end());
  const TemporaryDirectory directory;
  const StudyFiles files = write_study(run_study(device(), study), directory.path());
  EXPECT_EQ(files.note, "");
  EXPECT_TRUE(std::filesystem::exists(files.table));
}

}  // namespace
}  // namespace lobe::test
