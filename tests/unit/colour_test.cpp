// Colours of spectra against what the CIE and IEC publish.
#include "lobe/core/colour.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <limits>
#include <string>
#include <vector>

#include "lobe/core/error.hpp"

namespace lobe::test {
namespace {

using ::testing::HasSubstr;

constexpr std::array kWhite{500.0};  // one sample: the same at all wavelengths

Eigen::Vector3d white_of(Illuminant illuminant) {
  return spectrum_to_xyz(kWhite, illuminant);
}

TEST(Colour, MatchingFunctionsAddUpToThePublishedSums) {
  std::array<double, 3> sums{};
  for (int nanometres = 380; nanometres <= 780; nanometres += 5) {
    for (std::size_t k = 0; k < 3; ++k) sums[k] += colour_matching(nanometres)[k];
  }
  // CIE 15:2004, table T.4.
  EXPECT_NEAR(sums[0], 21.371524, 1e-6);
  EXPECT_NEAR(sums[1], 21.371327, 1e-6);
  EXPECT_NEAR(sums[2], 21.371540, 1e-6);
}

TEST(Colour, OfASingleWavelengthIsOnTheSpectralLocus) {
  const auto [x, y, z] = colour_matching(520);  // CIE 15:2004, table T.4: x = 0.07430, y = 0.83380
  EXPECT_NEAR(x / (x + y + z), 0.07430, 5e-6);
  EXPECT_NEAR(y / (x + y + z), 0.83380, 5e-6);
}

TEST(Colour, IsNothingBeyondTheVisibleRange) {
  EXPECT_EQ(colour_matching(379.9), (std::array<double, 3>{0, 0, 0}));
  EXPECT_EQ(colour_matching(780.1), (std::array<double, 3>{0, 0, 0}));
}

TEST(Colour, OfEqualEnergyIsOneOneOne) {
  const Eigen::Vector3d white = white_of(Illuminant::equal_energy);
  for (const double value : white) EXPECT_NEAR(value, 1, 1.1e-5);  // what the table's sums differ by
}

TEST(Colour, OfD65HasThePublishedTristimulusValuesAndChromaticity) {
  const Eigen::Vector3d white = white_of(Illuminant::daylight);
  // CIE 15:2004, table T.3: 95.04, 100, 108.88; x = 0.31272, y = 0.32903.
  EXPECT_NEAR(white.x(), 0.9504, 5e-5);
  EXPECT_NEAR(white.y(), 1, 1e-12);
  EXPECT_NEAR(white.z(), 1.0888, 5e-5);
  EXPECT_NEAR(white.x() / white.sum(), 0.31272, 1e-5);
  EXPECT_NEAR(white.y() / white.sum(), 0.32903, 1e-5);
}

TEST(Colour, OfD65IsTheWhiteOfSrgb) {
  const Eigen::Vector3d white = xyz_to_srgb() * white_of(Illuminant::daylight);
  for (const double value : white) EXPECT_NEAR(value, 1, 1e-14);
}

TEST(Colour, MatrixIsThatOfTheStandard) {
  Eigen::Matrix3d published;  // IEC 61966-2-1
  published << 3.2406, -1.5372, -0.4986, -0.9689, 1.8758, 0.0415, 0.0557, -0.2040, 1.0570;
  // The standard rounds its white to four digits.
  EXPECT_LT((xyz_to_srgb() - published).cwiseAbs().maxCoeff(), 1e-3);
}

TEST(Colour, TransferCurveIsThatOfTheStandard) {
  EXPECT_NEAR(encode_srgb(0.214041140482), 0.5, 1e-12);
  EXPECT_NEAR(decode_srgb(0.5), 0.214041140482, 1e-12);
  EXPECT_NEAR(encode_srgb(0.001), 0.01292, 1e-15);
  EXPECT_EQ(encode_srgb(-0.1), 0);
  EXPECT_NEAR(encode_srgb(7), 1, 1e-15);
}

TEST(Colour, OfASpectrumDoesNotDependOnHowItIsSampled) {
  // A ramp is linear between any samples.
  const std::vector<double> few{380, 780};
  const std::vector<double> many{700, 380, 500, 420, 780};
  const auto colour = [](const std::vector<double>& wavelengths) -> Eigen::Vector3d {
    Eigen::VectorXd ramp(static_cast<Eigen::Index>(wavelengths.size()));
    for (Eigen::Index k = 0; k < ramp.size(); ++k) ramp(k) = wavelengths[static_cast<std::size_t>(k)] / 800;
    return spectrum_to_xyz(wavelengths, Illuminant::daylight) * ramp;
  };
  EXPECT_LT((colour(few) - colour(many)).norm(), 1e-12);
}

TEST(Colour, OfASpectrumIsThatOfItsEndBeyondIt) {
  const std::vector<double> wavelengths{500, 600};
  const Eigen::Matrix3Xd weights = spectrum_to_xyz(wavelengths, Illuminant::equal_energy);
  double below = 0;
  for (int nanometres = 380; nanometres <= 500; nanometres += 5) below += colour_matching(nanometres)[2];
  for (int nanometres = 505; nanometres < 600; nanometres += 5) {
    below += (600 - nanometres) / 100.0 * colour_matching(nanometres)[2];
  }
  EXPECT_NEAR(weights(2, 0), below / 21.371327, 1e-12);
}

TEST(Colour, RefusesWavelengthsThatAreNone) {
  const auto complaint = [](const std::vector<double>& wavelengths) -> std::string {
    try {
      (void)spectrum_to_xyz(wavelengths, Illuminant::daylight);
    } catch (const ArgumentError& error) {
      return error.what();
    }
    return {};
  };
  EXPECT_THAT(complaint({}), HasSubstr("no wavelengths"));
  EXPECT_THAT(complaint({500, 500}), HasSubstr("500 nm occurs twice"));
  EXPECT_THAT(complaint({500, std::numeric_limits<double>::quiet_NaN()}), HasSubstr("no finite number"));
}

TEST(DisplayColours, TakesRedGreenAndBlueByName) {
  const std::vector<std::string> names{"blue", "Red", "infrared", "green"};
  const DisplayColours colours = display_colours(names, {});
  Eigen::MatrixXd expected(3, 4);
  expected << 0, 1, 0, 0, 0, 0, 0, 1, 1, 0, 0, 0;
  EXPECT_EQ(colours.weights, expected);
}

TEST(DisplayColours, TakesThreeChannelsWithoutNamesForRedGreenAndBlue) {
  const std::vector<std::string> names{"1", "2", "3"};
  EXPECT_EQ(display_colours(names, {}).weights, Eigen::MatrixXd::Identity(3, 3));
}

TEST(DisplayColours, ShowsWhatReflectsAllWavelengthsAlikeAsAGrey) {
  const std::vector<std::string> names{"450 nm", "500 nm", "550 nm", "600 nm", "650 nm"};
  const DisplayColours colours = display_colours(names, {});
  ASSERT_EQ(colours.weights.rows(), 3);
  const Eigen::Vector3d white = colours.weights.rowwise().sum();
  for (const double value : white) EXPECT_NEAR(value, 1, 1e-14);
}

TEST(DisplayColours, TakesSpectraThatSayEnoughOfTheVisibleRange) {
  const std::vector<std::string> names{"a", "b", "c", "d", "e"};
  const auto rows = [&](const std::vector<double>& wavelengths) {
    return display_colours(names, wavelengths).weights.rows();
  };
  EXPECT_EQ(rows({450, 500, 550, 600, 650}), 3);
  EXPECT_EQ(rows({450, 500, 550, 600, 640}), 1);  // ends before 650 nm
  EXPECT_EQ(rows({450, 500, 565, 610, 650}), 1);  // a gap of 65 nm
}

TEST(DisplayColours, ShowsWhatReflectsLongWavelengthsAsARed) {
  const std::vector<std::string> names{"450 nm", "500 nm", "550 nm", "600 nm", "650 nm"};
  const Eigen::Vector3d red = display_colours(names, {}).weights.col(4);
  EXPECT_GT(red(0), 0.1);
  EXPECT_GT(red(0), 5 * std::abs(red(1)));
  EXPECT_GT(red(0), 5 * std::abs(red(2)));
}

TEST(DisplayColours, ShowsOtherChannelsAsTheirMean) {
  const std::vector<std::string> names{"1.06 um", "10.6 um"};
  const DisplayColours colours = display_colours(names, {});
  EXPECT_EQ(colours.weights, Eigen::MatrixXd::Constant(1, 2, 0.5));
  EXPECT_THAT(colours.text, HasSubstr("mean of 2 channels"));
}

}  // namespace
}  // namespace lobe::test
