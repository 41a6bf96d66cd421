// Reflectances from files: against an independent reading, against other data of the same materials, and damaged.
#include "lobe/formats/measured.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <hdf5.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <functional>
#include <numbers>
#include <random>
#include <string>
#include <vector>

#include "energy/albedo.hpp"
#include "energy/repair.hpp"
#include "lobe/core/directions.hpp"
#include "lobe/core/error.hpp"
#include "lobe/energy/albedo.hpp"
#include "support/estimates.hpp"
#include "support/measured_data.hpp"
#include "support/temporary_directory.hpp"
#include "table/tabulate.hpp"

namespace lobe::test {
namespace {

namespace fs = std::filesystem;
using std::numbers::pi;
using ::testing::Each;
using ::testing::HasSubstr;

/// Shared data, or nothing where it is missing.
class Measured : public MeasuredData {
 protected:
  Measured() : MeasuredData("nbrdf") {}

  [[nodiscard]] fs::path felt() const { return data_ / "merl/pink-felt.h5"; }
};

std::vector<Directions> twenty_pairs() {
  std::vector<Directions> pairs;
  for (int i = 0; i < 20; ++i) pairs.push_back({0.02 + 0.077 * i, 1.5 - 0.07 * i, 0.3 * i - 3, 0});
  return pairs;
}

// --- Neural encodings: a reader of its own, by the C interface of HDF5 and loops.

std::vector<float> weights(hid_t file, const std::string& name, std::size_t count) {
  std::vector<float> values(count);
  const hid_t dataset = H5Dopen2(file, name.c_str(), H5P_DEFAULT);
  EXPECT_GE(H5Dread(dataset, H5T_NATIVE_FLOAT, H5S_ALL, H5S_ALL, H5P_DEFAULT, values.data()), 0);
  H5Dclose(dataset);
  return values;
}

std::array<double, 3> neural_reference(const fs::path& path, const Directions& pair) {
  const auto unit = [](double theta, double phi) {
    return std::array<double, 3>{std::sin(theta) * std::cos(phi), std::sin(theta) * std::sin(phi), std::cos(theta)};
  };
  const auto l = unit(pair.theta_in, 0.4);
  const auto v = unit(pair.theta_out, 0.4 + pair.delta_phi);
  std::array<double, 3> h{l[0] + v[0], l[1] + v[1], l[2] + v[2]};
  const double length = std::sqrt(h[0] * h[0] + h[1] * h[1] + h[2] * h[2]);
  for (double& c : h) c /= length;
  const double phi_h = std::atan2(h[1], h[0]);
  const double theta_h = std::acos(h[2]);
  // L turned by -phi_h about the normal, then by -theta_h about the y axis.
  const double x = l[0] * std::cos(phi_h) + l[1] * std::sin(phi_h);
  const double y = -l[0] * std::sin(phi_h) + l[1] * std::cos(phi_h);
  std::vector<double> in{std::sin(theta_h),
                         0,
                         std::cos(theta_h),
                         x * std::cos(theta_h) - l[2] * std::sin(theta_h),
                         y,
                         x * std::sin(theta_h) + l[2] * std::cos(theta_h)};
  const hid_t file = H5Fopen(path.c_str(), H5F_ACC_RDONLY, H5P_DEFAULT);
  const std::array<std::size_t, 4> sizes{6, 21, 21, 3};
  for (std::size_t layer = 1; layer <= 3; ++layer) {
    const std::string group = "/dense_" + std::to_string(layer) + "/dense_" + std::to_string(layer);
    const auto kernel = weights(file, group + "/kernel:0", sizes[layer - 1] * sizes[layer]);
    const auto bias = weights(file, group + "/bias:0", sizes[layer]);
    std::vector<double> out(sizes[layer]);
    for (std::size_t j = 0; j < out.size(); ++j) {
      out[j] = bias[j];
      for (std::size_t i = 0; i < in.size(); ++i) out[j] += in[i] * kernel[i * out.size() + j];
      if (layer < 3) out[j] = std::max(out[j], 0.0);
    }
    in = out;
  }
  H5Fclose(file);
  return {std::max(std::exp(in[0]) - 1, 0.0), std::max(std::exp(in[1]) - 1, 0.0), std::max(std::exp(in[2]) - 1, 0.0)};
}

void expect_reference_values(const fs::path& path) {
  const auto brdf = load_measured(path);
  EXPECT_EQ(brdf.name, path.stem().string());
  EXPECT_THAT(brdf.channels, ::testing::ElementsAre("red", "green", "blue"));
  const auto pairs = twenty_pairs();
  const auto values = brdf.at(pairs).value;
  for (std::size_t i = 0; i < pairs.size(); ++i) {
    const auto expected = neural_reference(path, pairs[i]);
    for (std::size_t c = 0; c < 3; ++c) {
      // The angles go through other functions; weights amplify that.
      EXPECT_NEAR(values(static_cast<Eigen::Index>(i), static_cast<Eigen::Index>(c)), expected[c],
                  1e-10 * (1 + expected[c]))
          << path << " " << i;
    }
  }
}

TEST_F(Measured, NeuralEncodingsHaveTheValuesOfAnIndependentReader) {
  for (const char* name : {"pink-felt", "chrome", "blue-metallic-paint"}) {
    expect_reference_values(data_ / "merl" / (std::string(name) + ".h5"));
  }
}

TEST(MeasuredFiles, OfRandomWeightsAreReadAsNeuralEncodings) {
  const TemporaryDirectory directory;
  const fs::path path = directory.path() / "random.h5";
  std::mt19937 engine(3);
  std::uniform_real_distribution<float> weight(-0.4F, 0.4F);
  const hid_t file = H5Fcreate(path.c_str(), H5F_ACC_TRUNC, H5P_DEFAULT, H5P_DEFAULT);
  const std::array<hsize_t, 4> sizes{6, 21, 21, 3};
  for (std::size_t layer = 1; layer <= 3; ++layer) {
    const std::string outer = "/dense_" + std::to_string(layer);
    const std::string inner = outer + outer;
    for (const auto& group : {outer, inner}) {
      H5Gclose(H5Gcreate2(file, group.c_str(), H5P_DEFAULT, H5P_DEFAULT, H5P_DEFAULT));
    }
    const auto write = [&](const std::string& name, const std::vector<hsize_t>& shape) {
      std::vector<float> values(shape.size() == 1 ? shape[0] : shape[0] * shape[1]);
      std::ranges::generate(values, [&] { return weight(engine); });
      const hid_t space = H5Screate_simple(static_cast<int>(shape.size()), shape.data(), nullptr);
      const hid_t dataset =
          H5Dcreate2(file, (inner + name).c_str(), H5T_IEEE_F32LE, space, H5P_DEFAULT, H5P_DEFAULT, H5P_DEFAULT);
      H5Dwrite(dataset, H5T_NATIVE_FLOAT, H5S_ALL, H5S_ALL, H5P_DEFAULT, values.data());
      H5Dclose(dataset);
      H5Sclose(space);
    };
    write("/kernel:0", {sizes[layer - 1], sizes[layer]});
    write("/bias:0", {sizes[layer]});
  }
  H5Fclose(file);
  expect_reference_values(path);
}

TEST(MeasuredFiles, InAnotherLayoutOfHdf5AreRefusedWithWhatToDo) {
  const TemporaryDirectory directory;
  const fs::path path = directory.path() / "latest.h5";
  const hid_t access = H5Pcreate(H5P_FILE_ACCESS);
  H5Pset_libver_bounds(access, H5F_LIBVER_LATEST, H5F_LIBVER_LATEST);
  const hid_t file = H5Fcreate(path.c_str(), H5F_ACC_TRUNC, H5P_DEFAULT, access);
  H5Gclose(H5Gcreate2(file, "/dense_1", H5P_DEFAULT, H5P_DEFAULT, H5P_DEFAULT));
  H5Fclose(file);
  H5Pclose(access);
  try {
    (void)load_measured(path);
    FAIL() << "it was read";
  } catch (const IoError& error) {
    EXPECT_THAT(error.what(), HasSubstr("'h5repack -l CONTI' converts it"));
  }
}

/// Of values along L = V from those of an ALTA file over cos(theta), relative, up to an angle.
double median_deviation(const BrdfFunction& brdf, const fs::path& path, double theta_max) {
  std::vector<double> deviations;
  for (const auto& row : number_rows(path)) {
    const std::array rgb{row[1], row[2], row[3]};
    const double cosine = row[0];
    const double theta = std::acos(cosine);
    if (theta > theta_max) continue;
    const auto values = brdf.at(std::vector<Directions>{{theta, theta, 0, 0}}).value;
    for (std::size_t c = 0; c < 3; ++c) {
      deviations.push_back(std::abs(values(0, static_cast<Eigen::Index>(c)) / rgb[c] - 1));
    }
  }
  EXPECT_GT(deviations.size(), 100U);
  const auto middle = deviations.begin() + static_cast<std::ptrdiff_t>(deviations.size() / 2);
  std::nth_element(deviations.begin(), middle, deviations.end());
  return *middle;
}

TEST_F(Measured, NeuralPinkFeltIsThatOfMerl) {
  // A slice of the measurement itself: theta_d = 0, where L = V = H. What the encoding loses: medians of 2.4 % up to 45
  // degrees and of 3.3 % in all.
  EXPECT_LT(median_deviation(load_measured(felt()), data_.parent_path() / "alta/pink-felt-1d.alta", 45 * kDegree),
            0.03);
  EXPECT_LT(median_deviation(load_measured(felt()), data_.parent_path() / "alta/pink-felt-1d.alta", 90 * kDegree),
            0.035);
}

TEST_F(Measured, NeuralMaterialsAreBalancedSymmetrically) {
  std::size_t count = 0;
  std::size_t repaired = 0;
  for (const auto& entry : fs::directory_iterator(data_ / "merl")) {
    const auto table = tabulate(load_measured(entry.path()), HemisphereGrid::gauss(12, 24), {.allow_unresolved = true});
    const auto reciprocal = symmetrise(table);
    const auto balanced = scale_symmetrically(reciprocal);
    ++count;
    if (balanced.sweeps > 0) ++repaired;
    const TableAlbedo albedos = row_albedos(balanced.table);
    const std::size_t rows = balanced.table.rows();
    const std::size_t half = balanced.table.grid.half_azimuths();
    for (std::size_t c = 0; c < 3; ++c) {
      for (const Estimate& a : albedos.in[c]) EXPECT_LE(a.value, 1 + 1e-9) << entry.path();
      const auto values = balanced.table.channel(c);
      for (std::size_t i = 0; i < rows; ++i) {
        for (std::size_t j = 0; j < i; ++j) {
          for (std::size_t k = 0; k < half; ++k) {
            const double there = values[(i * rows + j) * half + k];
            const double back = values[(j * rows + i) * half + k];
            ASSERT_LE(std::abs(there - back), 1e-12 * std::abs(there)) << entry.path();
          }
        }
      }
    }
  }
  EXPECT_EQ(count, 100U);
  RecordProperty("repaired", static_cast<int>(repaired));
}

// --- Zernike coefficients.

struct Row {
  double wavelength;
  Directions pair;
  double value;
};

std::vector<Row> raw_rows(const fs::path& path) {
  std::vector<Row> rows;
  for (const auto& row : number_rows(path)) {
    const auto [wavelength, theta_i, phi_i, theta_r, phi_r, value] =
        std::array{row[0], row[1], row[2], row[3], row[4], row[5]};
    // Angles of incidence below 0 are on the other side of the normal.
    const double turn = theta_i < 0 ? 180 : 0;
    rows.push_back(
        {wavelength, {std::abs(theta_i) * kDegree, theta_r * kDegree, (phi_r - phi_i - turn) * kDegree, 0}, value});
  }
  return rows;
}

TEST_F(Measured, ZernikeCoefficientsFitTheRawData) {
  const auto rows = raw_rows(data_.parent_path() / "nist_ptfe/PTFE.data.csv");
  ASSERT_EQ(rows.size(), 7296U);
  const auto all =
      load_measured(data_.parent_path() / "nist_ptfe/PTFE.coeff.csv", {.wavelengths = {351, 532, 633, 1064}});
  EXPECT_THAT(all.channels, ::testing::ElementsAre("351 nm", "532 nm", "633 nm", "1064 nm"));
  Eigen::Index channel = 0;
  for (const char* wavelength : {"351", "532", "633", "1064"}) {
    SCOPED_TRACE(wavelength);
    const auto alone =
        load_measured(data_.parent_path() / ("nist_ptfe/PTFE." + std::string(wavelength) + ".coeff.csv"));
    double square = 0;
    double square_of_all = 0;
    std::size_t count = 0;
    for (const Row& row : rows) {
      if (std::lround(row.wavelength * 1000) != std::stol(wavelength)) continue;
      const std::vector<Directions> pair{row.pair};
      square += std::pow(alone.at(pair).value(0, 0) / row.value - 1, 2);
      square_of_all += std::pow(all.at(pair).value(0, channel) / row.value - 1, 2);
      ++count;
    }
    EXPECT_EQ(count, 1824U);
    EXPECT_LT(std::sqrt(square / static_cast<double>(count)), 0.02) << wavelength;
    // One expansion for all wavelengths has fewer coefficients: 2.2 to 2.4 %.
    EXPECT_LT(std::sqrt(square_of_all / static_cast<double>(count)), 0.025) << wavelength;
    ++channel;
  }
}

/// n! / (n-k)!-free: the polynomial by its three-term recurrence in the degree (Kintner 1976).
double radial_reference(int n, int l, double rho) {
  double before = 0;
  double now = std::pow(rho, l);
  for (int k = l; k < n; k += 2) {
    double next = 0;
    if (k == l) {
      next = ((l + 2) * rho * rho - (l + 1)) * std::pow(rho, l);
    } else {
      const double a = 2.0 * (k + 1) * (k + 2) * k * 2 * rho * rho - 2.0 * (k + 1) * (l * l + k * (k + 2.0));
      const double b = 1.0 * (k + 2) * (k + l) * (k - l);
      next = (a * now - b * before) / (1.0 * k * (k + 2 + l) * (k + 2 - l));
    }
    before = now;
    now = next;
  }
  return now;
}

TEST_F(Measured, ZernikeExpansionsHaveTheValuesOfAnIndependentReader) {
  const fs::path path = data_.parent_path() / "nist_ptfe/PTFE.532.coeff.csv";
  const auto brdf = load_measured(path);
  const auto pairs = twenty_pairs();
  const auto values = brdf.at(pairs).value;
  for (std::size_t i = 0; i < pairs.size(); ++i) {
    double expected = 0;
    for (const auto& row : number_rows(path)) {
      const auto [r, s, n, m, l] =
          std::array{static_cast<int>(row[0]), static_cast<int>(row[1]), static_cast<int>(row[2]),
                     static_cast<int>(row[3]), static_cast<int>(row[5])};
      const double a = row[7];
      if (r != 1 || s != 1) continue;
      const double rho_i = std::sqrt(2.0) * std::sin(pairs[i].theta_in / 2);
      const double rho_r = std::sqrt(2.0) * std::sin(pairs[i].theta_out / 2);
      const double q = n == 0 || (n == m && l == 0) ? 4 : (n == m || l == 0 ? 2 : 1);
      expected += a / (2 * pi) * std::sqrt((n + 1) * (m + 1) / q) *
                  (radial_reference(n, l, rho_i) * radial_reference(m, l, rho_r) +
                   radial_reference(m, l, rho_i) * radial_reference(n, l, rho_r)) *
                  std::cos(l * pairs[i].delta_phi);
    }
    EXPECT_NEAR(values(static_cast<Eigen::Index>(i), 0), expected, 1e-11) << i;
  }
}

TEST_F(Measured, PtfeIsReciprocalAndIsBalanced) {
  const fs::path path = data_.parent_path() / "nist_ptfe/PTFE.coeff.csv";
  const auto brdf = load_measured(path, {.wavelengths = {351, 532, 633, 1064}, .theta_max = 80 * kDegree});
  const auto table = tabulate(brdf, HemisphereGrid::gauss(24, 48));
  EXPECT_LT(table.resolution_error, 1e-3);
  const auto balanced = scale_symmetrically(symmetrise(table));
  const TableAlbedo albedos = row_albedos(balanced.table);
  EXPECT_THAT(albedos.in, Each(Each(::testing::Field(&Estimate::value, ::testing::Le(1 + 1e-9)))));
  // Sintered PTFE reflects nearly everything.
  EXPECT_THAT(row_albedos(table).mean, Each(EstimateNear(0.99, 0.03)));
}

TEST_F(Measured, TablesHaveTheValuesOfTheFile) {
  const auto brdf = load_measured(felt());
  const auto grid = HemisphereGrid::gauss(8, 16);
  const auto table = tabulate(brdf, grid);
  const auto rings = grid.rings();
  const std::vector<Directions> pair{{rings[3].theta, rings[5].theta, 2 * pi * 2 / 16, 0},
                                     {rings[3].theta, rings[5].theta, -2 * pi * 2 / 16, 0}};
  const auto values = brdf.at(pair).value;
  for (std::size_t c = 0; c < 3; ++c) {
    SCOPED_TRACE(c);
    const auto at = static_cast<Eigen::Index>(c);
    const double found = table.channel(c)[(3 * 8 + 5) * 9 + 2];
    EXPECT_NEAR(found, (values(0, at) + values(1, at)) / 2, 1e-15);
    // The difference that the mean of both sides hides counts as error.
    EXPECT_GE(table.error[(c * 8 + 3) * 8 + 5], std::abs(values(0, at) - values(1, at)) / 2);
  }
  const auto klems = tabulate(brdf, HemisphereGrid::parse("klems:145"), {.cell_points = 1});
  EXPECT_EQ(klems.form, TableForm::general);
  const auto centre = brdf.at(std::vector<Directions>{{0, klems.grid.directions()[1].theta, 0, 0}}).value;
  EXPECT_NEAR(klems.channel(0)[1], centre(0, 0), 1e-2 * centre(0, 0));
}

TEST_F(Measured, AveragesOverPatchesKeepTheLightOfAHighlight) {
  // Four samples per coordinate of a patch had given 0.2005, and no error to speak of.
  const auto brdf = load_measured(data_ / "merl/alum-bronze.h5", {.channels = {"red"}});
  const auto found = row_albedos(tabulate(brdf, HemisphereGrid::klems(41), {.allow_unresolved = true})).mean.front();
  const auto expected = mean_albedo(brdf).front();
  EXPECT_NEAR(expected.value, 0.1275, 2e-4);
  EXPECT_NEAR(found.value, expected.value, found.error + expected.error);
  EXPECT_LT(found.error, 0.01 * found.value);
}

// --- What is refused.

void expect_refusal(const std::function<void()>& call, const std::string& complaint) {
  try {
    call();
    FAIL() << "not refused; expected '" << complaint << "'";
  } catch (const Error& error) {
    EXPECT_THAT(error.what(), HasSubstr(complaint));
  }
}

TEST_F(Measured, DamagedNeuralEncodingsAreRefused) {
  const TemporaryDirectory directory;
  std::ifstream original(felt(), std::ios::binary);
  const std::string bytes{std::istreambuf_iterator<char>(original), {}};
  const fs::path path = directory.path() / "cut.h5";
  for (std::size_t size = 0; size < bytes.size(); size += 997) {
    std::ofstream(path, std::ios::binary | std::ios::trunc).write(bytes.data(), static_cast<std::streamsize>(size));
    EXPECT_THROW((void)load_measured(path), IoError) << size;
  }
  // A weight that is no number.
  const fs::path broken = directory.path() / "broken.h5";
  fs::copy_file(felt(), broken);
  fs::permissions(broken, fs::perms::owner_all);
  const hid_t file = H5Fopen(broken.c_str(), H5F_ACC_RDWR, H5P_DEFAULT);
  const hid_t dataset = H5Dopen2(file, "/dense_2/dense_2/bias:0", H5P_DEFAULT);
  const std::vector<float> nans(21, std::nanf(""));
  ASSERT_GE(H5Dwrite(dataset, H5T_NATIVE_FLOAT, H5S_ALL, H5S_ALL, H5P_DEFAULT, nans.data()), 0);
  H5Dclose(dataset);
  H5Fclose(file);
  expect_refusal([&] { (void)load_measured(broken); }, "/dense_2/dense_2/bias:0 has a number that is not finite");
}

TEST(MeasuredFiles, ThatAreDamagedOrUnknownAreRefused) {
  const TemporaryDirectory directory;
  const auto refused = [&](const std::string& text, const std::string& complaint, const ReadOptions& options = {}) {
    const fs::path path = directory.path() / "coefficients.csv";
    std::ofstream(path) << text;
    expect_refusal([&] { (void)load_measured(path, options); }, complaint);
  };
  refused("", "no known format");
  refused("some, words\n", "no known format");
  refused("1, 1, 0, 0, 0, 0, 0, 2.05\n1, 1, 0, 0, 0\n", "line 2: no eight numbers");
  refused("1, 1, 0, 0, 0, 0, 0, 2.05\n1, 1, 1, 1, 1, 1, 0, nan\n", "line 2");
  refused("1, 1, 2.5, 0, 0, 0, 0, 2.05\n", "line 1: order 2.5");
  refused("1, 1, 400, 0, 0, 0, 0, 2.05\n", "line 1: order 400");
  refused("1, 1, 2, 1, 0, 0, 0, 2.05\n", "no Zernike polynomial");
  refused("\n1, 1, 2, 1, 0, 0, 0, 2.05", "line 2: R_1^0");
  refused("1, 1, 1, 1, 3, 3, 0, 2.05\n", "no Zernike polynomial");
  refused("1, 1, 0, 0, 0, 0, 1, 2.05\n", "expected wavelengths in nm");
  refused("1, 1, 0, 0, 0, 0, 1, 2.05\n", "expected one above 0", {.wavelengths = {-5}});
  refused("1, 1, 0, 0, 0, 0, 0, 2.05\n", "expected no wavelengths", {.wavelengths = {532}});
  refused("1, 1, 0, 0, 0, 0, 0, 2.05\n", "expected a value in (0, 90] degrees", {.theta_max = 2});
  expect_refusal([&] { (void)load_measured(directory.path() / "none.h5"); }, "there is no such file");
  expect_refusal([&] { (void)load_measured(directory.path()); }, "there is no such file");
}

TEST(MeasuredFiles, WithValuesThatAreNotFiniteBecomeNoTables) {
  const TemporaryDirectory directory;
  const fs::path path = directory.path() / "infinite.csv";
  std::ofstream(path) << "1, 1, 0, 0, 0, 0, 400, 1";
  const auto brdf = load_measured(path, {.wavelengths = {1e9}});
  expect_refusal([&] { (void)tabulate(brdf, HemisphereGrid::gauss(4, 8)); }, "no finite numbers");
  const auto stop = [](std::string_view, double) { return false; };
  const auto fine = load_measured(path, {.wavelengths = {1000}});
  EXPECT_THROW((void)tabulate(fine, HemisphereGrid::gauss(4, 8), {.progress = stop}), Cancelled);
}

TEST(MeasuredFiles, OfTwoTermsAreTheirFormula) {
  // f = a/(2 pi) sqrt(1/4) 2 = a/(2 pi); with lambda^1 twice that at 2 micrometres.
  const TemporaryDirectory directory;
  const fs::path path = directory.path() / "flat.csv";
  std::ofstream(path) << "1, 1, 0, 0, 0, 0, 1, 2\n\n2, 2, 0, 0, 0, 0, 0, 5\n";
  const auto brdf = load_measured(path, {.wavelengths = {500, 2000}});
  const auto values = brdf.at(std::vector<Directions>{{0.3, 1, 2, 0}}).value;
  EXPECT_NEAR(values(0, 0), 1 / (2 * pi), 1e-15);
  EXPECT_NEAR(values(0, 1), 2 / pi, 1e-15);
  const auto table = tabulate(brdf, HemisphereGrid::gauss(4, 8));
  EXPECT_NEAR(row_albedos(table).mean[1].value, 2, 1e-12);
}

}  // namespace
}  // namespace lobe::test
