// Content of a report's page; tests/cli/report_browser_test.cpp shows it in a browser.
#include "lobe/study/report_page.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <nlohmann/json.hpp>
#include <random>
#include <string>
#include <utility>
#include <vector>

#include "core/files.hpp"
#include "lobe/core/error.hpp"
#include "lobe/model/specification.hpp"
#include "lobe/study/study_results.hpp"
#include "plot/png.hpp"
#include "study/write/study_hdf5.hpp"
#include "support/device.hpp"
#include "support/png.hpp"
#include "support/temporary_directory.hpp"
#include "synthetic_study.hpp"

namespace lobe::test {
namespace {

using nlohmann::json;
using ::testing::HasSubstr;
using ::testing::Not;

constexpr const char* kHostile =
    "</script><script>alert(1)</script> <!-- <script> ]]> \xE2\x80\xA8 & \" ' {{data}} \xff";

StudyResult read_again(const StudyResult& result) {
  const TemporaryDirectory directory;
  const auto path = directory.path() / "synthetic.h5";
  write_text(path, false, study_table(result, "lobe run synthetic.toml", "2001-02-03T04:05:06Z"));
  return load_study_results(path);
}

std::size_t count_of(const std::string& text, const std::string& part) {
  std::size_t count = 0;
  for (std::size_t at = text.find(part); at != std::string::npos; at = text.find(part, at + 1)) ++count;
  return count;
}

std::string without_scripts(std::string page) {
  const std::string end = "</script>";
  for (std::size_t at = page.find("<script"); at != std::string::npos; at = page.find("<script", at)) {
    page.erase(at, page.find(end, at) + end.size() - at);
  }
  return page;
}

json data_of(const std::string& page) {
  const std::string mark = "<script id=\"data\" type=\"application/json\">";
  const std::size_t begin = page.find(mark) + mark.size();
  return json::parse(page.substr(begin, page.find("</script>", begin) - begin));
}

/// Entry of a lower triangle.
double entry(const json& triangle, std::size_t i, std::size_t j) {
  return triangle.at(i * (i - 1) / 2 + j).get<double>();
}

TEST(ReportPage, LoadsNothing) {
  const std::string page = report_page(read_again(synthetic_study()));
  // A picture of no bytes, so that browsers do not ask for one.
  EXPECT_THAT(page, HasSubstr("<link rel=\"icon\" href=\"data:,\">"));
  EXPECT_THAT(page, HasSubstr("default-src 'none'"));
  const std::string frame = without_scripts(page);
  EXPECT_EQ(count_of(frame, " src="), 0U);
  EXPECT_EQ(count_of(frame, " href="), 1U);
  EXPECT_EQ(count_of(frame, "url("), 0U);
  EXPECT_EQ(count_of(frame, "@import"), 0U);
}

TEST(ReportPage, EndsEveryElementThatItBegins) {
  const std::string page = report_page(read_again(synthetic_study()));
  EXPECT_EQ(page.find("<!DOCTYPE html>"), 0U);
  for (const std::string tag : {"script", "style", "section", "details", "main", "body", "html"}) {
    const std::size_t begun = count_of(page, "<" + tag + ">") + count_of(page, "<" + tag + " ");
    EXPECT_EQ(begun, count_of(page, "</" + tag + ">")) << tag;
    EXPECT_GT(begun, 0U) << tag;
  }
  EXPECT_THAT(page, Not(HasSubstr("{{")));
}

TEST(ReportPage, HasTheLicenceOfItsLibrary) {
  const std::string page = report_page(read_again(synthetic_study()));
  EXPECT_THAT(page, HasSubstr("Redistributions in binary form must reproduce"));
  EXPECT_THAT(page, HasSubstr("d3js.org v5"));
}

TEST(ReportPage, HoldsTheDistancesWithinTheirErrors) {
  const StudyResult result = synthetic_study();
  const json data = data_of(report_page(read_again(result)));
  ASSERT_EQ(data.at("measures").size(), 4U);
  const json& measure = data.at("measures").at(1);
  EXPECT_EQ(measure.at("name"), "daylight");
  EXPECT_EQ(measure.at("unit"), "sr^0.5");
  for (Eigen::Index i = 1; i < 6; ++i) {
    SCOPED_TRACE(i);
    for (Eigen::Index j = 0; j < i; ++j) {
      const auto row = static_cast<std::size_t>(i);
      const auto column = static_cast<std::size_t>(j);
      const double error = result.metrics[1].combined.distance_error(i, j);
      EXPECT_NEAR(entry(measure.at("distance"), row, column), result.metrics[1].combined.distance(i, j), 0.1 * error)
          << j;
      EXPECT_NEAR(entry(measure.at("distance_error"), row, column), error, 0.05 * error) << j;
    }
  }
}

TEST(ReportPage, HasTreeMapAndApproximationsOfEveryLighting) {
  const json data = data_of(report_page(read_again(synthetic_study())));
  for (const json& measure : data.at("measures")) {
    SCOPED_TRACE(measure.at("name").get<std::string>());
    EXPECT_EQ(measure.at("leaf_order").size(), 6U);
    EXPECT_EQ(measure.at("merges").size(), 5U);
    EXPECT_EQ(measure.at("map").at("points").size(), 6U);
    EXPECT_EQ(measure.at("approximations").size(), measure.at("is_lighting").get<bool>() ? 2U : 0U);
  }
  EXPECT_EQ(data.at("measures").at(0).at("approximations").at(1).at("fit"), "non-negative");
  EXPECT_EQ(data.at("agreement").at("metrics").size(), 4U);
}

TEST(ReportPage, HasEveryChannelUnlessAllAreTheSame) {
  StudyResult results = read_again(synthetic_study());
  auto& albedo = results.curves[4].albedo;
  auto& reflectance = results.curves[4].reflectance;
  albedo = {albedo[0], albedo[0], albedo[1]};
  reflectance = {reflectance[0], reflectance[0], reflectance[1]};
  const json three = data_of(report_page(results)).at("curves").at("materials").at(4).at("channels");
  ASSERT_EQ(three.size(), 3U);
  EXPECT_EQ(three[1], three[0]);
  EXPECT_NE(three[2], three[0]);

  albedo[2] = albedo[0];
  reflectance[2] = reflectance[0];
  EXPECT_EQ(data_of(report_page(results)).at("curves").at("materials").at(4).at("channels").size(), 1U);
}

TEST(ReportPage, ComparesMaterials) {
  StudyResult results;
  results.study.name = "figures";
  try {
    (void)report_page(results);
    FAIL() << "not refused";
  } catch (const ArgumentError& error) {
    EXPECT_STREQ(error.what(), "study 'figures' has no materials; expected one with distances");
  }
}

TEST(ReportPage, IsTheSameOfResultsThatWereNotWritten) {
  StudyResult result = synthetic_study();
  json computed = data_of(report_page(result));
  json read = data_of(report_page(read_again(result)));
  computed.erase("provenance");
  read.erase("provenance");
  EXPECT_EQ(computed, read);
}

TEST(ReportPage, HasTheCurves) {
  const StudyResult result = synthetic_study();
  const json curves = data_of(report_page(read_again(result))).at("curves");
  ASSERT_EQ(curves.at("materials").size(), 6U);
  const json& channel = curves.at("materials").at(4).at("channels").at(1);
  EXPECT_NEAR(channel.at("albedo").at(2).get<double>(), result.curves[4].albedo[1][2].value, 1e-4);
  EXPECT_NEAR(channel.at("reflectance").at(1).at(3).get<double>(), result.curves[4].reflectance[1][1][3].value, 1e-2);
  EXPECT_TRUE(curves.at("materials").at(1).at("has_delta").get<bool>());
}

TEST(ReportPage, HasNoCurvesOfOlderFiles) {
  StudyResult result = synthetic_study();
  result.curves.clear();
  EXPECT_TRUE(data_of(report_page(read_again(result))).at("curves").is_null());
}

TEST(ReportPage, SaysWhereMaterialsAndMetricsComeFrom) {
  StudyResult results = read_again(synthetic_study());
  EXPECT_TRUE(data_of(report_page(results)).at("materials").at(1).at("origin").is_null()) << "as in older files";
  StudyOrigins& origins = results.study.origins;
  origins.materials.resize(6);
  origins.materials[2] = {"a.toml", 12, "m=0.1", {}};
  origins.lightings = {{}, {"a.toml", 3, "", {}}};
  results.study.overrides = {"family.Ward.m=0.1"};
  const json data = data_of(report_page(results));
  EXPECT_EQ(data.at("materials").at(2).at("origin"), "a.toml:12 (m=0.1)");
  EXPECT_EQ(data.at("materials").at(1).at("origin"), "default");
  EXPECT_EQ(data.at("measures").at(1).at("origin"), "a.toml:3");
  EXPECT_EQ(data.at("provenance").at("overrides"), json({"family.Ward.m=0.1"}));
}

TEST(ReportPage, TakesHostileNamesForText) {
  StudyResult result = synthetic_study();
  const std::string plain = report_page(read_again(result));
  result.study.title = kHostile;
  result.study.comment = kHostile;
  result.study.configuration = kHostile;
  for (auto& material : result.study.materials) {
    Material formula = *material.formula();
    formula.name += kHostile;
    formula.family += kHostile;
    material = formula;
  }
  result.study.overrides = {kHostile};
  result.study.origins.materials.resize(result.study.materials.size(), {kHostile, 1, kHostile, {kHostile}});
  const std::string page = report_page(read_again(result));
  // Scripts begin and end as often as they did, and nothing else became one.
  EXPECT_EQ(count_of(page, "<script"), count_of(plain, "<script"));
  EXPECT_EQ(count_of(page, "</script"), count_of(plain, "</script"));
  EXPECT_EQ(count_of(page, "<!--"), count_of(plain, "<!--"));
  const auto name = data_of(page).at("materials").at(0).at("name").get<std::string>();
  EXPECT_THAT(name, HasSubstr("</script><script>alert(1)</script>"));
  EXPECT_THAT(name, HasSubstr("{{data}}"));
}

TEST(ReportPage, GivesNoCommandWhereNoneGivesTheSameNumbers) {
  StudyResult result = synthetic_study();
  // Weights 0.25 and 0.75: only the study itself weighs channels so.
  json data = data_of(report_page(read_again(result)));
  EXPECT_TRUE(data.at("materials").at(0).at("operand").is_null());
  EXPECT_EQ(data.at("measures").at(0).at("arguments"), "--lighting point --tolerance 1e-06");
  EXPECT_TRUE(data.at("measures").at(2).at("arguments").is_null()) << "comparison metrics";
  result.study.channel_weights = {0.5, 0.5};
  data = data_of(report_page(read_again(result)));
  EXPECT_EQ(data.at("materials").at(0).at("operand"), "phong:n=1,scale=0.5/0.3333333333333333");
  result.study.materials[0] = {result.study.materials[0].label(), MaterialFile{"felt.binary", "felt.binary", {}}};
  result.files = {R"({"name": "felt", "file": "felt.binary"})", "", "", "", "", ""};
  data = data_of(report_page(read_again(result)));
  EXPECT_EQ(data.at("materials").at(0).at("file"), "felt.binary");
  EXPECT_TRUE(data.at("measures").at(0).at("arguments").is_null()) << "files are measured as functions";
}

TEST(ReportPage, SaysOnWhatGridAndHowPreciselyToComputeAgain) {
  StudyResult result = synthetic_study();
  result.study.grid = HemisphereGrid::gauss(8, 16);
  result.study.precision = Precision::single_precision;
  const json data = data_of(report_page(read_again(result)));
  EXPECT_EQ(data.at("measures").at(0).at("arguments"),
            "--lighting point --tolerance 1e-06 --grid gauss:8x16 --allow-unresolved --precision single");
}

ReportSpheres spheres_of(std::size_t count) {
  ReportSpheres spheres(count);
  for (std::size_t k = 1; k < count; ++k) {
    spheres[k] = DisplayedSphere{.size = 2, .rgb = std::vector<std::uint8_t>(12, static_cast<std::uint8_t>(k))};
  }
  return spheres;
}

TEST(ReportPage, HasTheSpheresOfMaterialsInTheirOrder) {
  const StudyResult result = synthetic_study();
  const ReportSpheres spheres = spheres_of(result.study.materials.size());
  const json data = data_of(report_page(result, spheres)).at("spheres");
  ASSERT_EQ(data.size(), spheres.size());
  EXPECT_TRUE(data.at(0).is_null());
  EXPECT_EQ(data.at(2), "data:image/png;base64," + base64(png_file(2, 2, spheres[2]->rgb)));
  EXPECT_NE(data.at(1), data.at(2));
}

TEST(ReportPage, HasNoSpheresUnlessGiven) {
  EXPECT_EQ(data_of(report_page(synthetic_study())).at("spheres"), json::array());
}

TEST(ReportPage, RefusesSpheresOfAnotherNumber) {
  EXPECT_THROW((void)report_page(synthetic_study(), spheres_of(2)), ArgumentError);
}

class ReportSpheresTest : public ::testing::Test {
 protected:
  /// The spheres of some materials.
  [[nodiscard]] ReportSpheres spheres(const std::vector<std::string>& materials, std::vector<std::string> channels) {
    StudyResult result = synthetic_study();
    result.study.channels = std::move(channels);
    result.study.materials.clear();
    for (const auto& material : materials) result.study.materials.push_back(parse_material(material));
    return report_spheres(device(), result);
  }
};

// The exposure is that at which the median over this sphere is shown at half of the display's range.
TEST_F(ReportSpheresTest, OfTheGreyReferenceIsAtHalfTheRange) {
  const auto sphere = spheres({"lambert:scale=0.5"}, {"value"}).at(0);
  ASSERT_TRUE(sphere);
  ASSERT_EQ(sphere->size, kReportSphereSize);
  std::vector<int> levels;
  const double middle = (static_cast<double>(sphere->size) - 1) / 2;
  for (std::size_t row = 0; row < sphere->size; ++row) {
    for (std::size_t column = 0; column < sphere->size; ++column) {
      const double distance = std::hypot(static_cast<double>(row) - middle, static_cast<double>(column) - middle);
      if (distance < middle) levels.push_back(sphere->rgb.at(3 * (row * sphere->size + column)));
    }
  }
  std::ranges::sort(levels);
  // 255 / 2, with one level for rounding and two for the pixels of the rim, which are left out here.
  EXPECT_NEAR(levels.at(levels.size() / 2), 127.5, 3.5);
}

TEST_F(ReportSpheresTest, HaveTheColoursOfTheChannels) {
  const auto sphere = spheres({"lambert:scale=0.8/0.4/0.1"}, {"red", "green", "blue"}).at(0);
  ASSERT_TRUE(sphere);
  const std::size_t centre = 3 * (sphere->size / 2 * sphere->size + sphere->size / 2);
  EXPECT_GT(sphere->rgb.at(centre), sphere->rgb.at(centre + 1));
  EXPECT_GT(sphere->rgb.at(centre + 1), sphere->rgb.at(centre + 2));
}

TEST_F(ReportSpheresTest, AreLeftOutForFilesAndLobesTooNarrowForThePixels) {
  StudyResult result = synthetic_study();
  result.study.channels = {"value"};
  result.study.materials = {parse_material("lambert"), parse_material("phong:n=1e10"), StudyMaterial(MaterialLabel{})};
  const ReportSpheres found = report_spheres(device(), result);
  ASSERT_EQ(found.size(), 3U);
  EXPECT_TRUE(found[0]);
  EXPECT_FALSE(found[1]);
  EXPECT_FALSE(found[2]);
}

TEST_F(ReportSpheresTest, AreLeftOutOfStudiesOfManyMaterials) {
  EXPECT_EQ(spheres(std::vector<std::string>(kMostReportSpheres + 1, "lambert"), {"value"}).size(), 0U);
}

TEST_F(ReportSpheresTest, AreCancelled) {
  StudyResult result = synthetic_study();
  result.study.channels = {"value"};
  result.study.materials = {parse_material("lambert")};
  EXPECT_THROW((void)report_spheres(device(), result, [](std::string_view, double) { return false; }), Cancelled);
}

TEST(PngFile, HasThePixels) {
  constexpr std::size_t kSize = 37;
  std::mt19937 generator(7);
  std::vector<std::uint8_t> rgb(3 * kSize * kSize);
  for (auto& byte : rgb) byte = static_cast<std::uint8_t>(generator());
  const TemporaryDirectory directory;
  const auto path = directory.path() / "noise.png";
  write_text(path, false, png_file(kSize, kSize, rgb));
  const Png read = read_png(path);
  EXPECT_EQ(read.width, kSize);
  EXPECT_EQ(read.height, kSize);
  EXPECT_EQ(read.channels, 3U);
  EXPECT_EQ(read.bytes, rgb);
}

// RFC 4648, section 10.
TEST(Base64, IsThatOfTheStandard) {
  EXPECT_EQ(base64(""), "");
  EXPECT_EQ(base64("f"), "Zg==");
  EXPECT_EQ(base64("fo"), "Zm8=");
  EXPECT_EQ(base64("foo"), "Zm9v");
  EXPECT_EQ(base64("foobar"), "Zm9vYmFy");
  EXPECT_EQ(base64("\xff\xfe\xfd"), "//79");
}

TEST(ReportPage, OfAHundredMaterialsIsBelowThreeMegabytes) {
  StudyResult result = synthetic_study(50);
  result.curve_angles = CurveAngles::usual();
  for (std::size_t i = 0; i < result.curves.size(); ++i) {
    const double base = 0.1234567 * static_cast<double>(i + 1);
    MaterialCurves& curves = result.curves[i];
    curves.albedo.assign(2, std::vector<Estimate>(result.curve_angles.theta.size(), {base, 1e-5}));
    curves.reflectance.assign(2, {3, std::vector<Estimate>(result.curve_angles.theta_out.size(), {base, 1e-12})});
  }
  EXPECT_LT(report_page(read_again(result)).size(), 3'000'000U);
}

}  // namespace
}  // namespace lobe::test
