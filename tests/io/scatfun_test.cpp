// SCATFUN tables of cosine series: against a slow reading of the same bytes, and as reflectances of what they are of.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <numbers>
#include <span>
#include <sstream>
#include <string>
#include <vector>

#include "lobe/core/directions.hpp"
#include "lobe/core/error.hpp"
#include "lobe/energy/repair.hpp"
#include "lobe/formats/measured.hpp"
#include "support/device.hpp"
#include "support/functions.hpp"
#include "support/measured_data.hpp"
#include "support/temporary_directory.hpp"
#include "support/unzipped.hpp"
#include "table/tabulate.hpp"

namespace lobe::test {
namespace {

namespace fs = std::filesystem;
using std::numbers::pi;
using ::testing::ElementsAre;
using ::testing::HasSubstr;

/// Tables of leather, paint, rough glass and rough gold, unpacked.
class Scatfun : public MeasuredData {
 protected:
  Scatfun() : MeasuredData("fourier_computed") {}

  [[nodiscard]] std::string content(const std::string& name) const {
    return read_unzipped(data_ / (name + ".bsdf.gz"));
  }

  [[nodiscard]] fs::path unpacked(const std::string& name) const { return written(content(name)); }

  [[nodiscard]] fs::path written(const std::string& bytes) const {
    fs::path path = directory_.path() / "table.bsdf";
    std::ofstream(path, std::ios::binary) << bytes;
    return path;
  }

  void expect_refusal(const std::string& bytes, const std::string& complaint) const {
    try {
      (void)load_measured(written(bytes));
      FAIL() << "not refused; expected '" << complaint << "'";
    } catch (const IoError& error) {
      EXPECT_THAT(error.what(), HasSubstr(complaint));
    }
  }
  TemporaryDirectory directory_;
};

// --- A slow reading, as the comment in pbrt-v3's fourier.cpp describes the bytes.

template <typename Number>
Number number(const std::string& bytes, std::size_t offset) {
  Number value{};
  std::memcpy(&value, bytes.data() + offset, sizeof(Number));
  return value;
}

struct SlowTable {
  explicit SlowTable(std::string content) : bytes(std::move(content)), n(number<std::uint32_t>(bytes, 12)) {
    for (std::size_t i = 0; i < n; ++i) nodes.push_back(number<float>(bytes, 64 + 4 * i));
  }

  /// The series of a pair of nodes.
  [[nodiscard]] double at_nodes(std::size_t in, std::size_t out, std::size_t channel, double phi) const {
    const std::size_t places = 64 + 4 * n + 4 * n * n;
    const std::size_t first = number<std::uint32_t>(bytes, places + 8 * (out * n + in));
    const std::size_t count = number<std::uint32_t>(bytes, places + 8 * (out * n + in) + 4);
    double sum = 0;
    for (std::size_t k = 0; k < count; ++k) {
      sum += number<float>(bytes, places + 8 * n * n + 4 * (first + channel * count + k)) *
             std::cos(static_cast<double>(k) * phi);
    }
    return sum;
  }

  /// Hermite interpolation between nodes of any function of them, with slopes by differences.
  template <typename Function>
  [[nodiscard]] double between(double x, const Function& f) const {
    std::size_t i = 0;
    while (i + 2 < n && nodes[i + 1] <= x) ++i;
    const double x0 = nodes[i];
    const double x1 = nodes[i + 1];
    const double f0 = f(i);
    const double f1 = f(i + 1);
    const double width = x1 - x0;
    const double d0 = i > 0 ? width * (f1 - f(i - 1)) / (x1 - nodes[i - 1]) : f1 - f0;
    const double d1 = i + 2 < n ? width * (f(i + 2) - f0) / (nodes[i + 2] - x0) : f1 - f0;
    const double t = (x - x0) / width;
    return (2 * t * t * t - 3 * t * t + 1) * f0 + (t * t * t - 2 * t * t + t) * d0 + (3 * t * t - 2 * t * t * t) * f1 +
           (t * t * t - t * t) * d1;
  }

  /// pbrt has w_i turned round: mu_i = -cos theta_in, phi from -w_i to w_o.
  [[nodiscard]] double value(const Directions& pair, std::size_t channel) const {
    const double mu_in = -std::cos(pair.theta_in);
    const double mu_out = std::cos(pair.theta_out);
    return between(mu_out,
                   [&](std::size_t o) {
                     return between(mu_in, [&](std::size_t i) { return at_nodes(i, o, channel, pair.delta_phi - pi); });
                   }) /
           std::abs(mu_in);
  }

  std::string bytes;
  std::size_t n;
  std::vector<double> nodes;
};

std::vector<Directions> scatfun_pairs() {
  std::vector<Directions> pairs;
  for (int i = 0; i < 20; ++i) pairs.push_back({0.001 + 0.082 * i, 1.569 - 0.08 * i, 0.33 * i - 3, 0.2 * i});
  return pairs;
}

TEST_F(Scatfun, ColouredValuesAreThoseOfASlowReading) {
  for (const char* name : {"leather", "roughgold_alpha_0.2"}) {
    SCOPED_TRACE(name);
    const auto brdf = load_measured(unpacked(name));
    EXPECT_THAT(brdf.channels, ElementsAre("red", "green", "blue"));
    const SlowTable slow(content(name));
    const auto pairs = scatfun_pairs();
    const auto values = brdf.at(pairs).value;
    for (std::size_t i = 0; i < pairs.size(); ++i) {
      const auto at = static_cast<Eigen::Index>(i);
      const double luminance = slow.value(pairs[i], 0);
      const double red = slow.value(pairs[i], 1);
      const double blue = slow.value(pairs[i], 2);
      // Sums of up to 172 terms in another order; cancellation of terms of size f.
      const double scale = 1e-11 * (std::abs(luminance) + std::abs(red) + std::abs(blue) + 0.1);
      EXPECT_NEAR(values(at, 0), red, scale) << name << " " << i;
      EXPECT_NEAR(values(at, 2), blue, scale) << name << " " << i;
      // pbrt prints its factors with six digits.
      EXPECT_NEAR(values(at, 1), 1.39829 * luminance - 0.100913 * blue - 0.297375 * red, 1e5 * scale)
          << name << " " << i;
    }
  }
}

TEST_F(Scatfun, GreyValuesAreThoseOfASlowReading) {
  const auto brdf = load_measured(unpacked("roughglass_alpha_0.2"));
  EXPECT_THAT(brdf.channels, ElementsAre("value"));
  EXPECT_THAT(brdf.remarks, ::testing::Contains("transmission is left out"));
  const SlowTable slow(content("roughglass_alpha_0.2"));
  const auto pairs = scatfun_pairs();
  const auto values = brdf.at(pairs).value;
  for (std::size_t i = 0; i < pairs.size(); ++i) {
    const double expected = slow.value(pairs[i], 0);
    EXPECT_NEAR(values(static_cast<Eigen::Index>(i), 0), expected, 1e-11 * (0.1 + std::abs(expected))) << i;
  }
}

TEST_F(Scatfun, HighlightsLieOnTheMirrorSide) {
  const auto brdf = load_measured(unpacked("roughgold_alpha_0.2"));
  const double theta = 40 * kDegree;
  std::vector<Directions> pairs;
  for (int i = 0; i < 80; ++i) {
    for (int k = 0; k < 36; ++k) pairs.push_back({theta, i * kDegree, k * 10 * kDegree, 0});
  }
  Eigen::Index peak = 0;
  brdf.at(pairs).value.col(0).maxCoeff(&peak);
  const auto& highest = pairs[static_cast<std::size_t>(peak)];
  EXPECT_DOUBLE_EQ(highest.delta_phi, pi);
  // Off specular by a little, as rough surfaces are.
  EXPECT_NEAR(highest.theta_out, theta, 6 * kDegree);
}

TEST_F(Scatfun, TablesAreReciprocalAndKeepTheEnergy) {
  for (const char* name : {"leather", "paint", "roughglass_alpha_0.2", "roughgold_alpha_0.2"}) {
    const auto brdf = load_measured(unpacked(name));
    std::vector<Directions> pairs;
    std::vector<Directions> swapped;
    for (int i = 0; i <= 7; ++i) {
      for (int j = 0; j < i; ++j) {
        for (int k = 0; k <= 6; ++k) {
          pairs.push_back({i * 10 * kDegree, j * 10 * kDegree, k * 30 * kDegree, 0});
          swapped.push_back({j * 10 * kDegree, i * 10 * kDegree, k * 30 * kDegree, 0});
        }
      }
    }
    const Eigen::MatrixXd there = brdf.at(pairs).value;
    const Eigen::MatrixXd back = brdf.at(swapped).value;
    // What splines between the nodes lose; 2e-4 for gold.
    EXPECT_LT((there - back).norm(), 1e-3 * there.norm()) << name;
    const auto table = tabulate(brdf, HemisphereGrid::gauss(32, 64), {.allow_unresolved = true});
    for (const Estimate& mean : row_albedos(table).mean) {
      EXPECT_GT(mean.value, 0.02) << name;
      EXPECT_LT(mean.value, 1) << name;
    }
  }
}

TEST_F(Scatfun, GoldIsGolden) {
  // Linear sRGB of gold at normal incidence: 1.00, 0.77, 0.34; a little more in the mean over all angles.
  const auto table = tabulate(load_measured(unpacked("roughgold_alpha_0.2")), HemisphereGrid::gauss(32, 64),
                              {.allow_unresolved = true});
  const TableAlbedo albedos = row_albedos(table);
  EXPECT_NEAR(albedos.mean[0].value, 1.00, 0.05);
  EXPECT_NEAR(albedos.mean[1].value, 0.77, 0.05);
  EXPECT_NEAR(albedos.mean[2].value, 0.34, 0.05);
}

TEST_F(Scatfun, TheBackIsReadByName) {
  const fs::path path = unpacked("roughglass_alpha_0.2");
  const auto back = load_measured(path, {.component = "reflection back"});
  const std::vector<Directions> steep{{75 * kDegree, 75 * kDegree, pi, 0}};
  // From within the glass, total reflection.
  EXPECT_GT(back.at(steep).value(0, 0), 2 * load_measured(path).at(steep).value(0, 0));
  EXPECT_THROW((void)load_measured(path, {.component = "transmission"}), ArgumentError);
}

TEST_F(Scatfun, WhatIsNotReadIsSaid) {
  const std::string whole = content("roughgold_alpha_0.2");
  const auto with = [&](std::size_t offset, auto value) {
    std::string bytes = whole;
    std::memcpy(bytes.data() + offset, &value, sizeof(value));
    return bytes;
  };
  expect_refusal(whole.substr(0, 40), "byte 40: the file ends within the header");
  expect_refusal(whole.substr(0, whole.size() - 1),
                 "58 nodes and 41502 coefficients do not make a file of 207353 bytes");
  expect_refusal(with(7, std::uint8_t{2}), "byte 7: no SCATFUN of version 1");
  expect_refusal(with(8, std::uint32_t{3}), "byte 8: flags 3; expected 1");
  expect_refusal(with(12, std::uint32_t{0xffffffff}), "4294967295 nodes");
  expect_refusal(with(24, std::uint32_t{2}), "byte 24: 2 channels; expected 1 or 3");
  expect_refusal(with(28, std::uint32_t{4}), "byte 28: 4 bases");
  expect_refusal(with(64, -2.0F), "byte 64: node -2; expected cosines from -1 to 1");
  expect_refusal(with(72, -1.0F), "byte 72: node -1; expected cosines from -1 to 1, rising");
  const std::size_t nodes = 58;
  const std::size_t places = 64 + 4 * nodes + 4 * nodes * nodes;
  expect_refusal(with(places + 8, std::uint32_t{41503}), "byte " + std::to_string(places + 8) + ": ");
  expect_refusal(with(places + 8 * nodes * nodes, std::nanf("")), "a coefficient that is not finite");
}

/// Integral of the spline through the means of the series over mu_in, from the first node to another that is not above
/// 0: of reflection from above.
double integral_of_means(const SlowTable& table, std::size_t out, std::size_t last) {
  double sum = 0;
  for (std::size_t i = 0; i < last; ++i) {
    const double low = table.nodes[i];
    const double width = table.nodes[i + 1] - low;
    const auto mean = [&](std::size_t in) {
      const std::size_t place = 64 + 4 * table.n + 4 * table.n * table.n + 8 * (out * table.n + in);
      return number<std::uint32_t>(table.bytes, place + 4) == 0
                 ? 0.0
                 : number<float>(table.bytes, 64 + 4 * table.n + 12 * table.n * table.n +
                                                  4 * number<std::uint32_t>(table.bytes, place));
    };
    if (width == 0) continue;
    // Cubics: Simpson's rule is exact. Ends of the piece belong to it.
    const double ends = mean(i) + mean(i + 1);
    sum += width / 6 * (ends + 4 * table.between(low + width / 2, mean));
  }
  return sum;
}

void expect_integrals_of_means(const SlowTable& table) {
  for (const std::size_t out : {table.n / 2 + 5, 3 * table.n / 4, table.n - 2}) {
    for (const std::size_t last : {table.n / 8, table.n / 4, table.n / 2}) {
      const double written = number<float>(table.bytes, 64 + 4 * table.n + 4 * (out * table.n + last));
      EXPECT_NEAR(written, integral_of_means(table, out, last), 1e-5 * (1 + std::abs(written))) << out << " " << last;
    }
  }
}

// By which pbrt draws directions.
TEST_F(Scatfun, IntegralsInRealFilesAreThoseOfMeansOverTheLight) {
  expect_integrals_of_means(SlowTable(content("roughglass_alpha_0.2")));
  expect_integrals_of_means(SlowTable(content("leather")));
}

TEST(ScatfunFiles, AreWrittenWithTheLightsCosine) {
  const TemporaryDirectory directory;
  const BrdfFunction brdf = glossy_function({"value"});
  const fs::path path = directory.path() / "written.bsdf";
  save_measured(device(), brdf, "scatfun", path, {.command_line = "lobe export"});
  std::ostringstream bytes;
  bytes << std::ifstream(path, std::ios::binary).rdbuf();
  const SlowTable table(bytes.str());
  ASSERT_GT(table.n, 100U);
  for (std::size_t in = 3; in + 1 < table.n / 2; in += 9) {
    for (std::size_t out = table.n / 2 + 3; out < table.n; out += 8) {
      const double mu = -table.nodes[in];
      const double phi = 0.3 * static_cast<double>(in);
      const Directions pair{std::acos(mu), std::acos(table.nodes[out]), phi + pi, 0};
      EXPECT_NEAR(table.at_nodes(in, out, 0, phi), mu * glossy_at(pair), 3e-6) << in << " " << out;
    }
  }
  expect_integrals_of_means(table);
  EXPECT_EQ(table.at_nodes(table.n - 3, table.n - 3, 0, 0.1), 0);  // no transmission
  EXPECT_TRUE(bytes.str().ends_with("lobe export"));
}

TEST(ScatfunFiles, AreReadBackAsTheColoursThatWereWritten) {
  const TemporaryDirectory directory;
  const BrdfFunction brdf = glossy_function({"red", "green", "blue"});
  save_measured(device(), brdf, "scatfun", directory.path() / "written.bsdf");
  const auto read = load_measured(directory.path() / "written.bsdf");
  EXPECT_EQ(read.channels, brdf.channels);
  const std::vector<Directions> pairs{{0.3, 0.3, pi, 0}, {0.7, 0.6, 2.9, 0}, {1.2, 0.5, 0.4, 0}, {0, 1, 0, 0}};
  EXPECT_LT((read.at(pairs).value - brdf.at(pairs).value).cwiseAbs().maxCoeff(), 2e-4);
}

TEST(ScatfunFiles, HoldIsotropicReflectancesOfOneChannelOrThree) {
  const TemporaryDirectory directory;
  const fs::path path = directory.path() / "not.bsdf";
  BrdfFunction brdf = glossy_function({"a", "b"});
  EXPECT_THROW(save_measured(device(), brdf, "scatfun", path), ArgumentError);
  brdf = glossy_function({"value"});
  brdf.is_isotropic = false;
  EXPECT_THROW(save_measured(device(), brdf, "scatfun", path), ArgumentError);
  brdf.is_isotropic = true;
  brdf.is_bilateral = false;
  EXPECT_THROW(save_measured(device(), brdf, "scatfun", path), ArgumentError);
  EXPECT_FALSE(fs::exists(path));
}

}  // namespace
}  // namespace lobe::test
