// Cost of a study, extrapolated from some of its materials.
#include <gtest/gtest.h>

#include <cmath>
#include <set>
#include <string>

#include "core/files.hpp"
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

}  // namespace
}  // namespace lobe::test
