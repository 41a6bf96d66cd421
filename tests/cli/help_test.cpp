// The help text, and that what it shows can be typed.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <sstream>
#include <string>
#include <string_view>
#include <vector>

#include "cli/process.hpp"
#include "interface/command.hpp"
#include "support/temporary_directory.hpp"

namespace lobe::test {
namespace {

using ::testing::Ge;
using ::testing::HasSubstr;
using ::testing::IsEmpty;

std::vector<std::string> lines_of(const std::string& text) {
  std::vector<std::string> lines;
  std::istringstream stream(text);
  for (std::string line; std::getline(stream, line);) lines.push_back(line);
  return lines;
}

std::vector<std::string> examples_of(const std::string& help) {
  std::vector<std::string> examples;
  for (const auto& line : lines_of(help.substr(help.find("\nExamples:\n")))) {
    if (line.starts_with("  lobe ")) examples.push_back(line.substr(2));
  }
  return examples;
}

/// GoogleTest allows no dashes in names.
std::string word_of(std::string command) {
  std::ranges::replace(command, '-', '_');
  return command;
}

/// Columns of a line in UTF-8: bytes that begin a character.
std::ptrdiff_t characters_of(std::string_view line) {
  return std::ranges::count_if(line, [](char byte) { return (static_cast<unsigned char>(byte) & 0xC0U) != 0x80U; });
}

class Help : public ::testing::TestWithParam<std::string> {
 protected:
  [[nodiscard]] static Outcome help() {
    return GetParam().empty() ? run_lobe({"--help"}) : run_lobe({GetParam(), "--help"});
  }
};

TEST_P(Help, IsPrintedAndFitsEightyColumns) {
  const auto outcome = help();

  EXPECT_EQ(outcome.status, 0);
  EXPECT_THAT(outcome.error, IsEmpty());
  for (const auto& line : lines_of(outcome.output.substr(0, outcome.output.find("\nExamples:\n")))) {
    EXPECT_LE(characters_of(line), 80) << line;
  }
}

TEST_P(Help, EndsWithExamplesThatWork) {
  const TemporaryDirectory directory;
  const std::filesystem::path studies(LOBE_STUDIES_DIRECTORY);
  std::filesystem::create_directory_symlink(studies, directory.path() / "studies");
  std::filesystem::create_directory_symlink(studies.parent_path() / "examples", directory.path() / "examples");

  const auto examples = examples_of(help().output);

  EXPECT_THAT(examples.size(), Ge(2U));
  for (const auto& line : examples) {
    const auto outcome = run_line(line, {.directory = directory.path()});
    EXPECT_EQ(outcome.status, 0) << line << "\n" << outcome.error;
  }
}

/// All commands, but those whose examples need files that are not there, or end by Ctrl-C only.
std::vector<std::string> commands_with_examples() {
  std::vector<std::string> names{""};
  for (const auto& command : cli::commands()) {
    if (command.name != "import" && command.name != "agreement" && command.name != "view")
      names.emplace_back(command.name);
  }
  return names;
}

INSTANTIATE_TEST_SUITE_P(Commands, Help, ::testing::ValuesIn(commands_with_examples()),
                         [](const auto& test) { return test.param.empty() ? "lobe" : word_of(test.param); });

TEST(Version, NamesCommitAndLibraries) {
  const auto outcome = run_lobe({"--version"});

  EXPECT_EQ(outcome.status, 0);
  for (const char* part : {"lobe 0.", "commit: ", "OpenCL headers: ", "HDF5: 1."}) {
    EXPECT_THAT(outcome.output, HasSubstr(part));
  }
}

}  // namespace
}  // namespace lobe::test
