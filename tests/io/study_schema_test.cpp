// The schema of study files: what editors accept is what load_study() reads, as far as a schema can see.
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include <filesystem>
#include <memory>
#include <nlohmann/json.hpp>
#include <ostream>
#include <sstream>
#include <string>
#include <valijson/adapters/nlohmann_json_adapter.hpp>
#include <valijson/schema.hpp>
#include <valijson/schema_parser.hpp>
#include <valijson/validator.hpp>
#include <vector>

#include "cli/process.hpp"
#include "core/files.hpp"
#include "lobe/model/model.hpp"
#include "lobe/study/study_schema.hpp"
#include "study/read/toml.hpp"
#include "support/names.hpp"

namespace lobe::test {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::json;

/// As editors see a TOML file.
Json json_of(const std::string& toml) {
  std::ostringstream text;
  text << toml::json_formatter(toml::parse(toml));
  return Json::parse(text.str());
}

/// What the schema has against a study; empty: nothing.
std::string complaints(const std::string& toml) {
  static const auto kSchema = [] {
    auto schema = std::make_unique<valijson::Schema>();
    const Json text = Json::parse(study_schema());
    valijson::SchemaParser(valijson::SchemaParser::kDraft7)
        .populateSchema(valijson::adapters::NlohmannJsonAdapter(text), *schema);
    return schema;
  }();
  const Json study = json_of(toml);
  valijson::Validator validator;
  valijson::ValidationResults results;
  const bool is_valid = validator.validate(*kSchema, valijson::adapters::NlohmannJsonAdapter(study), &results);
  std::string text = is_valid ? "" : "not valid\n";
  for (valijson::ValidationResults::Error error; results.popError(error);) {
    for (const auto& step : error.context) text += step;
    text += ": " + error.description + "\n";
  }
  return is_valid ? "" : text;
}

struct NamedStudy {
  std::string name;
  std::string text;
};
std::ostream& operator<<(std::ostream& out, const NamedStudy& study) {
  return out << study.name;
}

// As the build has written it, to be installed.
TEST(StudySchema, IsTheOneThatComesWithTheCommand) {
  const fs::path share = fs::path(LOBE_COMMAND).parent_path().parent_path() / "share";
  EXPECT_TRUE(read_text(share / "lobe/studies/study.schema.json") == study_schema());
}

TEST(StudySchema, StandsBesideTheStudiesOfTheTree) {
  const fs::path studies(LOBE_STUDIES_DIRECTORY);
  if (access(studies.c_str(), W_OK) != 0) GTEST_SKIP() << "the tree cannot be written";
  EXPECT_TRUE(read_text(studies / "study.schema.json") == study_schema());
}

TEST(StudySchema, IsNamedByEveryStudy) {
  for (const auto& entry : fs::directory_iterator(LOBE_STUDIES_DIRECTORY)) {
    if (entry.path().extension() != ".toml") continue;
    EXPECT_TRUE(read_text(entry.path()).starts_with("#:schema ./study.schema.json\n")) << entry.path();
  }
}

TEST(StudySchema, AcceptsEveryStudyThatComesWithLobe) {
  std::size_t count = 0;
  for (const auto& entry : fs::directory_iterator(LOBE_STUDIES_DIRECTORY)) {
    if (entry.path().extension() != ".toml") continue;
    EXPECT_EQ(complaints(read_text(entry.path())), "") << entry.path();
    ++count;
  }
  EXPECT_GE(count, 6U);
}

/// The blocks of a page that are whole studies: indented by four, TOML, with a [study], a [[family]] and so on.
std::vector<NamedStudy> studies_on(const fs::path& page) {
  std::vector<NamedStudy> studies;
  std::istringstream lines(read_text(page));
  std::string block;
  std::size_t number = 0;
  std::size_t begin = 0;
  const auto finish = [&] {
    for (const char* head : {"[study]", "[[family]]", "[[material]]", "[[measured]]", "[[published]]", "[[chart]]"}) {
      if (block.find(std::string("\n") + head) == std::string::npos) continue;
      studies.push_back({page.stem().string() + "_" + std::to_string(begin), block});
      break;
    }
    block = "\n";
    begin = 0;
  };
  block = "\n";
  for (std::string line; std::getline(lines, line);) {
    ++number;
    if (line.starts_with("    ") && !line.starts_with("    lobe ")) {
      if (begin == 0) begin = number;
      block += line.substr(4) + "\n";
    } else if (line.empty() && begin > 0) {
      block += "\n";
    } else {
      finish();
    }
  }
  finish();
  return studies;
}

TEST(StudySchema, AcceptsTheStudiesOfThePages) {
  std::size_t count = 0;
  for (const char* name : {"study-files.md", "tutorial.md", "formulas.md", "measured-data.md", "published-tables.md"}) {
    for (const auto& study : studies_on(fs::path(LOBE_DOCS_DIRECTORY) / name)) {
      // A page may show a [study] alone.
      const bool has_materials = study.text.find("\n[[") != std::string::npos;
      const std::string whole = has_materials ? study.text : study.text + "[[material]]\nname='a'\nmodel='lambert'\n";
      EXPECT_EQ(complaints(whole), "") << study.name << "\n" << study.text;
      ++count;
    }
  }
  EXPECT_GE(count, 8U);
}

/// Without the # in front of lines that are switched off.
std::string switched_on(const std::string& study) {
  std::istringstream lines(study);
  std::string text;
  for (std::string line; std::getline(lines, line);) {
    const bool is_off = line.size() > 1 && line[0] == '#' && line[1] != ' ' && !line.starts_with("#:schema");
    text += line.substr(is_off ? 1 : 0) + "\n";
  }
  return text;
}

TEST(StudySchema, AcceptsWhatLobeNewStudyWrites) {
  std::string all;
  for (const auto& model : catalogue()) all += (all.empty() ? "" : ",") + std::string(model.name);
  for (const std::vector<std::string>& words :
       {std::vector<std::string>{"new-study"}, std::vector<std::string>{"new-study", "--models", all}}) {
    SCOPED_TRACE(::testing::PrintToString(words));
    const Outcome outcome = run_lobe(words);
    ASSERT_EQ(outcome.status, 0) << outcome.error;
    EXPECT_EQ(complaints(outcome.output), "");
    EXPECT_EQ(complaints(switched_on(outcome.output)), "");
  }
}

TEST(StudySchema, KnowsTheModelsWithTheirParameters) {
  const Json schema = Json::parse(study_schema());
  const auto& models = schema["definitions"]["model"];
  for (const auto& model : catalogue()) {
    EXPECT_THAT(models["properties"]["model"]["enum"], ::testing::Contains(Json(model.name))) << model.name;
    for (const auto& parameter : model.parameters) {
      EXPECT_TRUE(models["properties"].contains(parameter.name)) << parameter.name;
    }
  }
}

class GoodStudy : public ::testing::TestWithParam<NamedStudy> {};

TEST_P(GoodStudy, IsAccepted) {
  EXPECT_EQ(complaints(GetParam().text), "");
}

const std::string kMaterial = "[[material]]\nname = \"a\"\nmodel = \"lambert\"\n";
const std::string kPhong = "[[family]]\nname = \"P\"\nmodel = \"phong\"\n";

INSTANTIATE_TEST_SUITE_P(
    Studies, GoodStudy,
    ::testing::Values(
        NamedStudy{"lights",
                   "[study]\nlightings = [\"patch:0.25\", \"mixture:0.25=0.3,1=.7\", "
                   "\"density:0=1,0.5=2,2=0\", \"material:phong:n=20\", \"mean-albedo\"]\n" +
                       kMaterial},
        NamedStudy{"a formula",
                   "[[material]]\nname = \"a\"\nmodel = \"custom\"\nrho = 0.4\nlabel_ = 2\n"
                   "formula = \"rho / pi + label_\"\nwidth = 0.2\nreciprocal = true\n"},
        NamedStudy{"a curve", "[[material]]\nname = \"a\"\nmodel = \"profile\"\npoints = [[0, 4], [2, 0]]\n"},
        NamedStudy{"factors and adjustments",
                   kMaterial + "factors = [{name = \"fresnel\", ior = 1.5, k = 0}]\nadjustments = [\"pump:times=2\", "
                               "\"mirror:ior=1.5,k=0\", \"normalise\", \"pump:correction=g2,times=1\"]\n"},
        NamedStudy{
            "a value per channel",
            "[study]\nchannels = [\"r\", \"g\"]\n[[material]]\nname = \"a\"\nmodel = \"ward\"\nm = [0.1, 0.2]\n"},
        NamedStudy{"ranges", kPhong + "n = {logspace = [1, 100], count = 5}\nlabel = \"{n}\"\nscale = 0.5\n"},
        NamedStudy{"a chart of mean albedos",
                   "[[chart]]\nname = \"a\"\nquantity = \"mean-albedo\"\nparameter = \"m\"\n"
                   "x = {logspace = [0.1, 1], count = 3}\ncurves = [{label = \"w\", model = \"ward\"}]\n"},
        NamedStudy{"a chart over the viewer",
                   "[[chart]]\nname = \"a\"\nquantity = \"radiance\"\ncurves = [{label = \"w\", theta_in = 30, terms = "
                   "[{model = \"ward\", m = 0.1}, {model = \"lambert\"}]}]\n"}),
    ByName());

class BadStudy : public ::testing::TestWithParam<NamedStudy> {};

TEST_P(BadStudy, IsRefused) {
  EXPECT_NE(complaints(GetParam().text), "");
}

std::string chart(const std::string& text) {
  return "[[chart]]\nname = \"a\"\n" + text;
}
std::string published(const std::string& text) {
  return "[[published]]\ntitle = \"T\"\nmodel = \"lambert\"\n" + text;
}
const std::string kCurves = "curves = [{label = \"a\", model = \"lambert\"}]\n";
const std::string kFits =
    "[[family]]\nname = \"T\"\nterms = [{model = \"ward\", m = \"$m\"}]\ncolumns = [\"name\", \"m\"]\n";

// Those of BadStudyFile, LoadChartRefuses and LoadPublishedRefuses that a schema can see.
INSTANTIATE_TEST_SUITE_P(
    Mistakes, BadStudy,
    ::testing::Values(
        NamedStudy{"empty", ""},  //
        NamedStudy{"unknown table", "[stduy]\n" + kMaterial},
        NamedStudy{"unknown key", "[study]\nlighting = [\"point\"]\n" + kMaterial},
        NamedStudy{"study is no table", "study = 3\n" + kMaterial},
        NamedStudy{"family as table", "[family]\nname = \"P\"\nmodel = \"lambert\"\n"},
        NamedStudy{"wrong type", "[study]\ntolerance = \"small\"\n" + kMaterial},
        NamedStudy{"patch tolerance", "[study]\npatch_tolerance = 0.5\n" + kMaterial},
        NamedStudy{"tolerance out of range", "[study]\ntolerance = 2\n" + kMaterial},
        NamedStudy{"misspelt comparison", "[study]\ncomparison_metrics = [\"nagn-l2\"]\n" + kMaterial},
        NamedStudy{"comparison twice", "[study]\ncomparison_metrics = [\"low-l2\", \"low-l2\"]\n" + kMaterial},
        NamedStudy{"comparisons are no list", "[study]\ncomparison_metrics = \"low-l2\"\n" + kMaterial},
        NamedStudy{"unknown approximation", "[study]\napproximations = [\"liner\"]\n" + kMaterial},
        NamedStudy{"domain", "[study]\ndomain_theta_max = 100\n" + kMaterial},
        NamedStudy{"precision", "[study]\nprecision = \"half\"\n" + kMaterial},
        NamedStudy{"unknown lighting", "[study]\nlightings = [\"point\", \"dailight\"]\n" + kMaterial},
        NamedStudy{"light of a table", "[study]\nlightings = [\"table:sky.h5\"]\n" + kMaterial},
        NamedStudy{"material missing", "[study]\nlightings = [\"material:\"]\n" + kMaterial},
        NamedStudy{"radius missing", "[study]\nlightings = [\"patch\"]\n" + kMaterial},
        NamedStudy{"lighting twice", "[study]\nlightings = [\"point\", \"point\"]\n" + kMaterial},
        NamedStudy{"no lighting", "[study]\nlightings = []\n" + kMaterial},
        NamedStudy{"no channel", "[study]\nchannels = []\n" + kMaterial},
        NamedStudy{"channel twice", "[study]\nchannels = [\"r\", \"r\"]\n" + kMaterial},
        NamedStudy{"negative weight", "[study]\nchannel_weights = [-1]\n" + kMaterial},
        NamedStudy{"no weight", "[study]\nchannel_weights = [0]\n" + kMaterial},
        NamedStudy{"no clusters", "[study]\nclusters = 0\n" + kMaterial},
        NamedStudy{"half a cluster", "[study]\nclusters = 2.5\n" + kMaterial},
        NamedStudy{"neighbours as text", "[study]\nneighbours = \"all\"\n" + kMaterial},
        NamedStudy{"name with slash", "[study]\nname = \"a/b\"\n" + kMaterial},
        NamedStudy{"empty name", "[study]\nname = \" \"\n" + kMaterial},
        NamedStudy{"odd azimuths", "[study]\ngrid = \"gauss:8x15\"\n" + kMaterial},
        NamedStudy{"group of one", kPhong + "n = [1, 2]\nzip = [[\"n\"]]\n"},
        NamedStudy{"unknown grid", "[study]\ngrid = \"gaus:8x16\"\n" + kMaterial},
        NamedStudy{"no family name", "[[family]]\nmodel = \"lambert\"\n"},
        NamedStudy{"no model", "[[family]]\nname = \"P\"\n"},
        NamedStudy{"unknown model", "[[family]]\nname = \"P\"\nmodel = \"fong\"\n"},
        NamedStudy{"unknown parameter", kPhong + "n = 1\nexponent = 2\n"},
        NamedStudy{"parameter of another model", kPhong + "n = 1\nm = 2\n"},
        NamedStudy{"misspelt key", kPhong + "n = 1\nlable = \"x\"\n"}, NamedStudy{"missing parameter", kPhong},  //
        NamedStudy{"value out of range", kPhong + "n = [1, -3]\n"}, NamedStudy{"empty sweep", kPhong + "n = []\n"},
        NamedStudy{"empty values", kPhong + "n = {values = []}\n"},
        NamedStudy{"sweep of text", kPhong + "n = [1, \"2\"]\n"}, NamedStudy{"text for number", kPhong + "n = \"2\"\n"},
        NamedStudy{"count missing", kPhong + "n = {logspace = [1, 10]}\n"},
        NamedStudy{"count zero", kPhong + "n = {logspace = [1, 10], count = 0}\n"},
        NamedStudy{"count broken", kPhong + "n = {logspace = [1, 10], count = 2.5}\n"},
        NamedStudy{"logspace of zero", kPhong + "n = {logspace = [0, 10], count = 3}\n"},
        NamedStudy{"three ends", kPhong + "n = {linspace = [1, 2, 3], count = 3}\n"},
        NamedStudy{"two ranges", kPhong + "n = {linspace = [1, 2], logspace = [1, 2], count = 3}\n"},
        NamedStudy{"range key", kPhong + "n = {linspce = [1, 2], count = 3}\n"},
        NamedStudy{"material without name", "[[material]]\nmodel = \"lambert\"\n"},
        NamedStudy{"material without model", "[[material]]\nname = \"a\"\n"},
        NamedStudy{"material with a range", "[[material]]\nname = \"a\"\nmodel = \"phong\"\nn = {values = [1, 2]}\n"},
        NamedStudy{"material with a column", "[[material]]\nname = \"a\"\nmodel = \"phong\"\nn = \"$n\"\n"},
        NamedStudy{"material with a label", kMaterial + "label = \"b\"\n"},
        NamedStudy{"no terms", "[[material]]\nname = \"a\"\nterms = []\n"},
        NamedStudy{"term is no table", "[[material]]\nname = \"a\"\nterms = [\"lambert\"]\n"},
        NamedStudy{"term key", "[[material]]\nname = \"a\"\nterms = [{model = \"lambert\", scal = 1}]\n"},
        NamedStudy{"model beside terms",
                   "[[material]]\nname = \"a\"\nmodel = \"lambert\"\nterms = [{model = \"lambert\"}]\n"},
        NamedStudy{"scale is text", kMaterial + "scale = \"big\"\n"},
        NamedStudy{"formula without text", "[[material]]\nname = \"a\"\nmodel = \"custom\"\n"},
        NamedStudy{"width of a formula",
                   "[[material]]\nname = \"a\"\nmodel = \"custom\"\nwidth = 2\nformula = \"cos_i\"\n"},
        NamedStudy{"curve without points", "[[material]]\nname = \"a\"\nmodel = \"profile\"\n"},
        NamedStudy{"unknown factor", kMaterial + "factors = [{name = \"cosmax\"}]\n"},
        NamedStudy{"parameter of a factor", kMaterial + "factors = [{name = \"lacquer\", p = 1}]\n"},
        NamedStudy{"factor without name", kMaterial + "factors = [{p = 1}]\n"},
        NamedStudy{"too many factors", kMaterial + "factors = [{name = \"cos_max\"}, {name = \"cos_max\"}, {name = "
                                                   "\"cos_max\"}, {name = \"cos_max\"}]\n"},
        NamedStudy{"unknown adjustment", kMaterial + "adjustments = [\"normalize\"]\n"},
        NamedStudy{"columns without rows", kFits},  //
        NamedStudy{"no rows", kFits + "rows = []\n"},
        NamedStudy{"column name missing",
                   "[[family]]\nname = \"T\"\nmodel = \"ward\"\nm = \"$m\"\ncolumns = [\"m\"]\nrows = [[0.1]]\n"},
        NamedStudy{"file and files", "[[measured]]\nfile = \"a.csv\"\nfiles = \"*.csv\"\n"},
        NamedStudy{"no file", "[[measured]]\nfamily = \"a\"\n"},
        NamedStudy{"label of a file", "[[measured]]\nfile = \"a.csv\"\nlabel = \"b\"\n"},
        NamedStudy{"theta_max", "[[measured]]\nfile = \"a.csv\"\ntheta_max = 100\n"},
        NamedStudy{"chart quantity", chart("quantity = \"albdo\"\n" + kCurves)},
        NamedStudy{"chart without quantity", chart(kCurves)},
        NamedStudy{"chart without curves", chart("quantity = \"albedo\"\n")},
        NamedStudy{"empty curves", chart("quantity = \"albedo\"\ncurves = []\n")},
        NamedStudy{"curve without label", chart("quantity = \"albedo\"\ncurves = [{model = \"lambert\"}]\n")},
        NamedStudy{"curve without parameter",
                   chart("quantity = \"albedo\"\ncurves = [{label = \"a\", model = \"ward\"}]\n")},
        NamedStudy{"chart key", chart("quantity = \"albedo\"\ny_rnge = [0, 1]\n" + kCurves)},
        NamedStudy{"chart tolerance", chart("quantity = \"albedo\"\ntolerance = 1\n" + kCurves)},
        NamedStudy{"useless parameter", chart("quantity = \"albedo\"\nparameter = \"m\"\n" + kCurves)},
        NamedStudy{"useless angle",
                   chart("quantity = \"albedo\"\ncurves = [{label = \"a\", model = \"lambert\", theta_in = 3}]\n")},
        NamedStudy{"no viewer angle", chart("quantity = \"radiance\"\n" + kCurves)},
        NamedStudy{"viewer angle",
                   chart("quantity = \"radiance\"\ncurves = [{label = \"a\", model = \"lambert\", theta_in = 90}]\n")},
        NamedStudy{"logarithm of angles",
                   chart("quantity = \"radiance\"\nlog_x = true\ncurves = [{label = \"a\", model = \"lambert\", "
                         "theta_in = 9}]\n")},
        NamedStudy{"no swept parameter", chart("quantity = \"mean-albedo\"\nx = [1, 2]\n" + kCurves)},
        NamedStudy{"no abscissae", chart("quantity = \"mean-albedo\"\nparameter = \"R\"\n" + kCurves)},
        NamedStudy{"chart name", "[[chart]]\nname = \"b/c\"\nquantity = \"albedo\"\n" + kCurves},
        NamedStudy{"published quantity", published("quantity = \"albdo\"\nprinted = \"1\"\n")},
        NamedStudy{"published without quantity", published("printed = \"1\"\n")},
        NamedStudy{"not printed", published("quantity = \"constant\"\n")},
        NamedStudy{"no number", published("quantity = \"constant\"\nprinted = \"1/pi\"\n")},
        NamedStudy{"number instead of text", published("quantity = \"constant\"\nprinted = 1.5\n")},
        NamedStudy{"no angle", published("quantity = \"albedo\"\nprinted = \"1\"\n")},
        NamedStudy{"angle of the horizon", published("quantity = \"albedo\"\ntheta = 90\nprinted = \"1\"\n")},
        NamedStudy{"angle of a constant", published("quantity = \"constant\"\ntheta = 30\nprinted = \"1\"\n")},
        NamedStudy{"no directions", published("quantity = \"reflectance\"\nprinted = \"1\"\n")},
        NamedStudy{"two angles", published("quantity = \"reflectance\"\nat = [[0, 1]]\nprinted = \"1\"\n")},
        NamedStudy{"published key", published("quantity = \"constant\"\nprinted = \"1\"\nprintd = \"1\"\n")}),
    ByName());

}  // namespace
}  // namespace lobe::test
