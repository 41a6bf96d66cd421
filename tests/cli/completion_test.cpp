// Completions on a command line: by the command, and by the script that bash uses.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <fstream>
#include <sstream>

#include "cli/process.hpp"
#include "interface/command.hpp"
#include "interface/complete.hpp"
#include "support/temporary_directory.hpp"

namespace lobe::test {
namespace {

using ::testing::Contains;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::Not;
using Words = std::vector<std::string>;

cli::Completion completion(const Words& words) {
  return cli::complete(cli::commands(), words);
}

Words candidates(const Words& words) {
  Words found;
  for (const auto& candidate : completion(words).candidates) found.push_back(candidate.word);
  return found;
}

TEST(Completion, OffersCommandsWithTheirSummaries) {
  EXPECT_THAT(candidates({"dist"}), ElementsAre("distance", "distance-matrix"));
  EXPECT_EQ(completion({"tabu"}).candidates.at(0).help, "tabulate a material on a grid of directions");
}

TEST(Completion, OffersModelsWhereAMaterialStands) {
  EXPECT_THAT(candidates({"norm", "lamb"}), Contains("lambert"));
  EXPECT_THAT(candidates({"norm", "war"}), Contains("ward:"));
  EXPECT_THAT(candidates({"norm", "lambert+war"}), Contains("lambert+ward:"));
  EXPECT_EQ(completion({"norm", ""}).paths, cli::Completion::Paths::files);
}

TEST(Completion, OffersParametersThatAreNotThereYet) {
  EXPECT_THAT(candidates({"norm", "ward:"}), ElementsAre("ward:m=", "ward:scale="));
  EXPECT_THAT(candidates({"norm", "ward:m=0.2,"}), ElementsAre("ward:m=0.2,scale="));
  EXPECT_THAT(candidates({"norm", "lambert+phong:"}), ElementsAre("lambert+phong:n=", "lambert+phong:scale="));
  EXPECT_THAT(candidates({"norm", "ward:m="}), IsEmpty());
}

TEST(Completion, OffersFactorsAndAdjustments) {
  EXPECT_THAT(candidates({"norm", "phong:n=3*cos_m"}), ElementsAre("phong:n=3*cos_max:"));
  EXPECT_THAT(candidates({"norm", "phong:n=3*fresnel:"}), Contains("phong:n=3*fresnel:ior="));
  EXPECT_THAT(candidates({"norm", "phong:n=3@pum"}), ElementsAre("phong:n=3@pump:"));
  EXPECT_THAT(candidates({"norm", "phong:n=3@pump:"}),
              ElementsAre("phong:n=3@pump:correction=", "phong:n=3@pump:times="));
}

TEST(Completion, OffersValuesOfOptions) {
  EXPECT_THAT(candidates({"norm", "lambert", "--lighting", "d"}), ElementsAre("daylight", "density:"));
  EXPECT_THAT(candidates({"norm", "lambert", "--lighting=d"}),
              ElementsAre("--lighting=daylight", "--lighting=density:"));
  EXPECT_THAT(candidates({"norm", "lambert", "--lighting", "material:lambert+war"}),
              Contains("material:lambert+ward:"));
  EXPECT_THAT(candidates({"--precision", "s"}), ElementsAre("single"));
  EXPECT_THAT(candidates({"tabulate", "lambert", "--grid", "k"}), ElementsAre("klems:"));
  EXPECT_THAT(candidates({"export", "lambert", "--format", "mer"}), ElementsAre("merl"));
  EXPECT_THAT(candidates({"fit", "lambert", "--family", "lambert+war"}), Contains("lambert+ward"));
}

TEST(Completion, KnowsWhereWhichFilesAreExpected) {
  EXPECT_EQ(completion({"run", ""}).ending, ".toml");
  EXPECT_EQ(completion({"distance-matrix", "lambert", "-o", ""}).ending, ".csv");
  EXPECT_EQ(completion({"run", "s.toml", "--output", ""}).paths, cli::Completion::Paths::directories);
  EXPECT_EQ(completion({"norm", "lambert", "--lighting", "table:"}).ending, ".h5");
  EXPECT_EQ(completion({"norm", "lambert", "--lighting", "material:"}).paths, cli::Completion::Paths::files);
}

TEST(Completion, KnowsWhatAValueOfAnOptionIs) {
  // "lambert" after --lighting is its value, so that A is still to come.
  EXPECT_THAT(candidates({"norm", "--lighting", "point", "lamb"}), Contains("lambert"));
  EXPECT_THAT(candidates({"norm", "lambert", "lamb"}), IsEmpty());
  EXPECT_THAT(candidates({"norm", "--", "--"}), IsEmpty());
}

TEST(Completion, OffersTopicsAndModels) {
  EXPECT_THAT(candidates({"help", "exit"}), ElementsAre("exit-codes"));
  EXPECT_THAT(candidates({"help", "albe"}), ElementsAre("albedo"));
  EXPECT_THAT(candidates({"models", "cos_"}), ElementsAre("cos_max"));
}

// Bash.

/// What bash offers at the end of a line, with words parted as bash parts them.
Words in_bash(const std::string& line, const Words& parted, const std::filesystem::path& directory = ".") {
  std::string words;
  for (const auto& word : parted) words += " '" + word + "'";
  const std::string script = "source " LOBE_COMPLETIONS_DIRECTORY "/lobe.bash\nCOMP_LINE='" + line +
                             "'; COMP_POINT=${#COMP_LINE}; COMP_WORDS=(" + words +
                             "); COMP_CWORD=$((${#COMP_WORDS[@]} - 1)); _lobe\nprintf '%s\\n' \"${COMPREPLY[@]}\"\n";
  const auto outcome =
      run_line("bash --norc <<'END'\n" + script + "END\n", {.directory = std::filesystem::absolute(directory)});
  EXPECT_THAT(outcome.error, IsEmpty());
  Words found;
  std::istringstream stream(outcome.output);
  for (std::string word; std::getline(stream, word);) found.push_back(word);
  return found;
}

TEST(Bash, OffersCommandsAndOptions) {
  EXPECT_THAT(in_bash("lobe self", {"lobe", "self"}), ElementsAre("self-compose"));
  EXPECT_THAT(in_bash("lobe distance --fail", {"lobe", "distance", "--fail"}), ElementsAre("--fail-above"));
}

TEST(Bash, OffersWhatFollowsTheCharacterAtWhichItPartsWords) {
  EXPECT_THAT(in_bash("lobe norm ward:", {"lobe", "norm", "ward", ":"}), ElementsAre("m=", "scale="));
  EXPECT_THAT(in_bash("lobe norm ward:m=0.2,s", {"lobe", "norm", "ward", ":", "m", "=", "0.2,s"}),
              ElementsAre("0.2,scale="));
  EXPECT_THAT(in_bash("lobe norm --lighting=da", {"lobe", "norm", "--lighting", "=", "da"}), ElementsAre("daylight"));
  EXPECT_THAT(in_bash("lobe norm phong:n=3@pum", {"lobe", "norm", "phong", ":", "n", "=", "3", "@", "pum"}),
              ElementsAre("pump:"));
}

TEST(Bash, OffersFilesOfTheKindThatIsExpected) {
  const TemporaryDirectory directory;
  std::ofstream(directory.path() / "a study.toml");
  std::ofstream(directory.path() / "a picture.png");
  std::filesystem::create_directory(directory.path() / "a");

  EXPECT_THAT(in_bash("lobe run a", {"lobe", "run", "a"}, directory.path()),
              ::testing::UnorderedElementsAre("a study.toml", "a"));
  EXPECT_THAT(in_bash("lobe run x -o ", {"lobe", "run", "x", "-o", ""}, directory.path()), ElementsAre("a"));
}

TEST(Bash, HasNothingToOfferWhereNothingIsKnown) {
  EXPECT_THAT(in_bash("lobe nonsuch ", {"lobe", "nonsuch", ""}), Not(Contains(HasSubstr("lobe"))));
}

}  // namespace
}  // namespace lobe::test
