// Shards of a study: whoever computes which part, the results have the same bytes.
#include "lobe/study/shard.hpp"

#include <algorithm>
#include <chrono>
#include <fstream>
#include <functional>
#include <map>
#include <random>
#include <set>
#include <string>
#include <vector>

#include "cli/command_test.hpp"
#include "core/files.hpp"
#include "lobe/core/error.hpp"
#include "lobe/study/study.hpp"
#include "study/run/shard_file.hpp"
#include "study/run/study_identity.hpp"
#include "support/device.hpp"
#include "support/environment.hpp"
#include "support/temporary_directory.hpp"

namespace lobe::test {
namespace {

namespace fs = std::filesystem;

using cli::ExitCode;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;

/// All kinds of units: lightings with slabs and without, with tables, metrics with kinks and without, near-identical
/// materials, one that is prepared, printed figures and charts.
constexpr std::string_view kEverything = R"([study]
name = "all"
title = "Everything"
lightings = ["point", "daylight", "patch:0.8", "mean-albedo", "material:lambert:scale=0.5"]
comparison_metrics = ["cube-root", "bieron-l2"]
approximations = ["non-negative", "linear"]
tolerance = 1e-4
patch_tolerance = 1e-2
comparison_tolerance = 1e-2
allow_unresolved = true
channels = ["r", "g"]
[[family]]
name = "Ward"
model = "ward"
m = [0.4, 0.400001, 0.5]
scale = [0.5, 0.7]
[[family]]
name = "Phong"
model = "phong"
n = [2, 5]
[[material]]
name = "grey"
model = "oren_nayar"
sigma = 0.5
adjustments = ["normalise"]
[[published]]
title = "Table 1"
quantity = "constant"
model = "blinn"
n = "$n"
columns = ["n", "printed", "corrected"]
rows = [[1, "0.350", ""], [2, "0.382", ""]]
[[chart]]
name = "albedos"
title = "Albedos"
quantity = "albedo"
curves = [{label = "Ward", model = "ward", m = 0.4}, {label = "Phong", model = "phong", n = 5}]
[[chart]]
name = "slices"
title = "Slices"
quantity = "reflectance"
curves = [{label = "Ward", model = "ward", m = 0.4, theta_in = 30}]
)";

/// Relative names of all files below a folder, with their bytes.
std::map<std::string, std::string> contents_of(const fs::path& folder) {
  std::map<std::string, std::string> contents;
  for (const auto& entry : fs::recursive_directory_iterator(folder)) {
    if (entry.is_regular_file()) contents[fs::relative(entry.path(), folder)] = read_text(entry.path());
  }
  return contents;
}

std::vector<std::string> names_in(const fs::path& folder) {
  std::vector<std::string> names;
  for (const auto& [name, bytes] : contents_of(folder)) names.push_back(name);
  return names;
}

/// Names of files that are not the same in both.
std::vector<std::string> differing(const fs::path& one, const fs::path& other) {
  const auto ours = contents_of(one);
  const auto theirs = contents_of(other);
  std::vector<std::string> names;
  for (const auto& [name, bytes] : ours) {
    if (!theirs.contains(name) || theirs.at(name) != bytes) names.push_back(name);
  }
  for (const auto& [name, bytes] : theirs) {
    if (!ours.contains(name)) names.push_back(name);
  }
  return names;
}

class Shards : public ::testing::Test {
 protected:
  Shards() {
    std::ofstream(path("all.toml")) << kEverything;
    study_ = load_study(path("all.toml"));
  }
  [[nodiscard]] fs::path path(const std::string& name) const { return directory_.path() / name; }
  /// Computes all shards, in any order, and merges them.
  [[nodiscard]] StudyResult from_shards(std::size_t count, const fs::path& folder) const {
    std::vector<std::size_t> order;
    for (std::size_t index = 1; index <= count; ++index) order.push_back(index);
    std::shuffle(order.begin(), order.end(), std::mt19937(static_cast<unsigned>(count)));
    for (const std::size_t index : order) static_cast<void>(run_shard(device(), study_, {index, count}, folder));
    return merge_shards(device(), study_, ShardSet::find(folder));
  }

  TemporaryDirectory directory_;
  ScopedVariable epoch_{"SOURCE_DATE_EPOCH", "1000000000"};
  Study study_;
};

TEST_F(Shards, MergeToTheBytesOfAPlainRun) {
  // Pictures are drawn from what is compared, and take long.
  const OutputOptions options{.command_line = "lobe run", .progress = [](std::string_view, double) { return false; }};
  write_study(run_study(device(), study_), path("plain"), options);
  for (const std::size_t count : {1U, 2U, 7U, 64U}) {
    const std::string name = "of-" + std::to_string(count);
    const StudyResult merged = from_shards(count, path("shards-" + name));
    write_study(merged, path(name), options);
    EXPECT_THAT(differing(path("plain"), path(name)), IsEmpty()) << count;
  }
}

// A unit that no shard, or two of them, computed would be found by its time alone.
TEST_F(Shards, HaveEachUnitOnce) {
  const auto units = deal_study(device(), study_, 3);
  std::set<std::string> names;
  double share = 0;
  for (const DealtUnit& unit : units) {
    EXPECT_TRUE(names.insert(unit.name).second) << unit.name;
    EXPECT_TRUE(unit.shard >= 1 && unit.shard <= 3) << unit.name;
    share += unit.share;
  }
  EXPECT_NEAR(share, 1, 1e-12);
  EXPECT_TRUE(names.contains("slab 1 of lighting point"));
  EXPECT_TRUE(names.contains("slab 1 of lighting daylight"));
  EXPECT_TRUE(names.contains("lighting patch:0.8"));
  EXPECT_TRUE(names.contains("comparison cube-root"));
  EXPECT_TRUE(names.contains("curves of material 6"));
  std::size_t computed = 0;
  for (std::size_t index = 1; index <= 3; ++index) {
    const ShardReport report = run_shard(device(), study_, {index, 3}, path("shards"));
    EXPECT_EQ(report.all_units, units.size()) << index;
    EXPECT_EQ(report.units, static_cast<std::size_t>(std::ranges::count(units, index, &DealtUnit::shard))) << index;
    computed += report.units;
  }
  EXPECT_EQ(computed, units.size());
}

// Nothing is computed when all is there, but for distances of near-identical materials.
TEST_F(Shards, AreNotComputedAgainByTheMerge) {
  std::set<std::string> stages;
  for (std::size_t index = 1; index <= 2; ++index)
    static_cast<void>(run_shard(device(), study_, {index, 2}, path("shards")));
  static_cast<void>(merge_shards(device(), study_, ShardSet::find(path("shards")), [&](std::string_view stage, double) {
    stages.emplace(stage);
    return true;
  }));
  EXPECT_FALSE(stages.contains("patch:0.8"));
  EXPECT_FALSE(stages.contains("mean-albedo"));
  EXPECT_FALSE(stages.contains("cube-root"));
}

TEST_F(Shards, SayWhatTheyExpect) {
  EXPECT_EQ(to_string(parse_shard("3/64")), "3/64");
  for (const char* text : {"", "3", "0/4", "5/4", "1/0", "a/b", "1/2/3", "-1/2", "1/2000000", " 1/2"}) {
    EXPECT_THROW(static_cast<void>(parse_shard(text)), ArgumentError) << text;
  }
}

TEST_F(Shards, OfOtherContentsOfAFileAreRefused) {
  std::ofstream(path("flat.csv")) << "1, 1, 0, 0, 0, 0, 0, 1\n";
  std::ofstream(path("files.toml")) << "[study]\nlightings = [\"mean-albedo\"]\n[[measured]]\nfile = \"flat.csv\"\n";
  const Study study = load_study(path("files.toml"));
  static_cast<void>(run_shard(device(), study, {1, 1}, path("shards")));
  const ShardSet shards = ShardSet::find(path("shards"));
  EXPECT_NO_THROW(shards.require_same(device(), study));
  // Somewhere else the file is the same, whenever it was written.
  fs::create_directory(path("elsewhere"));
  for (const char* name : {"flat.csv", "files.toml"}) fs::copy(path(name), path("elsewhere") / name);
  EXPECT_NO_THROW(shards.require_same(device(), load_study(path("elsewhere/files.toml"))));
  std::ofstream(path("flat.csv")) << "1, 1, 0, 0, 0, 0, 0, 2\n";
  EXPECT_THROW(shards.require_same(device(), study), IoError);
}

/// The command, on a study of little work.
class ShardCommand : public CommandTest {
 protected:
  ShardCommand() {
    write("s.toml", "0.4");
    for (int i = 1; i <= 2; ++i) make({"run", "s.toml", "--shard", std::to_string(i) + "/2", "-o", "d"});
  }
  void write(const std::string& name, const std::string& m) const {
    std::ofstream(file(name)) << "[study]\nname = \"s\"\nlightings = [\"daylight\"]\ntolerance = 1e-3\n"
                                 "[[family]]\nname = \"Ward\"\nmodel = \"ward\"\nm = [0.3, "
                              << m << "]\n";
  }
  /// Refused with this line, and nothing is written.
  void expect_no_merge(const std::string& message) const {
    expect_refusal({"merge", "d", "-o", "out"}, ExitCode::file, message);
    EXPECT_FALSE(fs::exists(file("out"))) << message;
  }
  [[nodiscard]] std::string bytes(const std::string& name) const { return read_text(file(name)); }
  void put(const std::string& name, const std::string& content) const {
    std::ofstream(file(name), std::ios::binary) << content;
  }

  ScopedVariable epoch_{"SOURCE_DATE_EPOCH", "1000000000"};
};

TEST_F(ShardCommand, MergesToTheFilesOfTheSameRunWithoutShards) {
  make({"merge", "d", "-o", "merged"});
  fs::rename(file("merged"), file("kept"));
  make({"run", "s.toml", "-o", "merged"});
  EXPECT_THAT(differing(file("kept"), file("merged")), IsEmpty());
  EXPECT_THAT(names_in(file("d")), ElementsAre("s.1-of-2.shard", "s.2-of-2.shard")) << "shards stay";
}

// Whatever was said, and however, is in the history of the results.
TEST_F(ShardCommand, RemembersTheOptionsOfTheRun) {
  const Words run_words{
      "run",         "--output=x", "s.toml", "--set", "family.Ward.m=[0.5, 0.6]", "--tolerance", "1e-2",
      "--precision", "single",     "--name", "t"};
  for (int i = 1; i <= 2; ++i) {
    Words words = run_words;
    words[1] = "--output=e";
    words.insert(words.begin() + 2, {"--shard", std::to_string(i) + "/2"});
    words.emplace_back("--force");
    make(words);
  }
  make({"merge", "e", "-o", "x"});
  fs::rename(file("x"), file("kept"));
  make(run_words);
  EXPECT_THAT(differing(file("kept"), file("x")), IsEmpty());
}

TEST_F(ShardCommand, AnswersInJson) {
  const Json shard = json({"run", "s.toml", "--shard", "2/2", "-o", "d"});
  EXPECT_EQ(shard["shard"], 2);
  EXPECT_EQ(shard["was_complete"], true);
  EXPECT_EQ(shard["file"], "d/s.2-of-2.shard");
  const Json merged = json({"merge", "d", "-o", "out"});
  EXPECT_EQ(merged["schema"], "lobe.merge/1");
  EXPECT_EQ(merged["shards"], 2);
  EXPECT_EQ(merged["files"]["table"], "out/s.h5");
}

TEST_F(ShardCommand, ListsUnitsWithoutComputingThem) {
  const auto outcome = make({"run", "s.toml", "--shard", "1/1", "--dry-run", "-o", "new"});
  EXPECT_THAT(outcome.output, HasSubstr("slab 1 of lighting daylight\n"));
  EXPECT_THAT(outcome.output, HasSubstr("about 100.0 % of the work\n"));
  EXPECT_FALSE(fs::exists(file("new")));
}

TEST_F(ShardCommand, LeavesACompleteShardAlone) {
  const auto before = fs::last_write_time(file("d/s.1-of-2.shard"));
  const auto outcome = make({"run", "s.toml", "--shard", "1/2", "-o", "d"});
  EXPECT_THAT(outcome.error, HasSubstr("shard 1/2 is complete"));
  EXPECT_EQ(fs::last_write_time(file("d/s.1-of-2.shard")), before);
}

TEST_F(ShardCommand, DoesNotTakeAShardForAnother) {
  fs::copy_file(file("d/s.1-of-2.shard"), file("d/s.2-of-2.shard"), fs::copy_options::overwrite_existing);
  expect_refusal({"run", "s.toml", "--shard", "2/2", "-o", "d"}, ExitCode::file,
                 "d/s.2-of-2.shard exists and is shard 1/2 under the name of shard 2/2; use --force to replace it");
  make({"run", "s.toml", "--shard", "2/2", "-o", "d", "--force"});
  make({"merge", "d", "-o", "merged"});
  // Results that exist are replaced elsewhere, not under another name.
  expect_refusal({"merge", "d", "-o", "merged"}, ExitCode::file, "use --force to replace it, or give another --output");
}

TEST_F(ShardCommand, DoesNotMergeWithoutAllShards) {
  fs::remove(file("d/s.2-of-2.shard"));
  expect_no_merge("shard 2 of 2 of 's' is missing in d; compute it first");
  fs::remove(file("d/s.1-of-2.shard"));
  expect_no_merge("d holds no shard");
  fs::remove(file("d"));
  expect_no_merge("cannot read d: No such file or directory");
}

TEST_F(ShardCommand, NamesAllMissingShards) {
  make({"run", "s.toml", "--shard", "3/8", "-o", "e"});
  make({"run", "s.toml", "--shard", "5/8", "-o", "e"});
  expect_refusal({"merge", "e"}, ExitCode::file,
                 "shards 1, 2, 4 and 6 to 8 of 8 of 's' are missing in e; compute them first");
}

TEST_F(ShardCommand, DoesNotMergeAShardTwice) {
  fs::copy(file("d/s.2-of-2.shard"), file("d/copy.shard"));
  expect_no_merge("d/copy.shard and d/s.2-of-2.shard are both shard 2/2");
}

TEST_F(ShardCommand, DoesNotMergeShardsOfAnotherNumber) {
  make({"run", "s.toml", "--shard", "1/3", "-o", "d"});
  expect_no_merge("d/s.1-of-3.shard is shard 1/3 and d/s.1-of-2.shard shard 1/2");
}

TEST_F(ShardCommand, DoesNotMergeShardsOfAnotherStudy) {
  write("s.toml", "0.6");
  fs::create_directory(file("e"));
  make({"run", "s.toml", "--shard", "2/2", "-o", "e"});
  write("s.toml", "0.4");
  fs::copy_file(file("e/s.2-of-2.shard"), file("d/s.2-of-2.shard"), fs::copy_options::overwrite_existing);
  expect_no_merge("d/s.2-of-2.shard is a shard of another study");
  // Nor does it take them for those of a study that has changed since.
  write("s.toml", "0.7");
  expect_no_merge("d/s.1-of-2.shard is a shard of another study");
  expect_refusal({"run", "s.toml", "--shard", "1/2", "-o", "d"}, ExitCode::file,
                 "d/s.1-of-2.shard exists and is a shard of another study, or of this one before its text, its files "
                 "or its options changed; use --force to replace it");
  make({"run", "s.toml", "--shard", "1/2", "-o", "d", "--force"});
}

TEST_F(ShardCommand, AsksWhichOfSeveralStudies) {
  make({"run", "s.toml", "--shard", "1/1", "-o", "d", "--name", "other"});
  expect_no_merge("d holds shards of 'other' and of 's'");
  make({"merge", "d", "--name", "s", "-o", "one"});
  make({"merge", "d", "--name", "other", "-o", "two"});
  EXPECT_TRUE(fs::exists(file("two/other.h5")));
  expect_refusal({"merge", "d", "--name", "third"}, ExitCode::file, "d holds no shard of 'third'");
}

TEST_F(ShardCommand, FindsAStudyThatHasMoved) {
  fs::create_directory(file("new"));
  fs::rename(file("s.toml"), file("new/s.toml"));
  expect_no_merge("is not there; say by --study where it is");
  make({"merge", "d", "--study", "new/s.toml", "-o", "out"});
  EXPECT_TRUE(fs::exists(file("out/s.h5")));
}

TEST_F(ShardCommand, DoesNotMergeShardsOfAnotherVersionBuildOrDevice) {
  const ShardFile sound(file("d/s.2-of-2.shard"));
  std::map<std::string, std::string, std::less<>> records;
  for (const auto& [name, place] : sound.places()) records.emplace(name, sound.content(name));
  const std::string whole = bytes("d/s.2-of-2.shard");
  ASSERT_EQ(shard_text(sound.head(), records), whole);
  const auto expect_refused = [&](std::string PlanIdentity::*member, const std::string& message) {
    ShardHead head = sound.head();
    head.identity.*member = "another";
    put("d/s.2-of-2.shard", shard_text(head, records));
    expect_no_merge("d/s.2-of-2.shard " + message);
  };
  expect_refused(&PlanIdentity::version, "was computed by lobe another, and this is lobe ");
  expect_refused(&PlanIdentity::build, "was computed by another build of lobe ");
  expect_refused(&PlanIdentity::device, "was computed on another, and this is ");
  expect_refused(&PlanIdentity::plan, "is a shard of another study");
  std::string other = whole;
  other[std::string("lobe-shard/").size()] = '9';
  put("d/s.2-of-2.shard", other);
  expect_no_merge("d/s.2-of-2.shard was written by another version of lobe");
  records.erase(records.begin());
  put("d/s.2-of-2.shard", shard_text(sound.head(), records));
  expect_no_merge("d/s.2-of-2.shard lacks ");
}

TEST_F(ShardCommand, DoesNotMergeTruncatedShards) {
  const std::string whole = bytes("d/s.2-of-2.shard");
  for (const std::size_t size : {std::size_t{0}, std::size_t{5}, std::size_t{20}, whole.size() / 2, whole.size() - 1}) {
    put("d/s.2-of-2.shard", whole.substr(0, size));
    expect_no_merge("d/s.2-of-2.shard is truncated");
  }
  put("d/s.2-of-2.shard", whole + "x");
  expect_no_merge("d/s.2-of-2.shard is damaged: it has 1 bytes too many");
  put("d/s.2-of-2.shard", "notes");
  expect_no_merge("d/s.2-of-2.shard is no shard of a study");
}

TEST_F(ShardCommand, RefusesToGoOnFromADamagedShard) {
  const std::string whole = bytes("d/s.2-of-2.shard");
  put("d/s.2-of-2.shard", whole.substr(0, 100));
  expect_refusal({"run", "s.toml", "--shard", "2/2", "-o", "d"}, ExitCode::file, "is truncated");
  make({"run", "s.toml", "--shard", "2/2", "-o", "d", "--force"});
  EXPECT_EQ(bytes("d/s.2-of-2.shard"), whole);
}

TEST_F(ShardCommand, IsVerified) {
  EXPECT_THAT(make({"verify", "d/s.1-of-2.shard"}).output, HasSubstr("sound; shard of a study, "));
  put("d/s.1-of-2.shard", bytes("d/s.1-of-2.shard") + "x");
  EXPECT_EQ(run({"verify", "d/s.1-of-2.shard"}).status, static_cast<int>(ExitCode::file));
}

// In the process, as there are many bits.
TEST_F(ShardCommand, FindsEveryBitThatFlips) {
  const std::string whole = bytes("d/s.2-of-2.shard");
  std::mt19937 random(1);
  std::vector<std::size_t> places;
  for (std::size_t byte = 0; byte < 40; ++byte) places.push_back(byte);
  for (int k = 0; k < 200; ++k) places.push_back(random() % whole.size());
  for (const std::size_t byte : places) {
    std::string flipped = whole;
    flipped[byte] = static_cast<char>(flipped[byte] ^ (1 << (byte % 8)));
    put("d/s.2-of-2.shard", flipped);
    try {
      static_cast<void>(ShardSet::find(file("d")));
      ADD_FAILURE() << "byte " << byte;
    } catch (const IoError& error) {
      EXPECT_THAT(error.what(), HasSubstr("s.2-of-2.shard")) << byte;
    }
  }
  put("d/s.2-of-2.shard", whole);
  EXPECT_NO_THROW(static_cast<void>(ShardSet::find(file("d"))));
}

TEST_F(ShardCommand, ReportsMistakes) {
  expect_refusal({"run", "s.toml", "--shard", "3/2", "-o", "d"}, ExitCode::usage, "'3/2' is no shard");
  expect_refusal({"merge", "s.toml"}, ExitCode::file, "cannot read s.toml: Not a directory");
  make({"merge", "d", "-o", "out"});
  expect_refusal({"merge", "d", "-o", "out"}, ExitCode::file, "out/s.h5 exists; use --force to replace it");
  make({"merge", "d", "-o", "out", "--force"});
}

/// Work of a second or so, in many units.
class KilledShards : public CommandTest {
 protected:
  KilledShards() {
    std::ofstream(file("k.toml"))
        << "[study]\nname = \"k\"\nlightings = [\"point\", \"daylight\"]\ncomparison_metrics = [\"cube-root\"]\n"
           "[[family]]\nname = \"Ward\"\nmodel = \"ward\"\nm = {linspace = [0.1, 0.4], count = 6}\n";
  }
  ScopedVariable epoch_{"SOURCE_DATE_EPOCH", "1000000000"};
};

TEST_F(KilledShards, GoOnWithoutLoss) {
  using namespace std::chrono_literals;
  const Words first{"run", "k.toml", "--shard", "1/2", "-o", "d"};
  int killed = 0;
  for (const auto after : {20ms, 150ms, 300ms, 500ms, 700ms}) {
    fs::remove_all(file("d"));
    killed += run(first, {.interrupt_after = after, .signal = SIGKILL}).status == 128 + SIGKILL ? 1 : 0;
    const auto again = run(first);
    EXPECT_EQ(again.status, 0) << after.count() << again.error;
    EXPECT_THAT(names_in(file("d")), ElementsAre("k.1-of-2.shard")) << after.count() << " ms";
  }
  EXPECT_GE(killed, 2);
  // When some units are kept.
  fs::remove_all(file("d"));
  const auto outcome = run(first, {.interrupt_when = file("d/k.1-of-2.checkpoint"), .signal = SIGKILL});
  ASSERT_EQ(outcome.status, 128 + SIGKILL);
  expect_refusal({"merge", "d", "-o", "out"}, ExitCode::file, "d holds no shard");
  fs::copy_file(file("d/k.1-of-2.checkpoint"), file("units"));
  EXPECT_THAT(make(first).error, HasSubstr("went on from "));
  // Between writing the shard and removing the checkpoint.
  fs::rename(file("units"), file("d/k.1-of-2.checkpoint"));
  EXPECT_THAT(make(first).error, HasSubstr("shard 1/2 is complete"));
  EXPECT_THAT(names_in(file("d")), ElementsAre("k.1-of-2.shard"));
  make({"run", "k.toml", "--shard", "2/2", "-o", "d"});
  make({"merge", "d", "-o", "out"});
  fs::rename(file("out"), file("kept"));
  make({"run", "k.toml", "-o", "out"});
  EXPECT_THAT(differing(file("kept"), file("out")), IsEmpty());
}

TEST_F(KilledShards, DoNotDisturbEachOther) {
  const auto outcome = run_line(
      "for i in 1 2 3; do lobe run k.toml --shard $i/3 -o d & done; wait; lobe merge d -o out && lobe verify out/k.h5",
      {.directory = file("")});
  EXPECT_EQ(outcome.status, 0) << outcome.error;
  // Who computes the shard that another one computes is told so.
  const auto twice =
      run_line("lobe run k.toml --shard 1/2 -o e & sleep 0.2; lobe run k.toml --shard 1/2 -o e; s=$?; wait; exit $s",
               {.directory = file("")});
  EXPECT_TRUE(twice.status == 0 || twice.error.find("is being written by process") != std::string::npos) << twice.error;
  EXPECT_TRUE(fs::exists(file("e/k.1-of-2.shard")));
}

}  // namespace
}  // namespace lobe::test
