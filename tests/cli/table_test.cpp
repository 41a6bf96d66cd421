// The commands on tables: what they compute, what they leave, what they refuse.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <fstream>
#include <nlohmann/json.hpp>
#include <numbers>
#include <utility>

#include "cli/command_test.hpp"
#include "lobe/hdf5/table_file.hpp"
#include "support/unzipped.hpp"

namespace lobe::test {
namespace {

namespace fs = std::filesystem;
using cli::ExitCode;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::Not;

/// A directory with a few small tables in it.
class Tables : public CommandTest {};

const std::string kSmallTable = "gauss:12x24";

TEST_F(Tables, TabulateWritesATableAndSaysWhatItIs) {
  const auto outcome = make({"tabulate", "phong:n=5", "--grid", kSmallTable, "-o", "a.h5"});

  EXPECT_THAT(outcome.output, HasSubstr("a.h5"));
  EXPECT_THAT(outcome.output, HasSubstr("gauss:12x24 (288 directions), isotropic"));
  EXPECT_THAT(outcome.error, IsEmpty());
  EXPECT_EQ(load_table(file("a.h5")).expression, "phong:n=5");
}

TEST_F(Tables, DenseTablesAreGeneralOnesWithTheSameAlbedo) {
  make({"tabulate", "phong:n=5", "--grid", "gauss:8x16", "-o", "a.h5"});
  make({"tabulate", "phong:n=5", "--grid", "gauss:8x16", "-o", "dense.h5", "--dense", "--no-compress"});

  const Json plain = json({"info", "a.h5"});
  const Json dense = json({"info", "dense.h5"});

  EXPECT_EQ(plain["form"], "isotropic");
  EXPECT_EQ(dense["form"], "general");
  EXPECT_NEAR(dense["mean_albedo"][0]["value"], plain["mean_albedo"][0]["value"], 1e-14);
}

TEST_F(Tables, AreCheckedLikeMaterials) {
  make({"tabulate", "phong:n=5", "--grid", kSmallTable, "-o", "a.h5"});
  make({"scale", "a.h5", "1.2", "-o", "bright.h5"});

  EXPECT_THAT(make({"check", "a.h5"}).output, HasSubstr("a.h5: plausible\n"));
  const auto bright = run({"check", "a.h5", "bright.h5"});
  EXPECT_EQ(bright.status, 1);
  EXPECT_THAT(bright.output, HasSubstr("bright.h5: implausible: more light than it gets\n"));
}

TEST_F(Tables, ToleranceChoosesTheGridOfATabulation) {
  const Json rough = json({"tabulate", "ward:m=0.3", "--tolerance", "0.1", "-o", "rough.h5"});
  const Json fine = json({"tabulate", "ward:m=0.3", "--tolerance", "0.001", "-o", "fine.h5"});

  EXPECT_LE(rough["resolution_error"].get<double>(), 0.1);
  EXPECT_LE(fine["resolution_error"].get<double>(), 0.001);
  EXPECT_LT(rough["directions"], fine["directions"]);
}

TEST_F(Tables, StrictRefusesAnUnresolvedLobeByNameWithTheGridItNeeds) {
  expect_refusal({"tabulate", "lambert+ward:m=0.1", "--grid", kSmallTable, "-o", "a.h5", "--strict"}, ExitCode::numeric,
                 "does not resolve the lobe ward(m=0.1)");
  expect_refusal({"tabulate", "ward:m=0.1", "--grid", kSmallTable, "-o", "a.h5", "--strict"}, ExitCode::numeric,
                 "it needs gauss:48x96");
  EXPECT_THAT(files(), IsEmpty());
}

TEST_F(Tables, UnresolvedLobeMakesATableWithItsErrorAndOneLineOfWarning) {
  const auto outcome = make({"tabulate", "ward:m=0.1", "--grid", kSmallTable, "-o", "a.h5", "--json"});
  EXPECT_EQ(std::ranges::count(outcome.error, '\n'), 1) << outcome.error;
  EXPECT_THAT(outcome.error,
              HasSubstr("warning: grid gauss:12x24 does not resolve 'ward:m=0.1' (it needs gauss:48x96); errors"));
  const Json table = Json::parse(outcome.output);
  EXPECT_EQ(table["is_unresolved"], true);
  EXPECT_GT(table["resolution_error"].get<double>(), 0.1);
  const Json mean = table["mean_albedo"][0];
  const double exact = json({"mean-albedo", "ward:m=0.1"})["materials"][0]["mean_albedo"][0]["value"];
  EXPECT_NEAR(mean["value"], exact, mean["error"].get<double>());
}

TEST_F(Tables, AveragesOverCellsStartFromAsManyPointsAsAskedFor) {
  const Json exact = json({"mean-albedo", "ggx:alpha=0.5"})["materials"][0]["mean_albedo"][0];
  std::vector<double> means;
  for (const std::string points : {"1", "8"}) {
    SCOPED_TRACE(points);
    const Json table = json(
        {"tabulate", "ggx:alpha=0.5", "--grid", "klems:145", "--cell-points", points, "-o", "cells" + points + ".h5"});
    const Json& mean = table["mean_albedo"][0];
    means.push_back(mean["value"]);
    EXPECT_NEAR(means.back(), exact["value"], mean["error"].get<double>() + exact["error"].get<double>());
    make({"export", "ggx:alpha=0.5", "--format", "klems", "--cell-points", points, "-o", "cells" + points + ".xml"});
    make({"norm", "ggx:alpha=0.5", "--grid", "klems:145", "--cell-points", points});
  }
  EXPECT_NE(means[0], means[1]);
  EXPECT_NE(read_unzipped(file("cells1.xml")), read_unzipped(file("cells8.xml")));
}

TEST_F(Tables, MaterialsGetGridsAsFineAsTheyNeed) {
  EXPECT_EQ(json({"tabulate", "phong:n=5", "-o", "a.h5"})["grid"], "gauss:64x128");
  const auto sharp = make({"scale", "ward:m=0.03", "0.5", "-o", "b.h5", "--json"});
  EXPECT_THAT(sharp.error, IsEmpty());
  EXPECT_EQ(Json::parse(sharp.output)["grid"], "gauss:96x192");
  EXPECT_EQ(
      Json::parse(make({"mix", "a.h5", "ward:m=0.03", "--weights", "1,1", "-o", "c.h5", "--json"}).output)["grid"],
      "gauss:64x128")
      << "a table has its own";
}

TEST_F(Tables, AllowUnresolvedKeepsTheTableAndMarksItWithoutAWarning) {
  const auto outcome = make({"tabulate", "ward:m=0.1", "--grid", kSmallTable, "-o", "a.h5", "--allow-unresolved"});

  EXPECT_THAT(outcome.error, IsEmpty());
  EXPECT_THAT(make({"compose", "a.h5", "lambert", "-o", "b.h5"}).error,
              HasSubstr("warning: grid gauss:12x24 does not resolve a lobe; errors"));
  EXPECT_EQ(json({"info", "a.h5"})["is_unresolved"], true);
  EXPECT_EQ(json({"compose", "a.h5", "lambert"})["is_unresolved"], true);
}

TEST_F(Tables, LambertComposedHasTheAlbedoOfTheOtherTimesItsOwn) {
  const double phong = json({"tabulate", "phong:n=5", "--grid", kSmallTable, "-o", "a.h5"})["mean_albedo"][0]["value"];

  const double composed = json({"compose", "lambert:scale=0.5", "a.h5"})["mean_albedo"][0]["value"];

  EXPECT_NEAR(composed, 0.5 * phong, 1e-14);
}

TEST_F(Tables, ComposedWithTheRrimAreUnchangedToTheLastBit) {
  make({"tabulate", "phong:n=5+mirror:rho=0.2", "--grid", kSmallTable, "-o", "a.h5"});
  make({"compose", "a.h5", "rrim", "-o", "same.h5"});

  const BrdfTable a = load_table(file("a.h5"));
  const BrdfTable same = load_table(file("same.h5"));

  EXPECT_EQ(same.values, a.values);
  EXPECT_EQ(same.mirror, a.mirror);
  EXPECT_THAT(same.retro, IsEmpty());
}

TEST_F(Tables, TransposedCompositionIsTheSwappedOne) {
  make({"compose", "phong:n=5", "ward:m=0.4", "--grid", kSmallTable, "-o", "fg.h5"});
  make({"compose", "ward:m=0.4", "phong:n=5", "--grid", kSmallTable, "-o", "gf.h5"});
  make({"transpose", "fg.h5", "-o", "transposed.h5"});

  EXPECT_EQ(load_table(file("transposed.h5")).values, load_table(file("gf.h5")).values);
  EXPECT_NE(load_table(file("fg.h5")).values, load_table(file("gf.h5")).values);
}

TEST_F(Tables, TwoMirrorsReflectBack) {
  const Json answer = json({"compose", "mirror:rho=0.5", "mirror:rho=0.5"});

  EXPECT_EQ(answer["delta"], Json::parse(R"({"rrim": {"min": 0.25, "max": 0.25}})"));
}

/// A folder on a disk for tables in files; the usual one of tests may lie in memory.
const Surroundings kOnDisk{.environment = {{"TMPDIR", "/var/tmp"}}};

TEST_F(Tables, BoundedMemoryChangesNoBit) {
  // Beyond a mebibyte, from which on tables lie in files.
  const auto compose = [&](const std::string& output, Words more) {
    Words words{"compose", "ward_anisotropic:m_x=0.3,m_y=0.6", "lambert+phong:n=5", "--grid", "gauss:16x32", "-v", "-o",
                output};
    words.insert(words.end(), more.begin(), more.end());
    const auto outcome = run(words, kOnDisk);
    EXPECT_EQ(outcome.status, 0) << outcome.error;
    return outcome.error;
  };
  EXPECT_THAT(compose("plain.h5", {}), HasSubstr("peak memory will be about"));
  EXPECT_THAT(compose("bounded.h5", {"--memory", "8G"}),
              HasSubstr(" in /var/tmp, memory is meant to stay below 8 GiB\n"));
  const BrdfTable a = load_table(file("plain.h5"));
  const BrdfTable b = load_table(file("bounded.h5"));
  EXPECT_EQ(a.values.size(), 512U * 512U);
  EXPECT_EQ(a.values, b.values);
  EXPECT_EQ(a.error, b.error);
}

TEST_F(Tables, BoundedMemoryRefusesWhatItCannotKeep) {
  const auto expect_refused = [&](const Words& words, const std::string& size, cli::ExitCode code,
                                  const std::string& message, const std::string& folder = "/var/tmp") {
    Words all = words;
    all.insert(all.end(), {"--memory", size});
    const auto outcome = run(all, {.environment = {{"TMPDIR", folder}}});
    EXPECT_EQ(outcome.status, static_cast<int>(code)) << size;
    EXPECT_EQ(std::ranges::count(outcome.error, '\n'), 1) << outcome.error;
    EXPECT_THAT(outcome.error, HasSubstr(message)) << size;
    EXPECT_FALSE(fs::exists(file("a.h5"))) << size;
  };
  const Words scale{"scale", "phong:n=5", "0.5", "--grid", kSmallTable, "-o", "a.h5"};
  expect_refused(scale, "1M", ExitCode::numeric, "--memory 1M is too small: this takes about ");
  for (const std::string size : {"much", "2X", "2", "-1G", "0G", "2Gb", "nanG", "1e30T"}) {
    expect_refused(scale, size, ExitCode::usage,
                   "'" + size + "' is no size of memory; expected a number with K, M, G or T");
  }
  // Terabytes of tables, and of blocks, which are no tables.
  expect_refused({"scale", "ward_anisotropic:m_x=0.3,m_y=0.6", "0.5", "--grid", "gauss:1024x2048", "-o", "a.h5"}, "1G",
                 ExitCode::numeric, "that are free in /var/tmp; set TMPDIR to a folder on a larger disk");
  expect_refused({"spectrum", "phong:n=5", "--grid", "gauss:1024x2048"}, "1G", ExitCode::numeric,
                 "--memory 1G is too small: this takes about ");
  expect_refused(scale, "1G", ExitCode::file, "; set TMPDIR to a folder on a disk", file("absent").string());
  if (fs::exists("/dev/shm")) {
    expect_refused(scale, "1G", ExitCode::file, "which lies in memory (tmpfs); set TMPDIR to a folder", "/dev/shm");
  }
}

TEST_F(Tables, SelfCompositionOnceIsCompositionWithItself) {
  make({"self-compose", "phong:n=5", "--grid", kSmallTable, "-o", "once.h5"});
  make({"compose", "phong:n=5", "phong:n=5", "--grid", kSmallTable, "-o", "pair.h5"});
  make({"compose", "once.h5", "phong:n=5", "-o", "triple.h5"});
  make({"self-compose", "phong:n=5", "--grid", kSmallTable, "--times", "2", "-o", "twice.h5"});

  EXPECT_EQ(load_table(file("once.h5")).values, load_table(file("pair.h5")).values);
  EXPECT_EQ(load_table(file("twice.h5")).values, load_table(file("triple.h5")).values);
}

TEST_F(Tables, MixtureAndScaleAreLinear) {
  make({"tabulate", "phong:n=5", "--grid", kSmallTable, "-o", "a.h5"});
  const double mixed =
      json({"mix", "a.h5", "lambert", "--weights", "0.5,0.25", "-o", "m.h5"})["mean_albedo"][0]["value"];
  const double scaled = json({"scale", "a.h5", "0.5", "-o", "s.h5"})["mean_albedo"][0]["value"];

  EXPECT_NEAR(mixed, scaled + 0.25, 1e-14);
}

TEST_F(Tables, MaterialsAreComposedOnAGridFineEnough) {
  EXPECT_LE(json({"compose", "phong:n=5", "lambert", "--tolerance", "1e-3"})["relative_error"].get<double>(), 1e-3);
}

TEST_F(Tables, DifferentGridsAreInterpolatedWithTheErrorOrRefused) {
  make({"tabulate", "phong:n=5", "--grid", kSmallTable, "-o", "a.h5"});
  make({"tabulate", "phong:n=5", "--grid", "gauss:16x32", "-o", "b.h5"});

  const Json moved = json({"resample", "b.h5", "--grid", kSmallTable, "-o", "moved.h5"});

  EXPECT_EQ(json({"compose", "a.h5", "b.h5"})["grid"], kSmallTable);
  EXPECT_GT(moved["relative_error"].get<double>(), 1e-9);
  expect_refusal({"compose", "a.h5", "b.h5", "--exact-grid"}, ExitCode::usage, "expected the same grid");
  expect_refusal({"compose", "a.h5", "lambert", "--grid", "gauss:8x16", "--exact-grid"}, ExitCode::usage,
                 "leave out --exact-grid");
}

TEST_F(Tables, PointwiseCompositionGivesTheOraclesValue) {
  const Json answer = json({"compose", "phong:n=5", "phong:n=20", "--at", "30,30,0", "--at", "30,40,180"});

  ASSERT_EQ(answer["values"].size(), 2U);
  const Json& first = answer["values"][0];
  EXPECT_NEAR(first["brdf"][0], 0.7861541657195552, 1e-8);
  EXPECT_LE(std::abs(first["brdf"][0].get<double>() - 0.7861541657195552), first["brdf_error"][0].get<double>());
}

/// A file of values that depend on the viewer alone: 0.1, with a tent from 40 to 50 degrees whose top is 1; its
/// composition with itself is its albedo times its values.
class Tents : public Tables {
 protected:
  void SetUp() override {
    std::ofstream csv(file("tent.csv"));
    csv << "theta_in_deg,theta_out_deg,delta_phi_deg,value\n";
    for (const auto* in : {"0", "90"}) {
      for (const auto* row : {"0,0,0.1", "40,0,0.1", "45,0,1", "50,0,0.1", "90,0,0.1"}) csv << in << ',' << row << '\n';
    }
    constexpr int kSteps = 18000;  // of 0.005 degrees
    for (int k = 0; k < kSteps; ++k) {
      const double degrees = 90 * (k + 0.5) / kSteps;
      const double theta = degrees * std::numbers::pi / 180;
      const double value = std::max(0.1, 1 - 0.9 * std::abs(degrees - 45) / 5);
      albedo_ += 2 * std::numbers::pi * value * std::sin(theta) * std::cos(theta) * std::numbers::pi / 2 / kSteps;
    }
  }

  double albedo_ = 0;
};

TEST_F(Tents, OfAFileAreComposedAtSingleDirectionsWithoutAGrid) {
  const Json answer = json({"compose", "tent.csv", "tent.csv", "--at", "30,45,10", "--at", "80,10,0"});
  for (const auto& [k, value] : {std::pair{0U, 1.0}, std::pair{1U, 0.1}}) {
    SCOPED_TRACE(k);
    const Json& found = answer["values"][k];
    EXPECT_NEAR(found["brdf"][0], albedo_ * value, found["brdf_error"][0].get<double>() + 1e-8);
    EXPECT_LE(found["brdf_error"][0].get<double>(), 1e-4 * albedo_ * value);
  }
  const Json beside = json({"compose", "tent.csv", "lambert", "--at", "30,45,10"})["values"][0];
  EXPECT_NEAR(beside["brdf"][0], albedo_ / std::numbers::pi, beside["brdf_error"][0].get<double>() + 1e-8);
}

TEST_F(Tents, OfAFileAreComposedByItsValuesWhateverTheGrid) {
  for (const Words& words : {Words{"self-compose", "tent.csv"}, Words{"compose", "tent.csv", "tent.csv"}}) {
    SCOPED_TRACE(words.front());
    Words on_grid = words;
    on_grid.insert(on_grid.end(), {"--grid", "gauss:16x32", "--allow-unresolved", "-o", "c.h5", "-f"});
    const Json answer = json(on_grid);
    const BrdfTable c = load_table(file("c.h5"));
    EXPECT_LT(relative_error(c), 0.5);
    for (std::size_t ring = 0; ring < 16; ++ring) {
      SCOPED_TRACE(ring);
      const double degrees = c.grid.rings()[ring].theta * 180 / std::numbers::pi;
      const double expected = albedo_ * std::max(0.1, 1 - 0.9 * std::abs(degrees - 45) / 5);
      EXPECT_NEAR(c.values[(3 * 16 + ring) * 17 + 5], expected, c.error[3 * 16 + ring]);
    }
  }
}

TEST_F(Tents, OfAFileAreComposedSeveralTimes) {
  make({"self-compose", "tent.csv", "--times", "2", "--grid", "gauss:32x64", "--allow-unresolved", "-o", "c.h5"});
  const BrdfTable c = load_table(file("c.h5"));
  EXPECT_THAT(c.expression, HasSubstr("times=2"));
  const std::size_t last = 31;
  EXPECT_NEAR(c.values[(3 * 32 + last) * 33], albedo_ * albedo_ * 0.1, c.error[3 * 32 + last]);
}

TEST_F(Tables, ComposedTableAgreesWithPointwiseCompositionWithinItsError) {
  make({"tabulate", "phong:n=5", "--grid", "gauss:24x48", "-o", "a.h5"});

  const Json value = json({"compose", "a.h5", "phong:n=20", "--at", "30,30,0"})["values"][0];

  EXPECT_NEAR(value["brdf"][0], 0.7861541657195552, value["brdf_error"][0].get<double>());
  EXPECT_LT(value["brdf_error"][0].get<double>(), 1e-2);
}

TEST_F(Tables, InfoChecksTheBoundsOfACompositionsAlbedos) {
  make({"compose", "phong:n=5", "ward:m=0.4", "--grid", kSmallTable, "-o", "c.h5"});

  const Json answer = json({"info", "c.h5"});

  ASSERT_EQ(answer["bounds"].size(), 3U);
  for (const auto& bound : answer["bounds"]) EXPECT_EQ(bound["is_violated"], false) << bound;
}

TEST_F(Tables, InfoEndsWithStatusOneWhereABoundIsViolated) {
  make({"compose", "phong:n=5", "lambert", "--grid", kSmallTable, "-o", "c.h5"});
  BrdfTable table = load_table(file("c.h5"));
  for (double& value : table.values) value *= 1.1;
  save(table, file("wrong.h5"));

  const auto outcome = run({"info", "wrong.h5"});

  EXPECT_EQ(outcome.status, static_cast<int>(ExitCode::negative));
  EXPECT_THAT(outcome.output, HasSubstr("violated by"));
}

TEST_F(Tables, InfoReadsHeadersAlone) {
  make({"tabulate", "phong:n=5", "--grid", kSmallTable, "-o", "a.h5"});

  const Json answer = json({"info", "a.h5", "--header-only"});

  EXPECT_EQ(answer["grid"], kSmallTable);
  EXPECT_FALSE(answer.contains("mean_albedo"));
}

TEST_F(Tables, ServeAsMaterials) {
  make({"tabulate", "phong:n=5", "--grid", "gauss:24x48", "-o", "a.h5"});
  const Words angles{"--theta-in", "30", "--theta-out", "40", "--delta-phi", "180"};
  Words of_table{"eval", "a.h5"};
  Words of_material{"eval", "phong:n=5"};
  for (auto* words : {&of_table, &of_material}) words->insert(words->end(), angles.begin(), angles.end());

  const Json value = json(of_table)["values"][0];
  EXPECT_EQ(run({"albedo", "a.h5", "--theta", "30", "--tolerance", "1e-2"}).error, "");
  EXPECT_THAT(run({"albedo", "a.h5", "--theta", "30", "--tolerance", "1e-15"}).error,
              HasSubstr("albedo at 30 degrees of 'a.h5' reaches a relative error of"));
  const Json albedo = json({"albedo", "a.h5", "--theta", "30"})["albedos"][0]["albedo"][0];
  const Json exact_albedo = json({"albedo", "phong:n=5", "--theta", "30"})["albedos"][0]["albedo"][0];

  EXPECT_NEAR(value["brdf"][0], json(of_material)["values"][0]["brdf"][0], value["brdf_error"][0].get<double>());
  EXPECT_NEAR(albedo["value"], exact_albedo["value"], 1e-3);
  EXPECT_EQ(json({"distance", "a.h5", "phong:n=5"})["distance"]["value"], 0);
}

TEST_F(Tables, PredictedMemoryIsStated) {
  const auto verbose = make({"tabulate", "phong:n=5", "--grid", kSmallTable, "-o", "a.h5", "-v"});
  const Json memory = json({"compose", "a.h5", "a.h5"})["memory"];

  EXPECT_THAT(verbose.error, HasSubstr("peak memory will be about"));
  EXPECT_GT(memory["predicted_bytes"], 0);
  EXPECT_THAT(verbose.error, HasSubstr("\npeak memory "));
  EXPECT_EQ(make({"compose", "a.h5", "a.h5", "--json"}).output, make({"compose", "a.h5", "a.h5", "--json"}).output)
      << "no measured bytes";
}

TEST_F(Tables, TooLargeForTheMachineIsRefusedBeforehand) {
  expect_refusal({"tabulate", "lambert", "--grid", "shirley-chiu:512", "-o", "a.h5"}, ExitCode::numeric,
                 "of memory, more than the");
}

TEST_F(Tables, FilesAreReplacedOnlyByForce) {
  make({"tabulate", "lambert", "--grid", "gauss:8x16", "-o", "a.h5"});

  expect_refusal({"tabulate", "phong:n=5", "--grid", kSmallTable, "-o", "a.h5"}, ExitCode::file,
                 "a.h5 exists; use --force");
  make({"tabulate", "phong:n=5", "--grid", kSmallTable, "-o", "a.h5", "--force"});
}

TEST_F(Tables, DamagedFileIsAFileErrorThatNamesIt) {
  std::ofstream(file("damaged.h5")) << "no table";

  expect_refusal({"compose", "damaged.h5", "lambert"}, ExitCode::file, "damaged.h5");
  expect_refusal({"info", "damaged.h5"}, ExitCode::file, "damaged.h5");
}

TEST_F(Tables, UsageErrorsSayWhatToDo) {
  expect_refusal({"tabulate", "lambert"}, ExitCode::usage, "needs --output");
  expect_refusal({"tabulate", "lambert", "--grid", "guass:8x16", "-o", "a.h5"}, ExitCode::usage,
                 "did you mean 'gauss'?");
  expect_refusal({"compose", "lambert", "lambert", "--at", "30,30"}, ExitCode::usage, "--at 30,30,0");
  expect_refusal({"mix", "lambert", "mirror", "--weights", "1", "-o", "a.h5"}, ExitCode::usage, "1 weights for 2");
  expect_refusal({"self-compose", "lambert", "--times", "0"}, ExitCode::usage, "expected a whole number");
}

TEST_F(Tables, PlotsTablesBesideEachOther) {
  make({"compose", "phong:n=5", "lambert", "--grid", kSmallTable, "-o", "c.h5"});

  const auto outcome = make({"plot", "c.h5", "phong:n=5", "lambert", "-o", "out/c", "--format", "svg"});

  for (const char* name : {"out/c.polar.svg", "out/c.slice.svg", "out/c.albedo.svg"}) {
    SCOPED_TRACE(name);
    EXPECT_THAT(outcome.output, HasSubstr(name));
    EXPECT_TRUE(fs::exists(file(name))) << name;
  }
}

TEST_F(Tables, PlotsLeaveScriptsAndAWarningWithoutGnuplot) {
  fs::create_directory(file("no-programs"));
  make({"tabulate", "lambert", "--grid", "gauss:8x16", "-o", "a.h5"});

  const auto outcome = run({"plot", "a.h5", "-o", "p"}, {.environment = {{"PATH", file("no-programs").string()}}});

  EXPECT_EQ(outcome.status, 0) << outcome.error;
  EXPECT_THAT(outcome.error, HasSubstr("gnuplot"));
  EXPECT_THAT(outcome.output, HasSubstr("p.polar.gp"));
  EXPECT_THAT(outcome.output, Not(HasSubstr(".png")));
}

TEST_F(Tables, CtrlCLeavesNothing) {
  const auto outcome = run({"tabulate", "ward:m=0.2", "--grid", "gauss:384x768", "-o", "a.h5"},
                           {.interrupt_after = std::chrono::milliseconds(300)});

  EXPECT_EQ(outcome.status, 130) << outcome.error;
  EXPECT_THAT(files(), IsEmpty());
}

}  // namespace
}  // namespace lobe::test
