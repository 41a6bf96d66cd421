// The commands that measure materials: product, norm, distance, angle, gram, distance-matrix.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <fstream>
#include <iterator>
#include <nlohmann/json.hpp>
#include <numbers>
#include <sstream>

#include "cli/command_test.hpp"
#include "lobe/core/directions.hpp"

namespace lobe::test {
namespace {

using cli::ExitCode;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::StartsWith;

const std::string kA = "lambert:scale=0.3+ward:m=0.4,scale=0.5";
const std::string kB = "phong:n=5";

class Measures : public CommandTest {
 protected:
  void write(const std::string& name, const std::string& text) const { std::ofstream(file(name)) << text; }
  [[nodiscard]] std::string read(const std::string& name) const {
    std::ifstream stream(file(name));
    return {std::istreambuf_iterator<char>(stream), {}};
  }
  /// A study of two families and a material, in two channels of unlike weights.
  [[nodiscard]] std::string study() const {
    write("study.toml",
          "[study]\nchannels = [\"r\", \"g\"]\nchannel_weights = [3, 1]\n"
          "[[family]]\nname = \"Phong, wide\"\nmodel = \"phong\"\nn = [2, 5]\nscale = [0.5, 1]\n"
          "[[family]]\nname = \"Ward\"\nmodel = \"ward\"\nm = [0.3, 0.5]\n"
          "[[material]]\nname = \"paper\"\nmodel = \"lambert\"\nfamily = \"matt\"\n");
    return "study.toml";
  }
};

double value(const Json& estimate) {
  return estimate["value"];
}
double error(const Json& estimate) {
  return estimate["error"];
}

/// Within the stated error, which keeps to the tolerance.
/// \param expected above 0
void expect_about(const Json& estimate, double expected) {
  EXPECT_NEAR(value(estimate), expected, error(estimate) + 1e-14 * expected);
  EXPECT_LE(error(estimate), 1e-6 * expected);
}

std::vector<std::string> names_of(const Json& answer) {
  std::vector<std::string> names;
  for (const auto& material : answer["materials"]) names.push_back(material["name"]);
  return names;
}

/// The lines of a table without quoted fields, cell by cell.
std::vector<Words> cells_of(const std::string& csv) {
  std::vector<Words> lines;
  std::istringstream stream(csv);
  for (std::string line; std::getline(stream, line);) {
    lines.emplace_back();
    std::istringstream cells(line);
    for (std::string cell; std::getline(cells, cell, ',');) lines.back().push_back(cell);
  }
  return lines;
}

void expect_symmetric(const Json& matrix) {
  for (std::size_t i = 0; i < matrix.size(); ++i) {
    ASSERT_EQ(matrix[i].size(), matrix.size()) << i;
    for (std::size_t j = 0; j < i; ++j) EXPECT_EQ(matrix[i][j], matrix[j][i]) << i << ", " << j;
  }
}

TEST_F(Measures, ProductOfLambertWithItselfIsOne) {
  expect_about(json({"product", "lambert", "lambert"})["product"], 1);
  expect_about(json({"norm", "lambert:scale=0.5"})["norm"], 0.5);
  expect_about(json({"product", "lambert", "lambert", "--lighting", "daylight"})["product"], std::numbers::pi);
}

TEST_F(Measures, CommandsPrintOneNumberWithItsError) {
  for (const char* command : {"product", "distance", "angle"}) {
    SCOPED_TRACE(command);
    const auto outcome = make({command, kA, kB});
    EXPECT_THAT(outcome.output, ::testing::MatchesRegex("[0-9.]+ ± [0-9.e-]+\n")) << command;
    EXPECT_THAT(outcome.error, IsEmpty());
  }
  EXPECT_THAT(make({"norm", kA}).output, ::testing::MatchesRegex("[0-9.]+ ± [0-9.e-]+\n"));
}

TEST_F(Measures, ProductDistanceAndAngleGiveTheSameJsonButForTheSchema) {
  Json product = json({"product", kA, kB});
  Json distance = json({"distance", kA, kB});
  Json angle = json({"angle", kA, kB});

  EXPECT_EQ(product["schema"], "lobe.product/1");
  EXPECT_EQ(angle["schema"], "lobe.angle/1");
  product.erase("schema");
  distance.erase("schema");
  angle.erase("schema");
  EXPECT_EQ(product, distance);
  EXPECT_EQ(angle, distance);
}

TEST_F(Measures, NormIsThatOfTheOtherCommands) {
  const Json norm = json({"norm", kA, "--lighting", "daylight"});
  const Json pair = json({"distance", kA, kB, "--lighting", "daylight"});

  EXPECT_NEAR(value(norm["norm"]), value(pair["norm_a"]), error(norm["norm"]) + error(pair["norm_a"]));
  EXPECT_EQ(norm["units"]["norm"], "sr^1/2");
}

TEST_F(Measures, MatricesHoldWhatThePairCommandsSay) {
  const Json gram = json({"gram", kA, kB, "lambert"})["lightings"][0];
  const Json distances = json({"distance-matrix", kA, kB, "lambert"})["lightings"][0];
  const Json pair = json({"distance", kA, kB});

  EXPECT_NEAR(gram["gram"][0][1], value(pair["product"]),
              gram["gram_error"][0][1].get<double>() + error(pair["product"]));
  EXPECT_NEAR(distances["distance"][0][1], value(pair["distance"]),
              distances["distance_error"][0][1].get<double>() + error(pair["distance"]));
  EXPECT_NEAR(std::sqrt(gram["gram"][1][1].get<double>()), value(pair["norm_b"]), 1e-6);
}

TEST_F(Measures, MatricesAreSymmetricForEveryLighting) {
  const Words materials{kA, kB, "lambert", "ward:m=0.3"};
  for (const char* command : {"gram", "distance-matrix"}) {
    SCOPED_TRACE(command);
    Words words{command, "--lighting", "point", "--lighting", "daylight", "--lighting", "mean-albedo"};
    words.insert(words.end(), materials.begin(), materials.end());
    const Json answer = json(words);

    ASSERT_EQ(answer["lightings"].size(), 3U);
    const std::string name = command == std::string("gram") ? "gram" : "distance";
    for (const auto& entry : answer["lightings"]) {
      expect_symmetric(entry[name]);
      expect_symmetric(entry[name + "_error"]);
      EXPECT_EQ(entry[name].size(), materials.size());
    }
    EXPECT_EQ(answer["lightings"][2]["lighting"], "mean-albedo");
  }
}

TEST_F(Measures, MeanAlbedoProductIsThatOfTheIntegrals) {
  const Json answer = json({"product", "lambert:scale=0.3", "lambert:scale=0.5", "--lighting", "mean-albedo"});

  expect_about(answer["product"], 0.15 * std::numbers::pi * std::numbers::pi);
  EXPECT_EQ(answer["units"]["product"], "sr^2");
}

TEST_F(Measures, LargestPatchLightIsDaylightOverPi) {
  const Words pair{"product", "lambert", "lambert:scale=0.5", "--tolerance", "1e-2", "--lighting"};
  Words patch = pair;
  patch.emplace_back("patch:2");
  Words daylight = pair;
  daylight.emplace_back("daylight");
  const Json product = json(patch)["product"];

  EXPECT_NEAR(value(product), value(json(daylight)["product"]) / std::numbers::pi, error(product) + 1e-6);
}

TEST_F(Measures, AngleBelongsToProductAndNorms) {
  const Json pair = json({"angle", kA, kB});
  const double cosine = value(pair["product"]) / (value(pair["norm_a"]) * value(pair["norm_b"]));

  // Relative errors of the norms and of the product are at most 1e-6 each.
  EXPECT_NEAR(std::cos(value(pair["angle_deg"]) * kDegree), cosine, 3e-6);
  EXPECT_LT(error(pair["angle_deg"]) * kDegree, 1e-4);
}

TEST_F(Measures, AngleDoesNotChangeWithScale) {
  const Json pair = json({"angle", kA, kB});
  const Json scaled = json({"angle", kA, "phong:n=5,scale=0.001"});

  EXPECT_NEAR(value(scaled["angle_deg"]), value(pair["angle_deg"]),
              error(scaled["angle_deg"]) + error(pair["angle_deg"]));
}

TEST_F(Measures, AngleOfMultiplesIsZeroWithinItsError) {
  const Json multiple = json({"angle", kB, "phong:n=5,scale=0.3"})["angle_deg"];

  EXPECT_LE(value(multiple), error(multiple));
  EXPECT_LT(error(multiple), 0.1);
  EXPECT_EQ(value(json({"angle", kB, kB})["angle_deg"]), 0);
}

TEST_F(Measures, AngleOfOppositesIsAStraightOneWithinItsError) {
  const Json opposite = json({"angle", kB, "phong:n=5,scale=-1"})["angle_deg"];

  EXPECT_NEAR(value(opposite), 180, error(opposite));
  EXPECT_LT(error(opposite), 0.2);
}

TEST_F(Measures, AngleToNothingIsRefusedButNotTheDistance) {
  expect_refusal({"angle", kB, "lambert:scale=0"}, ExitCode::numeric, "no angle to 'lambert:scale=0', whose norm");
  expect_refusal({"angle", "lambert+lambert:scale=-1", kB}, ExitCode::numeric, "zero within its error");
  EXPECT_EQ(json({"distance", kB, "lambert:scale=0"})["angle_deg"]["value"], "nan");
}

// The norm of the diffuse reflectance 1 / pi is 1.
TEST_F(Measures, DeltaPartsThatAreEqualCancelInTheDistance) {
  make({"tabulate", "mirror+lambert", "--grid", "gauss:8x16", "-o", "a.h5"});
  make({"tabulate", "mirror+lambert:scale=0.8", "--grid", "gauss:8x16", "-o", "b.h5"});
  for (const auto& [a, b] : {std::pair("mirror+lambert", "mirror+lambert:scale=0.8"),
                             std::pair("mirror+lambert", "lambert:scale=0.8+mirror:scale=0.25+mirror:scale=0.75"),
                             std::pair("mirror*fresnel:ior=1.5,k=0+rrim:scale=0.5+lambert",
                                       "mirror*fresnel:ior=1.5,k=0+rrim:scale=0.5+lambert:scale=0.8"),
                             std::pair("a.h5", "b.h5")}) {
    SCOPED_TRACE(b);
    const Json found = json({"distance", a, b});
    expect_about(found["distance"], 0.2);
    EXPECT_EQ(found["norm_a"]["value"], "inf");
    EXPECT_EQ(found["angle_deg"]["value"], "nan");
  }
  expect_about(json({"distance", "mirror:scale=0.1/0.2+lambert", "mirror:scale=0.1/0.2+lambert:scale=0.8"})["distance"],
               0.2);
  EXPECT_EQ(json({"distance", "mirror", "mirror"})["distance"]["value"], 0);
  for (const auto* other : {"mirror:scale=0.5+lambert", "mirror*fresnel:ior=1.5,k=0+lambert", "rrim+lambert", "lambert",
                            "mirror:scale=1/0.5+lambert"}) {
    expect_refusal({"distance", "mirror+lambert", other}, ExitCode::numeric, "infinite norm under point light");
  }
  for (const auto* verb : {"angle", "norm", "gram"}) {
    Words words{verb, "mirror+lambert"};
    if (std::string_view(verb) != "norm") words.emplace_back("mirror+lambert:scale=0.8");
    expect_refusal(words, ExitCode::numeric, "infinite norm under point light");
  }
}

TEST_F(Measures, ChannelsAreShownBelowWhatTheyAreCombinedTo) {
  write("paint.toml", "model = \"lambert\"\nscale = [0.2, 0.4]\n");
  const Json norm = json({"norm", "paint.toml"});

  expect_about(norm["norm"], std::sqrt((0.04 + 0.16) / 2));
  expect_about(norm["channels"][1]["norm"], 0.4);
  EXPECT_THAT(make({"product", "paint.toml", "lambert"}).output,
              ::testing::MatchesRegex("combined +0\\.3[^\n]*\nchannel 1 +0\\.2[^\n]*\nchannel 2 +0\\.[34][^\n]*\n"));
}

TEST_F(Measures, ChannelsAreCalledAsInTheirFile) {
  write("flat.csv", "theta_in_deg,theta_out_deg,delta_phi_deg,550 nm,red\n0,0,0,0.1,0.2\n");
  const auto of_channels = [](const char* before) {
    return ::testing::MatchesRegex(std::string(before) + "550 nm +[^\n]*\nred +[^\n]*\n");
  };

  EXPECT_THAT(make({"norm", "flat.csv"}).output, of_channels("combined +[^\n]*\n"));
  EXPECT_THAT(make({"product", "phong:n=2", "flat.csv"}).output, of_channels("combined +[^\n]*\n"));
  EXPECT_THAT(make({"albedo", "flat.csv", "--theta", "30"}).output,
              ::testing::MatchesRegex("theta/deg +550 nm +red\n(.|\n)*"));
  EXPECT_THAT(make({"mean-albedo", "lambert", "flat.csv"}).output,
              ::testing::MatchesRegex("material +550 nm +red *\n(.|\n)*"));
  EXPECT_THAT(make({"check", "flat.csv"}).output, HasSubstr("mean albedo, red"));
  EXPECT_THAT(make({"pump", "flat.csv", "--grid", "gauss:4x8", "--correction", "g1"}).output,
              HasSubstr("albedo, 550 nm\n"));
  EXPECT_THAT(make({"fit", "flat.csv", "--family", "lambert", "--objective", "perceptual"}).output,
              ::testing::ContainsRegex("largest error of albedos .*, (550 nm|red)\n"));

  write("other.csv", "theta_in_deg,theta_out_deg,delta_phi_deg,green,red\n0,0,0,0.1,0.2\n");
  EXPECT_THAT(make({"distance", "other.csv", "flat.csv"}).output, HasSubstr("\nchannel 2 "));
}

TEST_F(Measures, StudyFilesGiveTheirMaterialsAndChannelWeights) {
  const Json answer = json({"gram", study()});
  const Json& entry = answer["lightings"][0];

  EXPECT_THAT(names_of(answer), ElementsAre("Phong, wide n=2", "Phong, wide n=5", "Ward m=0.3", "Ward m=0.5", "paper"));
  ASSERT_EQ(entry["channels"].size(), 2U);
  for (std::size_t i = 0; i < 5; ++i) {
    SCOPED_TRACE(i);
    const double sum =
        3 * entry["channels"][0]["gram"][i][i].get<double>() + entry["channels"][1]["gram"][i][i].get<double>();
    EXPECT_NEAR(entry["gram"][i][i], sum, 1e-12 * sum);
  }
}

TEST_F(Measures, FamiliesRestrictStudyFilesAlone) {
  const auto names = [&](const Words& words) { return names_of(json(words)); };
  const std::string file = study();

  EXPECT_THAT(names({"gram", file, "lambert", "--family", "Ward"}), ElementsAre("Ward m=0.3", "Ward m=0.5", "lambert"));
  EXPECT_THAT(names({"gram", "study.toml#Ward", "lambert"}), ElementsAre("Ward m=0.3", "Ward m=0.5", "lambert"));
  EXPECT_THAT(names({"distance-matrix", file, "--family", "matt", "--family", "Ward"}),
              ElementsAre("Ward m=0.3", "Ward m=0.5", "paper"));
  EXPECT_EQ(names({"gram", "study.toml#"}).size(), 5U);
}

TEST_F(Measures, FamilyOfOneChannelHasTheWeightsOfAllChannelsOfItsStudy) {
  const std::string file = study();
  const Json whole = json({"gram", file})["lightings"][0];
  const Json family = json({"gram", file, "--family", "Ward"})["lightings"][0];

  EXPECT_FALSE(family.contains("channels"));
  EXPECT_NEAR(family["gram"][0][1], whole["gram"][2][3],
              family["gram_error"][0][1].get<double>() + whole["gram_error"][2][3].get<double>());
}

TEST_F(Measures, FamiliesThatAreNotThereAreRefused) {
  const std::string file = study();

  expect_refusal({"gram", file, "--family", "Wadr"}, ExitCode::usage, "unknown family 'Wadr'; did you mean 'Ward'?");
  expect_refusal({"gram", "study.toml#Wadr"}, ExitCode::usage, "did you mean 'Ward'?");
  expect_refusal({"gram", "lambert", "--family", "Ward"}, ExitCode::usage, "chooses among the materials of a study");
  expect_refusal({"norm", file}, ExitCode::usage, "study.toml is a study file; expected a material");
}

TEST_F(Measures, StudiesThatWeighTheirChannelsInOtherWaysAreRefused) {
  const std::string file = study();
  write("other.toml", "[study]\nchannels = [\"r\", \"g\"]\n[[material]]\nname = \"b\"\nmodel = \"lambert\"\n");

  expect_refusal({"gram", file, "other.toml"}, ExitCode::usage, "weighs its channels otherwise");
}

TEST_F(Measures, CsvReadsBackAsTheJson) {
  const Words words{"gram", kB, "lambert", "ward:m=0.3", "--lighting", "point", "--lighting", "daylight"};
  Words as_csv = words;
  as_csv.emplace_back("--csv");

  const auto lines = cells_of(make(as_csv).output);
  const Json answer = json(words);

  ASSERT_EQ(lines.size(), 1U + 2 * 2 * 3);
  EXPECT_THAT(lines[0], ElementsAre("lighting", "channel", "quantity", "material", kB, "lambert", "ward:m=0.3"));
  for (std::size_t l = 0; l < 2; ++l) {
    SCOPED_TRACE(l);
    for (std::size_t q = 0; q < 2; ++q) {
      SCOPED_TRACE(q);
      for (std::size_t i = 0; i < 3; ++i) {
        SCOPED_TRACE(i);
        const Words& line = lines.at(1 + (l * 2 + q) * 3 + i);
        const Json& entry = answer["lightings"][l];
        const std::string name = q == 0 ? "gram" : "gram_error";
        EXPECT_EQ(line[0], entry["lighting"].get<std::string>());
        EXPECT_EQ(line[1], "combined");
        EXPECT_EQ(line[2], name);
        EXPECT_EQ(line[3], lines[0][4 + i]);
        for (std::size_t j = 0; j < 3; ++j) EXPECT_EQ(std::stod(line.at(4 + j)), entry[name][i][j].get<double>());
      }
    }
  }
}

TEST_F(Measures, CsvHasTheChannelsAndQuotesNames) {
  const std::string csv = make({"distance-matrix", study(), "--csv"}).output;

  EXPECT_EQ(std::ranges::count(csv, '\n'), 1 + 2 * 3 * 2 * 5);  // under the two lightings of studies that name none
  EXPECT_THAT(csv, StartsWith("lighting,channel,quantity,material,\"Phong, wide n=2\",\"Phong, wide n=5\",Ward m=0.3"));
  EXPECT_THAT(csv, HasSubstr("\npoint,1,distance_error,paper,"));
}

TEST_F(Measures, CsvFileIsTheCsvOfTheOutput) {
  const auto outcome = make({"gram", kB, "lambert", "-o", "g.csv"});

  EXPECT_EQ(outcome.output, "g.csv\n");
  EXPECT_EQ(read("g.csv"), make({"gram", kB, "lambert", "--csv"}).output);
}

TEST_F(Measures, CsvFilesAreReplacedOnlyByForce) {
  write("g.csv", "precious");

  expect_refusal({"gram", kB, "-o", "g.csv"}, ExitCode::file, "g.csv exists; use --force");
  EXPECT_EQ(read("g.csv"), "precious");
  make({"gram", kB, "-o", "g.csv", "--force"});
  EXPECT_THAT(read("g.csv"), StartsWith("lighting,"));
  expect_refusal({"gram", kB, "-o", "absent/g.csv"}, ExitCode::file, "absent");
}

TEST_F(Measures, TextIsALowerTriangleThatFitsIntoALine) {
  const std::string text = make({"gram", "phong:n=1", "phong:n=2", "phong:n=3", "phong:n=4", "phong:n=5", "phong:n=6",
                                 "phong:n=7", "phong:n=8", "--lighting", "point", "--lighting", "daylight"})
                               .output;

  EXPECT_THAT(text, StartsWith("point: f.g\n   material "));
  EXPECT_THAT(text, HasSubstr("\ndaylight: f.g/sr\n"));
  EXPECT_THAT(text, HasSubstr("\n8  phong:n=8 "));
  EXPECT_EQ(std::ranges::count(text, '\xc2'), 2 * 36) << "a plus-minus sign per entry of the triangles";
  std::istringstream lines(text);
  for (std::string line; std::getline(lines, line);) EXPECT_LE(line.size(), 100U + 8U) << line;
}

TEST_F(Measures, TablesAreComparedOnTheGridOfTheFirst) {
  make({"tabulate", kB, "--grid", "gauss:16x32", "-o", "a.h5"});
  make({"tabulate", "ward:m=0.5", "--grid", "gauss:24x48", "-o", "b.h5"});

  const Json gram = json({"gram", "lambert", "a.h5", "b.h5", "--lighting", "point", "--lighting", "daylight"});
  const Json pair = json({"product", "a.h5", "b.h5"});
  const Json exact = json({"product", kB, "ward:m=0.5"});

  EXPECT_EQ(gram["grid"], "gauss:16x32");
  for (const auto& entry : gram["lightings"]) {
    expect_symmetric(entry["gram"]);
    expect_symmetric(entry["gram_error"]);
  }
  EXPECT_EQ(gram["lightings"][0]["gram"][1][2], pair["product"]["value"]);
  EXPECT_NEAR(value(pair["product"]), value(exact["product"]), error(pair["product"]));
  EXPECT_NEAR(value(pair["angle_deg"]), value(exact["angle_deg"]), error(pair["angle_deg"]));
  EXPECT_LT(error(pair["product"]), 0.05 * value(pair["product"]));
}

TEST_F(Measures, TablesOfSeveralChannelsShowEach) {
  write("paint.toml", "model = \"lambert\"\nscale = [0.2, 0.4]\n");
  make({"tabulate", "paint.toml", "--grid", "gauss:8x16", "-o", "paint.h5"});

  const Json answer = json({"distance", "paint.h5", "lambert"});

  ASSERT_EQ(answer["channels"].size(), 2U);
  EXPECT_NEAR(value(answer["channels"][0]["distance"]), 0.8, 1e-12);
  EXPECT_NEAR(value(answer["channels"][1]["distance"]), 0.6, 1e-12);
  EXPECT_NEAR(value(answer["distance"]), std::sqrt(0.5), 1e-12);
  EXPECT_NEAR(value(json({"norm", "paint.h5"})["norm"]), std::sqrt(0.1), 1e-12);
}

TEST_F(Measures, GridHasMaterialsComparedAsTables) {
  const Json answer = json({"distance", kA, kB, "--grid", "gauss:16x32"});

  EXPECT_EQ(answer["grid"], "gauss:16x32");
  EXPECT_NEAR(value(answer["distance"]), value(json({"distance", kA, kB})["distance"]), error(answer["distance"]));
  expect_refusal({"norm", "ward:m=0.05", "--grid", "gauss:8x16", "--strict"}, ExitCode::numeric,
                 "does not resolve the lobe");
  EXPECT_THAT(make({"norm", "ward:m=0.05", "--grid", "gauss:8x16"}).error,
              HasSubstr("warning: grid gauss:8x16 does not resolve 'ward:m=0.05' (it needs gauss:"));
}

TEST_F(Measures, TablesTakeEveryLighting) {
  make({"tabulate", "lambert", "--grid", "gauss:16x32", "-o", "a.h5"});
  make({"tabulate", "phong:n=5", "--grid", "gauss:16x32", "-o", "w.h5"});
  const auto expect_product = [&](const std::string& lighting, double expected, double uncertainty) {
    const Json product = json({"product", "a.h5", "lambert:scale=0.5", "--lighting", lighting})["product"];
    EXPECT_NEAR(value(product), expected, product["error"].get<double>() + uncertainty) << lighting;
    EXPECT_LT(product["error"], 1e-2) << lighting;
  };

  // Lambert sees the mean albedo of W, whatever W is: by the oracle, and by `lobe albedo phong:n=5 --mean`.
  expect_product("patch:2", 0.5, 1e-12);
  expect_product("patch:0.5", 0.5 * 0.658532, 1e-5);
  expect_product("table:w.h5", 0.5 * 0.6828347872, 1e-6);
  // (1/pi) times the daylight product of phong:n=5 with itself.
  expect_product("material:phong:n=5", 0.5 * 0.511415031, 1e-9);
  expect_product("material:w.h5", 0.5 * 0.511415031, 1e-6);
  expect_product("mean-albedo", 0.5 * std::numbers::pi * std::numbers::pi, 1e-10);
  expect_refusal({"product", "a.h5", "lambert", "--lighting", "table:none.h5"}, ExitCode::file, "none.h5");
}

TEST_F(Measures, MirrorsHaveNoPointNormButOneUnderDaylight) {
  expect_refusal({"norm", "mirror"}, ExitCode::numeric, "'mirror'");
  // The trace of phong:n=20 is 22 / (2 pi) times the integral of cos(2 theta)^20 dmu up to 45 degrees.
  const Json trace = json({"product", "phong:n=20", "rrim"})["product"];
  EXPECT_NEAR(value(trace), 11.0 / 42, trace["error"].get<double>());
  EXPECT_LT(trace["error"], 1e-6);
  expect_refusal({"product", "rrim", "lambert+rrim"}, ExitCode::numeric, "is infinite");
  expect_refusal({"product", "cook_torrance:m=0.3", "mirror"}, ExitCode::numeric, "is infinite");
  expect_refusal({"gram", "lambert", "mirror:rho=0.5"}, ExitCode::numeric, "'mirror'");
  EXPECT_NEAR(value(json({"norm", "mirror:rho=0.5", "--lighting", "daylight"})["norm"]),
              0.5 * std::sqrt(std::numbers::pi), 1e-6);
}

TEST_F(Measures, LightingsAreReadByTheirNames) {
  expect_refusal({"product", "lambert", "lambert", "--lighting", "pont"}, ExitCode::usage, "did you mean 'point'?");
  expect_refusal({"norm", "lambert", "--lighting", "patch:3"}, ExitCode::usage, "out of range");
  expect_refusal({"gram", "lambert", "--lighting", "point", "--lighting", "point"}, ExitCode::usage, "given twice");
  expect_refusal({"distance", "lambert", "lambert", "--lighting", "point", "--lighting", "daylight"}, ExitCode::usage,
                 "more than once");
}

TEST_F(Measures, UsageErrorsSayWhatToDo) {
  expect_refusal({"product", "lambert"}, ExitCode::usage, "'lobe product' needs B");
  expect_refusal({"gram"}, ExitCode::usage, "needs MATERIAL");
  expect_refusal({"gran", "lambert"}, ExitCode::usage, "did you mean 'gram'?");
  expect_refusal({"distance-matrx", "lambert"}, ExitCode::usage, "did you mean 'distance-matrix'?");
  expect_refusal({"gram", "lambert", "--csv", "--json"}, ExitCode::usage, "choose one");
  expect_refusal({"gram", "lambert", "-o", "g.h5"}, ExitCode::usage, "expected FILE.csv");
  expect_refusal({"gram", "lambert", "absent.toml"}, ExitCode::file, "cannot read absent.toml");
}

using Uncertain = CommandTest;

TEST_F(Uncertain, AlbedosSayWhatTheDeviationsOfSamplesMakeOfThem) {
  std::ofstream(file("grey.csv")) << "theta_in_deg,theta_out_deg,delta_phi_deg,grey,grey_std\n0,0,0,0.1,0.002\n";
  const Json albedo = json({"albedo", "grey.csv", "--theta", "30", "--mean"});
  const Json& at_30 = albedo["albedos"][0]["albedo"][0];
  EXPECT_NEAR(at_30["value"].get<double>(), 0.1 * std::numbers::pi, 1e-6);
  EXPECT_LT(at_30["error"].get<double>(), 1e-4);
  // One sample, drawn a hundred times: known to 7 %.
  EXPECT_NEAR(at_30["measurement"].get<double>(), 0.002 * std::numbers::pi, 0.2 * 0.002 * std::numbers::pi);
  EXPECT_NEAR(albedo["mean_albedo"][0]["measurement"].get<double>(), at_30["measurement"].get<double>(), 1e-6);
  EXPECT_THAT(make({"albedo", "grey.csv", "--theta", "30"}).output,
              ::testing::ContainsRegex("0.3141[0-9]* ± [^ ]* .numerical. ± 0.00[0-9]* .measurement."));
}

/// W = P - 3/pi, P of a cosine lobe: positive for some materials, negative for lambert.
TEST_F(Measures, TakesAnIndefiniteLightingForProductsAndRefusesNormsByTheirSquare) {
  make({"tabulate", "phong:n=3", "--grid", "gauss:8x16", "-o", "p.h5"});
  make({"tabulate", "lambert", "--grid", "gauss:8x16", "-o", "l.h5"});
  make({"mix", "p.h5", "l.h5", "--weights", "1,-3", "-o", "w.h5"});
  const auto under_it = [&](std::vector<std::string> words) {
    words.insert(words.end(), {"--lighting", "table:w.h5", "--allow-unresolved"});
    return words;
  };

  const Json product = json(under_it({"product", "lambert", "lambert"}));
  // Linear in W, of which lambert sees the mean albedo.
  const Json under_p = json({"product", "lambert", "lambert", "--lighting", "table:p.h5"});
  const double mean = value(under_p["product"]) - 3;
  EXPECT_NEAR(value(product["product"]), mean, error(product["product"]));
  EXPECT_LT(mean, -2);
  EXPECT_FALSE(product["norm_a"]["value"].is_number());
  EXPECT_THAT(make(under_it({"gram", "l.h5", "phong:n=2"})).error,
              HasSubstr("warning: W of 'table:w.h5' is not positive semi-definite, its smallest eigenvalue is -2."));

  expect_refusal(under_it({"norm", "lambert", "--quiet"}), ExitCode::numeric,
                 "the square of the norm of 'lambert' under lighting "
                 "'table:w.h5' is -2.30");
  expect_refusal(under_it({"angle", "lambert", "phong:n=2", "--quiet"}), ExitCode::numeric,
                 "the square of the norm of 'lambert'");
  expect_refusal(under_it({"distance", "lambert", "phong:n=2", "--quiet"}), ExitCode::numeric,
                 "the square of the distance of 'lambert' and 'phong:n=2'");
  expect_refusal(under_it({"distance-matrix", "lambert", "phong:n=2", "--quiet"}), ExitCode::numeric,
                 "the square of the distance of 'lambert' and 'phong:n=2'");
}

}  // namespace
}  // namespace lobe::test
