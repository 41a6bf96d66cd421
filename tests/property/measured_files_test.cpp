// The readers of measured files and their integrals against independent ones (tests/reference/measured_files.hpp).
#include "reference/measured_files.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <random>
#include <string>
#include <vector>

#include "lobe/measured.hpp"
#include "support/measured_data.hpp"

namespace lobe::test {
namespace {

using reference::MeasuredFile;
using reference::Rgb;
using std::numbers::pi;

std::vector<Directions> random_pairs(std::size_t count) {
  std::mt19937_64 engine(20261123);
  std::uniform_real_distribution<double> theta(0, 85 * pi / 180);
  std::uniform_real_distribution<double> turn(-pi, pi);
  std::vector<Directions> pairs;
  for (std::size_t k = 0; k < count; ++k) {
    // Half of them about the mirror direction, where measured values change most.
    const double in = theta(engine);
    const double out = k % 2 == 0 ? theta(engine) : std::clamp(in + 0.02 * turn(engine), 0.0, 85 * pi / 180);
    pairs.push_back({in, out, k % 2 == 0 ? turn(engine) : pi + 0.02 * turn(engine)});
  }
  return pairs;
}

/// Values at pairs of directions relative to the largest there, as both routes round differently at highlights.
double largest_difference(const BrdfFunction& found, const MeasuredFile& expected) {
  const auto pairs = random_pairs(2000);
  const auto values = found.at(pairs).value;
  double worst = 0;
  for (std::size_t k = 0; k < pairs.size(); ++k) {
    const Rgb f = expected.f(pairs[k].theta_in, pairs[k].theta_out, pairs[k].delta_phi);
    for (std::size_t c = 0; c < 3; ++c) {
      const double value = values(static_cast<Eigen::Index>(k), static_cast<Eigen::Index>(c));
      worst = std::max(worst, std::abs(value - f[c]) / std::max(std::abs(f[c]), 1e-3));
    }
  }
  return worst;
}

std::vector<std::filesystem::path> files_in(const std::filesystem::path& folder) {
  std::vector<std::filesystem::path> files;
  for (const auto& entry : std::filesystem::directory_iterator(folder)) files.push_back(entry.path());
  std::ranges::sort(files);
  return files;
}

class NeuralEncodings : public MeasuredData {
 protected:
  NeuralEncodings() : MeasuredData("nbrdf") {}
};

class TensorFiles : public MeasuredData {
 protected:
  TensorFiles() : MeasuredData("rgl_bsdf") {}
};

TEST_F(NeuralEncodings, HaveTheValuesOfAnIndependentReader) {
  for (const char* folder : {"merl", "nielsen", "rgl-isotropic"}) {
    for (const auto& path : files_in(data_ / folder)) {
      EXPECT_LT(largest_difference(load_measured(path), reference::read_nbrdf(path)), 1e-9) << path;
    }
  }
}

TEST_F(TensorFiles, HaveTheValuesOfAnIndependentReader) {
  for (const auto& path : files_in(data_)) {
    EXPECT_LT(largest_difference(load_measured(path), reference::read_rgl(path)), 1e-9) << path;
  }
}

MeasuredFile file_of(const std::function<double(double, double, double)>& f) {
  return {"closed form",
          [f](double in, double out, double delta_phi) {
            const double value = f(in, out, delta_phi);
            return Rgb{value, 2 * value, 0};
          },
          false, 0};
}

TEST(ReferenceOfFiles, IntegratesWhatIsKnownInClosedForm) {
  // (1 + sin delta_phi) cos theta_out: 2 pi / 3 at every angle, and over a cone 2 pi/3 (1 - cos^3).
  const auto file = file_of([](double, double out, double phi) { return (1 + std::sin(phi)) * std::cos(out); });
  const auto whole = reference::albedo(file, 0.5, 1e-10);
  EXPECT_NEAR(whole.value[0], 2 * pi / 3, 1e-10);
  EXPECT_NEAR(whole.value[1], 4 * pi / 3, 1e-10);
  const auto cone = reference::albedo(file, 0, 1e-10, 1);
  EXPECT_NEAR(cone.value[0], 2 * pi / 3 * (1 - std::pow(std::cos(1), 3)), 1e-10);
}

TEST(ReferenceOfFiles, MeansOverPairsAreThoseInClosedForm) {
  const auto constant = file_of([](double, double, double) { return 0.5; });
  const double largest = std::pow(std::sin(80 * pi / 180), 2);
  const auto means = reference::pair_means(constant, 80 * pi / 180, 0.1, 20000, 8, 1);
  EXPECT_NEAR(means.albedo.value[0], 0.5 * pi * largest * largest, 5 * means.albedo.error[0]);
  EXPECT_NEAR(means.square.value[0], 0.25 * pi * pi * largest * largest, 5 * means.square.error[0]);
  EXPECT_LT(means.square.error[0], 0.002);
}

}  // namespace
}  // namespace lobe::test
