// lobe export: files of other programs, and what it says of them.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <string>

#include "cli/command_test.hpp"

namespace lobe::test {
namespace {

using cli::ExitCode;
using ::testing::HasSubstr;

class Export : public CommandTest {};

TEST_F(Export, WritesWhatImportReads) {
  const auto outcome = make({"export", "lambert:scale=0.5", "--format", "merl", "-o", "matt.binary"});

  EXPECT_THAT(outcome.output, HasSubstr("MERL .binary"));
  EXPECT_EQ(std::filesystem::file_size(file("matt.binary")), 34992012U);
  make({"import", "matt.binary", "-o", "matt.h5", "--grid", "gauss:4x8"});
  EXPECT_NEAR(json({"mean-albedo", "matt.h5"})["materials"][0]["mean_albedo"][0]["value"].get<double>(), 0.5, 1e-12);
}

// Without bird and openmaterial, which are read as astm is (tests/io).
TEST_F(Export, WritesEveryFormatThatIsNamed) {
  for (const char* format : {"alta", "astm", "csv", "klems", "rgl", "scatfun", "tensor-tree", "utia", "zemax"}) {
    const std::string name = std::string("matt.") + format;
    make({"export", "lambert:scale=0.5", "--format", format, "-o", name});
    const Json answer = json({"mean-albedo", name});
    // RGL's nodes do not follow the horizon of every light.
    const double tolerance = std::string(format) == "rgl" ? 1e-3 : 1e-6;
    EXPECT_NEAR(answer["materials"][0]["mean_albedo"][0]["value"].get<double>(), 0.5, tolerance) << format;
  }
}

TEST_F(Export, SaysHowFarTheFileIsFromTheMaterial) {
  const Json merl = json({"export", "phong:n=5", "--format", "merl", "-o", "a.binary"});
  const Json klems = json({"export", "phong:n=5", "--format", "klems", "-o", "a.xml"});

  EXPECT_GT(merl["rms_deviation"].get<double>(), 0);
  EXPECT_LT(merl["rms_deviation"].get<double>(), 1e-3);
  // Patches are 10 to 15 degrees wide.
  EXPECT_GT(klems["rms_deviation"].get<double>(), 0.01);
  EXPECT_LT(klems["rms_deviation"].get<double>(), 0.2);
}

TEST_F(Export, SaysHowFarTheFileIsOffAtMost) {
  const Json coarse = json({"export", "ggx:alpha=0.3", "--format", "rgl", "-o", "a.bsdf", "--nodes", "12"});
  const Json fine = json({"export", "ggx:alpha=0.3", "--format", "rgl", "-o", "b.bsdf"});
  EXPECT_GT(coarse["largest_deviation"].get<double>(), fine["largest_deviation"].get<double>());
  EXPECT_GT(coarse["rms_deviation"].get<double>(), 2 * fine["rms_deviation"].get<double>());
  EXPECT_GT(fine["largest_deviation"].get<double>(), 0);
  const auto text = make({"export", "ggx:alpha=0.3", "--format", "rgl", "-o", "c.bsdf", "--nodes", "12"}).output;
  EXPECT_THAT(text, HasSubstr("of the largest value"));
}

TEST_F(Export, WritesSpectraForLoadersOfThem) {
  const auto options = {"--light-angles", "3", "--nodes", "4"};
  Words words{"export", "lambert:scale=0.5", "--format", "rgl", "-o", "a.bsdf", "--spectra"};
  words.insert(words.end(), options.begin(), options.end());
  EXPECT_THAT(make(words).output, HasSubstr("550 nm"));
  expect_refusal({"export", "lambert", "--format", "csv", "-o", "a.csv", "--spectra"}, ExitCode::usage,
                 "--spectra is for the format 'rgl'; leave it out for 'csv'");
  expect_refusal({"export", "lambert", "--format", "rgl", "-o", "b.bsdf", "--light-angles", "1"}, ExitCode::usage,
                 "1 angles of the light for an RGL file; expected 2 to 4096");
  expect_refusal({"export", "mirror", "--format", "rgl", "-o", "b.bsdf"}, ExitCode::usage, "has delta parts");
}

TEST_F(Export, SaysHowMuchLightSamplesLose) {
  const double exact = json({"mean-albedo", "ggx:alpha=0.3"})["materials"][0]["mean_albedo"][0]["value"].get<double>();
  for (const char* format : {"alta", "csv", "merl", "rgl", "utia"}) {
    const std::string name = std::string("gloss.") + format;
    const Json written = json({"export", "ggx:alpha=0.3", "--format", format, "-o", name});
    const Json read = json({"mean-albedo", name})["materials"][0]["mean_albedo"];

    ASSERT_EQ(written["source_mean_albedo"].size(), 1U) << format;
    EXPECT_NEAR(written["source_mean_albedo"][0]["value"].get<double>(), exact, 1e-6) << format;
    EXPECT_EQ(written["mean_albedo"], read) << format;
  }
  const Json klems = json({"export", "ggx:alpha=0.3", "--format", "klems", "-o", "gloss.xml"});
  EXPECT_FALSE(klems.contains("source_mean_albedo"));
  EXPECT_LE(std::abs(klems["mean_albedo"][0]["value"].get<double>() - exact),
            klems["mean_albedo"][0]["error"].get<double>());
}

TEST_F(Export, RefusesAnisotropicMaterialsWhereTheFormatHasNoTurns) {
  for (const char* format : {"alta", "merl", "openmaterial", "scatfun"}) {
    expect_refusal({"export", "ggx_anisotropic:alpha_x=0.3,alpha_y=0.5", "--format", format, "-o", "a.x"},
                   ExitCode::usage, "is anisotropic");
  }
}

TEST_F(Export, KeepsStandardDeviations) {
  std::ofstream csv(file("measured.csv"));
  csv << "theta_in_deg,theta_out_deg,delta_phi_deg,550 nm,550 nm_std\n";
  for (const char* in : {"0", "45", "80"}) {
    for (const char* out : {"0", "45", "80"}) {
      for (const char* phi : {"0", "180"}) csv << in << ',' << out << ',' << phi << ",0.3,0.03\n";
    }
  }
  csv.close();
  make({"export", "measured.csv", "--format", "csv", "-o", "copy.csv"});
  const Json answer = json({"eval", "copy.csv", "--theta-in", "45", "--theta-out", "45", "--delta-phi", "180"});
  // 100 replicates give 7 %, twice; here up to four times that.
  EXPECT_NEAR(answer["values"][0]["brdf_measurement"][0].get<double>() / 0.03, 1, 0.4);
}

TEST_F(Export, WarnsWhereSamplesMissALobe) {
  const auto narrow = make({"export", "phong:n=5000", "--format", "utia", "-o", "narrow.utia"});
  EXPECT_THAT(narrow.error, HasSubstr("lobe: warning: the samples of 'utia' are too far apart for this: read again the "
                                      "mean albedo is "));
  const auto wide = make({"export", "phong:n=5", "--format", "utia", "-o", "wide.utia"});
  EXPECT_THAT(wide.error, ::testing::IsEmpty());
}

// The light of cells is right within an error that hides what their samples lose.
TEST_F(Export, WarnsOfValuesThatAreOff) {
  make({"export", "lambert:scale=0.2+phong:n=200", "--format", "klems", "-o", "cells.xml"});
  const auto outcome = make({"export", "cells.xml", "--format", "csv", "-o", "cells.csv", "--json"});
  const Json answer = Json::parse(outcome.output);
  const double off = std::abs(answer["mean_albedo"][0]["value"].get<double>() -
                              answer["source_mean_albedo"][0]["value"].get<double>());
  EXPECT_LT(off, answer["mean_albedo"][0]["error"].get<double>());
  EXPECT_GT(answer["rms_deviation"].get<double>(), 0.4);
  EXPECT_THAT(outcome.error, HasSubstr("too far apart for this: read again values are off by "));
}

// 4.5 and 6.6 % more light.
TEST_F(Export, WarnsOfATwentiethOfTheLight) {
  EXPECT_THAT(make({"export", "phong:n=70", "--format", "utia", "-o", "less.utia"}).error, ::testing::IsEmpty());
  EXPECT_THAT(make({"export", "phong:n=80", "--format", "utia", "-o", "more.utia"}).error, HasSubstr("too far apart"));
}

TEST_F(Export, NamesTheChannelsOfWhatItWrites) {
  const auto outcome = make({"export", "lambert:scale=0.5", "--format", "utia", "-o", "matt.utia"});
  EXPECT_THAT(outcome.output, HasSubstr("mean albedo  0.5"));
  const auto three = make({"export", "matt.utia", "--format", "csv", "-o", "three.csv"});
  EXPECT_THAT(three.output, HasSubstr("mean albedo, green  0.5"));
  EXPECT_THAT(three.output, HasSubstr(", in the file 0.5"));
}

TEST_F(Export, TakesPointsOfCellsWhereThereAreCells) {
  expect_refusal({"export", "lambert", "--format", "csv", "--cell-points", "8", "-o", "a.csv"}, ExitCode::usage,
                 "--cell-points is for formats of cells; leave it out for 'csv'");
  make({"export", "lambert", "--format", "klems", "--cell-points", "2", "-o", "a.xml"});
}

TEST_F(Export, TakesLeavesWhereThereAreTrees) {
  expect_refusal({"export", "lambert", "--format", "klems", "--leaves", "8", "-o", "a.xml"}, ExitCode::usage,
                 "--leaves is for the format 'tensor-tree'; leave it out for 'klems'");
  expect_refusal({"export", "lambert", "--format", "tensor-tree", "--leaves", "12", "-o", "a.xml"}, ExitCode::usage,
                 "expected a power of two from 2 to 128");
  make({"export", "ward:m=0.5", "--format", "tensor-tree", "--leaves", "8", "-o", "a.xml"});
  make({"export", "ward:m=0.5", "--format", "tensor-tree", "--leaves", "16", "-o", "b.xml"});
  EXPECT_GT(std::filesystem::file_size(file("b.xml")), 4 * std::filesystem::file_size(file("a.xml")));
}

TEST_F(Export, KeepsMirrorsInPatches) {
  make({"export", "lambert:scale=0.3+mirror:scale=0.5", "--format", "klems", "-o", "gloss.xml"});
  EXPECT_NEAR(json({"mean-albedo", "gloss.xml"})["materials"][0]["mean_albedo"][0]["value"].get<double>(), 0.8, 1e-12);
}

TEST_F(Export, LosesNoMirror) {
  make({"export", "mirror", "--format", "klems", "-o", "mirror.xml"});
  expect_refusal({"export", "mirror.xml", "--format", "csv", "-o", "a.csv"}, ExitCode::usage, "has delta parts");
  expect_refusal({"info", "mirror.xml", "--theta-max", "80"}, ExitCode::usage, "has delta parts");
  EXPECT_NEAR(json({"mean-albedo", "mirror.xml"})["materials"][0]["mean_albedo"][0]["value"].get<double>(), 1, 1e-12);
}

TEST_F(Export, RefusesWhatAFormatCannotHold) {
  expect_refusal({"export", "lambert", "--format", "merll", "-o", "a.binary"}, ExitCode::usage, "did you mean 'merl'");
  expect_refusal({"export", "mirror", "--format", "merl", "-o", "a.binary"}, ExitCode::usage, "delta parts");
  std::ofstream(file("there.binary")) << "old";
  expect_refusal({"export", "lambert", "--format", "merl", "-o", "there.binary"}, ExitCode::file, "exists");
  EXPECT_EQ(std::filesystem::file_size(file("there.binary")), 3U);
}

}  // namespace
}  // namespace lobe::test
