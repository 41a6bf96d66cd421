// MERL files: against a reading by rotations and loops, written and read again, with holes, and damaged.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <array>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <numbers>
#include <random>
#include <string>
#include <vector>

#include "io/measured_files.hpp"
#include "support/device.hpp"
#include "support/temporary_directory.hpp"

namespace lobe::test {
namespace {

using Eigen::Vector3d;
using std::numbers::pi;
using ::testing::ElementsAre;
using ::testing::HasSubstr;

constexpr std::array<double, 3> kFactor{1.0 / 1500, 1.15 / 1500, 1.66 / 1500};

Vector3d unit(double theta, double phi) {
  return {std::sin(theta) * std::cos(phi), std::sin(theta) * std::sin(phi), std::cos(theta)};
}

/// A file as three numbers of cells and values, and where its cells lie.
struct Cells {
  std::array<std::int32_t, 3> count;
  std::vector<double> raw;

  [[nodiscard]] double turn() const { return count[2] == 2 * count[1] ? pi : 2 * pi; }
  [[nodiscard]] std::size_t place(std::size_t c, int h, int d, int p) const {
    return ((c * static_cast<std::size_t>(count[0]) + static_cast<std::size_t>(h)) *
                static_cast<std::size_t>(count[1]) +
            static_cast<std::size_t>(d)) *
               static_cast<std::size_t>(count[2]) +
           static_cast<std::size_t>(p);
  }
  [[nodiscard]] std::string bytes() const {
    std::string content;
    append_bytes(content, std::vector<std::int32_t>(count.begin(), count.end()));
    append_bytes(content, raw);
    return content;
  }
  /// L and V at the middle of a cell.
  [[nodiscard]] std::array<Vector3d, 2> middle(int h, int d, int p) const {
    const double theta_h = (h + 0.5) * (h + 0.5) / count[0] / count[0] * pi / 2;
    const Eigen::AngleAxisd tilt(theta_h, Vector3d::UnitY());
    const double theta_d = (d + 0.5) / count[1] * pi / 2;
    const double phi_d = (p + 0.5) / count[2] * turn();
    return {tilt * unit(theta_d, phi_d), tilt * unit(theta_d, phi_d + pi)};
  }
  [[nodiscard]] bool is_visible(int h, int d, int p) const {
    const auto [light, view] = middle(h, d, p);
    return light.z() > 0 && view.z() > 0;
  }
  [[nodiscard]] Directions geometry(int h, int d, int p) const {
    const auto [l, v] = middle(h, d, p);
    return {std::atan2(std::hypot(l.x(), l.y()), l.z()), std::atan2(std::hypot(v.x(), v.y()), v.z()),
            std::atan2(v.y(), v.x()) - std::atan2(l.y(), l.x()), 0};
  }
};

Cells random_cells(std::array<std::int32_t, 3> count, unsigned seed) {
  Cells cells{count, {}};
  cells.raw.resize(3 * static_cast<std::size_t>(count[0]) * static_cast<std::size_t>(count[1]) *
                   static_cast<std::size_t>(count[2]));
  std::mt19937 engine(seed);
  std::uniform_real_distribution<double> value(0.1, 900);
  for (double& raw : cells.raw) raw = value(engine);
  return cells;
}

/// By the angles of Rusinkiewicz, step by step, and eight corners, of which known ones count.
double reference(const Cells& cells, const Directions& pair, std::size_t channel) {
  const Vector3d light = unit(pair.theta_in, 0.4);
  const Vector3d half = (light + unit(pair.theta_out, 0.4 + pair.delta_phi)).normalized();
  const double theta_h = std::acos(half.z());
  const Vector3d d = Eigen::AngleAxisd(-theta_h, Vector3d::UnitY()) *
                     (Eigen::AngleAxisd(-std::atan2(half.y(), half.x()), Vector3d::UnitZ()) * light);
  double phi_d = std::atan2(d.y(), d.x());
  if (phi_d < 0) phi_d += cells.turn();
  const double h = cells.count[0] * std::sqrt(theta_h / (pi / 2)) - 0.5;
  const double t = cells.count[1] * std::acos(d.z()) / (pi / 2) - 0.5;
  const double p = cells.count[2] * phi_d / cells.turn() - 0.5;
  double sum = 0;
  double total = 0;
  for (int corner = 0; corner < 8; ++corner) {
    const int upper_h = corner / 4;
    const double at_h = std::floor(h) + upper_h;
    const double at_t = std::floor(t) + corner / 2 % 2;
    const double at_p = std::floor(p) + corner % 2;
    const double weight = (1 - std::abs(h - at_h)) * (1 - std::abs(t - at_t)) * (1 - std::abs(p - at_p));
    const int i = std::min(std::max(static_cast<int>(at_h), 0), cells.count[0] - 1);
    const int j = std::min(std::max(static_cast<int>(at_t), 0), cells.count[1] - 1);
    const int k = (static_cast<int>(at_p) + cells.count[2]) % cells.count[2];
    const double raw = cells.raw[cells.place(channel, i, j, k)];
    if (raw < 0 || !cells.is_visible(i, j, k)) continue;
    sum += weight * raw;
    total += weight;
  }
  EXPECT_GT(total, 0);
  return sum / total * kFactor[channel];
}

class Merl : public ::testing::Test {
 protected:
  [[nodiscard]] BrdfFunction load(const Cells& cells) const {
    write_file(path(), cells.bytes());
    return load_measured(path());
  }
  [[nodiscard]] std::filesystem::path path() const { return directory_.path() / "material.binary"; }

  TemporaryDirectory directory_;
};

void expect_reference_values(const BrdfFunction& brdf, const Cells& cells) {
  const auto pairs = twenty_geometries();
  const auto values = brdf.at(pairs).value;
  for (std::size_t i = 0; i < pairs.size(); ++i) {
    for (std::size_t c = 0; c < 3; ++c) {
      // Arc cosines near the poles lose half of the digits, of values up to 1.
      EXPECT_NEAR(values(static_cast<Eigen::Index>(i), static_cast<Eigen::Index>(c)), reference(cells, pairs[i], c),
                  1e-10)
          << i;
    }
  }
}

TEST_F(Merl, HasTheValuesOfAnIndependentReading) {
  const Cells cells = random_cells({90, 90, 180}, 1);
  const BrdfFunction brdf = load(cells);
  EXPECT_EQ(brdf.name, "material");
  EXPECT_EQ(brdf.format, "MERL .binary (Matusik et al. 2003)");
  EXPECT_THAT(brdf.channels, ElementsAre("red", "green", "blue"));
  EXPECT_TRUE(brdf.is_isotropic);
  expect_reference_values(brdf, cells);
}

TEST_F(Merl, OfWholeTurnsHasTheValuesOfAnIndependentReading) {
  const Cells cells = random_cells({30, 20, 80}, 2);
  expect_reference_values(load(cells), cells);
}

TEST_F(Merl, WithHolesHasTheValuesOfAnIndependentReading) {
  Cells cells = random_cells({90, 90, 180}, 3);
  std::mt19937 engine(4);
  for (double& raw : cells.raw) {
    if (engine() % 4 == 0) raw = -raw;
  }
  expect_reference_values(load(cells), cells);
}

TEST_F(Merl, MeetsTheMiddlesOfCellsToTheLastBit) {
  const Cells cells = random_cells({9, 10, 20}, 5);
  const BrdfFunction brdf = load(cells);
  std::size_t visible = 0;
  for (int h = 0; h < 9; ++h) {
    SCOPED_TRACE(h);
    for (int d = 0; d < 10; ++d) {
      SCOPED_TRACE(d);
      for (int p = 0; p < 20; ++p) {
        SCOPED_TRACE(p);
        if (!cells.is_visible(h, d, p)) continue;
        const auto value = brdf.at(std::vector{cells.geometry(h, d, p)}).value;
        for (std::size_t c = 0; c < 3; ++c) {
          SCOPED_TRACE(c);
          ASSERT_EQ(value(0, static_cast<Eigen::Index>(c)), cells.raw[cells.place(c, h, d, p)] * kFactor[c]);
        }
        ++visible;
      }
    }
  }
  EXPECT_GT(visible, 600U);
}

TEST_F(Merl, OfHalfTurnsIsReciprocal) {
  const BrdfFunction brdf = load(random_cells({90, 90, 180}, 6));
  for (const Directions& pair : twenty_geometries()) {
    SCOPED_TRACE(::testing::PrintToString(std::array{pair.theta_in, pair.theta_out, pair.delta_phi}));
    const auto there = brdf.at(std::vector{pair}).value;
    const auto back = brdf.at(std::vector<Directions>{{pair.theta_out, pair.theta_in, -pair.delta_phi, 0}}).value;
    EXPECT_LT((there - back).cwiseAbs().maxCoeff(), 1e-11);
  }
}

TEST_F(Merl, HasItsPeakOnTheMirrorSide) {
  Cells cells = random_cells({90, 90, 180}, 7);
  for (std::size_t i = 0; i < cells.raw.size(); ++i) cells.raw[i] = i % 1458000 < 16200 ? 15000 : 15;
  const BrdfFunction brdf = load(cells);
  for (const double theta : {0.0, 0.5, 1.2, 1.5}) {
    SCOPED_TRACE(theta);
    EXPECT_EQ(brdf.at(std::vector<Directions>{{theta, theta, pi, 0}}).value(0, 0), 15000 * kFactor[0]) << theta;
    if (theta > 0) {
      EXPECT_NEAR(brdf.at(std::vector<Directions>{{theta, theta, 0, 0}}).value(0, 0), 15 * kFactor[0], 1e-15);
    }
  }
}

TEST_F(Merl, CountsHolesAndIsDefinedInThem) {
  Cells cells = random_cells({6, 6, 12}, 8);
  std::size_t visible = 0;
  for (int h = 0; h < 6; ++h) {
    for (int d = 0; d < 6; ++d) {
      for (int p = 0; p < 12; ++p) {
        for (std::size_t c = 0; c < 3; ++c) {
          double& raw = cells.raw[cells.place(c, h, d, p)];
          if (!cells.is_visible(h, d, p) || (c == 1 && d > 2)) raw = -1;
          if (c == 2) raw = h == 2 && d == 3 && p == 4 ? 500 : -1;
        }
        if (cells.is_visible(h, d, p)) ++visible;
      }
    }
  }
  const BrdfFunction brdf = load(cells);
  std::size_t holes = visible - 1;
  for (int h = 0; h < 6; ++h) {
    for (int d = 3; d < 6; ++d) {
      for (int p = 0; p < 12; ++p) holes += cells.is_visible(h, d, p) ? 1U : 0U;
    }
  }
  EXPECT_THAT(brdf.remarks, ElementsAre(HasSubstr(std::to_string(holes) + " of " + std::to_string(3 * visible))));
  // All of a channel that knows one value is that value; towards theta_d = 0 from a hole is the next one.
  const auto values = brdf.at(twenty_geometries()).value;
  EXPECT_TRUE((values.col(2).array() == 500 * kFactor[2]).all());
  const Directions hole = cells.geometry(1, 5, 6);
  EXPECT_EQ(brdf.at(std::vector{hole}).value(0, 1), cells.raw[cells.place(1, 1, 2, 6)] * kFactor[1]);
}

TEST_F(Merl, IsFiniteUpToTheHorizon) {
  Cells cells = random_cells({90, 90, 180}, 9);
  const BrdfFunction brdf = load(cells);
  EXPECT_THAT(brdf.remarks, ElementsAre(HasSubstr("cells below the horizon are not used")));
  std::vector<Directions> pairs;
  for (const double in : {0.0, 1e-14, 0.7, 1.5, 1.57, pi / 2 - 1e-15}) {
    for (const double out : {0.0, 1e-14, 0.7, 1.5, 1.57, pi / 2 - 1e-15}) {
      for (const double phi : {0.0, 1e-15, 1.0, pi / 2, pi, -pi, 3 * pi, -1.0}) pairs.push_back({in, out, phi, 0});
    }
  }
  const auto values = brdf.at(pairs).value;
  EXPECT_GE(values.minCoeff(), 0.1 / 1500);
  EXPECT_LE(values.maxCoeff(), 900 * 1.66 / 1500);
}

// --- Writing.

/// Reciprocal lobes about H.
BrdfFunction smooth_lobes() {
  BrdfFunction brdf;
  brdf.name = "lobes";
  brdf.channels = {"a", "b", "c"};
  brdf.at = [](std::span<const Directions> pairs) {
    BrdfValues values{Eigen::MatrixXd(static_cast<Eigen::Index>(pairs.size()), 3), {}};
    for (std::size_t i = 0; i < pairs.size(); ++i) {
      const auto& pair = pairs[i];
      const double cosine = (unit(pair.theta_in, 0) + unit(pair.theta_out, pair.delta_phi)).normalized().z();
      for (int c = 0; c < 3; ++c) {
        values.value(static_cast<Eigen::Index>(i), c) =
            2 + std::pow(cosine, 10 * c + 1) +
            std::sin(pair.theta_in) * std::sin(pair.theta_out) * std::cos(pair.delta_phi);
      }
    }
    return values;
  };
  return brdf;
}

TEST_F(Merl, IsWrittenAndReadBackToTheLastBit) {
  // Values that are some number by the file's factor are met exactly, whichever number wrote them.
  const Cells cells = random_cells({90, 90, 180}, 10);
  save_measured(device(), load(cells), "merl", directory_.path() / "written.binary");
  const std::string written = read_file(directory_.path() / "written.binary");
  ASSERT_EQ(written.size(), 34992012U);
  EXPECT_EQ(written.substr(0, 12), cells.bytes().substr(0, 12));
  std::size_t differing = 0;
  for (std::size_t c = 0; c < 3; ++c) {
    for (int h = 0; h < 90; ++h) {
      for (int d = 0; d < 90; ++d) {
        for (int p = 0; p < 180; ++p) {
          double raw = 0;
          std::memcpy(&raw, written.data() + 12 + 8 * cells.place(c, h, d, p), 8);
          const double expected = cells.is_visible(h, d, p) ? cells.raw[cells.place(c, h, d, p)] * kFactor[c] : -1;
          if ((raw < 0 ? raw : raw * kFactor[c]) != expected) ++differing;
        }
      }
    }
  }
  EXPECT_EQ(differing, 0U);
  // Reading a written file and writing it again gives the same bytes.
  save_measured(device(), load_measured(directory_.path() / "written.binary"), "merl",
                directory_.path() / "again.binary");
  EXPECT_TRUE(read_file(directory_.path() / "again.binary") == written);
}

TEST_F(Merl, KeepsSmoothFunctionsWithinTheLastBit) {
  const BrdfFunction lobes = smooth_lobes();
  save_measured(device(), lobes, "merl", path());
  const BrdfFunction read = load_measured(path());
  EXPECT_THAT(read.remarks, ::testing::IsEmpty());
  const Cells cells{{90, 90, 180}, {}};
  std::vector<Directions> middles;
  for (int h = 0; h < 90; h += 7) {
    for (int d = 0; d < 90; d += 7) {
      for (int p = 3; p < 180; p += 11) {
        if (cells.is_visible(h, d, p)) middles.push_back(cells.geometry(h, d, p));
      }
    }
  }
  ASSERT_GT(middles.size(), 1000U);
  const auto found = read.at(middles).value;
  const auto exact = lobes.at(middles).value;
  // The test's own angles differ in the last digits, and the lobes with them.
  EXPECT_LT((found - exact).cwiseAbs().maxCoeff(), 1e-11);
  // Between the middles the interpolation errs with the square of a degree.
  const auto pairs = twenty_geometries();
  EXPECT_LT((read.at(pairs).value - lobes.at(pairs).value).cwiseAbs().maxCoeff(), 3e-3);
}

TEST_F(Merl, HoldsOneChannelThreeTimes) {
  BrdfFunction brdf = smooth_lobes();
  brdf.channels = {"value"};
  brdf.at = [at = brdf.at](std::span<const Directions> pairs) {
    return BrdfValues{Eigen::MatrixXd(at(pairs).value.col(1)), {}};
  };
  save_measured(device(), brdf, "merl", path());
  const auto values = load_measured(path()).at(twenty_geometries()).value;
  EXPECT_LT((values.col(0) - values.col(1)).cwiseAbs().maxCoeff(), 1e-15);
  EXPECT_LT((values.col(0) - values.col(2)).cwiseAbs().maxCoeff(), 1e-15);
}

TEST_F(Merl, IsNotWrittenForWhatItCannotHold) {
  const auto refused = [&](BrdfFunction brdf, const std::string& complaint) {
    expect_complaint([&] { save_measured(device(), brdf, "merl", path()); }, complaint);
    EXPECT_FALSE(std::filesystem::exists(path()));
  };
  BrdfFunction two = smooth_lobes();
  two.channels = {"a", "b"};
  refused(two, "'lobes' has 2 channels; MERL files hold red, green and blue");
  BrdfFunction anisotropic = smooth_lobes();
  anisotropic.is_isotropic = false;
  refused(anisotropic, "'lobes' is anisotropic");
  const auto shifted = [](double by) {
    BrdfFunction brdf = smooth_lobes();
    brdf.at = [at = brdf.at, by](std::span<const Directions> pairs) {
      return BrdfValues{at(pairs).value.array() + by, {}};
    };
    return brdf;
  };
  refused(shifted(-4), "'lobes' has negative values");
  refused(shifted(std::nan("")), "no finite numbers");
}

// --- Damaged files.

TEST_F(Merl, IsRefusedWhereItIsDamaged) {
  const std::string whole = random_cells({6, 6, 12}, 11).bytes();
  std::string usual = random_cells({90, 90, 180}, 12).bytes();
  expect_unreadable(path(), usual.substr(0, 1000), "byte 1000: the file has 1000 bytes; expected 34992012");
  expect_unreadable(path(), usual.substr(0, 12), "byte 12: the file has 12 bytes");
  expect_unreadable(path(), usual + "x", "byte 34992012: the file has 34992013 bytes");
  expect_unreadable(path(), with_number(usual, 8, 2'000'000'000), "byte 0: 90 x 90 x 2000000000 cells");
  expect_unreadable(path(), with_number(usual, 8, 0), "byte 0: 90 x 90 x 0 cells");
  expect_unreadable(path(), with_number(usual, 628, std::nan("")), "byte 628: a value is no finite number");
  expect_unreadable(path(), with_number(usual, 34992004, HUGE_VAL), "byte 34992004: a value is no finite number");
  expect_unreadable(path(), std::string("\0\0\0\x5a\0\0\0\x5a\0\0\0\xb4", 12) + whole,
                    "byte 0: the numbers are big-endian");
  Cells odd = random_cells({6, 6, 18}, 13);
  expect_unreadable(path(), odd.bytes(), "byte 8: 18 cells of phi_d; expected twice or four times the 6 of theta_d");
  Cells empty = random_cells({6, 6, 12}, 14);
  for (double& raw : empty.raw) raw = -1;
  expect_unreadable(path(), empty.bytes(), "byte 12: all values of a channel are missing");
}

}  // namespace
}  // namespace lobe::test
