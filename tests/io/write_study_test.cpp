#include <gtest/gtest.h>

#include <filesystem>
#include <sstream>
#include <string>
#include <vector>

#include "command.hpp"
#include "core/clock.hpp"
#include "core/files.hpp"
#include "lobe/core/error.hpp"
#include "lobe/fit/approximation.hpp"
#include "lobe/study/study.hpp"
#include "plot/gnuplot.hpp"
#include "support/environment.hpp"
#include "support/full_disk.hpp"
#include "support/temporary_directory.hpp"
#include "synthetic_study.hpp"

namespace lobe::test {
namespace {

namespace fs = std::filesystem;

std::size_t count_files(const fs::path& directory) {
  return static_cast<std::size_t>(std::distance(fs::directory_iterator(directory), fs::directory_iterator()));
}

TEST(WriteStudy, LeavesAllFilesAndSaysWhich) {
  ASSERT_TRUE(has_program("gnuplot")) << "gnuplot is missing; install gnuplot-nox";
  const TemporaryDirectory directory;
  const StudyFiles files = write_study(synthetic_study(), directory.path());
  EXPECT_EQ(files.note, "");
  EXPECT_EQ(files.table.filename(), "synthetic.h5");
  EXPECT_EQ(files.csv.size(), 13U);
  EXPECT_EQ(files.pictures.size(), 10U);
  EXPECT_EQ(files.scripts.size(), 20U);
  for (const auto& list : {files.csv, files.pictures, files.scripts}) {
    for (const auto& path : list) EXPECT_GT(fs::file_size(path), 0U) << path;
  }
  EXPECT_EQ(count_files(directory.path()), 44U);
}

TEST(WriteStudy, MakesTheDirectory) {
  const TemporaryDirectory directory;
  const ScopedVariable path("PATH", "/nowhere");
  const StudyFiles files = write_study(synthetic_study(), directory.path() / "a" / "b");
  EXPECT_TRUE(fs::exists(files.table));
}

TEST(WriteStudy, LeavesScriptsThatRunAlone) {
  ASSERT_TRUE(has_program("gnuplot")) << "gnuplot is missing; install gnuplot-nox";
  const TemporaryDirectory directory;
  write_study(synthetic_study(), directory.path());
  for (const std::string stem : {"synthetic.point.distance", "synthetic.point.dendrogram", "synthetic.daylight.map",
                                 "synthetic.ngan-l2.distance", "synthetic.agreement"}) {
    SCOPED_TRACE(stem);
    fs::remove(directory.path() / (stem + ".png"));
    const auto run = run_command("cd " + directory.path().string() + " && gnuplot " + stem + ".gp 2>&1");
    EXPECT_EQ(run.status, 0);
    EXPECT_EQ(run.output, "");
    EXPECT_TRUE(fs::exists(directory.path() / (stem + ".png")));
  }
}

TEST(WriteStudy, NamesTheTablesBeforehand) {
  const TemporaryDirectory directory;
  const ScopedVariable path("PATH", "/nowhere");
  const StudyResult result = synthetic_study();
  const StudyFiles files = write_study(result, directory.path());
  std::vector<std::string> names;
  for (const auto& file : files.csv) names.push_back(file.filename().string());
  EXPECT_EQ(names, csv_names(result.study));
  EXPECT_EQ(names[3], "synthetic.point.linear-residuals.csv");
  EXPECT_EQ(names[4], "synthetic.point.non-negative-residuals.csv");
  EXPECT_EQ(names[11], "synthetic.log-relative.distance.csv");
  EXPECT_EQ(names[12], "synthetic.agreement.csv");
}

TEST(WriteStudy, WritesRankCorrelationsLineByLine) {
  const TemporaryDirectory directory;
  const ScopedVariable path("PATH", "/nowhere");
  const StudyResult result = synthetic_study();
  write_study(result, directory.path());
  std::istringstream lines(read_text(directory.path() / "synthetic.agreement.csv"));
  std::string line;
  std::getline(lines, line);
  EXPECT_EQ(line, "metric,other,spearman,kendall,spearman_within_families,kendall_within_families");
  std::getline(lines, line);
  // Made of the same points, the distances rank alike.
  EXPECT_TRUE(line.starts_with("daylight,point,1,1,1,1")) << line;
  int rest = 0;
  while (std::getline(lines, line)) ++rest;
  EXPECT_EQ(rest, 5);  // of 4 metrics
}

TEST(WriteStudy, WritesAFamilysResidualsAsFamilyResidualsDoes) {
  const TemporaryDirectory directory;
  const ScopedVariable path("PATH", "/nowhere");
  const StudyResult result = synthetic_study();
  write_study(result, directory.path());
  EXPECT_EQ(read_text(directory.path() / "synthetic.daylight.non-negative-residuals.csv"),
            csv_text(family_residuals(result.metrics[1], labels(result.study), true, result.study.channel_weights)));
}

class WriteStudyOfSize : public ::testing::TestWithParam<std::size_t> {};

TEST_P(WriteStudyOfSize, RendersEveryPicture) {
  ASSERT_TRUE(has_program("gnuplot")) << "gnuplot is missing; install gnuplot-nox";
  const TemporaryDirectory directory;
  const StudyFiles files = write_study(synthetic_study(GetParam()), directory.path());
  EXPECT_EQ(files.note, "");
  // No ranks of a single pair, none within families of two.
  EXPECT_EQ(files.pictures.size(), GetParam() == 1 ? 8U : GetParam() == 2 ? 9U : 10U);
}

INSTANTIATE_TEST_SUITE_P(MaterialsPerFamily, WriteStudyOfSize, ::testing::Values(1, 2, 30, 120));

TEST(WriteStudy, SucceedsWithoutGnuplotAndSaysWhatIsMissing) {
  const TemporaryDirectory directory;
  const ScopedVariable path("PATH", "");
  const StudyFiles files = write_study(synthetic_study(), directory.path());
  EXPECT_NE(files.note.find("gnuplot is not installed"), std::string::npos) << files.note;
  EXPECT_TRUE(files.pictures.empty());
  EXPECT_TRUE(fs::exists(files.table));
  EXPECT_EQ(count_files(directory.path()), 34U);
}

TEST(WriteStudy, RemovesOlderPicturesItCannotRenew) {
  const TemporaryDirectory directory;
  write_study(synthetic_study(), directory.path());
  const ScopedVariable path("PATH", "");
  OutputOptions options;
  options.overwrite = true;
  write_study(synthetic_study(), directory.path(), options);
  EXPECT_FALSE(fs::exists(directory.path() / "synthetic.point.map.png"));
}

TEST(WriteStudy, KeepsExistingFilesUnlessToldToOverwrite) {
  const TemporaryDirectory directory;
  const fs::path csv = directory.path() / "synthetic.daylight.distance.csv";
  write_text(csv, false, "mine");
  EXPECT_THROW(write_study(synthetic_study(), directory.path()), IoError);
  EXPECT_EQ(read_text(csv), "mine");
  EXPECT_EQ(count_files(directory.path()), 1U);
}

TEST(WriteStudy, LeavesNothingOnAFullDisk) {
  const TemporaryDirectory directory;
  const FullDisk disk(20000);
  try {
    write_study(synthetic_study(), directory.path());
    FAIL() << "no error";
  } catch (const IoError& error) {
    EXPECT_EQ(std::string(error.what()).find("cannot write "), 0U) << error.what();
    EXPECT_EQ(std::string(error.what()).find('\n'), std::string::npos) << error.what();
  }
  EXPECT_EQ(count_files(directory.path()), 0U);
}

TEST(WriteStudy, KeepsTheOlderFilesOnAFullDisk) {
  const TemporaryDirectory directory;
  const fs::path table = write_study(synthetic_study(), directory.path()).table;
  const std::string before = read_text(table);
  OutputOptions options;
  options.overwrite = true;
  {
    const FullDisk disk(20000);
    EXPECT_THROW(write_study(synthetic_study(4), directory.path(), options), IoError);
  }
  EXPECT_EQ(read_text(table), before);
}

TEST(WriteStudy, FailsWhereItMayNotWrite) {
  const TemporaryDirectory directory;
  const fs::path file = directory.path() / "file";
  write_text(file, false, "");
  EXPECT_THROW(write_study(synthetic_study(), file / "below"), IoError);
}

TEST(WriteStudy, GivesTheSameBytesAgain) {
  const ScopedVariable epoch("SOURCE_DATE_EPOCH", "1000000000");
  const ScopedVariable path("PATH", "");
  const TemporaryDirectory directory;
  const fs::path first = directory.path() / "first";
  const fs::path second = directory.path() / "second";
  write_study(synthetic_study(), first);
  write_study(synthetic_study(), second);
  for (const auto& entry : fs::directory_iterator(first)) {
    EXPECT_EQ(read_text(entry.path()), read_text(second / entry.path().filename())) << entry.path();
  }
}

TEST(TimeOfWriting, IsTheSourceDateEpoch) {
  const ScopedVariable epoch("SOURCE_DATE_EPOCH", "1000000000");
  EXPECT_EQ(time_of_writing(), "2001-09-09T01:46:40Z");
}

TEST(TimeOfWriting, RefusesAnEpochThatIsNoNumber) {
  const ScopedVariable epoch("SOURCE_DATE_EPOCH", "yesterday");
  EXPECT_THROW((void)time_of_writing(), ArgumentError);
}

TEST(Render, ReportsWhatGnuplotSays) {
  ASSERT_TRUE(has_program("gnuplot")) << "gnuplot is missing; install gnuplot-nox";
  const TemporaryDirectory directory;
  write_text(directory.path() / "bad.gp", false, gnuplot::preamble("bad", "test", 100, 100) + "plot 'absent.dat'\n");
  const std::string reason = gnuplot::render(directory.path(), "bad");
  EXPECT_EQ(reason.find("gnuplot failed: "), 0U) << reason;
  EXPECT_EQ(reason.find('\n'), std::string::npos) << reason;
  EXPECT_EQ(count_files(directory.path()), 1U);
}

}  // namespace
}  // namespace lobe::test
