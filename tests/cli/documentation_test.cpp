// Commands in README.md and docs/ work, and print what the pages show.
//
// All steps of a page run in one folder, in which studies/ is found:
//   - indented lines that begin with "lobe " are run, up to two blanks and a "#"; a comment may hold "exit status N";
//   - indented lines after "# NAME.toml", "# NAME.csv" or "// NAME.glsl", up to the next such line, are written to that
//     file;
//   - in blocks fenced as ```console, lines after "$ " are run and print the lines that follow, with numbers within
//     1e-3 of those shown, and numbers after "±" within a factor of 4; a line "..." stands for any lines.
// A comment <!-- not run: REASON --> excludes the block that follows.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <charconv>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <ostream>
#include <sstream>
#include <string>
#include <string_view>
#include <vector>

#include "cli/process.hpp"
#include "support/temporary_directory.hpp"

namespace lobe::test {
namespace {

namespace fs = std::filesystem;

/// What is typed, where it stands, and what it prints.
struct Step {
  std::size_t line = 0;
  std::string command;
  std::string file;                   ///< written with `expected` in place of running anything
  std::vector<std::string> expected;  ///< of commands: empty where the page does not say
  int status = 0;
};

/// A line to run and what its comment says of its exit status.
Step step_of(std::size_t line, std::string_view text) {
  constexpr std::string_view kStatus = "exit status ";
  const auto comment = text.substr(std::min(text.find("  #"), text.size()));
  const auto status = comment.find(kStatus);
  return {line,
          std::string(text.substr(0, text.size() - comment.size())),
          "",
          {},
          status == comment.npos ? 0 : comment[status + kStatus.size()] - '0'};
}

std::vector<std::string> lines_of(std::istream& stream) {
  std::vector<std::string> lines;
  for (std::string line; std::getline(stream, line);) lines.push_back(line);
  return lines;
}

constexpr std::string_view kIndent = "    ";

/// "NAME.toml" of a line "# NAME.toml", likewise of .csv and "// NAME.glsl"; empty for others.
std::string file_of(std::string_view text) {
  if (text.starts_with("// ") && text.ends_with(".glsl") && text.find(' ', 3) == text.npos) {
    return std::string(text.substr(3));
  }
  const bool names_file =
      text.starts_with("# ") && (text.ends_with(".toml") || text.ends_with(".csv")) && text.find(' ', 2) == text.npos;
  return names_file ? std::string(text.substr(2)) : "";
}

/// The steps of an indented block that begins at `at`; `at` is left at its end.
void read_indented(const std::vector<std::string>& lines, std::size_t& at, std::vector<Step>& steps) {
  bool is_file = false;
  for (; at < lines.size() && (lines[at].starts_with(kIndent) || lines[at].empty()); ++at) {
    const std::string_view line = lines[at];
    const auto text = line.substr(std::min(kIndent.size(), line.size()));
    if (const auto file = file_of(text); !file.empty()) {
      steps.push_back({at + 1, "", file, {}});
      is_file = true;
    } else if (text.starts_with("lobe ")) {
      steps.push_back(step_of(at + 1, text));
      is_file = false;
    } else if (is_file) {
      steps.back().expected.emplace_back(text);
    }
  }
}

void read_console(const std::vector<std::string>& lines, std::size_t& at, std::vector<Step>& steps) {
  for (++at; at < lines.size() && lines[at] != "```"; ++at) {
    if (lines[at].starts_with("$ ")) {
      steps.push_back(step_of(at + 1, std::string_view(lines[at]).substr(2)));
    } else {
      steps.back().expected.push_back(lines[at]);
    }
  }
}

std::vector<Step> steps_of(const fs::path& page) {
  std::ifstream stream(page);
  const auto lines = lines_of(stream);
  std::vector<Step> steps;
  bool is_fenced = false;
  bool is_left_out = false;
  for (std::size_t at = 0; at < lines.size(); ++at) {
    const std::string& line = lines[at];
    const std::size_t kept = steps.size();
    if (line.starts_with("<!-- not run: ")) {
      is_left_out = true;
      continue;
    }
    const bool starts_block = at == 0 || lines[at - 1].empty();
    if (line == "```console") {
      read_console(lines, at, steps);
    } else if (line.starts_with("```")) {
      is_fenced = !is_fenced;
      continue;
    } else if (!is_fenced && starts_block && line.starts_with(kIndent)) {
      read_indented(lines, at, steps);
      --at;  // the line that ended it may begin the next block
    } else {
      if (!line.empty()) is_left_out = false;
      continue;
    }
    if (is_left_out) steps.resize(kept);
    is_left_out = false;
  }
  return steps;
}

/// Whether two words are the same, or numbers of nearly the same value with the same text about them.
bool is_same(std::string_view printed, std::string_view expected, bool is_error) {
  if (printed == expected) return true;
  const auto start_of = [](std::string_view word) { return std::min(word.find_first_of("0123456789-"), word.size()); };
  if (printed.substr(0, start_of(printed)) != expected.substr(0, start_of(expected))) return false;
  const auto number_at = [&](std::string_view word, double& value) {
    const std::size_t start = start_of(word);
    const auto [end, failure] = std::from_chars(word.data() + start, word.data() + word.size(), value);
    return failure == std::errc() ? static_cast<std::size_t>(end - word.data()) : word.npos;
  };
  double one = 0;
  double other = 0;
  const std::size_t end = number_at(printed, one);
  const std::size_t other_end = number_at(expected, other);
  if (end == printed.npos || other_end == expected.npos || printed.substr(end) != expected.substr(other_end))
    return false;
  if (is_error) return one <= 4 * other && other <= 4 * one;
  return std::abs(one - other) <= 1e-3 * std::abs(other);
}

/// A line whose cells are words, too: "30,40,0.2" as "30, 40, 0.2".
std::string with_blanks(const std::string& line) {
  std::string spread;
  for (const char c : line) spread += c == ',' ? std::string(", ") : std::string(1, c);
  return spread;
}

bool is_same_line(const std::string& printed, const std::string& expected) {
  std::istringstream one(with_blanks(printed));
  std::istringstream other(with_blanks(expected));
  std::string word;
  std::string expected_word;
  bool is_error = false;
  while (other >> expected_word) {
    if (!(one >> word) || !is_same(word, expected_word, is_error)) return false;
    is_error = expected_word == "±";
  }
  return !(one >> word);
}

/// Where what is printed first departs from what is expected; empty: nowhere.
std::string difference(const std::vector<std::string>& printed, const std::vector<std::string>& expected) {
  std::size_t at = 0;
  for (std::size_t i = 0; i < expected.size(); ++i) {
    if (expected[i] == "...") {
      if (i + 1 == expected.size()) return "";
      while (at < printed.size() && !is_same_line(printed[at], expected[i + 1])) ++at;
      if (at == printed.size()) return "nowhere: " + expected[i + 1];
      continue;
    }
    if (at == printed.size()) return "missing: " + expected[i];
    if (!is_same_line(printed[at], expected[i])) return "printed:  " + printed[at] + "\n  expected: " + expected[i];
    ++at;
  }
  return at < printed.size() ? "not on the page: " + printed[at] : "";
}

struct Page {
  fs::path path;
  std::string name;
};
std::ostream& operator<<(std::ostream& out, const Page& page) {
  return out << page.path.filename();
}

std::vector<Page> pages() {
  std::vector<fs::path> paths{LOBE_README};
  for (const auto& entry : fs::directory_iterator(LOBE_DOCS_DIR)) {
    if (entry.path().extension() == ".md" && !steps_of(entry.path()).empty()) paths.push_back(entry.path());
  }
  std::vector<Page> list;
  for (const auto& path : paths) {
    std::string name = path.stem();
    std::ranges::replace(name, '-', '_');
    list.push_back({path, name});
  }
  std::ranges::sort(list, {}, &Page::name);
  return list;
}

class Documentation : public ::testing::TestWithParam<Page> {};

TEST_P(Documentation, TellsWhatWorks) {
  const TemporaryDirectory directory;
  fs::create_directory_symlink(LOBE_STUDIES_DIRECTORY, directory.path() / "studies");
  const auto steps = steps_of(GetParam().path);
  ASSERT_FALSE(steps.empty());
  for (const Step& step : steps) {
    const std::string place = GetParam().path.filename().string() + ":" + std::to_string(step.line);
    if (!step.file.empty()) {
      std::ofstream file(directory.path() / step.file);
      for (const auto& line : step.expected) file << line << '\n';
      continue;
    }
    const auto outcome = run_line(step.command, {.directory = directory.path()});
    EXPECT_EQ(outcome.status, step.status) << place << ": " << step.command << "\n" << outcome.error;
    if (step.expected.empty()) continue;
    std::istringstream output(outcome.output);
    EXPECT_EQ(difference(lines_of(output), step.expected), "") << place << ": " << step.command;
  }
}

INSTANTIATE_TEST_SUITE_P(pages, Documentation, ::testing::ValuesIn(pages()),
                         [](const auto& instance) { return instance.param.name; });

// A fence right after an indented block was once passed over, and its commands with it.
TEST(DocumentationSteps, AreFoundInBlocksThatFollowEachOther) {
  const TemporaryDirectory directory;
  const auto page = directory.path() / "page.md";
  std::ofstream(page) << "    # rows.csv\n    a,b\n\n```console\n$ lobe info rows.csv\nrows\n```\n\n    lobe models\n";

  const auto steps = steps_of(page);

  ASSERT_THAT(steps, ::testing::SizeIs(3));
  EXPECT_EQ(steps[0].file, "rows.csv");
  EXPECT_THAT(steps[0].expected, ::testing::Contains("a,b"));
  EXPECT_EQ(steps[1].command, "lobe info rows.csv");
  EXPECT_THAT(steps[1].expected, ::testing::ElementsAre("rows"));
  EXPECT_EQ(steps[2].command, "lobe models");
}

// The comparison can fail.
TEST(DocumentationComparison, SeesWhatDiffers) {
  const std::vector<std::string> printed{"distance 0.70471 ± 3e-06", "two materials", "end"};

  EXPECT_EQ(difference(printed, {"distance  0.7047 ± 2e-06", "...", "end"}), "");
  EXPECT_NE(difference(printed, {"distance 0.7057 ± 3e-06", "two materials", "end"}), "");
  EXPECT_NE(difference(printed, {"distance 0.70471 ± 3e-05", "two materials", "end"}), "");
  EXPECT_NE(difference(printed, {"distance 0.70471 ± 3e-06", "two tables", "end"}), "");
  EXPECT_NE(difference(printed, {"distance 0.70471 ± 3e-06", "two materials"}), "");
  EXPECT_NE(difference(printed, {"...", "the end"}), "");
  EXPECT_NE(difference({"n=5"}, {"m=5"}), "");
  EXPECT_EQ(difference({"30,40,0.20784856"}, {"30,40,0.20784857"}), "");
  EXPECT_NE(difference({"30,40,0.20784856"}, {"30,41,0.20784856"}), "");
  EXPECT_NE(difference({"30,40,0.20784856"}, {"30,40"}), "");
}

}  // namespace
}  // namespace lobe::test
