// Cost of a study, extrapolated from some of its materials.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <set>
#include <string>

#include "core/files.hpp"
#include "lobe/core/error.hpp"
#include "lobe/study/shard.hpp"
#include "lobe/study/study.hpp"
#include "lobe/study/study_plan.hpp"
#include "support/device.hpp"
#include "support/temporary_directory.hpp"

namespace lobe::test {
namespace {

Study study_of_forty() {
  const TemporaryDirectory directory;
  write_text(directory.path() / "forty.toml", false, R"(
[study]
tolerance = 1e-2
comparison_metrics = ["bieron-l2"]
comparison_tolerance = 0.1
[[family]]
name = "Phong"
model = "phong"
n = {logspace = [1, 100], count = 40}
[[chart]]
name = "albedo"
quantity = "albedo"
curves = [{label = "a", model = "phong", n = 5}]
[[chart]]
name = "mean"
quantity = "mean-albedo"
parameter = "n"
x = [1, 5, 20, 50, 100]
curves = [{label = "a", model = "phong"}]
)");
  return load_study(directory.path() / "forty.toml");
}

std::set<std::string> stage_names(const StudyPlan& plan) {
  std::set<std::string> names;
  for (const auto& stage : plan.stages) names.insert(stage.name);
  return names;
}

TEST(StudyPlan, OfAFewMaterialsHasTheStagesOfAllAndARangeAroundTheTime) {
  const Study study = study_of_forty();
  const StudyPlan few = plan_study(device(), study, {.trial_seconds = 0});
  const StudyPlan all = plan_study(device(), study, {.trial_seconds = 1000, .deadline_seconds = 1000});

  EXPECT_EQ(few.materials, 40U);
  EXPECT_EQ(few.pairs, 780U);
  EXPECT_EQ(few.tried, 8U);  // two trials, to tell what grows
  EXPECT_EQ(all.tried, 40U);
  EXPECT_EQ(stage_names(few), stage_names(all));
  for (const auto* plan : {&few, &all}) {
    SCOPED_TRACE(plan->tried);
    EXPECT_GT(plan->seconds_low, 0);
    EXPECT_LT(plan->seconds_low, plan->seconds);
    EXPECT_LT(plan->seconds, plan->seconds_high);
    EXPECT_TRUE(std::isfinite(plan->seconds_high));
    double sum = 0;
    for (const auto& stage : plan->stages) sum += stage.seconds;
    EXPECT_NEAR(plan->seconds, sum, 1e-9 * sum);
  }
  EXPECT_GT(few.seconds_high / few.seconds_low, all.seconds_high / all.seconds_low);  // less is known
}

TEST(StudyPlan, WithoutATrialInTimeHasALowerBoundAlone) {
  const StudyPlan plan = plan_study(device(), study_of_forty(), {.trial_seconds = 0, .deadline_seconds = 1e-9});
  EXPECT_EQ(plan.tried, 0U);
  EXPECT_TRUE(std::isinf(plan.seconds_high));
  EXPECT_GT(plan.seconds_low, 0);
}

/// A plan whose times are known: of the study of forty, and what is no unit.
StudyPlan plan_of(double point, double curves, double rest) {
  StudyPlan plan;
  plan.materials = plan.tried = 40;
  plan.stages = {
      {.name = "point", .seconds = point}, {.name = "curves", .seconds = curves}, {.name = "x", .seconds = rest}};
  plan.seconds = point + curves + rest;
  plan.work_bytes = 1000;
  plan.unit_bytes = 700;
  return plan;
}

TEST(RankPlans, ShareAllUnitsAndNothingElse) {
  const Study study = study_of_forty();
  const StudyPlan plan = plan_of(20, 8, 5);
  const RankPlan alone = plan_ranks(device(), study, plan, 1);
  EXPECT_NEAR(alone.seconds, 33, 1e-9);
  EXPECT_NEAR(alone.alone_seconds, 5, 1e-9);
  EXPECT_EQ(alone.units, deal_study(device(), study, 1).size());
  EXPECT_EQ(alone.moved_bytes, 0U);
  EXPECT_EQ(alone.first_bytes, plan.work_bytes);
  EXPECT_EQ(alone.other_bytes, 0U);

  double before = alone.seconds;
  for (const std::size_t ranks : {2U, 4U, 8U, 1000U}) {
    const RankPlan together = plan_ranks(device(), study, plan, ranks);
    EXPECT_LE(together.seconds, before + 1e-9) << ranks;
    EXPECT_GE(together.seconds, 5 + 28.0 / static_cast<double>(ranks)) << ranks;
    EXPECT_GE(together.seconds, 5 + together.longest_seconds) << ranks;
    EXPECT_GT(together.moved_bytes, 0U) << ranks;
    EXPECT_LT(together.moved_bytes, together.all_bytes) << ranks;
    EXPECT_EQ(together.all_bytes, alone.all_bytes) << ranks;
    EXPECT_EQ(together.first_bytes, plan.work_bytes + 2 * together.all_bytes) << ranks;
    EXPECT_EQ(together.other_bytes, plan.unit_bytes) << ranks;
    before = together.seconds;
  }
  // Forty curves of a fifth of a second are dealt evenly.
  EXPECT_NEAR(plan_ranks(device(), study, plan_of(0, 8, 5), 4).seconds, 5 + 8.0 / 4, 1e-9);
}

TEST(RankPlans, LeaveTreesAndMapsToTheFirst) {
  StudyPlan plan = plan_of(20, 8, 5);
  plan.stages.front().alone_seconds = 12;
  const RankPlan together = plan_ranks(device(), study_of_forty(), plan, 8);
  EXPECT_NEAR(together.alone_seconds, 5 + 12, 1e-9);
  EXPECT_LT(together.longest_seconds, 8);
  EXPECT_NEAR(plan_ranks(device(), study_of_forty(), plan, 1).seconds, 33, 1e-9);
}

TEST(RankPlans, WithoutTimesAreDealtByRoughCosts) {
  StudyPlan plan = plan_of(0, 0, 0);
  plan.tried = 0;
  plan.stages.clear();
  const RankPlan together = plan_ranks(device(), study_of_forty(), plan, 4);
  EXPECT_GT(together.moved_bytes, together.all_bytes / 4);
  EXPECT_EQ(together.longest_unit, "");
  EXPECT_EQ(together.seconds, 0);
}

// Trials say what of a stage is not shared.
TEST(StudyPlan, TellsWhatOfAStageIsNotShared) {
  const StudyPlan plan = plan_study(device(), study_of_forty(), {.trial_seconds = 0});
  const auto point = std::ranges::find(plan.stages, "point", &PlannedStage::name);
  ASSERT_NE(point, plan.stages.end());
  EXPECT_GT(point->alone_seconds, 0);
  EXPECT_LT(point->alone_seconds, point->seconds);
}

TEST(RankPlans, LeaveOutWhatACheckpointHas) {
  StudyPlan plan = plan_of(20, 8, 5);
  plan.stages.front().is_kept = true;
  plan.seconds -= 20;
  const RankPlan rest = plan_ranks(device(), study_of_forty(), plan, 2);
  const auto all = deal_study(device(), study_of_forty(), 1);
  const auto slabs =
      std::ranges::count_if(all, [](const DealtUnit& unit) { return unit.name.ends_with(" of lighting point"); });
  EXPECT_GT(slabs, 1);
  EXPECT_EQ(rest.units, all.size() - static_cast<std::size_t>(slabs));
  EXPECT_NEAR(rest.seconds, 5 + 8.0 / 2, 1e-9);
  EXPECT_LT(rest.all_bytes, plan_ranks(device(), study_of_forty(), plan_of(20, 8, 5), 2).all_bytes);
}

TEST(RankPlans, AreOfOneRankAtLeast) {
  EXPECT_THROW(static_cast<void>(plan_ranks(device(), study_of_forty(), plan_of(1, 1, 1), 0)), ArgumentError);
  EXPECT_THROW(static_cast<void>(plan_ranks(device(), study_of_forty(), plan_of(1, 1, 1), kMostRanks + 1)),
               ArgumentError);
}

}  // namespace
}  // namespace lobe::test
