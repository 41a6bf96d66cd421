#include "lobe/plot/table_pictures.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <numbers>
#include <string>
#include <vector>

#include "command.hpp"
#include "core/files.hpp"
#include "lobe/core/directions.hpp"
#include "lobe/core/error.hpp"
#include "lobe/energy/albedo.hpp"
#include "lobe/reflectance/evaluate.hpp"
#include "plot/drawn_reflectance.hpp"
#include "plot/panels.hpp"
#include "plot/polar_picture.hpp"
#include "plot/slice_picture.hpp"
#include "support/device.hpp"
#include "support/environment.hpp"
#include "support/temporary_directory.hpp"
#include "synthetic_table.hpp"
#include "table/evaluate.hpp"

namespace lobe::test {
namespace {

namespace fs = std::filesystem;
using std::numbers::pi;
using ::testing::DoubleNear;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::Pointwise;

std::size_t file_count(const fs::path& directory) {
  return static_cast<std::size_t>(std::distance(fs::directory_iterator(directory), fs::directory_iterator()));
}

std::vector<BrdfTable> composition_and_factors() {
  const HemisphereGrid grid = HemisphereGrid::gauss(8, 16);
  return {synthetic_composition(grid, TableForm::isotropic), synthetic_table(grid, TableForm::isotropic),
          synthetic_table(grid, TableForm::isotropic, 3)};
}

TEST(WriteTablePictures, LeavesThreePicturesOfACompositionAndItsFactors) {
  ASSERT_TRUE(has_program("gnuplot")) << "gnuplot is missing; install gnuplot-nox";
  const TemporaryDirectory directory;
  const PictureFiles files = write_table_pictures(composition_and_factors(), directory.path() / "made", "x");
  EXPECT_EQ(files.note, "");
  EXPECT_THAT(files.pictures,
              ElementsAre(directory.path() / "made" / "x.polar.png", directory.path() / "made" / "x.slice.png",
                          directory.path() / "made" / "x.albedo.png"));
  EXPECT_EQ(files.scripts.size(), 6U);
  EXPECT_EQ(file_count(directory.path() / "made"), 9U);
}

TEST(WriteTablePictures, LeavesSvgWhereAskedFor) {
  ASSERT_TRUE(has_program("gnuplot")) << "gnuplot is missing; install gnuplot-nox";
  const TemporaryDirectory directory;
  const PictureFiles files =
      write_table_pictures(composition_and_factors(), directory.path(), "x", {.format = PictureFormat::svg});
  EXPECT_EQ(files.note, "");
  ASSERT_EQ(files.pictures.size(), 3U);
  EXPECT_EQ(read_text(files.pictures[0]).find("<?xml"), 0U);
}

TEST(WriteTablePictures, DrawsGridsOfPatches) {
  ASSERT_TRUE(has_program("gnuplot")) << "gnuplot is missing; install gnuplot-nox";
  const TemporaryDirectory directory;
  const std::vector<BrdfTable> tables = {synthetic_table(HemisphereGrid::klems(41), TableForm::general),
                                         synthetic_table(HemisphereGrid::shirley_chiu(8), TableForm::general)};
  const PictureFiles files = write_table_pictures(tables, directory.path(), "x");
  EXPECT_EQ(files.note, "");
  EXPECT_EQ(files.pictures.size(), 3U);
}

TEST(WriteTablePictures, DrawsATableThatIsZero) {
  ASSERT_TRUE(has_program("gnuplot")) << "gnuplot is missing; install gnuplot-nox";
  const TemporaryDirectory directory;
  std::vector<BrdfTable> tables = {synthetic_table(HemisphereGrid::gauss(8, 16), TableForm::isotropic)};
  std::ranges::fill(tables.front().values, 0.0);
  EXPECT_EQ(write_table_pictures(tables, directory.path(), "x").note, "");
}

TEST(WriteTablePictures, SucceedsWithoutGnuplotAndSaysWhatIsMissing) {
  const TemporaryDirectory directory;
  const ScopedVariable path("PATH", "");
  const PictureFiles files = write_table_pictures(composition_and_factors(), directory.path(), "x");
  EXPECT_NE(files.note.find("gnuplot is not installed"), std::string::npos) << files.note;
  EXPECT_TRUE(files.pictures.empty());
  EXPECT_EQ(file_count(directory.path()), 6U);
}

TEST(WriteTablePictures, KeepsExistingFilesUnlessToldToOverwrite) {
  const TemporaryDirectory directory;
  const ScopedVariable path("PATH", "");
  write_text(directory.path() / "x.slice.png", false, "mine");
  EXPECT_THROW(write_table_pictures(composition_and_factors(), directory.path(), "x"), IoError);
  EXPECT_EQ(read_text(directory.path() / "x.slice.png"), "mine");
  EXPECT_EQ(file_count(directory.path()), 1U);
}

TEST(WriteTablePictures, RefusesNoTables) {
  EXPECT_THROW(write_table_pictures({}, ".", "x"), ArgumentError);
}

TEST(IncidencePlanes, AreAtRoundAngles) {
  const auto planes = incidence_planes(synthetic_table(HemisphereGrid::uniform(90, 4), TableForm::isotropic));
  ASSERT_EQ(planes.size(), 4U);
  EXPECT_EQ(planes[0].theta_in, 0);
  EXPECT_EQ(planes[1].theta_in, 30 * kDegree);
  EXPECT_EQ(planes[2].theta_in, 60 * kDegree);
  EXPECT_EQ(planes[3].theta_in, 75 * kDegree);
}

TEST(IncidencePlanes, HaveTheValuesBetweenTheNodes) {
  const BrdfTable table = synthetic_table(HemisphereGrid::gauss(32, 64), TableForm::isotropic);
  const auto plane = incidence_planes(table)[1];
  std::vector<Directions> directions;
  for (const double theta : plane.theta_out) {
    directions.push_back({30 * kDegree, std::abs(theta), theta < 0 ? 0 : pi});
  }
  const auto values = evaluate(table, directions).front();
  for (std::size_t i = 0; i < values.size(); ++i) ASSERT_EQ(plane.f[i], values[i].value) << plane.theta_out[i];
}

TEST(IncidencePlanes, EndAtTheLastRing) {
  const HemisphereGrid grid = HemisphereGrid::uniform(2, 4);
  const double last = grid.rings().back().theta;
  ASSERT_LT(last, 75 * kDegree);
  const auto planes = incidence_planes(synthetic_table(grid, TableForm::isotropic));
  EXPECT_EQ(planes.size(), 3U);
  EXPECT_EQ(planes.back().theta_out.front(), -last);
  EXPECT_EQ(planes.back().theta_out.back(), last);
}

TEST(IncidencePlanes, EndAt85Degrees) {
  const auto planes = incidence_planes(synthetic_table(HemisphereGrid::gauss(64, 4), TableForm::isotropic));
  EXPECT_EQ(planes.back().theta_out.front(), -85 * kDegree);
  EXPECT_EQ(planes.back().theta_out.back(), 85 * kDegree);
}

/// Runs of so many line ends.
std::size_t runs_of_line_ends(const std::string& text, std::size_t length) {
  std::size_t count = 0;
  for (std::size_t at = text.find('\n'); at != std::string::npos; at = text.find('\n', at)) {
    const std::size_t end = std::min(text.find_first_not_of('\n', at), text.size());
    count += end - at == length ? 1 : 0;
    at = end;
  }
  return count;
}

TEST(PolarPicture, BreaksCurvesBeyondTheRim) {
  BrdfTable table = synthetic_table(HemisphereGrid::gauss(64, 4), TableForm::isotropic);
  std::ranges::fill(table.values, 1.0);
  const auto whole = polar_picture("x", std::vector{drawn(table)}, PictureFormat::png);
  const std::size_t rings = table.grid.n_theta();
  const std::size_t half = table.grid.half_azimuths();
  // f is a thousand from 82 degrees on, where nothing sets the scale, and left of it.
  for (std::size_t i = 0; i < rings; ++i) {
    for (std::size_t j = 0; j < rings; ++j) {
      const bool is_bright = table.grid.rings()[j].theta > 82 * kDegree;
      for (std::size_t k = 0; k < half && is_bright; ++k) table.values[(i * rings + j) * half + k] = 1000;
    }
  }
  const auto cut = polar_picture("x", std::vector{drawn(table)}, PictureFormat::png);
  EXPECT_THAT(cut.script, HasSubstr("up to 85°"));
  EXPECT_THAT(cut.script, HasSubstr("cut at the rim"));
  // Three line ends or more part the blocks, which are as many as before; on the right the break is in front of them.
  EXPECT_EQ(runs_of_line_ends(cut.data, 3), runs_of_line_ends(whole.data, 3) - 4);
  EXPECT_EQ(runs_of_line_ends(cut.data, 4), 4U) << "one for each curve";
}

TEST(IncidencePlanes, AreThoseOfTheNearestRowsOnGridsOfCells) {
  const HemisphereGrid grid = HemisphereGrid::klems(145);
  const auto planes = incidence_planes(synthetic_table(grid, TableForm::general));
  ASSERT_EQ(planes.size(), 4U);
  EXPECT_EQ(planes[1].theta_in, grid.rings()[3].theta);
}

TEST(IncidencePlanes, HaveTheMirrorDirectionOnThePositiveSide) {
  const auto planes = incidence_planes(synthetic_table(HemisphereGrid::gauss(32, 64), TableForm::isotropic));
  const auto& plane = planes[1];
  const auto peak = static_cast<std::size_t>(std::ranges::max_element(plane.f) - plane.f.begin());
  EXPECT_NEAR(plane.theta_out[peak], plane.theta_in, 0.5 * kDegree);
  EXPECT_TRUE(std::ranges::is_sorted(plane.theta_out));
}

TEST(IncidencePlanes, AreTheSameForTheGeneralForm) {
  const HemisphereGrid grid = HemisphereGrid::gauss(6, 8);
  const auto isotropic = incidence_planes(synthetic_table(grid, TableForm::isotropic));
  const auto general = incidence_planes(to_general(synthetic_table(grid, TableForm::isotropic)));
  ASSERT_EQ(isotropic.size(), general.size());
  // The two forms add the same terms in another order.
  EXPECT_THAT(general.back().f, Pointwise(DoubleNear(1e-13), isotropic.back().f));
  EXPECT_EQ(isotropic.back().theta_out, general.back().theta_out);
}

TEST(IncidencePlanes, ReachFromHorizonToHorizonOnGridsOfCells) {
  const auto planes = incidence_planes(synthetic_table(HemisphereGrid::klems(145), TableForm::general));
  EXPECT_NEAR(planes[0].theta_out.front(), -pi / 2, 1e-9);
  EXPECT_NEAR(planes[0].theta_out.back(), pi / 2, 1e-9);
}

TEST(IncidencePlanes, AreMeansOfTheChannels) {
  const HemisphereGrid grid = HemisphereGrid::gauss(6, 8);
  const auto one = incidence_planes(synthetic_table(grid, TableForm::isotropic));
  const auto three = incidence_planes(synthetic_table(grid, TableForm::isotropic, 3));
  EXPECT_NEAR(three[0].f[3], one[0].f[3] + 0.1, 1e-14);
}

TEST(RadialScale, IsLinearForPeaksOfLikeHeight) {
  const RadialScale scale(std::vector<double>{1.0, 3.9});
  EXPECT_EQ(scale.note(), "radius: proportional to f");
  EXPECT_EQ(scale.top(), 4);
  EXPECT_EQ(scale.radius(1), 0.25);
  EXPECT_THAT(scale.ticks(), ElementsAre(1, 2, 3, 4));
}

TEST(RadialScale, TakesTheCubeRootOfPeaksOfSeveralDecades) {
  const RadialScale scale(std::vector<double>{0.01, 1.0});
  EXPECT_EQ(scale.note(), "radius: cube root of f");
  EXPECT_NEAR(scale.radius(0.125), 0.5, 1e-15);
  EXPECT_EQ(scale.ticks().back(), 1);
}

TEST(RadialScale, TakesTheLogarithmOfPeaksOfManyDecades) {
  const RadialScale scale(std::vector<double>{1e-6, 1.0});
  EXPECT_EQ(scale.note(), "radius: logarithm of f, centre: 0.0001 sr⁻¹ and below");
  EXPECT_NEAR(scale.radius(0.01), 0.5, 1e-15);
  EXPECT_EQ(scale.radius(0), 0);
}

TEST(RadialScale, CutsAtTheRimAndAtTheCentre) {
  const RadialScale scale(std::vector<double>{1.0});
  EXPECT_EQ(scale.radius(7), 1);
  EXPECT_EQ(scale.radius(-1), 0);
}

TEST(RadialScale, IsAHarmlessOneForNothing) {
  const RadialScale scale(std::vector<double>{0.0});
  EXPECT_EQ(scale.radius(0), 0);
  EXPECT_EQ(scale.ticks().back(), scale.top());
}

TEST(HalfDifferenceDirections, AreMirroredWhereTheHalfVectorIsTheNormal) {
  const Directions pair = half_difference_directions(0, 0.7);
  EXPECT_NEAR(pair.theta_in, 0.7, 1e-15);
  EXPECT_NEAR(pair.theta_out, 0.7, 1e-15);
  EXPECT_NEAR(pair.delta_phi, pi, 1e-15);
}

TEST(HalfDifferenceDirections, CoincideWithTheHalfVectorWithoutDifference) {
  const Directions pair = half_difference_directions(0.7, 0);
  EXPECT_NEAR(pair.theta_in, 0.7, 1e-15);
  EXPECT_EQ(pair.delta_phi, 0);
}

TEST(InTwoLines, LeavesAShortTextAlone) {
  EXPECT_EQ(in_two_lines("ward:m=0.2", 10), "ward:m=0.2");
}

TEST(InTwoLines, BreaksBetweenOperands) {
  EXPECT_EQ(in_two_lines("grey reference sphere", 20), "grey reference\nsphere");
  EXPECT_EQ(in_two_lines("three point lights | daylight", 21), "three point lights |\ndaylight");
  EXPECT_EQ(in_two_lines("compose(phong:n=20, ward:m=0.2)", 24), "compose(phong:n=20,\nward:m=0.2)");
}

TEST(InTwoLines, CutsWhatIsTooLong) {
  EXPECT_EQ(in_two_lines("aaaaaaaaaabbbbbbbbbbcc", 10), "aaaaaaaaaa\nbbbbbbbbb…");
}

TEST(SourceNames, AreNamedOnce) {
  std::vector<DrawnReflectance> all;
  for (const auto& table : composition_and_factors()) all.push_back(drawn(table));
  EXPECT_EQ(source_names(all), "gauss:8x16");
}

TEST(DrawnReflectances, OfFormulasHaveTheirOwnValues) {
  const Material material = parse_material("lambert:scale=0.3+ward:m=0.001,scale=0.2+mirror:rho=0.1");
  const DrawnReflectance found = drawn(device(), material);
  EXPECT_EQ(found.source, "own values");
  EXPECT_TRUE(found.has_delta);
  ASSERT_EQ(found.planes.size(), 4U);
  const IncidencePlane& plane = found.planes[1];
  EXPECT_TRUE(plane.has_mirror);
  EXPECT_FALSE(plane.has_retro);
  std::vector<Directions> directions;
  for (const double theta : plane.theta_out) {
    directions.push_back({30 * kDegree, std::abs(theta), theta < 0 ? 0 : pi});
  }
  const auto values = evaluate(device(), parse_material("lambert:scale=0.3+ward:m=0.001,scale=0.2"), directions).value;
  for (std::size_t i = 0; i < directions.size(); ++i) {
    ASSERT_EQ(plane.f[i], values(static_cast<Eigen::Index>(i), 0)) << plane.theta_out[i];
  }
  EXPECT_GT(*std::ranges::max_element(plane.f), 1e3) << "the highlight is met, however narrow";
  EXPECT_NEAR(found.albedo.mean, mean_albedo(device(), material).front().value, 1e-4);
  EXPECT_EQ(found.albedo.in, found.albedo.out);
}

TEST(DrawnReflectances, OfFunctionsHaveTheAlbedosOfBothSides) {
  BrdfFunction brdf;
  brdf.name = "one-sided";
  brdf.channels = {"only"};
  brdf.is_bilateral = true;
  brdf.at = [](std::span<const Directions> pairs) {
    BrdfValues values{Eigen::MatrixXd(static_cast<Eigen::Index>(pairs.size()), 1), {}};
    for (std::size_t i = 0; i < pairs.size(); ++i) {
      values.value(static_cast<Eigen::Index>(i), 0) = std::cos(pairs[i].theta_out) / pi;
    }
    return values;
  };
  const AlbedoByAngle albedo = drawn(device(), brdf).albedo;
  ASSERT_EQ(albedo.in.size(), albedo.theta.size());
  for (std::size_t i = 0; i < albedo.theta.size(); ++i) {
    // The integrals of cos theta_V / pi over V and over L.
    EXPECT_NEAR(albedo.in[i], 2.0 / 3, 1e-3) << albedo.theta[i];
    EXPECT_NEAR(albedo.out[i], std::cos(albedo.theta[i]), 1e-3) << albedo.theta[i];
  }
  EXPECT_NEAR(albedo.mean, 2.0 / 3, 1e-3);
}

TEST(DrawnReflectances, OfTablesAreThoseOfTheTables) {
  const BrdfTable table = synthetic_table(HemisphereGrid::gauss(8, 16), TableForm::isotropic);
  const DrawnReflectance of_table = drawn(table);
  const DrawnReflectance of_reflectance = drawn(device(), table);
  EXPECT_EQ(of_reflectance.source, "gauss:8x16");
  EXPECT_EQ(of_reflectance.albedo.in, of_table.albedo.in);
  EXPECT_EQ(of_reflectance.planes.front().f, of_table.planes.front().f);
}

}  // namespace
}  // namespace lobe::test
