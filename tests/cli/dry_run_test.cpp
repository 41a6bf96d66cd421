// `lobe run --dry-run`: what a run takes and leaves, before it.
#include <fstream>
#include <set>

#include "cli/command_test.hpp"

namespace lobe::test {
namespace {

namespace fs = std::filesystem;
using cli::ExitCode;
using ::testing::Contains;
using ::testing::HasSubstr;
using ::testing::UnorderedElementsAre;

constexpr const char* kPlannedStudy = R"(
[study]
tolerance = 1e-3
lightings = ["point", "daylight"]
comparison_metrics = ["bieron-l2"]
comparison_tolerance = 0.1

[[family]]
name = "Phong"
model = "phong"
n = [1, 5, 20]

[[material]]
name = "matt"
model = "lambert"

[[published]]
title = "T"
quantity = "constant"
model = "lambert"
printed = "0.318"

[[chart]]
name = "albedo"
quantity = "albedo"
x = [0, 30, 60]
curves = [{label = "a", model = "phong", n = 5}]
)";

class DryRun : public CommandTest {
 protected:
  DryRun() { write("four.toml", kPlannedStudy); }
  void write(const std::string& name, const std::string& text) const { std::ofstream(file(name)) << text; }
};

TEST_F(DryRun, CountsMaterialsAndWritesNothing) {
  const auto plan = json({"run", "four.toml", "-o", "out", "--dry-run"});
  EXPECT_EQ(plan["materials"], 4);
  EXPECT_EQ(plan["pairs"], 6);
  EXPECT_EQ(plan["families"][0], (Json{{"family", "Phong"}, {"materials", 3}}));
  EXPECT_THAT(files(), UnorderedElementsAre("four.toml"));
}

TEST_F(DryRun, NamesTheFilesThatTheRunLeavesAndItsStages) {
  const auto plan = json({"run", "four.toml", "-o", "out", "--dry-run"});
  const auto run = json({"run", "four.toml", "-o", "out"});
  std::set<std::string> planned(plan["files"].begin(), plan["files"].end());
  std::set<std::string> left{run["files"]["table"]};
  for (const auto* kind : {"csv", "pages", "pictures"})
    left.insert(run["files"][kind].begin(), run["files"][kind].end());
  EXPECT_EQ(planned, left);

  std::set<std::string> stages;
  for (const auto& stage : plan["stages"]) {
    stages.insert(stage["stage"]);
    EXPECT_GT(stage["seconds"], 0) << stage["stage"];
  }
  for (const auto* name :
       {"point", "daylight", "bieron-l2", "curves", "published figures", "chart albedo", "files and pictures"}) {
    EXPECT_THAT(stages, Contains(name));
  }
  const auto& seconds = plan["seconds"];
  EXPECT_LT(seconds["at_least"], seconds["expected"]);
  EXPECT_LT(seconds["expected"], seconds["at_most"]);
  double sum = 0;
  for (const auto& stage : plan["stages"]) sum += stage["seconds"].get<double>();
  EXPECT_NEAR(seconds["expected"].get<double>(), sum, 1e-6 * sum);
  EXPECT_GT(plan["peak_bytes"], 1 << 20);
}

TEST_F(DryRun, TellsOfResultsThatAreThere) {
  EXPECT_EQ(json({"run", "four.toml", "--dry-run"})["existing"], Json());
  write("four.h5", "");
  EXPECT_EQ(json({"run", "four.toml", "--dry-run"})["existing"], "./four.h5");
  const auto outcome = run({"run", "four.toml", "--dry-run"});
  EXPECT_EQ(outcome.status, 0);
  EXPECT_EQ(outcome.error, "lobe: warning: ./four.h5 exists; the run needs --force to replace it, or another --name\n");
  EXPECT_EQ(run({"run", "four.toml", "--dry-run", "--force"}).error, "");
}

// Many lobes of two models.
constexpr const char* kManyUnits = R"(
[study]
tolerance = 1e-2
lightings = ["point", "daylight"]

[[family]]
name = "Phong"
model = "phong"
n = {linspace = [2, 60], count = 30}

[[family]]
name = "Ward"
model = "ward"
m = {linspace = [0.2, 0.6], count = 20}
)";

TEST_F(DryRun, TellsWhatRanksNeed) {
  const Json plan = json({"run", "four.toml", "--dry-run", "--ranks", "3"});
  const Json& three = plan["ranks"];
  EXPECT_EQ(three["count"], 3);
  EXPECT_LT(three["seconds"].get<double>(), plan["seconds"]["expected"].get<double>());
  EXPECT_GE(three["seconds"].get<double>(),
            three["alone_seconds"].get<double>() + three["longest_seconds"].get<double>());
  EXPECT_GT(three["moved_bytes"], 0);
  EXPECT_LT(three["moved_bytes"], three["all_bytes"]);
  EXPECT_LT(three["other_rank_bytes"], three["rank_0_bytes"]);
  EXPECT_FALSE(json({"run", "four.toml", "--dry-run"}).contains("ranks"));

  const auto outcome = run({"run", "four.toml", "--dry-run", "--ranks", "1"});
  EXPECT_THAT(outcome.output, HasSubstr("\nranks       1, each on a machine like this one, for "));
  EXPECT_THAT(outcome.output, HasSubstr("the longest unit takes "));
  EXPECT_THAT(outcome.output, HasSubstr(", about 0 bytes of them move to rank 0\n"));
}

// A shard that is the whole study holds what could travel. Slabs are counted as if all had three levels.
TEST_F(DryRun, KnowsTheSizesOfResults) {
  write("many.toml", kManyUnits);
  std::string coloured(kPlannedStudy);
  const std::string matt = "model = \"lambert\"";
  coloured.replace(coloured.find(matt), matt.size(), matt + "\nscale = [0.1, 0.2, 0.3]");
  coloured.insert(coloured.find("tolerance"), "channels = [\"r\", \"g\", \"b\"]\n");
  write("four.toml", coloured);
  for (const char* name : {"many", "four"}) {
    const std::string study = std::string(name) + ".toml";
    const auto planned = json({"run", study, "--dry-run", "--ranks", "2"})["ranks"]["all_bytes"].get<double>();
    make({"run", study, "--shard", "1/1", "-o", "shards"});
    const auto found = static_cast<double>(fs::file_size(file("shards/" + std::string(name) + ".1-of-1.shard")));
    EXPECT_GT(found / planned, 1 / 1.2) << name;
    EXPECT_LT(found / planned, 1.2) << name;
  }
}

TEST_F(DryRun, TellsOfRanksOnlyWhereThereMayBeSome) {
  expect_refusal({"run", "four.toml", "--ranks", "2"}, ExitCode::usage, "--ranks belongs to --dry-run");
  expect_refusal({"run", "four.toml", "--dry-run", "--ranks", "2", "--shard", "1/2"}, ExitCode::usage,
                 "--ranks belongs to --dry-run");
  expect_refusal({"run", "four.toml", "--dry-run", "--ranks", "0"}, ExitCode::usage, "ranks");
  expect_refusal({"run", "four.toml", "--dry-run", "--ranks", "100001"}, ExitCode::usage, "from 1 to 100000");
}

TEST_F(DryRun, PlansMirrorsWhereTheyHaveNorms) {
  write("mirror.toml",
        "[study]\nlightings = [\"daylight\"]\n[[material]]\nname = \"m\"\nmodel = \"mirror\"\n"
        "[[material]]\nname = \"l\"\nmodel = \"lambert\"\n");
  EXPECT_THAT(make({"run", "mirror.toml", "--dry-run"}).output, HasSubstr("daylight"));
}

TEST_F(DryRun, RefusesWhatTheRunRefuses) {
  write("typo.toml", "[study]\nlightnings = []\n");
  expect_refusal({"run", "typo.toml", "--dry-run"}, ExitCode::usage, "typo.toml:2:1: unknown key 'lightnings'");
  write("four.h5", "");
  expect_refusal({"run", "four.toml", "-o", "four.h5/out", "--dry-run"}, ExitCode::file,
                 "cannot create directory four.h5/out: Not a directory");
  write("plate.csv", "this is no table\n");
  write("plate.toml", "[[measured]]\nfile = \"plate.csv\"\n");
  expect_refusal({"run", "plate.toml", "--dry-run"}, ExitCode::file,
                 "plate.csv: it is of no known format; 'lobe import --help' names those that are read");
}

}  // namespace
}  // namespace lobe::test
