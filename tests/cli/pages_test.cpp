// Texts made from the option tables: help, manual pages, completions. None lacks an option.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <fstream>

#include "cli/process.hpp"
#include "core/text.hpp"
#include "interface/command.hpp"
#include "interface/complete.hpp"
#include "interface/exit_code.hpp"
#include "interface/help.hpp"
#include "interface/model_page.hpp"
#include "interface/topics.hpp"
#include "lobe/model/model.hpp"
#include "support/temporary_directory.hpp"

namespace lobe::test {
namespace {

using ::testing::Contains;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::Le;
using ::testing::StartsWith;

std::vector<cli::Option> options_of(const cli::Command& command) {
  std::vector<cli::Option> options = command.options;
  options.insert(options.end(), cli::common_options().begin(), cli::common_options().end());
  return options;
}

std::string manual_page(const std::string& file) {
  const auto pages = cli::manual(cli::commands());
  const auto page = std::ranges::find(pages, file, &cli::ManualPage::file);
  return page == pages.end() ? "" : page->text;
}

/// As roff has it: dashes that can be copied.
std::string in_roff(std::string text) {
  for (std::size_t at = text.find('-'); at != std::string::npos; at = text.find('-', at + 2)) text.insert(at, "\\");
  return text;
}

std::vector<std::string> words_of(const cli::Completion& completion) {
  std::vector<std::string> words;
  for (const auto& candidate : completion.candidates) words.push_back(candidate.word);
  return words;
}

class EveryCommand : public ::testing::TestWithParam<std::size_t> {
 protected:
  [[nodiscard]] static const cli::Command& command() { return cli::commands()[GetParam()]; }
};

TEST_P(EveryCommand, HasAllItsOptionsInItsHelp) {
  const std::string text = cli::terminal_text(cli::command_page(command()));
  for (const auto& option : options_of(command())) {
    EXPECT_THAT(text, HasSubstr("--" + std::string(option.name()) + (option.value.empty() ? "" : " ")))
        << option.name();
  }
}

TEST_P(EveryCommand, HasAllItsOptionsInItsManualPage) {
  const std::string text = manual_page("lobe-" + std::string(command().name) + ".1");
  for (const auto& option : options_of(command())) {
    EXPECT_THAT(text, HasSubstr("\\fB" + in_roff("--" + std::string(option.name())) + "\\fR")) << option.name();
  }
}

TEST_P(EveryCommand, HasAllItsOptionsInItsPageOfTheSite) {
  const std::string text = cli::html_text(cli::command_page(command()));
  EXPECT_THAT(text, StartsWith("<h1>lobe " + std::string(command().name) + "</h1>"));
  for (const auto& option : options_of(command())) {
    EXPECT_THAT(text, HasSubstr("--" + std::string(option.name()) + (option.value.empty() ? "</code>" : " ")))
        << option.name();
  }
}

TEST_P(EveryCommand, HasAllItsOptionsInCompletions) {
  const std::vector<std::string> line{std::string(command().name), "--"};
  const auto words = words_of(cli::complete(cli::commands(), line));
  for (const auto& option : options_of(command())) EXPECT_THAT(words, Contains("--" + std::string(option.name())));
}

TEST_P(EveryCommand, CompletesTheChoicesOfItsOptions) {
  for (const auto& option : options_of(command())) {
    const std::vector<std::string> line{std::string(command().name), "--" + std::string(option.name()), ""};
    const auto words = words_of(cli::complete(cli::commands(), line));
    for (const auto choice : option.choices) EXPECT_THAT(words, Contains(std::string(choice))) << option.name();
  }
}

TEST_P(EveryCommand, IsInTheListOfLobeItself) {
  EXPECT_THAT(cli::overview(cli::commands()), HasSubstr(std::string(command().name) + " "));
  EXPECT_THAT(manual_page("lobe.1"), HasSubstr("\\fB" + in_roff(std::string(command().name)) + "\\fR"));
}

TEST_P(EveryCommand, IsALinkOfTheSite) {
  const std::string name(command().name);
  EXPECT_THAT(cli::html_text(cli::lobe_page(cli::commands()), {name}), HasSubstr("<a href=\"" + name + ".html\">"));
}

INSTANTIATE_TEST_SUITE_P(Tables, EveryCommand, ::testing::Range(std::size_t{0}, cli::commands().size()),
                         [](const auto& test) {
                           std::string name(cli::commands()[test.param].name);
                           std::ranges::replace(name, '-', '_');
                           return name;
                         });

TEST(Overview, FitsOneScreen) {
  const std::string text = cli::overview(cli::commands());

  EXPECT_THAT(std::ranges::count(text, '\n'), Le(55));
  for (std::size_t at = 0; at < text.size();) {
    const std::size_t end = text.find('\n', at);
    EXPECT_THAT(end - at, Le(80U)) << text.substr(at, end - at);
    at = end + 1;
  }
}

TEST(ManualPages, AreGoodRoff) {
  if (run_line("command -v groff").status != 0) GTEST_SKIP() << "groff is not installed; the pages stay unchecked";
  const TemporaryDirectory directory;
  for (const auto& [name, text] : cli::manual(cli::commands())) {
    std::ofstream(directory.path() / name) << text;
    const auto outcome = run_line("groff -man -Tutf8 -Kutf8 -ww -z " + name, {.directory = directory.path()});
    EXPECT_EQ(outcome.status, 0) << name;
    EXPECT_THAT(outcome.error, IsEmpty()) << name;
  }
}

TEST(ManualPages, ShowWhatHelpShows) {
  if (run_line("command -v groff").status != 0) GTEST_SKIP() << "groff is not installed; the pages stay unchecked";
  const TemporaryDirectory directory;
  std::ofstream(directory.path() / "page") << manual_page("lobe-distance.1");
  const std::string shown = run_line("groff -man -Tascii -P-c -P-b -P-u page", {.directory = directory.path()}).output;

  for (const char* part : {"lobe-distance - compute the distance between two materials", "lobe distance A B [OPTIONS]",
                           "--fail-above X", "lobe distance phong:n=20 ward:m=0.2", "lobe(1)", "lobe-lightings(7)"}) {
    EXPECT_THAT(shown, HasSubstr(part));
  }
}

// The reference of models.

class EveryModel : public ::testing::TestWithParam<std::size_t> {
 protected:
  [[nodiscard]] static const Model& model() { return catalogue()[GetParam()]; }
  [[nodiscard]] static std::string page() { return cli::html_text(model(), "EXAMPLE", "../kernels/models/x.clh", {}); }
};

TEST_P(EveryModel, HasAPageOfTheSiteWithAllThatTheCatalogueKnows) {
  const std::string text = page();
  EXPECT_THAT(text, StartsWith("<h1>" + std::string(model().name) + "</h1>"));
  EXPECT_THAT(text, HasSubstr(escaped_markup(model().formula)));
  EXPECT_THAT(text, HasSubstr(escaped_markup(model().source)));
  for (const auto& parameter : model().parameters) {
    SCOPED_TRACE(parameter.name);
    EXPECT_THAT(text, HasSubstr("<tr><td><code>" + std::string(parameter.name) + "</code></td>"));
    EXPECT_THAT(text, HasSubstr("<td>" + escaped_markup(parameter.description) + "</td></tr>"));
  }
  EXPECT_THAT(text, HasSubstr(model().traits.reciprocal ? "<td>reciprocal</td><td>yes" : "<td>reciprocal</td><td>no"));
  EXPECT_THAT(text, HasSubstr(model().traits.isotropic ? "<td>isotropic</td><td>yes" : "<td>isotropic</td><td>no"));
}

TEST_P(EveryModel, IsALinkOfThePageOfAllModels) {
  const std::vector<std::string> thumbnails(catalogue().size());
  EXPECT_THAT(cli::catalogue_html(thumbnails), HasSubstr("<a href=\"" + std::string(model().name) + ".html\">"));
}

INSTANTIATE_TEST_SUITE_P(Catalogue, EveryModel, ::testing::Range(std::size_t{0}, catalogue().size()),
                         [](const auto& test) { return std::string(catalogue()[test.param].name); });

TEST(PagesOfTheSite, ShowMarksAsText) {
  const cli::Page page{.name = "x",
                       .summary = "a < b & c",
                       .sections = {{"A Title, of two", {cli::entry("-o <FILE>", "text"), cli::paragraph("1 > 0")}}}};

  EXPECT_EQ(cli::html_text(page),
            "<h1>x</h1>\n<p class=\"summary\">a &lt; b &amp; c</p>\n<h2 id=\"a-title-of-two\">A Title, of two</h2>\n"
            "<dl>\n<dt><code>-o &lt;FILE&gt;</code></dt>\n<dd>text</dd>\n</dl>\n<p>1 &gt; 0</p>\n");
}

// Topics.

class EveryTopic : public ::testing::TestWithParam<std::size_t> {
 protected:
  [[nodiscard]] static std::string name() { return std::string(cli::topics()[GetParam()].name); }
};

TEST_P(EveryTopic, IsExplainedByLobeHelpAndByAManualPage) {
  const auto outcome = run_lobe({"help", name()});

  EXPECT_EQ(outcome.status, 0);
  EXPECT_THAT(outcome.output, HasSubstr(std::string(cli::topics()[GetParam()].summary)));
  EXPECT_THAT(manual_page("lobe-" + name() + ".7"), HasSubstr(".SH NAME\nlobe\\-" + in_roff(name())));
}

TEST_P(EveryTopic, EndsWithExamplesThatWork) {
  const TemporaryDirectory directory;
  std::filesystem::create_directory_symlink(LOBE_STUDIES_DIRECTORY, directory.path() / "studies");

  const auto sections = cli::topics()[GetParam()].sections();
  ASSERT_EQ(sections.back().title, "Examples");
  for (const auto& example : sections.back().blocks) {
    const auto outcome = run_line(example.item, {.directory = directory.path()});
    EXPECT_EQ(outcome.status, 0) << example.item << "\n" << outcome.error;
  }
}

INSTANTIATE_TEST_SUITE_P(Tables, EveryTopic, ::testing::Range(std::size_t{0}, cli::topics().size()),
                         [](const auto& test) {
                           std::string name(cli::topics()[test.param].name);
                           std::ranges::replace(name, '-', '_');
                           return name;
                         });

TEST(Studies, AreExplainedByOneThatRuns) {
  const TemporaryDirectory directory;
  for (const auto& section : cli::topics()[3].sections()) {
    for (const auto& block : section.blocks) {
      if (block.kind == cli::Block::Kind::verbatim) std::ofstream(directory.path() / "gloss.toml") << block.text;
    }
  }

  const auto outcome = run_lobe({"run", "gloss.toml"}, {.directory = directory.path()});

  EXPECT_EQ(outcome.status, 0) << outcome.error;
  EXPECT_THAT(outcome.output, HasSubstr("gloss.daylight.distance.csv"));
}

TEST(Help, OfACommandIsThatOfItsOption) {
  EXPECT_EQ(run_lobe({"help", "distance"}).output, run_lobe({"distance", "--help"}).output);
  EXPECT_EQ(run_lobe({"help"}).output, run_lobe({"--help"}).output);
}

TEST(Help, OfExitCodesListsAllOfThem) {
  const std::string text = run_lobe({"help", "exit-codes"}).output;
  for (const char* status : {"\n  0 ", "\n  1 ", "\n  2 ", "\n  3 ", "\n  4 ", "\n  5 ", "\n  130 "}) {
    EXPECT_THAT(text, HasSubstr(status));
  }
}

}  // namespace
}  // namespace lobe::test
