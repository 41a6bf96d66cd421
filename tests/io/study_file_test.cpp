#include <gtest/gtest.h>

#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <numbers>
#include <ostream>
#include <set>
#include <string>
#include <vector>

#include "core/files.hpp"
#include "io/load_text.hpp"
#include "lobe/core/error.hpp"
#include "lobe/study/study.hpp"
#include "support/device.hpp"
#include "support/names.hpp"
#include "support/temporary_directory.hpp"

namespace lobe::test {
namespace {

namespace fs = std::filesystem;

std::vector<std::string> names(const Study& study) {
  std::vector<std::string> list;
  for (const auto& material : study.materials) list.push_back(material.name());
  return list;
}

TEST(LoadStudy, FillsInWhatTheFileLeavesOut) {
  const Study study = load_text("[[material]]\nname = \"a\"\nmodel = \"lambert\"\n");
  EXPECT_EQ(study.name, "file");
  EXPECT_EQ(study.title, "file");
  EXPECT_EQ(study.channels, std::vector<std::string>{"value"});
  EXPECT_EQ(study.channel_weights, std::vector<double>{1});
  EXPECT_EQ(study.lightings, (std::vector<Lighting>{Lighting::point(), Lighting::daylight()}));
  EXPECT_EQ(study.tolerance, 1e-6);
  EXPECT_EQ(study.precision, Precision::double_precision);
  EXPECT_EQ(study.clustering.clusters, 0U);
  EXPECT_EQ(study.clustering.neighbours, 3U);
  EXPECT_EQ(study.patch_tolerance, MetricOptions{}.patch_tolerance);
  EXPECT_TRUE(study.comparison_metrics.empty());
  EXPECT_EQ(study.comparison_tolerance, LiteratureOptions{}.tolerance);
  EXPECT_TRUE(study.approximations.empty());
  EXPECT_EQ(study.materials.front().family(), "Lambert");
}

TEST(LoadStudy, ReadsTheStudyTable) {
  const std::string text = R"([study]
name = "mine"
title = "My study"
comment = "none"
references = ["A", "B"]
channels = ["r", "g"]
channel_weights = [1, 2]
lightings = ["daylight"]
tolerance = 1e-4
precision = "single"
clusters = 1
neighbours = 5
patch_tolerance = 1e-2
comparison_metrics = ["cube-root", "ngan-l2"]
comparison_tolerance = 3e-3
domain_theta_max = 80
approximations = ["non-negative"]

[[material]]
name = "a"
family = "flat"
model = "lambert"
scale = [0.2, 0.4]
)";
  const Study study = load_text(text);
  EXPECT_EQ(study.name, "mine");
  EXPECT_EQ(study.title, "My study");
  EXPECT_EQ(study.references, (std::vector<std::string>{"A", "B"}));
  EXPECT_EQ(study.channels, (std::vector<std::string>{"r", "g"}));
  EXPECT_EQ(study.channel_weights, (std::vector<double>{1, 2}));
  EXPECT_EQ(study.lightings, std::vector<Lighting>{Lighting::daylight()});
  EXPECT_EQ(study.tolerance, 1e-4);
  EXPECT_EQ(study.precision, Precision::single_precision);
  EXPECT_EQ(study.clustering.clusters, 1U);
  EXPECT_EQ(study.clustering.neighbours, 5U);
  EXPECT_EQ(study.patch_tolerance, 1e-2);
  EXPECT_EQ(study.comparison_metrics,
            (std::vector<LiteratureMetric>{LiteratureMetric::cube_root, LiteratureMetric::ngan_l2}));
  EXPECT_EQ(study.comparison_tolerance, 3e-3);
  EXPECT_NEAR(study.domain_theta_max, 80 * std::numbers::pi / 180, 1e-15);
  EXPECT_EQ(study.approximations, std::vector<FamilyFit>{FamilyFit::non_negative});
  EXPECT_EQ(study.configuration, text);
  EXPECT_EQ(study.materials.front().family(), "flat");
  EXPECT_EQ(study.materials.front().formula()->terms.front().weight, (std::vector<double>{0.2, 0.4}));
}

TEST(LoadStudy, WeighsChannelsAlikeByDefault) {
  const Study study =
      load_text("study.channels = [\"r\", \"g\", \"b\", \"x\"]\n[[material]]\nname = \"a\"\nmodel = \"lambert\"\n");
  EXPECT_EQ(study.channel_weights, std::vector<double>(4, 0.25));
}

TEST(LoadStudy, SweepsAListedParameter) {
  const Study study = load_text("[[family]]\nname = \"P\"\nmodel = \"phong\"\nn = [1, 2.5, 1e4]\n");
  EXPECT_EQ(names(study), (std::vector<std::string>{"P n=1", "P n=2.5", "P n=10000"}));
  EXPECT_EQ(study.materials[1].formula()->terms.front().values, std::vector<double>{2.5});
}

TEST(LoadStudy, SweepsALogarithmicRangeWithExactEnds) {
  const Study study = load_text("[[family]]\nname = \"P\"\nmodel = \"phong\"\nn = {logspace = [1, 1000], count = 4}\n");
  EXPECT_EQ(names(study), (std::vector<std::string>{"P n=1", "P n=10", "P n=100", "P n=1000"}));
  EXPECT_EQ(study.materials.front().formula()->terms.front().values.front(), 1);
  EXPECT_EQ(study.materials.back().formula()->terms.front().values.front(), 1000);
  EXPECT_NEAR(study.materials[1].formula()->terms.front().values.front(), 10, 1e-14 * 10);
}

TEST(LoadStudy, SweepsALinearRange) {
  const Study study = load_text("[[family]]\nname = \"W\"\nmodel = \"ward\"\nm = {linspace = [0.1, 0.5], count = 3}\n");
  EXPECT_EQ(names(study), (std::vector<std::string>{"W m=0.1", "W m=0.3", "W m=0.5"}));
}

TEST(LoadStudy, MultipliesSweepsTheLastParameterFastest) {
  const Study study =
      load_text("[[family]]\nname = \"C\"\nmodel = \"cook_torrance\"\nf0 = {values = [0.5, 1]}\nm = [0.1, 0.2]\n");
  EXPECT_EQ(names(study),
            (std::vector<std::string>{"C m=0.1, f0=0.5", "C m=0.1, f0=1", "C m=0.2, f0=0.5", "C m=0.2, f0=1"}));
}

TEST(LoadStudy, ZipsSweeps) {
  const Study study = load_text(
      "[[family]]\nname = \"C\"\nmodel = \"cook_torrance\"\nf0 = [0.5, 1]\nm = [0.1, 0.2]\nzip = true\n"
      "label = \"{f0} at {m} of {family}\"\n");
  EXPECT_EQ(names(study), (std::vector<std::string>{"0.5 at 0.1 of C", "1 at 0.2 of C"}));
}

TEST(LoadStudy, TellsNearValuesOfARangeApart) {
  const Study study =
      load_text("[[family]]\nname = \"W\"\nmodel = \"ward\"\nm = {linspace = [0.1, 0.10001], count = 3}\n");
  EXPECT_EQ(names(study), (std::vector<std::string>{"W m=0.1", "W m=0.100005", "W m=0.10001"}));
}

TEST(LoadStudy, ReadsATableOfFits) {
  const Study study = load_text(R"(study.channels = ["r", "g"]
[[family]]
name = "Ward"
terms = [{model = "lambert", scale = "$kd"}, {model = "ward", m = "$m", scale = "2 * $ks"}]
columns = ["name", "kd", "ks", "m"]
rows = [
  ["blue", [0.1, 0.2], [0.3, 0.4], 0.05],
  ["red", 0.5, [0.1, 0], 0.2],
]
)");
  EXPECT_EQ(names(study), (std::vector<std::string>{"Ward blue", "Ward red"}));
  const auto& terms = study.materials.front().formula()->terms;
  ASSERT_EQ(terms.size(), 2U);
  EXPECT_EQ(terms[0].weight, (std::vector<double>{0.1, 0.2}));
  EXPECT_EQ(terms[1].weight, (std::vector<double>{0.6, 0.8}));
  EXPECT_EQ(terms[1].values, std::vector<double>{0.05});
  EXPECT_EQ(study.materials[1].formula()->terms[0].weight, std::vector<double>{0.5});
}

TEST(LoadStudy, KeepsFileOrderAndFamiliesTogether) {
  const Study study = load_text(R"([[material]]
name = "first"
family = "A"
model = "lambert"
[[family]]
name = "B"
model = "phong"
n = 3
[[material]]
name = "last"
family = "A"
model = "phong"
n = 2
)");
  EXPECT_EQ(names(study), (std::vector<std::string>{"first", "last", "B"}));
}

// --- Materials that are files.

/// A folder with two files of measurements of Lambertian surfaces.
class MeasuredStudy : public ::testing::Test {
 protected:
  MeasuredStudy() {
    write_text(folder() / "a.csv", false, "1, 1, 0, 0, 0, 0, 0, 1\n");
    write_text(folder() / "b.csv", false, "1, 1, 0, 0, 0, 0, 0, 0.5\n");
  }

  [[nodiscard]] fs::path folder() const { return directory_.path(); }

  [[nodiscard]] Study load(const std::string& text) const {
    write_text(folder() / "study.toml", true, text);
    return load_study(folder() / "study.toml");
  }

  void expect_complaint(const std::string& text, const std::string& complaint) const {
    try {
      (void)load(text);
      FAIL() << "not refused; expected '" << complaint << "'";
    } catch (const ArgumentError& error) {
      EXPECT_NE(std::string(error.what()).find(complaint), std::string::npos) << error.what();
    }
  }

 private:
  TemporaryDirectory directory_;
};

TEST_F(MeasuredStudy, NamesEveryFileOfAPattern) {
  const Study study = load(R"(
[[family]]
name = "Lambert"
model = "lambert"
[[measured]]
family = "plates"
files = ["*.csv"]
label = "{family} {name}"
theta_max = 80
)");
  EXPECT_EQ(names(study), (std::vector<std::string>{"Lambert", "plates a", "plates b"}));
  ASSERT_EQ(study.materials.size(), 3U);
  EXPECT_EQ(study.materials[0].file(), nullptr);
  EXPECT_EQ(study.materials[2].file()->path, folder() / "b.csv");
  EXPECT_EQ(study.materials[2].file()->name, "b.csv");
  EXPECT_NEAR(study.materials[2].file()->options.theta_max, 80 * std::numbers::pi / 180, 1e-15);
}

TEST_F(MeasuredStudy, TakesFilesAsLights) {
  const Study study = load(
      "[study]\nlightings = [\"material:a.csv\", \"material:phong:n=5\"]\n"
      "[[material]]\nname = \"b\"\nmodel = \"lambert\"\n");
  ASSERT_EQ(study.lightings.size(), 2U);
  EXPECT_NE(study.lightings[0].material().function(), nullptr);
  EXPECT_FALSE(study.lightings[0].is_told_by_name());
  EXPECT_EQ(study.lightings[1], parse_lighting("material:phong:n=5"));
}

TEST_F(MeasuredStudy, TakesTheNamesOfFoldersAsTheyAre) {
  const fs::path odd = folder() / "set [a-c]*?";
  fs::create_directory(odd);
  fs::create_directory(folder() / "set a");  // what a pattern of this name would match
  write_text(odd / "plate.csv", false, "1, 1, 0, 0, 0, 0, 0, 1\n");
  write_text(odd / "study.toml", false, "[[measured]]\nfiles = \"*.csv\"\n");
  EXPECT_EQ(names(load_study(odd / "study.toml")), std::vector<std::string>{"plate"});

  ASSERT_EQ(setenv("LOBE_TEST_PLATES", odd.c_str(), 1), 0);
  EXPECT_EQ(names(load("[[measured]]\nfiles = \"$LOBE_TEST_PLATES/p*.csv\"\n")), std::vector<std::string>{"plate"});
  unsetenv("LOBE_TEST_PLATES");
}

TEST_F(MeasuredStudy, FindsFilesByEnvironmentVariable) {
  ASSERT_EQ(setenv("LOBE_TEST_PLATES", folder().c_str(), 1), 0);
  const Study study = load("[[measured]]\nfile = \"$LOBE_TEST_PLATES/a.csv\"\nname = \"plate\"\n");
  unsetenv("LOBE_TEST_PLATES");
  EXPECT_EQ(names(study), std::vector<std::string>{"plate"});
  EXPECT_EQ(study.materials[0].file()->name, "$LOBE_TEST_PLATES/a.csv");
  expect_complaint("[[measured]]\nfile = \"$LOBE_TEST_PLATES/a.csv\"\n", "LOBE_TEST_PLATES of");
}

TEST_F(MeasuredStudy, TakesChannelsByNumber) {
  const Study study = load("[[measured]]\nfile = \"a.csv\"\nchannels = [1, \"red\"]\n");
  EXPECT_EQ(study.materials[0].file()->options.channels, (std::vector<std::string>{"1", "red"}));
  expect_complaint("[[measured]]\nfile = \"a.csv\"\nchannels = [0]\n", "study.toml:3:13: channels has the number 0");
  expect_complaint("[[measured]]\nfile = \"a.csv\"\nchannels = [1.5]\n", "study.toml:3:13");
  expect_complaint("[[measured]]\nfile = \"a.csv\"\nchannels = []\n", "channels is empty");
}

TEST_F(MeasuredStudy, TakesOptionsOfOneFileInBrackets) {
  const Study study = load(R"(
[[measured]]
files = ["a.csv[theta_max=70]", "[b-c].csv[channels=2]"]
theta_max = 80
luminance = "rec709"
[[measured]]
file = "b.csv[component=reflection back]"
name = "back"
)");
  EXPECT_EQ(names(study), (std::vector<std::string>{"a", "b", "back"}));
  EXPECT_NEAR(study.materials[0].file()->options.theta_max, 70 * std::numbers::pi / 180, 1e-15);
  EXPECT_EQ(study.materials[0].file()->options.luminance, "rec709");
  EXPECT_EQ(study.materials[0].file()->name, "a.csv");
  EXPECT_NEAR(study.materials[1].file()->options.theta_max, 80 * std::numbers::pi / 180, 1e-15);
  EXPECT_EQ(study.materials[1].file()->options.luminance, "");
  EXPECT_EQ(study.materials[1].file()->options.channels, std::vector<std::string>{"2"});
  EXPECT_EQ(study.materials[2].file()->options.component, "reflection back");
  expect_complaint("[[measured]]\nfiles = [\"*.csv[theta_mx=80]\"]\n",
                   "study.toml:2:10: '*.csv[theta_mx=80]', character 7");
  expect_complaint("[[measured]]\nfile = \"a.csv[theta_mx=80]\"\n", "did you mean 'theta_max'?");

  const Study shader = load("[[measured]]\nfile = \"b.csv\"\nentry = \"f\"\nuniforms = [\"a=1\", \"b=1/2\"]\n");
  EXPECT_EQ(shader.materials[0].file()->options.entry, "f");
  EXPECT_EQ(shader.materials[0].file()->options.uniforms,
            (std::vector<UniformValue>{UniformValue{"a", {1}}, UniformValue{"b", {1, 2}}}));
  expect_complaint("[[measured]]\nfile = \"b.csv\"\nuniforms = [\"a\"]\n", "study.toml:3:13: 'a' sets no uniform");

  write_text(folder() / "a.csv[theta_max=9]", false, "1, 1, 0, 0, 0, 0, 0, 1\n");
  const Study whole = load("[[measured]]\nfiles = [\"a.csv[theta_max=9]\"]\n");
  EXPECT_EQ(whole.materials[0].file()->path.filename(), "a.csv[theta_max=9]");
  EXPECT_FALSE(has_choices(whole.materials[0].file()->options));
}

TEST_F(MeasuredStudy, RefusesWhatItCannotFind) {
  expect_complaint("[[measured]]\nfiles = \"*.binary\"\n", "study.toml:2:9: no file matches");
  expect_complaint("[[measured]]\nfiles = []\n", "files is empty");
  expect_complaint("[[measured]]\nfamily = \"x\"\n", "expected one");
  expect_complaint("[[measured]]\nfile = \"a.csv\"\nlabel = \"x\"\n", "expected 'name'");
  expect_complaint("[[measured]]\nfile = \"a.csv\"\ntheta_max = 100\n", "at most 90");
  expect_complaint("[study]\ngrid = \"gauss\"\n[[measured]]\nfile = \"a.csv\"\n", "study.toml:2:8");
  expect_complaint("[[measured]]\nfile = \"a.csv\"\n[[measured]]\nfile = \"a.csv\"\n", "exists already");
}

TEST_F(MeasuredStudy, IsMeasuredOnItsGridAndNamesTheNearestModels) {
  const Study study = load(R"(
[study]
name = "plates"
grid = "gauss:8x16"
neighbours = 1
comparison_metrics = ["bieron-l2"]
[[measured]]
files = "*.csv"
[[family]]
name = "Phong"
model = "phong"
n = [1, 3]
[[material]]
name = "matt"
model = "lambert"
)");
  const StudyResult result = run_study(device(), study);
  // f = a/(2 pi), so that a = 1 is half a Lambertian surface, |f - 1/pi| = 1/2.
  const Metric& point = result.metrics[0].combined;
  EXPECT_NEAR(point.norm(0), 0.5, 1e-12);
  EXPECT_NEAR(point.distance(0, 4), 0.5, 1e-12);
  EXPECT_NEAR(point.distance(0, 1), 0.25, 1e-12);
  EXPECT_NE(result.files[0].find("NIST Zernike coefficients"), std::string::npos);
  EXPECT_TRUE(result.files[4].empty());

  const StudyFiles files = write_study(result, folder() / "out");
  std::ifstream csv(folder() / "out/plates.point.nearest-models.csv");
  std::string header;
  std::string by_distance;
  std::string scaled;
  std::getline(csv, header);
  std::getline(csv, by_distance);
  std::getline(csv, scaled);
  EXPECT_TRUE(by_distance.starts_with("a,distance,1,")) << by_distance;
  EXPECT_TRUE(scaled.starts_with("a,scaled,1,matt,Lambert,0.5")) << scaled;
}

TEST_F(MeasuredStudy, RefusesChannelsThatDoNotFit) {
  write_text(folder() / "spectral.csv", false, "1, 1, 0, 0, 0, 0, 1, 1\n");
  const Study study = load("[[measured]]\nfile = \"spectral.csv\"\nwavelengths = [500, 600]\n");
  try {
    (void)run_study(device(), study);
    FAIL() << "not refused";
  } catch (const ArgumentError& error) {
    EXPECT_STREQ(error.what(),
                 "'spectral' has 2 channels (500 nm, 600 nm) and the study 1; choose some by 'channels', 'wavelengths' "
                 "or 'luminance' of [[measured]], or name those of the study");
  }
}

TEST(LoadMaterial, ReadsATermAndTakesTheNameOfTheFile) {
  const TemporaryDirectory directory;
  const fs::path path = directory.path() / "gloss.toml";
  write_text(path, false,
             "terms = [{model = \"lambert\", scale = 0.3}, {model = \"ward\", m = 0.1, scale = [1, 2]}]\n");
  const Material material = load_material_file(path);
  EXPECT_EQ(material.name, "gloss");
  EXPECT_EQ(material.family, "mixture");
  EXPECT_EQ(material.channels(), 2U);
}

TEST(LoadMaterial, RefusesTermsOfDifferentChannels) {
  const TemporaryDirectory directory;
  const fs::path path = directory.path() / "gloss.toml";
  write_text(path, false,
             "terms = [{model = \"lambert\", scale = [1, 2, 3]}, {model = \"ward\", m = 0.1, scale = [1, 2]}]\n");
  EXPECT_THROW((void)load_material_file(path), ArgumentError);
}

TEST(LoadStudy, FailsForAFileThatIsNotThere) {
  EXPECT_THROW((void)load_study("absent.toml"), IoError);
}

TEST(ClassicalFamilies, HasEightFamilies) {
  const Study study = load_study(fs::path(LOBE_STUDIES_DIRECTORY) / "classical-families.toml");
  std::set<std::string> families;
  for (const auto& material : study.materials) families.insert(material.family());
  EXPECT_EQ(families.size(), 8U);
  EXPECT_EQ(study.materials.size(), 64U);
}

TEST(MerlFits, HasTheFitsOfFourModelsInThreeChannels) {
  const Study study = load_study(fs::path(LOBE_STUDIES_DIRECTORY) / "merl-fits.toml");
  ASSERT_EQ(study.materials.size(), 344U);
  EXPECT_EQ(study.channels.size(), 3U);
  const Material& first = *study.materials.front().formula();
  EXPECT_EQ(first.name, "Ward blue-acrylic");
  EXPECT_EQ(first.terms[0].weight, (std::vector<double>{0.0138, 0.0326, 0.0636}));
  EXPECT_EQ(first.terms[1].weight, (std::vector<double>{0.00774, 0.00547, 0.00339}));
  EXPECT_EQ(first.terms[1].values, std::vector<double>{0.0162});
}

TEST(MerlFits, CarriesFourOverPiInCookTorrance) {
  const Study study = load_study(fs::path(LOBE_STUDIES_DIRECTORY) / "merl-fits.toml");
  const Material& material = *study.materials[172].formula();
  ASSERT_EQ(material.name, "Cook-Torrance blue-acrylic");
  EXPECT_EQ(material.terms[1].weight[0], 0.0291 * (4 / std::numbers::pi));
  EXPECT_EQ(material.terms[1].values, (std::vector<double>{0.0137, 0.117}));
}

TEST(LoadStudy, ReadsFormulasWithTheirParametersAndPlace) {
  const Study study = load_text(
      "[[material]]\nname = \"a\"\nmodel = \"custom\"\nn = 4\nrho = 0.3\nwidth = 0.5\n"
      "reciprocal = false\nscale = 2\nformula = \"rho / pi * pow(cos_h, n)\"\n");
  const Material& material = *study.materials.at(0).formula();
  EXPECT_EQ(material.family, "custom");
  const Term& term = material.terms.at(0);
  ASSERT_TRUE(term.formula);
  EXPECT_EQ(term.formula->text, "rho / pi * pow(cos_h, n)");
  EXPECT_EQ(term.formula->parameters, (std::vector<std::string>{"n", "rho"}));
  EXPECT_EQ(term.values, (std::vector<double>{4, 0.3}));
  EXPECT_EQ(term.weight, std::vector<double>{2});
  EXPECT_EQ(term.formula->width, 0.5);
  EXPECT_FALSE(term.formula->reciprocal);
  EXPECT_EQ(term.formula->line, 9U);
  EXPECT_EQ(term.formula->column, 12U);
}

TEST(LoadStudy, SweepsAFormula) {
  const Study study = load_text(
      "[[family]]\nname = \"F\"\nmodel = \"custom\"\nformula = \"pow(cos_h, n)\"\nn = [1, 2]\n"
      "factors = [{name = \"cos_max\", p = 0.5}]\nadjustments = [\"normalise\"]\n");
  EXPECT_EQ(names(study), (std::vector<std::string>{"F n=1", "F n=2"}));
  EXPECT_EQ(study.materials[1].formula()->terms[0].values, std::vector<double>{2});
  EXPECT_EQ(study.materials[1].formula()->terms[0].factors.at(0).values, std::vector<double>{0.5});
  EXPECT_EQ(study.materials[1].formula()->adjustments, std::vector{Adjustment{}});
}

TEST(LoadStudy, SplitsTermsWhoseParametersDifferByChannel) {
  const Study study = load_text(
      "[study]\nchannels = [\"r\", \"g\"]\n[[material]]\nname = \"a\"\nmodel = \"ward\"\n"
      "m = [0.1, 0.2]\nscale = [0.5, 1]\n");
  const auto& terms = study.materials.at(0).formula()->terms;
  ASSERT_EQ(terms.size(), 2U);
  EXPECT_EQ(terms[0].weight, (std::vector<double>{0.5, 0}));
  EXPECT_EQ(terms[1].weight, (std::vector<double>{0, 1}));
  EXPECT_EQ(terms[1].values, std::vector<double>{0.2});
  EXPECT_EQ(study.materials[0].family(), "Ward");
}

/// A study file with one mistake.
struct BadFile {
  std::string name;
  std::string text;
  std::string place;    ///< LINE:COLUMN
  std::string message;  ///< a part of it
};

std::ostream& operator<<(std::ostream& out, const BadFile& file) {
  return out << file.name;
}

class BadStudyFile : public ::testing::TestWithParam<BadFile> {};

TEST_P(BadStudyFile, IsRefusedWithPlaceAndReasonInOneLine) {
  const TemporaryDirectory directory;
  const fs::path path = directory.path() / "bad.toml";
  write_text(path, false, GetParam().text);
  try {
    (void)load_study(path);
    FAIL() << "no error";
  } catch (const ArgumentError& error) {
    const std::string message = error.what();
    EXPECT_EQ(message.find(path.string() + ":" + GetParam().place + ": "), 0U) << message;
    EXPECT_NE(message.find(GetParam().message), std::string::npos) << message;
    EXPECT_EQ(message.find('\n'), std::string::npos) << message;
  }
}

std::string phong_head() {
  return "[[family]]\nname = \"P\"\nmodel = \"phong\"\n";
}

std::string table_head() {
  return "[[family]]\nname = \"T\"\nterms = [{model = \"ward\", m = \"$m\", scale = \"$k\"}]\ncolumns = [\"name\", "
         "\"k\", "
         "\"m\"]\n";
}

std::string good_material() {
  return "[[material]]\nname = \"a\"\nmodel = \"lambert\"\n";
}

INSTANTIATE_TEST_SUITE_P(
    Mistakes, BadStudyFile,
    ::testing::Values(
        BadFile{"malformed", "[study]\nname = \n", "2:8", "not valid TOML"},
        BadFile{"unclosed list", "[study]\nname = \"a\"\nlightings = [\"point\"\n", "3:22", "not valid TOML"},
        // toml++ 3.3 ends the process at these, or does anything.
        BadFile{"table without a name", "[study]\n[!x]\n", "2:2", "not valid TOML"},
        BadFile{"four brackets", "[[[[ffaa", "1:3", "not valid TOML"},
        BadFile{"letter of another alphabet where a name begins", "[study]\n\u0130 = 1\n", "2:1", "not valid TOML"},
        BadFile{"letter of another alphabet behind a value", "[study]\nname = \"a\" \u00e9\n", "2:12",
                "not valid TOML"},
        BadFile{"duplicate key", "[study]\nname = \"a\"\nname = \"b\"\n", "3:8", "not valid TOML"},
        BadFile{"empty", "", "1:1", "study has no material"},
        BadFile{"formula without text", "[[material]]\nname = \"a\"\nmodel = \"custom\"\n", "1:1", "no 'formula'"},
        BadFile{"parameter that a formula does not use",
                "[[material]]\nname = \"a\"\nmodel = \"custom\"\nrho = 1\nn = 2\nformula = \"rho / pi\"\n", "6:11",
                "the formula does not use the parameter 'n'"},
        BadFile{"parameter with the name of a quantity",
                "[[material]]\nname = \"a\"\nmodel = \"custom\"\ncos_i = 1\nformula = \"cos_i\"\n", "5:11",
                "'cos_i' of a formula has the name of a quantity of the geometry"},
        BadFile{"width of a formula",
                "[[material]]\nname = \"a\"\nmodel = \"custom\"\nwidth = 2\nformula = \"cos_i\"\n", "5:11",
                "expected a value in (0, 1] rad"},
        BadFile{"unknown factor", good_material() + "factors = [{name = \"cosmax\"}]\n", "4:12",
                "did you mean 'cos_max'?"},
        BadFile{"factor without name", good_material() + "factors = [{p = 1}]\n", "4:12", "no 'name'"},
        BadFile{"too many factors",
                good_material() +
                    "factors = [{name = \"cos_max\"}, {name = \"cos_max\"}, {name = \"cos_max\"}, {name = "
                    "\"cos_max\"}]\n",
                "4:11", "factors has 4 entries; expected at most 3"},
        BadFile{"unknown adjustment", good_material() + "adjustments = [\"normalize\"]\n", "4:16",
                "did you mean 'normalise'?"},
        BadFile{"parameters for too many channels", "[[material]]\nname = \"a\"\nmodel = \"ward\"\nm = [0.1, 0.2]\n",
                "4:5", "'m' has 2 values; expected one number, or a list of 1, one per channel (a [[family]] sweeps)"},
        BadFile{"unknown table", "[stduy]\n" + good_material(), "1:2", "did you mean 'study'?"},
        BadFile{"unknown key", "[study]\nlighting = [\"point\"]\n" + good_material(), "2:1",
                "did you mean 'lightings'?"},
        BadFile{"wrong type", "[study]\ntolerance = \"small\"\n" + good_material(), "2:13",
                "tolerance is a text; expected a number"},
        BadFile{"patch tolerance", "[study]\npatch_tolerance = 0.5\n" + good_material(), "2:19",
                "patch_tolerance is 0.5; expected a value in [1e-12, 0.1]"},
        BadFile{"unknown comparison", "[study]\ncomparison_metrics = [\"ngan\", \"nagn-l2\"]\n" + good_material(),
                "2:23", "unknown comparison metric 'ngan'"},
        BadFile{"misspelt comparison", "[study]\ncomparison_metrics = [\"nagn-l2\"]\n" + good_material(), "2:23",
                "did you mean 'ngan-l2'?"},
        BadFile{"comparison twice", "[study]\ncomparison_metrics = [\"low-l2\", \"low-l2\"]\n" + good_material(),
                "2:33", "'low-l2' is listed twice in comparison_metrics; expected it once"},
        BadFile{"comparisons are no list", "[study]\ncomparison_metrics = \"low-l2\"\n" + good_material(), "2:22",
                "comparison_metrics is a text; expected a list"},
        BadFile{"unknown approximation", "[study]\napproximations = [\"liner\"]\n" + good_material(), "2:19",
                "unknown approximation 'liner'; did you mean 'linear'?"},
        BadFile{"study is no table", "study = 3\n" + good_material(), "1:9", "'study' is a number; expected a table"},
        BadFile{"tolerance out of range", "[study]\ntolerance = 2\n" + good_material(), "2:13",
                "expected a value in [1e-12, 0.1]"},
        BadFile{"tolerance not finite", "[study]\ntolerance = nan\n" + good_material(), "2:13",
                "tolerance is not finite"},
        BadFile{"precision", "[study]\nprecision = \"half\"\n" + good_material(), "2:13",
                "expected \"double\" or \"single\""},
        BadFile{"domain out of range", "[study]\ndomain_theta_max = 100\n" + good_material(), "2:20", "at most 90"},
        BadFile{"domain under patch lights",
                "[study]\nlightings = [\"patch:0.5\"]\ndomain_theta_max = 80\n" + good_material(), "3:20",
                "expected point, daylight or mean-albedo"},
        BadFile{"unknown lighting", "[study]\nlightings = [\"point\", \"dailight\"]\n" + good_material(), "2:23",
                "did you mean 'daylight'?"},
        BadFile{"lighting twice", "[study]\nlightings = [\"point\", \"point\"]\n" + good_material(), "2:23",
                "listed twice"},
        BadFile{"no lighting", "[study]\nlightings = []\n" + good_material(), "2:13", "lightings is empty"},
        BadFile{"no channel", "[study]\nchannels = []\n" + good_material(), "2:12", "channels is empty"},
        BadFile{"channel twice", "[study]\nchannels = [\"r\", \"r\"]\n" + good_material(), "2:18",
                "channel 'r' is listed twice"},
        BadFile{"weights", "[study]\nchannel_weights = [1, 1]\n" + good_material(), "2:19", "has 2 values; expected 1"},
        BadFile{"negative weight", "[study]\nchannel_weights = [-1]\n" + good_material(), "2:19", "negative weight"},
        BadFile{"no clusters", "[study]\nclusters = 0\n" + good_material(), "2:12", "clusters is 0; expected a whole"},
        BadFile{"half a cluster", "[study]\nclusters = 2.5\n" + good_material(), "2:12", "clusters is 2.5; expected"},
        BadFile{"more clusters than materials", "[study]\nclusters = 2\n" + good_material(), "2:12",
                "clusters is 2; expected at most 1"},
        BadFile{"neighbours as text", "[study]\nneighbours = \"all\"\n" + good_material(), "2:14",
                "neighbours is a text; expected a whole"},
        BadFile{"name with slash", "[study]\nname = \"a/b\"\n" + good_material(), "2:8", "no stem of file names"},
        BadFile{"empty name", "[study]\nname = \" \"\n" + good_material(), "2:8", "name is empty"},
        BadFile{"family as table", "[family]\nname = \"P\"\n", "1:1", "expected tables headed [[family]]"},
        BadFile{"no family name", "[[family]]\nmodel = \"lambert\"\n", "1:1", "[[family]] has no 'name'"},
        BadFile{"no model", "[[family]]\nname = \"P\"\n", "1:1", "[[family]] has no 'model'"},
        BadFile{"unknown model", "[[family]]\nname = \"P\"\nmodel = \"fong\"\n", "3:9", "unknown model 'fong'"},
        BadFile{"unknown parameter", phong_head() + "n = 1\nexponent = 2\n", "5:1",
                "model 'phong' has no parameter 'exponent'"},
        BadFile{"misspelt key", phong_head() + "n = 1\nlable = \"x\"\n", "5:1", "did you mean 'label'?"},
        BadFile{"missing parameter", phong_head(), "3:9", "needs the parameter 'n'"},
        BadFile{"value out of range", phong_head() + "n = [1, -3]\n", "4:5", "parameter 'n' of model 'phong' is -3"},
        BadFile{"empty sweep", phong_head() + "n = []\n", "4:5", "sweeps over no values"},
        BadFile{"empty values", phong_head() + "n = {values = []}\n", "4:15", "sweeps over no values"},
        BadFile{"sweep of text", phong_head() + "n = [1, \"2\"]\n", "4:9", "is a text; expected a number"},
        BadFile{"text for number", phong_head() + "n = \"2\"\n", "4:5", "expected a number, a list of numbers"},
        BadFile{"count missing", phong_head() + "n = {logspace = [1, 10]}\n", "4:5", "has no 'count'"},
        BadFile{"count zero", phong_head() + "n = {logspace = [1, 10], count = 0}\n", "4:34",
                "expected a whole number from 2"},
        BadFile{"count broken", phong_head() + "n = {logspace = [1, 10], count = 2.5}\n", "4:34",
                "expected a whole number"},
        BadFile{"logspace of zero", phong_head() + "n = {logspace = [0, 10], count = 3}\n", "4:17",
                "expected positive ends"},
        BadFile{"three ends", phong_head() + "n = {linspace = [1, 2, 3], count = 3}\n", "4:17", "expected two"},
        BadFile{"two ranges", phong_head() + "n = {linspace = [1, 2], logspace = [1, 2], count = 3}\n", "4:5",
                "expected one"},
        BadFile{"range key", phong_head() + "n = {linspce = [1, 2], count = 3}\n", "4:6", "did you mean 'linspace'?"},
        BadFile{
            "zip lengths",
            "[[family]]\nname = \"C\"\nmodel = \"cook_torrance\"\nm = [0.1, 0.2, 0.3]\nf0 = [0.1, 0.2]\nzip = true\n",
            "5:6", "expects as many"},
        BadFile{"too many",
                "[[family]]\nname = \"C\"\nmodel = \"cook_torrance\"\nm = {linspace = [0.1, 1], count = 1000}\n"
                "f0 = {linspace = [0, 1], count = 1000}\n",
                "1:1", "more than 100000 materials"},
        BadFile{"label placeholder", phong_head() + "n = [1, 2]\nlabel = \"P {m}\"\n", "5:9", "unknown name '{m}'"},
        BadFile{"label brace", phong_head() + "n = [1, 2]\nlabel = \"P {n\"\n", "5:9", "'{' without '}'"},
        BadFile{"labels alike", phong_head() + "n = [1, 2]\nlabel = \"P\"\n", "5:9", "material 'P' exists already"},
        BadFile{"duplicate material", good_material() + good_material(), "5:8",
                "material 'a' exists already, from line 2"},
        BadFile{"duplicate value", phong_head() + "n = [1, 1]\n", "2:8", "material 'P n=1' exists already"},
        BadFile{"material without name", "[[material]]\nmodel = \"lambert\"\n", "1:1", "[[material]] has no 'name'"},
        BadFile{"material without model", "[[material]]\nname = \"a\"\n", "1:1", "neither 'model' nor 'terms'"},
        BadFile{"material sweep", "[[material]]\nname = \"a\"\nmodel = \"phong\"\nn = [1, 2]\n", "4:5",
                "'n' has 2 values; expected one number, or a list of 1, one per channel (a [[family]] sweeps)"},
        BadFile{"no terms", "[[material]]\nname = \"a\"\nterms = []\n", "3:9", "terms is empty"},
        BadFile{"term is no table", "[[material]]\nname = \"a\"\nterms = [\"lambert\"]\n", "3:10",
                "an entry of terms is a text; expected a table"},
        BadFile{"term key", "[[material]]\nname = \"a\"\nterms = [{model = \"lambert\", scal = 1}]\n", "3:30",
                "did you mean 'scale'?"},
        BadFile{"model beside terms",
                "[[material]]\nname = \"a\"\nmodel = \"lambert\"\nterms = [{model = \"lambert\"}]\n", "3:1",
                "unknown key 'model' in [[material]] with 'terms'"},
        BadFile{"scale channels", good_material() + "scale = [1, 2, 3]\n", "4:9",
                "scale has 3 values; expected one number"},
        BadFile{"scale is text", good_material() + "scale = \"big\"\n", "4:9", "scale is a text; expected a number"},
        BadFile{"columns without rows", table_head(), "1:1", "has no 'rows'"},
        BadFile{"no rows", table_head() + "rows = []\n", "5:8", "rows is empty"},
        BadFile{"short row", table_head() + "rows = [\n[\"a\", 1, 0.1],\n[\"b\", 1],\n]\n", "7:1",
                "row has 2 entries; expected 3"},
        BadFile{"cell out of range", table_head() + "rows = [[\"a\", 1, 0]]\n", "5:18",
                "parameter 'm' of model 'ward' is 0"},
        BadFile{"cell of wrong type", table_head() + "rows = [[\"a\", \"x\", 0.1]]\n", "5:15", "scale is a text"},
        BadFile{"cell channels", table_head() + "rows = [[\"a\", [1, 2], 0.1]]\n", "5:15", "scale has 2 values"},
        BadFile{"nameless row", table_head() + "rows = [[1, 1, 0.1]]\n", "5:10", "name is a number"},
        BadFile{"duplicate row", table_head() + "rows = [\n[\"a\", 1, 0.1],\n[\"a\", 1, 0.2],\n]\n", "7:1",
                "material 'T a' exists already, from line 6"},
        BadFile{"unknown column",
                "[[family]]\nname = \"T\"\nterms = [{model = \"ward\", m = \"$rough\"}]\ncolumns = [\"name\", "
                "\"roughness\"]\n"
                "rows = [[\"a\", 0.1]]\n",
                "3:31", "did you mean 'roughness'?"},
        BadFile{"column name missing",
                "[[family]]\nname = \"T\"\nmodel = \"ward\"\nm = \"$m\"\ncolumns = [\"m\"]\nrows = [[0.1]]\n", "5:11",
                "columns has no \"name\""}),
    ByName());

}  // namespace
}  // namespace lobe::test
