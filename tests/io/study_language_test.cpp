// Sweeps, included files, values from outside, and where everything in a study comes from.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cstdlib>
#include <filesystem>
#include <ostream>
#include <string>
#include <vector>

#include "core/files.hpp"
#include "io/load_text.hpp"
#include "lobe/core/error.hpp"
#include "lobe/study/study.hpp"
#include "support/names.hpp"
#include "support/temporary_directory.hpp"

namespace lobe::test {
namespace {

namespace fs = std::filesystem;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;

std::vector<std::string> names_in(const Study& study) {
  std::vector<std::string> list;
  for (const auto& material : study.materials) list.push_back(material.name());
  return list;
}

std::vector<std::string> texts(const std::vector<Origin>& origins) {
  std::vector<std::string> list;
  for (const auto& origin : origins) list.push_back(to_string(origin));
  return list;
}

/// The complaint, without the folder's name; "none" where there is none.
template <typename Call>
std::string complaint(const Call& call, const fs::path& folder = {}) {
  try {
    call();
  } catch (const ArgumentError& error) {
    std::string text = error.what();
    const std::string prefix = folder.empty() ? "" : folder.string() + "/";
    for (std::size_t at = 0; !prefix.empty() && (at = text.find(prefix)) != std::string::npos;) {
      text.erase(at, prefix.size());
    }
    return text;
  }
  return "none";
}

// --- Sweeps.

constexpr const char* kCookTorrance = "[[family]]\nname = \"C\"\nmodel = \"cook_torrance\"\n";

TEST(Sweep, OfAGroupGoesTogetherAndWithTheRestMakesEveryCombination) {
  const Study study = load_text(
      "[[family]]\nname = \"C\"\nmodel = \"cook_torrance\"\nm = [0.1, 0.2]\nf0 = [0.5, 1]\n"
      "scale = {linspace = [0.1, 0.3], count = 2}\nzip = [[\"m\", \"scale\"]]\n");
  EXPECT_THAT(names_in(study), ElementsAre("C m=0.1, f0=0.5, scale=0.1", "C m=0.1, f0=1, scale=0.1",
                                           "C m=0.2, f0=0.5, scale=0.3", "C m=0.2, f0=1, scale=0.3"));
  EXPECT_EQ(study.materials[2].formula()->terms[0].weight, std::vector<double>{0.3});
  EXPECT_EQ(study.materials[2].formula()->terms[0].values, (std::vector<double>{0.2, 0.5}));
}

TEST(Sweep, OfAGroupTakesSingleValuesAlong) {
  const Study study = load_text(std::string(kCookTorrance) + "m = [0.1, 0.2]\nf0 = 0.5\nzip = [[\"m\", \"f0\"]]\n");
  EXPECT_THAT(names_in(study), ElementsAre("C m=0.1", "C m=0.2"));
}

TEST(Sweep, OfScalesKeepsListsForChannels) {
  const Study study = load_text(
      "[study]\nchannels = [\"r\", \"g\"]\n[[family]]\nname = \"W\"\nmodel = \"ward\"\nm = [0.1, 0.2]\n"
      "scale = [0.5, 0.7]\n[[family]]\nname = \"V\"\nmodel = \"ward\"\nm = 0.1\nscale = {values = [1, 1.4]}\n");
  EXPECT_THAT(names_in(study), ElementsAre("W m=0.1", "W m=0.2", "V scale=1", "V scale=1.4"));
  EXPECT_EQ(study.materials[1].formula()->terms[0].weight, (std::vector<double>{0.5, 0.7}));
  EXPECT_EQ(study.materials[3].formula()->terms[0].weight, std::vector<double>{1.4});
}

// Files from before `factor` became part of `scale`.
TEST(Scale, TakesTheFactorOfOlderFilesIn) {
  const Study study = load_text(
      "[study]\nchannels = [\"r\", \"g\"]\n[[material]]\nname = \"a\"\nmodel = \"lambert\"\nscale = [0.25, 0.5]\n"
      "factor = 2\n[[family]]\nname = \"V\"\nmodel = \"ward\"\nm = 0.1\nscale = {values = [0.5, 0.7]}\nfactor = 2\n");
  EXPECT_EQ(study.materials[0].formula()->terms[0].weight, (std::vector<double>{0.5, 1}));
  EXPECT_EQ(study.materials[2].formula()->terms[0].weight, std::vector<double>{1.4});
}

constexpr const char* kRows =
    "columns = [\"name\", \"a\", \"b\"]\nrows = [[\"x\", [0.5, 0.25], 3], [\"y\", 2, [4, 8]]]\n";

TEST(Scale, IsAProductOfNumbersAndColumns) {
  const Study study =
      load_text(std::string("[study]\nchannels = [\"r\", \"g\"]\n[[family]]\nname = \"F\"\nmodel = \"lambert\"\n"
                            "scale = \"0.5*$b * $a\"\n") +
                kRows);
  EXPECT_EQ(study.materials[0].formula()->terms[0].weight, (std::vector<double>{0.75, 0.375}));
  EXPECT_EQ(study.materials[1].formula()->terms[0].weight, (std::vector<double>{4, 8}));
}

TEST(Sweep, OfFactors) {
  const Study study = load_text(
      "[[family]]\nname = \"M\"\nmodel = \"phong\"\nn = [1, 10]\nfactors = [{name = \"cos_max\", p = [0.5, 1]}]\n");
  EXPECT_THAT(names_in(study), ElementsAre("M n=1, p=0.5", "M n=1, p=1", "M n=10, p=0.5", "M n=10, p=1"));
  EXPECT_EQ(study.materials[1].formula()->terms[0].factors.at(0).values, std::vector<double>{1});
}

TEST(Sweep, OfTermsHasNamesThatTellThemApart) {
  const Study study = load_text(
      "[[family]]\nname = \"gloss\"\nterms = [\n  {model = \"lambert\", scale = {linspace = [0.1, 0.5], count = 2}},\n"
      "  {model = \"ward\", m = [0.1, 0.2], scale = {values = [0.3, 0.4]}},\n"
      "  {model = \"ward\", m = [0.3, 0.4]},\n]\nzip = [[\"terms.1.m\", \"terms.2.m\", \"ward.scale\"]]\n");
  EXPECT_THAT(names_in(study), ElementsAre("gloss lambert.scale=0.1, terms.1.m=0.1, ward.scale=0.3, terms.2.m=0.3",
                                           "gloss lambert.scale=0.1, terms.1.m=0.2, ward.scale=0.4, terms.2.m=0.4",
                                           "gloss lambert.scale=0.5, terms.1.m=0.1, ward.scale=0.3, terms.2.m=0.3",
                                           "gloss lambert.scale=0.5, terms.1.m=0.2, ward.scale=0.4, terms.2.m=0.4"));
  const auto& terms = study.materials[1].formula()->terms;
  ASSERT_EQ(terms.size(), 3U);
  EXPECT_EQ(terms[0].weight, std::vector<double>{0.1});
  EXPECT_EQ(terms[1].weight, std::vector<double>{0.4});
  EXPECT_EQ(terms[1].values, std::vector<double>{0.2});
  EXPECT_EQ(terms[2].values, std::vector<double>{0.4});
}

TEST(Sweep, OfTermsNeedsNoLongNamesWhereOneOfThemVaries) {
  const Study study = load_text(
      "[[family]]\nname = \"gloss\"\nterms = [{model = \"lambert\", scale = 0.5}, {model = \"ward\", m = [0.1, 0.2], "
      "scale = 0.3}]\nlabel = \"{family}: {m} at {ward.scale}\"\n");
  EXPECT_THAT(names_in(study), ElementsAre("gloss: 0.1 at 0.3", "gloss: 0.2 at 0.3"));
}

TEST(Sweep, OfACurveBelowAnotherTerm) {
  const Study study = load_text(
      "[[family]]\nname = \"coat\"\nterms = [{model = \"profile\", points = [[0, 4], [0.5, 0]], scale = {values = [1, "
      "2]}}, {model = \"lambert\", scale = 0.5}]\n");
  EXPECT_THAT(names_in(study), ElementsAre("coat scale=1", "coat scale=2"));
  EXPECT_EQ(study.materials[1].formula()->terms.front().weight.front(),
            2 * study.materials[0].formula()->terms.front().weight.front());
  EXPECT_EQ(study.materials[1].formula()->terms.back().weight, std::vector<double>{0.5});
}

struct BadText {
  std::string name;
  std::string text;
  std::string message;  ///< from the line on
};

std::ostream& operator<<(std::ostream& out, const BadText& bad) {
  return out << bad.name;
}

class BadSweep : public ::testing::TestWithParam<BadText> {};

TEST_P(BadSweep, IsRefusedWithItsPlace) {
  const std::string text = complaint([&] { (void)load_text(GetParam().text); });
  EXPECT_THAT(text, HasSubstr("file.toml:" + GetParam().message));
  EXPECT_EQ(text.find('\n'), std::string::npos);
}

INSTANTIATE_TEST_SUITE_P(
    Mistakes, BadSweep,
    ::testing::Values(
        BadText{"unlike lengths",
                std::string(kCookTorrance) + "m = [0.1, 0.2, 0.3]\nf0 = [0.1, 0.2]\nzip = [[\"m\", \"f0\"]]\n",
                "5:6: 'f0' has 2 values where 'm' has 3; zip expects as many"},
        BadText{"unknown name",
                std::string(kCookTorrance) + "m = [0.1, 0.2]\nf0 = [0.1, 0.2]\nzip = [[\"m\", \"f1\"]]\n",
                "6:14: zip has 'f1', which the family does not give; did you mean 'f0'?"},
        BadText{"name twice",
                std::string(kCookTorrance) + "m = [0.1, 0.2]\nf0 = [0.1, 0.2]\nzip = [[\"m\", \"f0\", \"m\"]]\n",
                "6:20: 'm' is in zip twice; expected it once"},
        BadText{"one name", std::string(kCookTorrance) + "m = [0.1, 0.2]\nf0 = 1\nzip = [[\"m\"]]\n",
                "6:8: a group of zip has less than two names; expected two or more"},
        BadText{"name without a group", std::string(kCookTorrance) + "m = [0.1, 0.2]\nf0 = 1\nzip = [\"m\", \"f0\"]\n",
                "6:8: an entry of zip is a text; expected a group of names, [[\"m\", \"scale\"]]"},
        BadText{"zip is a text", std::string(kCookTorrance) + "m = 0.1\nf0 = 1\nzip = \"m\"\n",
                "6:7: zip is a text; expected true, or groups of names"},
        BadText{
            "name of two numbers",
            "[[family]]\nname = \"t\"\nterms = [{model = \"ward\", m = [0.1, 0.2]}, {model = \"phong\", n = [1, 2]},"
            " {model = \"ward\", m = [0.1, 0.2]}]\nzip = [[\"n\", \"ward.m\"]]\n",
            "4:14: zip has 'ward.m', which may be terms.0.m, terms.2.m; expected one of these"},
        BadText{"label of two numbers",
                "[[family]]\nname = \"t\"\nterms = [{model = \"ward\", m = [0.1, 0.2]}, {model = \"ward\", m = [0.1, "
                "0.2]}]\nlabel = \"{m}\"\n",
                "4:9: unknown name '{m}' in label"},
        BadText{"value of a factor",
                "[[family]]\nname = \"t\"\nmodel = \"phong\"\nn = 1\nfactors = [{name = "
                "\"cos_max\", p = [0.5, \"1\"]}]\n",
                "5:41: an entry of 'p' is a text; expected a number"},
        BadText{"range of a scale", "[[family]]\nname = \"t\"\nmodel = \"lambert\"\nscale = {linspace = [1, 2]}\n",
                "4:9: 'scale' has no 'count'"},
        BadText{"factor is not swept", "[[family]]\nname = \"t\"\nmodel = \"lambert\"\nfactor = {values = [1, 2]}\n",
                "4:10: factor (which is part of 'scale' now) is a table; expected a number"},
        BadText{
            "unknown column of a product",
            "[[family]]\nname = \"t\"\nmodel = \"lambert\"\nscale = \"2 * $c\"\ncolumns = [\"name\", \"a\"]\nrows = "
            "[[\"x\", 1]]\n",
            "4:9: unknown column 'c'"},
        BadText{"product of something else",
                "[[family]]\nname = \"t\"\nmodel = \"lambert\"\nscale = \"two * $a\"\ncolumns = [\"name\", "
                "\"a\"]\nrows = [[\"x\", 1]]\n",
                "4:9: scale has 'two'; expected a product of numbers and columns, such as 0.5 * $ks"},
        BadText{"product without rows", "[[material]]\nname = \"t\"\nmodel = \"lambert\"\nscale = \"2 * 3\"\n",
                "4:9: scale is a text; expected a number"},
        BadText{"sweep in a material", "[[material]]\nname = \"t\"\nmodel = \"lambert\"\nscale = {values = [1, 2]}\n",
                "4:9: scale is a table; expected a number"}),
    ByName());

// --- Included files.

/// A folder with files; complaints are without its name.
class StudyFolder : public ::testing::Test {
 protected:
  void write(const std::string& name, const std::string& text) const {
    fs::create_directories((folder() / name).parent_path());
    write_text(folder() / name, true, text);
  }
  [[nodiscard]] fs::path folder() const { return directory_.path(); }
  [[nodiscard]] Study load(const std::vector<std::string>& overrides = {}) const {
    return load_study(folder() / "main.toml", overrides);
  }
  [[nodiscard]] std::string refusal(const std::vector<std::string>& overrides = {}) const {
    return complaint([&] { (void)load(overrides); }, folder());
  }

 private:
  TemporaryDirectory directory_;
};

using Inclusion = StudyFolder;

constexpr const char* kMatt = "[[material]]\nname = \"matt\"\nmodel = \"lambert\"\n";

TEST_F(Inclusion, StandsBeforeTheFilesOwnInOrder) {
  write("families/a.toml", "include = [\"deep/b.toml\"]\n[[family]]\nname = \"A\"\nmodel = \"phong\"\nn = [1, 2]\n");
  write("families/deep/b.toml", "[[material]]\nname = \"b\"\nmodel = \"oren_nayar\"\nsigma = 0.3\n");
  write("c.toml", "[[chart]]\nname = \"c\"\nquantity = \"albedo\"\ncurves = [{label = \"x\", model = \"lambert\"}]\n");
  write("main.toml", std::string("include = [\"families/a.toml\", \"c.toml\"]\n") + kMatt);
  const Study study = load();
  EXPECT_THAT(names_in(study), ElementsAre("b", "A n=1", "A n=2", "matt"));
  EXPECT_EQ(study.charts.size(), 1U);
  EXPECT_THAT(texts(study.origins.materials), ElementsAre("families/deep/b.toml:1", "families/a.toml:2 (n=1)",
                                                          "families/a.toml:2 (n=2)", "main.toml:2"));
  ASSERT_EQ(study.texts.size(), 4U);
  EXPECT_EQ(study.texts[0].name, "main.toml");
  EXPECT_EQ(study.texts[1].name, "families/deep/b.toml");
  EXPECT_EQ(study.texts[1].text, read_text(folder() / "families/deep/b.toml"));
}

TEST_F(Inclusion, GivesSettingsThatTheFileDoesNotGive) {
  write("a.toml",
        "[study]\nname = \"a\"\ntitle = \"A\"\ncomment = \"of a\"\nreferences = [\"R\", \"S\"]\ntolerance = 1e-3\n"
        "lightings = [\"daylight\"]\n" +
            std::string(kMatt));
  write("b.toml", "[study]\nreferences = [\"T\", \"S\"]\ntolerance = 1e-4\npatch_tolerance = 1e-2\n");
  write("main.toml", "include = [\"a.toml\", \"b.toml\"]\n[study]\nreferences = [\"U\"]\nlightings = [\"point\"]\n");
  const Study study = load();
  EXPECT_EQ(study.name, "main");
  EXPECT_EQ(study.title, "main");
  EXPECT_EQ(study.comment, "");
  EXPECT_THAT(study.references, ElementsAre("R", "S", "T", "U"));
  EXPECT_EQ(study.tolerance, 1e-4);
  EXPECT_EQ(study.patch_tolerance, 1e-2);
  EXPECT_THAT(study.lightings, ElementsAre(Lighting::point()));
  EXPECT_THAT(texts(study.origins.lightings), ElementsAre("main.toml:4"));
}

TEST_F(Inclusion, FindsFilesByEnvironmentVariableAndMeasuredOnesFromItsOwnFolder) {
  write("far/plates.toml", "[[measured]]\nfile = \"data/a.csv\"\n[[measured]]\nfiles = [\"data/b*.csv\"]\n");
  write("far/data/a.csv", "1, 1, 0, 0, 0, 0, 0, 1\n");
  write("far/data/b1.csv", "1, 1, 0, 0, 0, 0, 0, 1\n");
  write("main.toml", "include = [\"$LOBE_TEST_FAR/plates.toml\"]\n");
  ASSERT_EQ(setenv("LOBE_TEST_FAR", (folder() / "far").c_str(), 1), 0);
  const Study study = load();
  unsetenv("LOBE_TEST_FAR");
  EXPECT_THAT(names_in(study), ElementsAre("a", "b1"));
  EXPECT_EQ(study.materials[1].file()->name, "$LOBE_TEST_FAR/data/b1.csv");
  EXPECT_EQ(to_string(study.origins.materials[1]), "$LOBE_TEST_FAR/plates.toml:4");
  EXPECT_THAT(refusal(), HasSubstr("main.toml:1:12: environment variable LOBE_TEST_FAR"));
}

TEST_F(Inclusion, OfItselfOrTwiceIsRefused) {
  write("main.toml", "include = [\n  \"main.toml\",\n]\n");
  EXPECT_EQ(refusal(), "main.toml:2:3: 'main.toml' includes itself; expected no circle");
  write("main.toml", "include = [\"a.toml\"]\n");
  write("a.toml", "include = [\"b.toml\"]\n");
  write("b.toml", "include = [\"./a.toml\"]\n");
  EXPECT_EQ(refusal(), "b.toml:1:12: './a.toml' includes itself by way of this file; expected no circle");
  write("a.toml", kMatt);
  write("b.toml", "include = [\"a.toml\"]\n");
  write("main.toml", "include = [\"a.toml\", \"b.toml\"]\n");
  EXPECT_EQ(refusal(), "b.toml:1:12: 'a.toml' is included already, by main.toml:1; expected every file once");
}

TEST_F(Inclusion, ComplainsAboutTheIncludedFileAtItsLine) {
  write("main.toml", "include = [\"sub/a.toml\"]\n");
  EXPECT_THAT(refusal(), HasSubstr("main.toml:1:12: there is no file 'sub/a.toml'"));
  write("sub/a.toml", "[[family]]\nname = \"A\"\nmodel = \"phnog\"\n");
  EXPECT_THAT(refusal(), HasSubstr("sub/a.toml:3:9: unknown model 'phnog'"));
  write("sub/a.toml", "[study]\ntolerence = 1\n");
  EXPECT_THAT(refusal(), HasSubstr("sub/a.toml:2:1: unknown key 'tolerence' in [study]"));
  write("sub/a.toml", "[study]\ntolerance = 1\n");
  EXPECT_THAT(refusal(), HasSubstr("sub/a.toml:2:13: tolerance is 1; expected a value in"));
  write("sub/a.toml", "name = \"a\"\nmodel = \"lambert\"\n");
  EXPECT_THAT(refusal(), HasSubstr("sub/a.toml:2:1: unknown key 'model' in a study file"));
  write("main.toml", "include = \"sub/a.toml\"\n");
  EXPECT_EQ(refusal(), "main.toml:1:11: include is a text; expected a list");
}

TEST_F(Inclusion, NamesBothPlacesOfAMaterialThatIsThereTwice) {
  write("a.toml", kMatt);
  write("main.toml", std::string("include = [\"a.toml\"]\n\n") + kMatt);
  EXPECT_EQ(refusal(), "main.toml:4:8: material 'matt' exists already, from a.toml:2; expected distinct names");
}

// --- Values from outside.

class Override : public StudyFolder {
 protected:
  Override() {
    write("main.toml", R"([[family]]
name = "Ward"
model = "ward"
m = {logspace = [0.1, 1], count = 3}

[[family]]
name = "Cook-Torrance 1.0"
model = "cook_torrance"
m = 0.1
f0 = 0.5

[[material]]
name = "mixed"
terms = [{model = "lambert", scale = 0.4}, {model = "ward", m = 0.05}]

[[chart]]
name = "gloss"
quantity = "albedo"
curves = [{label = "x", model = "phong", n = 20}]
)");
  }
};

TEST_F(Override, SetsWhatItsKeyMeans) {
  const Study study = load({"study.tolerance=1e-3", "study.lightings=[\"daylight\"]", "study.grid = gauss:8x16",
                            "family.Ward.m.count=2", "family.\"Cook-Torrance 1.0\".f0=[0.5, 1]",
                            "material.mixed.terms.1.m=0.2", "chart.gloss.curves.0.n=30", "chart.gloss.title=Gloss"});
  EXPECT_EQ(study.tolerance, 1e-3);
  EXPECT_THAT(study.lightings, ElementsAre(Lighting::daylight()));
  EXPECT_EQ(study.grid->name(), HemisphereGrid::gauss(8, 16).name());
  EXPECT_THAT(names_in(study),
              ElementsAre("Ward m=0.1", "Ward m=1", "Cook-Torrance 1.0 f0=0.5", "Cook-Torrance 1.0 f0=1", "mixed"));
  EXPECT_EQ(study.materials.back().formula()->terms[1].values, std::vector<double>{0.2});
  EXPECT_EQ(study.charts[0].curves[0].materials[0].terms[0].values, std::vector<double>{30});
  EXPECT_EQ(study.charts[0].title, "Gloss");
  EXPECT_EQ(study.overrides.size(), 8U);
}

TEST_F(Override, IsPartOfWhereThingsComeFrom) {
  const Study study = load({"study.lightings=[\"point\"]", "family.Ward.m=[0.1, 0.2]"});
  EXPECT_THAT(texts(study.origins.lightings), ElementsAre("--set study.lightings"));
  EXPECT_THAT(texts(study.origins.materials),
              ElementsAre("main.toml:1 (m=0.1), --set family.Ward.m", "main.toml:1 (m=0.2), --set family.Ward.m",
                          "main.toml:6", "main.toml:12"));
  EXPECT_THAT(texts(study.origins.charts), ElementsAre("main.toml:16"));
  EXPECT_THAT(texts(study.origins.curves.at(0)), ElementsAre("main.toml:19"));
}

TEST_F(Override, IsNamedInOneWayHoweverItsKeyIsWritten) {
  const Study study = load({"study.\"lightings\"=[\"point\"]", "family.'Cook-Torrance 1.0'.f0=0.4"});
  EXPECT_THAT(texts(study.origins.lightings), ElementsAre("--set study.lightings"));
  EXPECT_EQ(to_string(study.origins.materials[3]), "main.toml:6, --set family.\"Cook-Torrance 1.0\".f0");
}

TEST_F(Override, ReachesIncludedFilesAndTheLaterOneCounts) {
  write("outer.toml", "include = [\"main.toml\"]\n");
  const std::vector<std::string> overrides{"family.Ward.m=0.3", "family.Ward.m=0.4"};
  const Study study = load_study(folder() / "outer.toml", overrides);
  EXPECT_EQ(study.materials[0].formula()->terms[0].values, std::vector<double>{0.4});
}

struct BadOverride {
  std::string name;
  std::string text;
  std::string complaint;
};

std::ostream& operator<<(std::ostream& out, const BadOverride& bad) {
  return out << bad.name;
}

class BadOverrides : public Override, public ::testing::WithParamInterface<BadOverride> {};

TEST_P(BadOverrides, AreRefusedInOneLine) {
  EXPECT_EQ(refusal({GetParam().text}), "--set " + GetParam().text + ": " + GetParam().complaint);
}

INSTANTIATE_TEST_SUITE_P(
    Mistakes, BadOverrides,
    ::testing::Values(
        BadOverride{"no value", "study.tolerance", "there is no '='; expected KEY=VALUE, such as study.tolerance=1e-4"},
        BadOverride{"empty value", "study.tolerance=", "there is no value after '='; expected one as in a study file"},
        BadOverride{"misspelt table", "famly.Ward.m=1", "nothing in a study is called 'famly'; did you mean 'family'?"},
        BadOverride{"misspelt name", "family.Wrad.m=1",
                    "there is no [[family]] 'Wrad' in main.toml; did you mean 'Ward'?"},
        BadOverride{"no published figures", "published.x.offset=1",
                    "there is no [[published]] 'x' in main.toml; it has none"},
        BadOverride{"whole entry", "family.Ward=1", "the key has 2 parts; expected three or more, family.NAME.KEY"},
        BadOverride{"whole table", "study=1", "the key names all of [study]; expected one of its keys, study.KEY"},
        BadOverride{"empty part", "family..m=1", "the key has an empty part; expected one like family.NAME.KEY"},
        BadOverride{"open quote", "family.\"Ward.m",
                    "there is no '='; expected KEY=VALUE, such as study.tolerance=1e-4"},
        BadOverride{"misspelt key", "study.tolerence=1e-3",
                    "unknown key 'tolerence' in [study]; did you mean 'tolerance'?"},
        BadOverride{"misspelt parameter", "family.Ward.lable=x",
                    "model 'ward' has no parameter 'lable'; did you mean 'label'?"},
        BadOverride{"key of a number", "family.\"Cook-Torrance 1.0\".m.count=4",
                    "'m' of main.toml:9 is a number, which has no 'count'; expected a table or a list"},
        BadOverride{"key of a missing table", "material.mixed.factors.0.p=1",
                    "there is no 'factors' in material 'mixed' of main.toml:12; known: name, terms"},
        BadOverride{"place in a list", "material.mixed.terms.2.m=1",
                    "'2' is no place in 'terms' of main.toml:14; expected a whole number from 0 to 1"},
        BadOverride{"value out of range", "family.Ward.m=0",
                    "parameter 'm' of model 'ward' is 0; expected a value in [1e-05, 100]"},
        BadOverride{"value of another kind", "study.tolerance=small", "tolerance is a text; expected a number"}),
    ByName());

TEST_F(Override, ThatIsNoTomlIsRefused) {
  EXPECT_THAT(refusal({"family.Ward.m=[0.1, x]"}), HasSubstr("--set family.Ward.m=[0.1, x]: not valid TOML: "));
  EXPECT_THAT(refusal({"family.Ward.m=1\nb=2"}), HasSubstr("--set family.Ward.m=1 b=2: the value has several lines"));
  EXPECT_THAT(refusal({"family.Ward.m=[" + std::string(200, '1') + "]"}), HasSubstr("--set family.Ward.m=...: "));
}

TEST_F(Override, OfTwoEntriesWithOneNameIsRefused) {
  write("two.toml",
        "[[family]]\nname = \"A\"\nmodel = \"lambert\"\n[[family]]\nname = \"A\"\nmodel = \"phong\"\nn = 1\n");
  const std::vector<std::string> overrides{"family.A.scale=2"};
  EXPECT_EQ(complaint([&] { (void)load_study(folder() / "two.toml", overrides); }, folder()),
            "--set family.A.scale=2: there are 2 [[family]] 'A', at two.toml:1 and two.toml:4; expected one");
}

// --- What results keep.

TEST_F(StudyFolder, WithoutInclusionsAndOverridesKeepsItsTextAsItIs) {
  write("main.toml", std::string("# kept\n") + kMatt);
  EXPECT_EQ(load().configuration, std::string("# kept\n") + kMatt);
}

/// All that results depend on.
void expect_same(const Study& found, const Study& expected) {
  EXPECT_EQ(found.name, expected.name);
  EXPECT_EQ(found.title, expected.title);
  EXPECT_EQ(found.references, expected.references);
  EXPECT_EQ(found.channels, expected.channels);
  EXPECT_EQ(found.lightings, expected.lightings);
  EXPECT_EQ(found.tolerance, expected.tolerance);
  ASSERT_EQ(found.materials.size(), expected.materials.size());
  for (std::size_t i = 0; i < found.materials.size(); ++i) {
    EXPECT_EQ(to_json(*found.materials[i].formula()), to_json(*expected.materials[i].formula())) << i;
  }
  ASSERT_EQ(found.published.size(), expected.published.size());
  for (std::size_t i = 0; i < found.published.size(); ++i) {
    EXPECT_EQ(found.published[i].label, expected.published[i].label) << i;
    EXPECT_EQ(to_json(found.published[i].material), to_json(expected.published[i].material)) << i;
  }
  ASSERT_EQ(found.charts.size(), expected.charts.size());
  for (std::size_t i = 0; i < found.charts.size(); ++i) {
    EXPECT_EQ(found.charts[i].x, expected.charts[i].x) << i;
    EXPECT_EQ(to_json(found.charts[i].curves.at(0).materials.at(0)),
              to_json(expected.charts[i].curves.at(0).materials.at(0)))
        << i;
  }
}

/// The study of its configuration alone, in another folder.
Study repeated(const Study& study) {
  const TemporaryDirectory directory;
  write_text(directory.path() / "other.toml", true, study.configuration);
  return load_study(directory.path() / "other.toml");
}

TEST_F(StudyFolder, IsRepeatedFromTheOneTextThatItsResultsKeep) {
  write("a.toml",
        "[study]\nreferences = [\"Ward: \\\"Measuring\\\", 1992\"]\n[[family]]\nname = \"a \\\\ \\u00e4.\"\n"
        "model = \"custom\"\nformula = '''\nrho / pi\n* pow(cos_h, n)'''\nrho = 0.1\nn = [1, 2.5e-7, 1e20]\n"
        "[[published]]\ntitle = \"T\"\nquantity = \"albedo\"\nmodel = \"lambert\"\ntheta = \"$t\"\n"
        "columns = [\"t\", \"printed\"]\nrows = [[0, \"1.00\"], [30, \"1.00\"]]\n");
  write("main.toml",
        std::string("include = [\"a.toml\"]\n[study]\nchannels = [\"r\", \"g\"]\n") + kMatt +
            "scale = [0.1, 0.30000000000000004]\n[[family]]\nname = \"F\"\nterms = [{model = \"ward\", "
            "m = {logspace = [0.1, 1], count = 3}}]\nadjustments = [\"normalise\"]\n[[chart]]\nname = "
            "\"c\"\nquantity = \"albedo\"\nlog_x = true\ncurves = [{label = \"x\", model = \"lambert\"}]\n");
  const Study study = load({"study.tolerance=1e-3", "study.title=\"A title\""});
  EXPECT_THAT(study.configuration,
              HasSubstr("# What main.toml says, with a.toml, --set study.tolerance, --set study.title;"));
  expect_same(repeated(study), study);
}

TEST_F(StudyFolder, OfEveryStudyThatComesWithLobeIsRepeatedFromOneText) {
  for (const char* name : {"classical-families", "merl-fits", "published-tables", "albedo-figures", "metals"}) {
    const fs::path path = fs::path(LOBE_STUDIES_DIRECTORY) / (std::string(name) + ".toml");
    SCOPED_TRACE(name);
    const std::vector<std::string> overrides{"study.tolerance=1e-3"};
    const Study study = load_study(path, overrides);
    EXPECT_NE(study.configuration, read_text(path));
    expect_same(repeated(study), study);
  }
}

// --- Where things come from.

TEST_F(StudyFolder, SaysTheRowOfATableAndTheLineOfEverythingElse) {
  write("main.toml", R"([study]
comparison_metrics = [
  "ngan-l2",
  "cube-root",
]

[[family]]
name = "T"
model = "ward"
m = "$m"
columns = ["name", "m"]
rows = [
  ["a", 0.1],
  ["b", 0.2],
]

[[published]]
title = "P"
quantity = "albedo"
model = "lambert"
theta = 0
columns = ["printed"]
rows = [["1.0"],
        ["1.00"]]

[[published]]
title = "Q"
quantity = "albedo"
model = "lambert"
theta = 0
printed = "1.0"
)");
  const StudyOrigins origins = load().origins;
  EXPECT_THAT(texts(origins.materials), ElementsAre("main.toml:13", "main.toml:14"));
  EXPECT_THAT(texts(origins.lightings), ElementsAre("default", "default"));
  EXPECT_THAT(texts(origins.comparison_metrics), ElementsAre("main.toml:3", "main.toml:4"));
  EXPECT_THAT(texts(origins.published), ElementsAre("main.toml:23", "main.toml:24", "main.toml:26"));
  EXPECT_THAT(origins.charts, IsEmpty());
}

}  // namespace
}  // namespace lobe::test
