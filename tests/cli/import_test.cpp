// lobe import: tables of measured reflectances, and what it refuses.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <numbers>

#include "cli/command_test.hpp"
#include "lobe/hdf5/table_file.hpp"
#include "support/gzipped.hpp"

namespace lobe::test {
namespace {

using cli::ExitCode;
using ::testing::HasSubstr;

class Import : public CommandTest {
 protected:
  /// Zernike coefficients of a Lambertian surface: f = a/(2 pi).
  void write_coefficients(const std::string& name, double a, int power) const {
    std::ofstream(file(name)) << "1, 1, 0, 0, 0, 0, " << power << ", " << a << "\n";
  }
};

TEST_F(Import, LeavesATableThatOtherCommandsTake) {
  write_coefficients("flat.csv", 1.5, 0);
  const auto outcome = make({"import", "flat.csv", "-o", "flat.h5", "--grid", "gauss:4x8"});

  EXPECT_THAT(outcome.output, HasSubstr("NIST Zernike coefficients"));
  const BrdfTable table = load_table(file("flat.h5"));
  EXPECT_EQ(table.expression, "flat (NIST Zernike coefficients)");
  EXPECT_NEAR(table.values.front(), 1.5 / (2 * std::numbers::pi), 1e-15);
  EXPECT_NEAR(json({"mean-albedo", "flat.h5"})["materials"][0]["mean_albedo"][0]["value"].get<double>(), 0.75, 1e-12);
}

TEST_F(Import, MakesChannelsOfWavelengths) {
  write_coefficients("spectral.csv", 1, 1);
  const Json answer =
      json({"import", "spectral.csv", "--wavelengths", "500,1000", "-o", "t.h5", "--grid", "gauss:4x8"});

  EXPECT_EQ(answer["channel_names"], Json::parse(R"(["500 nm", "1000 nm"])"));
  EXPECT_EQ(load_table(file("t.h5")).channels, 2U);
}

TEST_F(Import, TakesChannelsOfATable) {
  write_coefficients("spectral.csv", 1, 1);
  make({"import", "spectral.csv", "--wavelengths", "500,1000", "-o", "t.h5", "--grid", "gauss:4x8"});
  make({"import", "t.h5", "--channels", "1000 nm", "-o", "one.h5"});
  make({"import", "t.h5", "--wavelengths", "750", "-o", "between.h5"});

  // f = lambda/(2 pi), lambda in micrometres.
  EXPECT_NEAR(load_table(file("one.h5")).values.front(), 1 / (2 * std::numbers::pi), 1e-15);
  EXPECT_NEAR(load_table(file("between.h5")).values.front(), 0.75 / (2 * std::numbers::pi), 1e-15);
  EXPECT_EQ(load_table(file("one.h5")).channel_names, std::vector<std::string>{"1000 nm"});
  expect_refusal({"import", "t.h5", "--channels", "red", "-o", "x.h5"}, ExitCode::usage,
                 "it has the channels 500 nm, 1000 nm");
  expect_refusal({"import", "t.h5", "--wavelengths", "300", "-o", "x.h5"}, ExitCode::usage, "no wavelength of 300 nm");
  expect_refusal({"import", "t.h5", "--theta-max", "80", "-o", "x.h5"}, ExitCode::usage, "is a table");
}

TEST_F(Import, TakesAnyOfTheChannelsOfAFile) {
  std::ofstream(file("paint.csv"))
      << "theta_in_deg,theta_out_deg,delta_phi_deg,red,green,blue\n"
         "0,0,0,0.3,0.2,0.1\n0,60,0,0.3,0.2,0.1\n60,0,0,0.3,0.2,0.1\n60,60,0,0.3,0.2,0.1\n";
  const std::vector<std::pair<std::string, std::vector<double>>> choices{{"red", {0.3}},
                                                                         {"green", {0.2}},
                                                                         {"red,green", {0.3, 0.2}},
                                                                         {"blue,red", {0.1, 0.3}},
                                                                         {"1,2,3", {0.3, 0.2, 0.1}}};
  for (const auto& [names, values] : choices) {
    make({"import", "paint.csv", "--channels", names, "-o", "t.h5", "--grid", "gauss:4x8", "--force"});
    const BrdfTable table = load_table(file("t.h5"));
    ASSERT_EQ(table.channels, values.size()) << names;
    for (std::size_t c = 0; c < values.size(); ++c) EXPECT_NEAR(table.channel(c).front(), values[c], 1e-15) << names;
  }
}

TEST_F(Import, IsNotNeededForFilesThatStandForMaterials) {
  write_coefficients("flat.csv", 1.5, 0);
  // f = 1.5/(2 pi), three quarters of a Lambertian surface.
  EXPECT_NEAR(json({"distance", "flat.csv", "lambert", "--grid", "gauss:4x8"})["distance"]["value"].get<double>(), 0.25,
              1e-12);
  const Json found = json({"distance", "flat.csv", "lambert"});
  EXPECT_NEAR(found["distance"]["value"].get<double>(), 0.25, found["distance"]["error"].get<double>());
  EXPECT_LT(found["distance"]["error"].get<double>(), 1e-4);
  EXPECT_FALSE(found.contains("grid"));
  const Json nearest = json({"approximate", "flat.csv", "-b", "lambert", "-b", "phong:n=3", "--plot", "pictures"});
  const Json& coefficients = nearest["answers"][0]["fits"][0]["coefficients"];
  EXPECT_NEAR(coefficients[0]["value"].get<double>(), 0.75, coefficients[0]["error"].get<double>());
  EXPECT_LT(coefficients[0]["error"].get<double>(), 1e-3);
  EXPECT_TRUE(std::filesystem::exists(file("pictures/approximation.point.slices.gp")));
  const Json values = json({"eval", "flat.csv", "--theta-in", "30", "--theta-out", "20", "--delta-phi", "180"});
  EXPECT_NEAR(values["values"][0]["brdf"][0].get<double>(), 1.5 / (2 * std::numbers::pi), 1e-15);
  const Json info = json({"info", "flat.csv"});
  EXPECT_EQ(info["format"], "NIST Zernike coefficients");
  EXPECT_EQ(info["grid"], "gauss:64x128");
  const Json& mean = info["mean_albedo"][0];
  EXPECT_NEAR(mean["value"].get<double>(), 0.75, mean["error"].get<double>());
  EXPECT_LT(mean["error"].get<double>(), 1e-4);
  EXPECT_EQ(info["albedos"][3]["theta_deg"], 80);
  EXPECT_NEAR(info["albedos"][3]["albedo"][0]["value"].get<double>(), 0.75, 1e-4);
}

TEST_F(Import, SaysOfAnyFileWhetherItIsKnown) {
  std::ofstream(file("words.txt")) << "some words\n";
  std::ofstream(file("packed.bsdf.gz"), std::ios::binary) << "\x1f\x8b\x08 and so on";
  expect_refusal({"info", "words.txt"}, ExitCode::file, "no known format");
  expect_refusal({"info", "packed.bsdf.gz"}, ExitCode::file, "its compressed data is damaged");
  expect_refusal({"distance", "-", "-"}, ExitCode::usage, "standard input is named twice; expected one '-'");
  expect_refusal({"distance", "-", "/dev/stdin"}, ExitCode::usage, "standard input is named twice; expected one '-'");
  expect_refusal({"info", "none.bsdf"}, ExitCode::file, "there is no such file");
  expect_refusal({"norm", "none.bsdf"}, ExitCode::file, "there is no such file");
}

TEST_F(Import, TakesStandardInputAndPipes) {
  const std::string text =
      "theta_in_deg,theta_out_deg,delta_phi_deg,value\n0,0,0,0.25\n60,0,0,0.25\n0,60,0,0.25\n60,60,0,0.25\n";
  std::ofstream(file("paint.csv")) << text;
  std::ofstream(file("paint.csv.gz"), std::ios::binary) << gzipped(text);
  const auto said = [&](const std::string& line) {
    const Outcome outcome = run_line(line, {.directory = file(".")});
    EXPECT_EQ(outcome.status, 0) << line << ": " << outcome.error;
    return outcome.output;
  };
  const std::string angles = " --theta-in 10 --theta-out 20 --delta-phi 0";
  const std::string expected = said("lobe eval paint.csv" + angles);
  EXPECT_THAT(expected, HasSubstr("0.25"));
  EXPECT_EQ(said("cat paint.csv | lobe eval -" + angles), expected);
  EXPECT_EQ(said("lobe eval - <paint.csv.gz" + angles), expected);
  EXPECT_EQ(said("gunzip <paint.csv.gz | lobe eval /dev/stdin" + angles), expected);
  EXPECT_EQ(said("bash -c 'lobe eval <(cat paint.csv)" + angles + "'"), expected);
  EXPECT_EQ(said("lobe eval paint.csv.gz" + angles), expected);
  EXPECT_THAT(said("cat paint.csv | lobe info --header-only -"), HasSubstr("CSV of directions and values"));
  EXPECT_THAT(said("cat paint.csv | lobe distance - lambert"), HasSubstr("0.21"));  // 1 - 0.25 pi
  EXPECT_THAT(run_line("lobe info - </dev/null").error, HasSubstr("cannot read -: it is of no known format"));
}

TEST_F(Import, RefusesWhatItCannotRead) {
  write_coefficients("spectral.csv", 1, 1);
  std::ofstream(file("words.csv")) << "some words\n";
  expect_refusal({"import", "spectral.csv", "-o", "t.h5"}, ExitCode::usage, "expected wavelengths in nm");
  expect_refusal({"import", "words.csv", "-o", "t.h5"}, ExitCode::file, "no known format");
  expect_refusal({"import", "none.csv", "-o", "t.h5"}, ExitCode::file, "there is no such file");
  expect_refusal({"import", "spectral.csv", "--theta-max", "100", "-o", "t.h5"}, ExitCode::usage,
                 "theta_max is 100; expected degrees above 0, at most 90");
}

}  // namespace
}  // namespace lobe::test
