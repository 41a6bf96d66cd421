// Ranks of a study, here threads of one process, as the protocol needs no MPI; and studies on several devices.
#include "lobe/study/ranks.hpp"

#include <chrono>
#include <condition_variable>
#include <deque>
#include <fstream>
#include <functional>
#include <iterator>
#include <mutex>
#include <optional>
#include <random>
#include <set>
#include <string>
#include <thread>
#include <utility>
#include <vector>

#include "cli/command_test.hpp"
#include "core/files.hpp"
#include "lobe/core/error.hpp"
#include "lobe/study/shard.hpp"
#include "lobe/study/study.hpp"
#include "study/run/rank_messages.hpp"
#include "study/run/study_units.hpp"
#include "study/run/unit_dealer.hpp"
#include "support/device.hpp"
#include "support/environment.hpp"
#include "support/temporary_directory.hpp"

namespace lobe::test {
namespace {

namespace fs = std::filesystem;

using std::chrono::milliseconds;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using namespace std::chrono_literals;

/// Where threads leave texts for each other.
struct Mail {
  std::mutex mutex;
  std::condition_variable has_come;
  std::vector<std::deque<RankMessage>> boxes;
  std::size_t bytes = 0;  ///< of all texts
};

class ThreadRanks : public Ranks {
 public:
  ThreadRanks(Mail& mail, std::size_t rank) : mail_(mail), rank_(rank) {}

  [[nodiscard]] std::size_t rank() const override { return rank_; }
  [[nodiscard]] std::size_t count() const override { return mail_.boxes.size(); }
  [[nodiscard]] std::string host(std::size_t) const override { return "here"; }
  void send(std::size_t to, std::string text) override {
    const std::scoped_lock lock(mail_.mutex);
    mail_.bytes += text.size();
    mail_.boxes[to].push_back({rank_, std::move(text)});
    mail_.has_come.notify_all();
  }
  [[nodiscard]] std::optional<RankMessage> receive(milliseconds patience) override {
    std::unique_lock lock(mail_.mutex);
    auto& box = mail_.boxes[rank_];
    if (!mail_.has_come.wait_for(lock, patience, [&] { return !box.empty(); })) return {};
    RankMessage message = std::move(box.front());
    box.pop_front();
    return message;
  }
  [[nodiscard]] bool has_ended(std::size_t) const override { return false; }
  void leave(bool all_leave) override { left = all_leave; }

  std::optional<bool> left;  ///< what leave() was told

 private:
  Mail& mail_;
  std::size_t rank_;
};

constexpr std::string_view kStudy = R"([study]
name = "s"
lightings = ["point", "daylight", "patch:0.8"]
comparison_metrics = ["cube-root"]
tolerance = 1e-3
patch_tolerance = 1e-2
comparison_tolerance = 1e-2
[[family]]
name = "Ward"
model = "ward"
m = [0.4, 0.400001, 0.5]
[[published]]
title = "Table 1"
quantity = "constant"
model = "blinn"
n = "$n"
columns = ["n", "printed", "corrected"]
rows = [[1, "0.350", ""]]
[[chart]]
name = "albedos"
title = "Albedos"
quantity = "albedo"
curves = [{label = "Ward", model = "ward", m = 0.4}, {label = "Phong", model = "phong", n = 5}]
)";

class RankThreads : public ::testing::Test {
 protected:
  RankThreads() {
    std::ofstream(path("s.toml")) << kStudy;
    study_ = load_study(path("s.toml"));
  }
  [[nodiscard]] fs::path path(const std::string& name) const { return directory_.path() / name; }
  /// Starts rank 1 of two as a thread with a device of its own.
  [[nodiscard]] std::jthread helper(std::function<Study()> load) {
    return std::jthread([this, load = std::move(load)] {
      ThreadRanks ranks(mail_, mail_.boxes.size() - 1);
      help_run_study(Device::choose(), load, ranks);
    });
  }
  void write(const StudyResult& result, const std::string& folder) const {
    // Pictures are drawn from what is compared.
    write_study(result, path(folder),
                {.command_line = "lobe run", .progress = [](std::string_view, double) { return false; }});
  }
  /// What rank 0 throws.
  template <typename Thrown>
  [[nodiscard]] std::string message_of(const std::function<Study()>& load) {
    const std::jthread other = helper(load);
    ThreadRanks ranks(mail_, 0);
    try {
      static_cast<void>(run_study(device(), study_, nullptr, ranks));
    } catch (const Thrown& error) {
      EXPECT_EQ(ranks.left, true) << "the others have left as well";
      return error.what();
    }
    return "nothing was thrown";
  }

  Mail mail_{.mutex = {}, .has_come = {}, .boxes = std::vector<std::deque<RankMessage>>(2)};
  Study study_;

 private:
  TemporaryDirectory directory_;
  ScopedVariable epoch_{"SOURCE_DATE_EPOCH", "1000000000"};
};

TEST_F(RankThreads, ComputeTheBytesOfAPlainRunAndCountWhatTheySend) {
  write(run_study(device(), study_), "plain");
  std::optional<RankTraffic> traffic;
  {
    const std::jthread other = helper([this] { return study_; });
    ThreadRanks ranks(mail_, 0);
    Checkpoint checkpoint(path("s.checkpoint"));
    std::vector<std::size_t> kept;
    write(run_study(device(), study_, &checkpoint, ranks,
                    {.progress = {},
                     .kept = [&](std::size_t now) { kept.push_back(now); },
                     .done = [&](const RankTraffic& found) { traffic = found; }}),
          "ranks");
    EXPECT_EQ(ranks.left, true);
    ASSERT_FALSE(kept.empty());
    EXPECT_EQ(kept.front(), 0U);
    EXPECT_GT(checkpoint.kept(), 0U) << "units stay until the results are written";
  }
  ASSERT_TRUE(traffic);
  EXPECT_EQ(traffic->received_bytes + traffic->sent_bytes, mail_.bytes);
  EXPECT_EQ(traffic->units, deal_study(device(), study_, 1).size());
  std::size_t files = 0;
  for (const auto& entry : fs::directory_iterator(path("plain"))) {
    const fs::path name = entry.path().filename();
    EXPECT_EQ(read_text(entry.path()), read_text(path("ranks") / name)) << name;
    ++files;
  }
  EXPECT_GT(files, 3U);

  // A plain run goes on from their checkpoint and computes none of it again.
  std::set<std::string> stages;
  Checkpoint checkpoint(path("s.checkpoint"));
  write(run_study(device(), study_, checkpoint,
                  [&](std::string_view stage, double) {
                    stages.emplace(stage);
                    return true;
                  }),
        "resumed");
  EXPECT_FALSE(stages.contains("patch:0.8"));
  EXPECT_FALSE(stages.contains("cube-root"));
  EXPECT_EQ(read_text(path("plain/s.h5")), read_text(path("resumed/s.h5")));
}

// Figures and charts are no part of a checkpoint's identity.
TEST_F(RankThreads, TakeNoFigureOfAnotherStudyFromACheckpoint) {
  const auto run = [&](const Study& study, const std::string& name) {
    const std::jthread other = helper([&study] { return study; });
    ThreadRanks ranks(mail_, 0);
    Checkpoint checkpoint(path("s.checkpoint"));
    write(run_study(device(), study, &checkpoint, ranks), name);
  };
  run(study_, "first");
  Study changed = study_;
  changed.charts.front().curves.front() = changed.charts.front().curves.back();
  run(changed, "second");
  write(run_study(device(), changed), "plain");
  EXPECT_EQ(read_text(path("second/s.h5")), read_text(path("plain/s.h5")));
  EXPECT_NE(read_text(path("second/s.h5")), read_text(path("first/s.h5")));
}

TEST_F(RankThreads, FailAsTheOneThatFailed) {
  const auto load = []() -> Study { throw IoError("cannot read x; mend it", {.path = "x"}); };
  EXPECT_EQ(message_of<IoError>(load), "rank 1 of 2 (on here): cannot read x; mend it");
}

TEST_F(RankThreads, RefuseAnotherStudy) {
  Study other = study_;
  other.tolerance = 1e-2;
  EXPECT_THAT(message_of<IoError>([&] { return other; }), HasSubstr("finds another study"));
}

TEST_F(RankThreads, GiveUpWhoTakesAUnitAndSaysNothing) {
  ThreadRanks other(mail_, 1);
  other.send(0, written_rank_text({.word = RankWord::next}));
  ThreadRanks ranks(mail_, 0);
  const auto begin = std::chrono::steady_clock::now();
  EXPECT_THROW(static_cast<void>(run_study(device(), study_, nullptr, ranks)), DeviceError);
  EXPECT_LT(std::chrono::steady_clock::now() - begin, 10s);
  EXPECT_EQ(ranks.left, false) << "nobody waits for it";
}

TEST_F(RankThreads, RefuseDamagedTexts) {
  ThreadRanks other(mail_, 1);
  other.send(0, "something");
  ThreadRanks ranks(mail_, 0);
  EXPECT_THROW(static_cast<void>(run_study(device(), study_, nullptr, ranks)), DeviceError);
}

TEST_F(RankThreads, EndWhenTheyAreInterrupted) {
  const std::jthread other = helper([this] { return study_; });
  ThreadRanks ranks(mail_, 0);
  const CrewOptions options{.progress = [](std::string_view, double) { return false; }, .kept = {}, .done = {}};
  EXPECT_THROW(static_cast<void>(run_study(device(), study_, nullptr, ranks, options)), Cancelled);
  EXPECT_EQ(ranks.left, true);
}

TEST_F(RankThreads, AreSentAwayWithoutWork) {
  bool is_loaded = false;
  {
    const std::jthread other = helper([&] {
      is_loaded = true;
      return study_;
    });
    ThreadRanks ranks(mail_, 0);
    dismiss_ranks(ranks);
    EXPECT_EQ(ranks.left, true);
  }
  EXPECT_FALSE(is_loaded);
}

/// Two devices in one process, which PoCL makes of one processor.
class SeveralDevices : public CommandTest {
 protected:
  SeveralDevices() { std::ofstream(file("s.toml")) << kStudy; }

  [[nodiscard]] Outcome run_on(const std::string& selector, const Words& words) const {
    // The names of PoCL 3 and 6.
    for (const char* devices : {"pthread pthread", "cpu cpu"}) {
      const Surroundings surroundings{
          .environment = {{"POCL_DEVICES", devices}, {"LOBE_DEVICE", selector}, {"SOURCE_DATE_EPOCH", "1000000000"}}};
      if (run({"devices"}, surroundings).output.find("0:1 ") != std::string::npos) return run(words, surroundings);
    }
    ADD_FAILURE() << "PoCL makes no second device";
    return {};
  }
};

TEST_F(SeveralDevices, ComputeTheBytesOfOne) {
  const Words words{"run", "s.toml", "-o", "out", "--verbose"};
  ASSERT_EQ(run_on("0:0", words).status, 0);
  fs::rename(file("out"), file("one"));
  const Outcome outcome = run_on("0:0,0:1", words);
  ASSERT_EQ(outcome.status, 0) << outcome.error;
  const std::size_t at = outcome.error.find("together: ");
  ASSERT_NE(at, std::string::npos) << outcome.error;
  EXPECT_GT(std::stoul(outcome.error.substr(at + std::string("together: ").size())), 0U) << "units of the second one";
  std::size_t files = 0;
  for (const auto& entry : fs::directory_iterator(file("one"))) {
    const fs::path name = entry.path().filename();
    EXPECT_EQ(read_text(entry.path()), read_text(file("out") / name)) << name;
    ++files;
  }
  EXPECT_GT(files, 3U);
  EXPECT_EQ(std::distance(fs::directory_iterator(file("out")), {}), static_cast<std::ptrdiff_t>(files));
}

TEST_F(SeveralDevices, AreRefusedWhereOneIsNamedTwiceOrOneIsMeant) {
  const auto expect_refused = [&](const std::string& selector, const Words& words, const std::string& message) {
    const Outcome outcome = run_on(selector, words);
    EXPECT_GT(outcome.status, 1) << selector;
    EXPECT_THAT(outcome.error, HasSubstr(message));
    EXPECT_EQ(std::ranges::count(outcome.error, '\n'), 1) << outcome.error;
    EXPECT_FALSE(fs::exists(file("out"))) << selector;
  };
  const Words words{"run", "s.toml", "-o", "out"};
  expect_refused("0:0,0:0", words, "device 0:0 is named twice");
  expect_refused("0:0,,0:1", words, "'0:0,,0:1' names no devices");
  expect_refused("0:0,0:7", words, "'0:7' matches no OpenCL device");
  expect_refused("0:0,0:1", {"run", "s.toml", "-o", "out", "--shard", "1/2"}, "--shard and --dry-run take one device");
}

TEST(RankTexts, AreReadAsTheyWereWritten) {
  const std::string bytes = written_rank_text({.word = RankWord::result, .name = "unit", .content = {"a\0b", 3}});
  const auto text = read_rank_text(bytes);
  ASSERT_TRUE(text);
  EXPECT_EQ(text->word, RankWord::result);
  EXPECT_EQ(text->name, "unit");
  EXPECT_EQ(text->content, std::string("a\0b", 3));
  // The word itself is beside the checksum, and one of few.
  for (std::size_t byte = sizeof(std::uint64_t); byte < bytes.size(); ++byte) {
    std::string flipped = bytes;
    flipped[byte] = static_cast<char>(flipped[byte] ^ 1);
    EXPECT_FALSE(read_rank_text(flipped)) << byte;
    EXPECT_FALSE(read_rank_text(bytes.substr(0, byte))) << byte;
  }
}

TEST(RankTexts, CarryErrorsWithTheirFields) {
  const auto carried = [](const auto& error) { return written_error(std::make_exception_ptr(error)); };
  try {
    throw_written_error(carried(UnresolvedError("too coarse", {.fault = Fault::other_grid, .grid = "gauss:8x16"})),
                        "r");
  } catch (const UnresolvedError& error) {
    EXPECT_STREQ(error.what(), "too coarse");
    EXPECT_EQ(error.fault(), Fault::other_grid);
    EXPECT_EQ(error.grid(), "gauss:8x16");
  }
  try {
    throw_written_error(carried(DeviceError("no build", "log")), "rank 1");
  } catch (const DeviceError& error) {
    EXPECT_STREQ(error.what(), "rank 1: no build");
    EXPECT_EQ(error.build_log(), "log");
  }
  EXPECT_THROW(throw_written_error(carried(ArgumentError("a")), "r"), ArgumentError);
  EXPECT_THROW(throw_written_error(carried(NumericError("a")), "r"), NumericError);
  EXPECT_THROW(throw_written_error(carried(std::bad_alloc()), "r"), NumericError);
}

/// Units of these costs; equal numbers of groups belong together.
std::vector<StudyUnit> units_of(const std::vector<std::pair<std::size_t, double>>& groups_and_costs, double shared) {
  std::vector<StudyUnit> units;
  for (const auto& [group, cost] : groups_and_costs) {
    units.push_back({.name = std::to_string(units.size()), .cost = cost, .shared_cost = shared, .group = group});
  }
  return units;
}

std::vector<std::size_t> all_of(UnitDealer& dealer, std::size_t taker) {
  std::vector<std::size_t> dealt;
  while (const auto unit = dealer.next(taker)) dealt.push_back(*unit);
  return dealt;
}

bool nobody_knows(const StudyUnit&) {
  return false;
}

TEST(Dealer, GivesEachUnitOnceWhateverTheOrder) {
  const auto units = units_of({{0, 1}, {0, 1}, {1, 9}, {2, 1}, {2, 1}, {2, 1}, {3, 2}}, 0.1);
  for (unsigned seed = 0; seed < 20; ++seed) {
    std::mt19937 random(seed);
    UnitDealer dealer(units, nobody_knows, 3);
    std::multiset<std::size_t> dealt;
    std::set<std::size_t> done;
    while (done.size() < 3) {
      const std::size_t taker = random() % 3;
      const auto unit = dealer.next(taker);
      unit ? static_cast<void>(dealt.insert(*unit)) : static_cast<void>(done.insert(taker));
    }
    EXPECT_EQ(dealt, (std::multiset<std::size_t>{0, 1, 2, 3, 4, 5, 6})) << seed;
  }
}

TEST(Dealer, BeginsWithWhatCannotBeCutAndKeepsToAGroup) {
  const auto units = units_of({{0, 5}, {0, 5}, {1, 1}, {2, 2}}, 0);
  UnitDealer dealer(units, nobody_knows, 1);
  EXPECT_THAT(all_of(dealer, 0), ElementsAre(3, 2, 0, 1));
}

TEST(Dealer, LeavesOutWhatIsKnown) {
  const auto units = units_of({{0, 1}, {0, 1}, {0, 1}}, 0);
  UnitDealer dealer(
      units, [](const StudyUnit& unit) { return unit.name == "1"; }, 1);
  EXPECT_THAT(all_of(dealer, 0), ElementsAre(0, 2));
}

TEST(Dealer, SendsNobodyWhereHelpComesTooLate) {
  const auto units = units_of({{0, 1}, {0, 1}, {0, 1}}, 1.5);
  UnitDealer dealer(units, nobody_knows, 2);
  EXPECT_EQ(dealer.next(0), 0U);
  EXPECT_EQ(dealer.next(1), 1U) << "two units are left, which take longer than to begin";
  UnitDealer late(units, nobody_knows, 2);
  static_cast<void>(late.next(0));
  static_cast<void>(late.next(0));
  EXPECT_EQ(late.next(1), std::nullopt);
  EXPECT_EQ(late.next(0), 2U);
}

}  // namespace
}  // namespace lobe::test
