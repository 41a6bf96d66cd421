// `lobe sample`: the directions it lists, what it makes of them, what it refuses.
#include <cmath>
#include <fstream>
#include <numbers>

#include "cli/command_test.hpp"

namespace lobe::test {
namespace {

using cli::ExitCode;

class Sample : public CommandTest {};

TEST_F(Sample, ListsUnitVectorsWithDensityAndWeight) {
  const Json samples = json({"sample", "lambert:scale=0.5", "--theta", "30", "--count", "20"})["samples"];

  ASSERT_EQ(samples.size(), 20U);
  for (const auto& one : samples) {
    SCOPED_TRACE(one);
    const double z = one["direction"][2];
    EXPECT_NEAR(std::hypot(double(one["direction"][0]), double(one["direction"][1]), z), 1, 1e-12);
    EXPECT_NEAR(one["density"], z / std::numbers::pi, 1e-12);
    EXPECT_NEAR(one["weight"][0], 0.5, 1e-12);
    EXPECT_EQ(one["kind"], "smooth");
  }
}

TEST_F(Sample, GivesTheSameForTheSameSeedAndOthersForAnother) {
  const Words words{"sample", "ward:m=0.2", "--theta", "60", "--count", "5", "--seed"};
  const auto with_seed = [&](const std::string& seed) {
    Words all = words;
    all.push_back(seed);
    return make(all).output;
  };

  EXPECT_EQ(with_seed("7"), with_seed("7"));
  EXPECT_NE(with_seed("7"), with_seed("8"));
}

TEST_F(Sample, WritesAFileWithALineForEachSample) {
  EXPECT_EQ(make({"sample", "lambert+mirror", "--theta", "60", "--count", "10", "-o", "d.csv"}).output, "");

  std::ifstream stream(file("d.csv"));
  std::string line;
  std::getline(stream, line);
  EXPECT_EQ(line, "x,y,z,density,weight,kind");
  int lines = 0;
  while (std::getline(stream, line)) ++lines;
  EXPECT_EQ(lines, 10);
}

TEST_F(Sample, SummarisesTheAlbedoByImportanceAndByTheCosine) {
  const Json answer = json({"sample", "phong:n=20", "--theta", "45", "--count", "20000", "--summary"});

  const double exact = json({"albedo", "phong:n=20", "--theta", "45"})["albedos"][0]["albedo"][0]["value"];
  for (const char* way : {"importance", "cosine"}) {
    const Json& albedo = answer[way]["albedo"][0];
    EXPECT_NEAR(albedo["value"], exact, 4 * double(albedo["error"])) << way;
  }
  EXPECT_LT(answer["importance"]["relative_variance"][0], answer["cosine"]["relative_variance"][0]);
}

TEST_F(Sample, TakesTables) {
  make({"tabulate", "lambert:scale=0.5", "--grid", "gauss:8x16", "-o", "t.h5"});

  const Json answer = json({"sample", "t.h5", "--theta", "45", "--count", "2000", "--summary"});

  EXPECT_NEAR(answer["importance"]["albedo"][0]["value"], 0.5, 1e-9);
}

TEST_F(Sample, RefusesWhatItCannotDo) {
  expect_refusal({"sample", "lambert"}, ExitCode::usage, "give one by --theta");
  expect_refusal({"sample"}, ExitCode::usage, "give a material or a table");
  expect_refusal({"sample", "lambert", "--theta", "90"}, ExitCode::usage, "expected a value in [0, 90) degrees");
  expect_refusal({"sample", "lambert", "--theta", "0", "--seed", "-1"}, ExitCode::usage, "is no seed");
  expect_refusal({"sample", "lambert", "--theta", "0", "--count", "0"}, ExitCode::usage, "--count");
  expect_refusal({"sample", "lambert", "--theta", "0", "--count", "1", "--summary"}, ExitCode::usage, "at least 2");
  for (const char* name : {"d.npy", "d.CSV.h5", "d"}) {
    expect_refusal({"sample", "lambert", "--theta", "0", "-o", name}, ExitCode::usage, "expected an ending .csv");
  }
  EXPECT_THAT(files(), ::testing::IsEmpty());
  expect_refusal({"sample", "lambert", "--theta", "0", "--summary", "-o", "d.csv"}, ExitCode::usage, "--output");
}

}  // namespace
}  // namespace lobe::test
