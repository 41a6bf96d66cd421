// Disks that are full, broken or slow under everything that is written: the old files or the new ones, whole.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cstdlib>
#include <functional>
#include <iterator>
#include <ostream>

#include "nets/file_failures.hpp"

namespace lobe::test {
namespace {

using ::testing::AllOf;
using ::testing::Contains;
using ::testing::HasSubstr;
using ::testing::IsEmpty;

using Inputs = std::function<Files()>;

struct Case {
  Job job;
  Calls calls = Calls::ends;
  Inputs inputs = {};  ///< made when the test runs
};

/// GoogleTest shows a case by its name.
std::ostream& operator<<(std::ostream& stream, const Case& one) {
  return stream << one.job.name;
}

Case lobe(
    const std::string& name, Calls calls, std::vector<std::string> words, Inputs inputs = [] { return Files(); }) {
  words.insert(words.begin(), LOBE_COMMAND);
  return {{name, std::move(words)}, calls, std::move(inputs)};
}

const char* const kStudy =
    "[study]\nname = \"s\"\nlightings = [\"point\"]\n"
    "[[family]]\nname = \"P\"\nmodel = \"phong\"\nn = [2, 3]\n";

/// What a command makes of nothing.
Files made_by(std::vector<std::string> words, Files inputs = {}) {
  words.insert(words.begin(), LOBE_COMMAND);
  return run_job({"made", std::move(words), std::move(inputs)}, LOBE_FILE_SHIM, "LOBE_IO_LOG").files;
}

const Files& table() {
  static const Files kFiles = made_by({"tabulate", "phong:n=3", "--grid", "gauss:8x16", "-o", "t.h5"});
  return kFiles;
}

const Files& results() {
  static const Files kFiles = made_by({"run", "s.toml", "-o", "."}, {{"s.toml", kStudy}});
  return kFiles;
}

const Files& samples() {
  static const Files kFiles = made_by({"export", "lambert", "--format", "csv", "-o", "e.csv"});
  return kFiles;
}

Inputs text(const std::string& name, const std::string& content = "what was there before") {
  return [name, content] { return Files{{name, content}}; };
}

std::vector<Case> cases() {
  return {
      lobe("tabulate", Calls::ends, {"tabulate", "phong:n=3", "--grid", "gauss:8x16", "-o", "t.h5"}),
      lobe("tabulate_again", Calls::inside, {"tabulate", "phong:n=3", "--grid", "gauss:8x16", "-o", "t.h5", "--force"},
           text("t.h5")),
      lobe("self_compose", Calls::ends, {"self-compose", "t.h5", "-o", "c.h5"}, table),
      lobe("export", Calls::ends, {"export", "t.h5", "--format", "csv", "-o", "e.csv"}, table),
      lobe("run", Calls::ends, {"run", "s.toml", "-o", "out"}, text("s.toml", kStudy)),
      lobe("shard", Calls::ends, {"run", "s.toml", "--shard", "1/1", "-o", "out", "--no-checkpoint"},
           text("s.toml", kStudy)),
      lobe("run_again", Calls::inside, {"run", "s.toml", "-o", ".", "--force"}, results),
      lobe("report", Calls::ends, {"report", "s.h5", "-o", "r.html", "--force"},
           [] {
             Files files = results();
             files["r.html"] = "what was there before";
             return files;
           }),
      lobe("plot", Calls::inside, {"plot", "t.h5", "-o", "p"}, table),
      lobe("preview", Calls::ends, {"preview", "lambert", "--size", "16", "-o", "p.png", "--force"}, text("p.png")),
      lobe("sample", Calls::ends, {"sample", "phong:n=3", "--theta", "30", "-n", "3", "-o", "s.csv"}),
      lobe("gram", Calls::inside, {"gram", "lambert", "phong:n=2", "-o", "g.csv", "--force"}, text("g.csv")),
  };
}

/// For script/soak, which has the time.
std::vector<Case> more_cases() {
  return {
      lobe("import", Calls::ends, {"import", "e.csv", "--grid", "gauss:8x16", "-o", "i.h5"}, samples),
      lobe("export_klems", Calls::ends, {"export", "t.h5", "--format", "klems", "-o", "e.xml"}, table),
      lobe("export_utia", Calls::ends, {"export", "t.h5", "--format", "utia", "-o", "e.bin"}, table),
      lobe("export_alta", Calls::ends, {"export", "t.h5", "--format", "alta", "-o", "e.alta"}, table),
      lobe("export_merl", Calls::ends, {"export", "lambert", "--format", "merl", "-o", "e.binary"}),
      lobe("compose", Calls::ends, {"compose", "phong:n=3", "lambert", "--grid", "gauss:8x16", "-o", "c.h5"}),
      lobe("distance_matrix", Calls::ends, {"distance-matrix", "s.toml", "-o", "d.csv"}, text("s.toml", kStudy)),
      lobe("fit", Calls::ends, {"fit", "phong:n=3", "--family", "lambert", "-o", "f.toml"}),
      lobe("approximate", Calls::ends, {"approximate", "phong:n=3", "-b", "lambert", "-o", "a.toml"}),
      lobe("new_study", Calls::ends, {"new-study", "-o", "n.toml"}),
  };
}

std::vector<Case> chosen_cases() {
  std::vector<Case> all = cases();
  if (std::getenv("LOBE_NETS") != nullptr) std::ranges::move(more_cases(), std::back_inserter(all));
  return all;
}

class FileFailures : public ::testing::TestWithParam<Case> {};

TEST_P(FileFailures, LeaveTheOldFilesOrTheNewOnesWhole) {
  Job job = GetParam().job;
  job.inputs = GetParam().inputs();
  EXPECT_THAT(file_complaints(job, GetParam().calls), IsEmpty());
}

INSTANTIATE_TEST_SUITE_P(Writers, FileFailures, ::testing::ValuesIn(chosen_cases()),
                         [](const auto& test) { return test.param.job.name; });

TEST(FileFailuresNet, CatchesAProgramThatLooksAtNothing) {
  const auto complaints =
      file_complaints({"careless_writer", {LOBE_CARELESS_WRITER, "a"}, {{"a", "old"}}}, Calls::ends);

  EXPECT_THAT(complaints, Contains(AllOf(HasSubstr("*:1+:SHORT"), HasSubstr("a has changed"))));
  EXPECT_THAT(complaints, Contains(AllOf(HasSubstr("*:1+:EINTR"), HasSubstr("a has changed"))));
  EXPECT_THAT(complaints, Contains(AllOf(HasSubstr("write:1+:ENOSPC"), HasSubstr("exit status 0"))));
  EXPECT_THAT(complaints, Contains(AllOf(HasSubstr("rename:1+:ENOSPC"), HasSubstr("a.new is left"))));
}

}  // namespace
}  // namespace lobe::test
