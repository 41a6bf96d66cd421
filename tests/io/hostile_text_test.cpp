// Texts that gnuplot could take for something else than a text: no command is executed, and every picture is made.
#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <string>
#include <vector>

#include "command.hpp"
#include "core/files.hpp"
#include "lobe/core/error.hpp"
#include "lobe/formats/measured.hpp"
#include "lobe/study/chart.hpp"
#include "lobe/study/study.hpp"
#include "plot/gnuplot.hpp"
#include "support/temporary_directory.hpp"
#include "synthetic_study.hpp"

namespace lobe::test {
namespace {

namespace fs = std::filesystem;

/// Every one of them would leave a file `sentinel` in the folder of the pictures.
const std::vector<std::string>& hostile_texts() {
  static const std::vector<std::string> texts{"line\nsystem('touch sentinel')\n",
                                              "line\n!touch sentinel\n#",
                                              "line\r\nset output '|touch sentinel'\n",
                                              "'; system('touch sentinel'); x='",
                                              "'quoted' at the start",
                                              "it's",
                                              "''",
                                              "\"; system(\"touch sentinel\"); x=\"",
                                              "`touch sentinel`",
                                              "$(touch sentinel)",
                                              "${sentinel}",
                                              "@sentinel",
                                              "@output_file",
                                              "<touch sentinel",
                                              "< touch sentinel",
                                              "|touch sentinel",
                                              "100 %",
                                              "%s%n%d",
                                              "back\\slash\\",
                                              "a\\n!touch sentinel",
                                              "a\\",
                                              "\\047); system(\\042touch sentinel\\042)",
                                              "{/Symbol a}_{b}^{c}",
                                              "}{",
                                              "; set print '|touch sentinel'; print 1",
                                              "# not a comment",
                                              "\x1b[2J\x1b]0;title\x07",
                                              "tab\there",
                                              "\x01\x02\x7f",
                                              "~ & * ? [ ] ! ^ = , : ;",
                                              "\xff\xfe",
                                              "Größe √sr"};
  return texts;
}

/// What stands in a folder and does not begin with a name.
std::vector<std::string> others_in(const fs::path& directory, const std::string& name) {
  std::vector<std::string> others;
  for (const auto& entry : fs::directory_iterator(directory)) {
    if (!entry.path().filename().string().starts_with(name)) others.push_back(entry.path().filename().string());
  }
  return others;
}

void expect_all_pictures(const StudyResult& result, const fs::path& directory) {
  ASSERT_TRUE(has_program("gnuplot")) << "gnuplot is missing; install gnuplot-nox";
  const StudyFiles files = write_study(result, directory);
  EXPECT_EQ(files.note, "");
  EXPECT_EQ(files.pictures.size(), 10U);
  for (const auto& path : files.pictures) EXPECT_GT(fs::file_size(path), 0U) << path;
  EXPECT_EQ(others_in(directory, result.study.name), std::vector<std::string>{});
}

class HostileText : public ::testing::TestWithParam<std::string> {};

TEST_P(HostileText, AsTitleAndNamesIsDrawn) {
  const TemporaryDirectory directory;
  StudyResult result = synthetic_study();
  result.study.title = GetParam();
  for (auto& material : result.study.materials) {
    Material formula = *material.formula();
    formula.name = GetParam() + formula.name;
    formula.family += GetParam();
    material = formula;
  }
  for (auto& channel : result.study.channels) channel += GetParam();
  expect_all_pictures(result, directory.path());
}

TEST_P(HostileText, OfAChartIsDrawn) {
  ASSERT_TRUE(has_program("gnuplot")) << "gnuplot is missing; install gnuplot-nox";
  const TemporaryDirectory directory;
  Chart chart;
  chart.name = "chart";
  chart.title = GetParam();
  chart.quantity = ChartQuantity::mean_albedo;
  chart.parameter = GetParam();
  chart.x = {0.1, 0.5};
  chart.curves = {{.label = GetParam(), .materials = {}}, {.label = "x" + GetParam(), .materials = {}}};
  const ChartValues values(2, {{0.1, 1e-3}, {0.2, 1e-3}});
  const PictureFiles files = write_chart_picture(chart, values, directory.path(), "chart");
  EXPECT_EQ(files.note, "");
  EXPECT_EQ(files.pictures.size(), 1U);
  EXPECT_EQ(others_in(directory.path(), "chart"), std::vector<std::string>{});
}

INSTANTIATE_TEST_SUITE_P(All, HostileText, ::testing::ValuesIn(hostile_texts()));

/// Parts of file names: neither '/' nor NUL.
class HostileStudyName : public ::testing::TestWithParam<std::string> {};

TEST_P(HostileStudyName, IsDrawn) {
  const TemporaryDirectory directory;
  StudyResult result = synthetic_study();
  result.study.name = GetParam();
  expect_all_pictures(result, directory.path());
}

INSTANTIATE_TEST_SUITE_P(All, HostileStudyName,
                         ::testing::Values("<touch sentinel", "< touch sentinel", "|touch sentinel", "it's", "'quoted'",
                                           "\"quoted\"", "`touch sentinel`", "$(touch sentinel)", "$data", "@sentinel",
                                           "100 %", "a\\nb", "a\\", "#", "; touch sentinel", "{a}", "a b", "*", "~",
                                           "a\n!touch sentinel\n", "\x1b[2J", "Größe"));

// --- As gnuplot reads them.
TEST(StringLiteral, IsTheTextForGnuplot) {
  ASSERT_TRUE(has_program("gnuplot")) << "gnuplot is missing; install gnuplot-nox";
  const TemporaryDirectory directory;
  for (const std::string& text : hostile_texts()) {
    SCOPED_TRACE(text);
    write_text(directory.path() / "a.gp", true,
               "set print 'said'\nprint " + gnuplot::string_literal(text) + ".\"\"\nunset print\n");
    const auto run = run_command("cd " + directory.path().string() + " && gnuplot a.gp 2>&1");
    EXPECT_EQ(run.status, 0) << text << run.output;
    EXPECT_EQ(read_text(directory.path() / "said"), text + "\n");
  }
}

TEST(GnuplotComment, IsOneLineOfPlainCharacters) {
  EXPECT_EQ(gnuplot::comment("a\nsystem('x') \\"), "# a system('x')  \n");
  EXPECT_EQ(gnuplot::comment("{`$@\"#"), "#       \n");
  EXPECT_EQ(gnuplot::data_comment("a\n1 2\r\n`x`"), "# a 1 2  `x`\n");
}

// --- Names that are read from files.
TEST(MeasuredFiles, WithControlCharactersInTheirNamesAreRefused) {
  const TemporaryDirectory directory;
  const fs::path path = directory.path() / "a\x1b[2J.csv";
  write_text(path, false, "theta_in_deg,theta_out_deg,delta_phi_deg,red\n0,10,0,1\n0,50,0,1\n60,10,0,1\n60,50,0,1\n");
  try {
    (void)load_measured(path);
    FAIL() << "no error";
  } catch (const IoError& error) {
    const std::string message = error.what();
    EXPECT_NE(message.find("has control characters"), std::string::npos) << message;
    EXPECT_EQ(message.find('\x1b'), std::string::npos) << message;
  }
}

}  // namespace
}  // namespace lobe::test
