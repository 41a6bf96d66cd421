// RGL tensor files: against an evaluation that integrates densities by quadrature, on real files and on synthetic ones.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <filesystem>
#include <map>
#include <numbers>
#include <random>
#include <string>
#include <vector>

#include "io/measured_files.hpp"
#include "support/measured_data.hpp"
#include "support/temporary_directory.hpp"

namespace lobe::test {
namespace {

namespace fs = std::filesystem;
using Eigen::Vector3d;
using std::numbers::pi;
using ::testing::ElementsAre;
using ::testing::HasSubstr;

// --- A tensor file in memory: read and written here, not by the library.

struct Tensor {
  std::vector<std::size_t> shape;
  std::vector<float> values;
  std::size_t offset = 0;
};

using Tensors = std::map<std::string, Tensor>;

template <typename Number>
Number take(const std::string& bytes, std::size_t& offset) {
  Number number{};
  std::memcpy(&number, bytes.data() + offset, sizeof(Number));
  offset += sizeof(Number);
  return number;
}

/// Fields of floats, and of bytes as floats.
Tensors parse(const std::string& bytes) {
  Tensors tensors;
  std::size_t at = 14;
  const auto count = take<std::uint32_t>(bytes, at);
  for (std::uint32_t i = 0; i < count; ++i) {
    const auto length = take<std::uint16_t>(bytes, at);
    const std::string name = bytes.substr(at, length);
    at += length;
    const auto axes = take<std::uint16_t>(bytes, at);
    const auto type = take<std::uint8_t>(bytes, at);
    Tensor tensor;
    tensor.offset = take<std::uint64_t>(bytes, at);
    std::size_t size = 1;
    for (int k = 0; k < axes; ++k) {
      tensor.shape.push_back(take<std::uint64_t>(bytes, at));
      size *= tensor.shape.back();
    }
    std::size_t number = tensor.offset;
    for (std::size_t k = 0; k < size && (type == 1 || type == 10); ++k) {
      tensor.values.push_back(type == 1 ? take<std::uint8_t>(bytes, number) : take<float>(bytes, number));
    }
    tensors[name] = tensor;
  }
  return tensors;
}

template <typename Number>
void put(std::string& bytes, Number number) {
  append_bytes(bytes, std::vector<Number>{number});
}

/// jacobian as a byte, all others as floats; sets their offsets.
std::string file_of(Tensors& tensors) {
  std::size_t header = 18;
  for (const auto& [name, tensor] : tensors) header += 2 + name.size() + 2 + 1 + 8 + 8 * tensor.shape.size();
  std::string bytes("tensor_file\0\1\0", 14);
  put(bytes, static_cast<std::uint32_t>(tensors.size()));
  std::size_t end = header;
  for (auto& [name, tensor] : tensors) {
    end = (end + 7) / 8 * 8;
    tensor.offset = end;
    const bool is_byte = name == "jacobian";
    end += tensor.values.size() * (is_byte ? 1 : 4);
    put(bytes, static_cast<std::uint16_t>(name.size()));
    bytes += name;
    put(bytes, static_cast<std::uint16_t>(tensor.shape.size()));
    put(bytes, static_cast<std::uint8_t>(is_byte ? 1 : 10));
    put(bytes, static_cast<std::uint64_t>(tensor.offset));
    for (const std::size_t length : tensor.shape) put(bytes, static_cast<std::uint64_t>(length));
  }
  for (const auto& [name, tensor] : tensors) {
    bytes.resize(tensor.offset);
    if (name == "jacobian") {
      bytes += static_cast<char>(tensor.values[0]);
    } else {
      append_bytes(bytes, tensor.values);
    }
  }
  return bytes;
}

// --- The reflectance by its definition.

/// A grid of a tensor with the given numbers of its first axes, bilinear in the unit square.
double bilinear(const Tensor& tensor, const std::vector<std::size_t>& first, double x, double y) {
  std::size_t start = 0;
  for (std::size_t k = 0; k < first.size(); ++k) start = start * tensor.shape[k] + first[k];
  const std::size_t height = tensor.shape[first.size()];
  const std::size_t width = tensor.shape[first.size() + 1];
  const auto node = [](double place, std::size_t nodes) {
    return std::min(static_cast<std::size_t>(place * static_cast<double>(nodes - 1)), nodes - 2);
  };
  double sum = 0;
  for (std::size_t j = node(y, height); j < node(y, height) + 2; ++j) {
    const double weight_y = 1 - std::abs(y * static_cast<double>(height - 1) - static_cast<double>(j));
    for (std::size_t i = node(x, width); i < node(x, width) + 2; ++i) {
      const double weight_x = 1 - std::abs(x * static_cast<double>(width - 1) - static_cast<double>(i));
      sum += weight_x * weight_y * static_cast<double>(tensor.values[(start * height + j) * width + i]);
    }
  }
  return sum;
}

/// Of a function that is at most quadratic between multiples of 1/steps, from 0 to `end`: Simpson's rule.
template <typename Function>
double integral(const Function& function, double end, std::size_t steps) {
  double sum = 0;
  for (std::size_t i = 0; i < steps; ++i) {
    const double from = static_cast<double>(i) / static_cast<double>(steps);
    const double to = std::min(static_cast<double>(i + 1) / static_cast<double>(steps), end);
    if (to <= from) break;
    sum += (to - from) / 6 * (function(from) + 4 * function((from + to) / 2) + function(to));
  }
  return sum;
}

/// Weights of an axis' nodes at a value.
std::vector<double> hats(const std::vector<float>& axis, double value) {
  std::vector<double> weights(axis.size(), 0.0);
  if (value <= static_cast<double>(axis.front()) || axis.size() == 1) {
    weights.front() = 1;
  } else if (value >= static_cast<double>(axis.back())) {
    weights.back() = 1;
  } else {
    for (std::size_t k = 0; k + 1 < axis.size(); ++k) {
      const auto a = static_cast<double>(axis[k]);
      const auto b = static_cast<double>(axis[k + 1]);
      if (value < a || value >= b) continue;
      weights[k] = (b - value) / (b - a);
      weights[k + 1] = (value - a) / (b - a);
    }
  }
  return weights;
}

Vector3d unit_of_angles(double theta, double phi) {
  return {std::sin(theta) * std::cos(phi), std::sin(theta) * std::sin(phi), std::cos(theta)};
}

struct Slice {
  std::size_t p;
  std::size_t t;
  double weight;
  double total;
};

/// All channels at one pair.
/// \param parts 0 isotropic, else the number of equal parts of a turn
std::vector<double> reference(const Tensors& tensors, const Directions& pair, int parts) {
  const Tensor& vndf = tensors.at("vndf");
  const Tensor& values = tensors.contains("spectra") ? tensors.at("spectra") : tensors.at("rgb");
  const double phi = parts == 0 ? 0.7 : pair.phi_in;
  Vector3d light = unit_of_angles(pair.theta_in, phi);
  Vector3d view = unit_of_angles(pair.theta_out, phi + pair.delta_phi);
  if (parts == 2 && light.y() > 0) {
    for (Vector3d* d : {&light, &view}) *d = Vector3d(-d->x(), -d->y(), d->z());
  }
  if (parts == 4) {
    const Vector3d sign(light.x() > 0 ? -1 : 1, light.y() > 0 ? -1 : 1, 1);
    for (Vector3d* d : {&light, &view}) *d = d->cwiseProduct(sign);
  }
  const Vector3d half = (light + view).normalized();
  const double phi_light = std::atan2(light.y(), light.x());
  const double turn = (std::atan2(half.y(), half.x()) - (parts == 0 ? phi_light : 0) + pi) / (2 * pi);
  const double x = std::sqrt(2 * std::asin((half - Vector3d::UnitZ()).norm() / 2) * 2 / pi);
  const double y = turn - std::floor(turn);

  const auto by_phi = hats(tensors.at("phi_i").values, phi_light);
  const auto by_theta = hats(tensors.at("theta_i").values, pair.theta_in);
  const std::size_t height = vndf.shape[2];
  const std::size_t width = vndf.shape[3];
  std::vector<Slice> slices;
  for (std::size_t p = 0; p < by_phi.size(); ++p) {
    for (std::size_t t = 0; t < by_theta.size(); ++t) {
      if (by_phi[p] * by_theta[t] == 0) continue;
      const auto row = [&](double v) {
        return integral([&](double u) { return bilinear(vndf, {p, t}, u, v); }, 1, width - 1);
      };
      slices.push_back({p, t, by_phi[p] * by_theta[t], integral(row, 1, height - 1)});
    }
  }
  const auto density = [&](double u, double v) {
    double sum = 0;
    for (const Slice& s : slices) sum += s.weight / s.total * bilinear(vndf, {s.p, s.t}, u, v);
    return sum;
  };
  const auto row_up_to = [&](double end, double v) {
    return integral([&](double u) { return density(u, v); }, end, width - 1);
  };
  const double sample_x = row_up_to(x, y) / row_up_to(1, y);
  const double sample_y = integral([&](double v) { return row_up_to(1, v); }, y, height - 1);

  double factor = 1 / view.z();
  if (tensors.at("jacobian").values[0] != 0) {
    factor *= bilinear(tensors.at("ndf"), {}, x, y) /
              (4 * bilinear(tensors.at("sigma"), {}, std::sqrt(pair.theta_in * 2 / pi),
                            parts == 0 ? 0.5 : (phi_light + pi) / (2 * pi)));
  }
  std::vector<double> found(values.shape[2], 0.0);
  for (std::size_t c = 0; c < found.size(); ++c) {
    for (const Slice& s : slices) {
      found[c] += factor * s.weight * bilinear(values, {s.p, s.t, c}, std::min(sample_x, 1.0), std::min(sample_y, 1.0));
    }
  }
  return found;
}

void expect_reference_values(const fs::path& path, const std::vector<Directions>& pairs, int parts) {
  const Tensors tensors = parse(read_file(path));
  const BrdfFunction brdf = load_measured(path);
  const auto values = brdf.at(pairs).value;
  for (std::size_t i = 0; i < pairs.size(); ++i) {
    const auto expected = reference(tensors, pairs[i], parts);
    ASSERT_EQ(static_cast<std::size_t>(values.cols()), expected.size()) << i;
    for (std::size_t c = 0; c < expected.size(); ++c) {
      // The inverse amplifies rounding where a density is flat and where the values are steep.
      EXPECT_NEAR(values(static_cast<Eigen::Index>(i), static_cast<Eigen::Index>(c)), expected[c],
                  1e-10 * (1 + std::abs(expected[c])))
          << path << " " << i << " " << c;
    }
  }
}

// --- Real files.

class RglFiles : public MeasuredData {
 protected:
  RglFiles() : MeasuredData("rgl_bsdf") {}
};

/// In general position, some of them near the mirror direction.
std::vector<Directions> twenty_with_peaks() {
  std::vector<Directions> pairs = twenty_geometries();
  for (std::size_t i = 0; i < 10; ++i) {
    Directions& pair = pairs[2 * i];
    const double angle = 0.03 * (static_cast<double>(i) + 1);
    pair = {0.14 * static_cast<double>(i) + 0.05, std::abs(0.14 * static_cast<double>(i) + 0.05 - angle), pi - angle,
            0};
  }
  return pairs;
}

TEST_F(RglFiles, HaveTheValuesOfAnIndependentEvaluation) {
  for (const char* name : {"cc_green_malachite_rgb", "irid_flake_paint1_rgb", "vch_golden_yellow_rgb"}) {
    expect_reference_values(data_ / (std::string(name) + ".bsdf"), twenty_with_peaks(), 0);
  }
}

TEST_F(RglFiles, AreMeasurementsOfReflectingFilms) {
  std::size_t count = 0;
  double worst = 0;
  for (const auto& entry : fs::directory_iterator(data_)) {
    SCOPED_TRACE(entry.path().filename().string());
    const BrdfFunction brdf = load_measured(entry.path());
    EXPECT_EQ(brdf.format, "RGL tensor_file .bsdf (Dupuy and Jakob 2018)");
    EXPECT_THAT(brdf.channels, ElementsAre("red", "green", "blue"));
    EXPECT_THAT(brdf.remarks, ElementsAre(HasSubstr("of 24576 values are negative, and kept")));
    EXPECT_TRUE(brdf.is_isotropic);
    // Bright towards the mirror direction, dark towards the light; green, as others are outside the gamut of sRGB.
    const auto values = brdf.at(std::vector<Directions>{{0.6, 0.6, pi, 0}, {0.6, 0.6, 0, 0}}).value;
    EXPECT_GT(values(0, 1), 1);
    EXPECT_LT(values(1, 1), 0.1);
    // Reciprocal as far as measurements are: mean difference over mean value.
    double difference = 0;
    double sum = 0;
    for (double in = 0.1; in < 1.2; in += 0.1) {
      for (double out = 0.1; out < 1.2; out += 0.1) {
        for (double phi = 0; phi < 3.2; phi += 0.2) {
          const auto both = brdf.at(std::vector<Directions>{{in, out, phi, 0}, {out, in, -phi, 0}}).value;
          difference += (both.row(0) - both.row(1)).cwiseAbs().sum();
          sum += both.sum() / 2;
        }
      }
    }
    EXPECT_LT(difference / sum, 0.25) << entry.path();
    worst = std::max(worst, difference / sum);
    ++count;
  }
  EXPECT_EQ(count, 10U);
  RecordProperty("reciprocity", std::to_string(worst));
}

TEST_F(RglFiles, AreTheSameInBothSensesOfTheMirrorDirection) {
  // H is the normal, whose azimuth rounding would make up.
  const BrdfFunction brdf = load_measured(data_ / "chm_mint_rgb.bsdf");
  for (const double theta : {0.0, 0.3, 1.0, 1.5}) {
    SCOPED_TRACE(theta);
    const auto values = brdf.at(std::vector<Directions>{{theta, theta, pi, 0}, {theta, theta, -pi, 0}}).value;
    EXPECT_EQ(values.row(0), values.row(1));
  }
}

// --- Synthetic files.

class Rgl : public ::testing::Test {
 protected:
  [[nodiscard]] fs::path path() const { return directory_.path() / "film.bsdf"; }

  TemporaryDirectory directory_;
};

/// \param azimuths of the light, none for isotropic files;
/// \param wavelengths none for red, green and blue
Tensors random_tensors(const std::vector<float>& azimuths, const std::vector<float>& wavelengths, unsigned seed) {
  std::mt19937 engine(seed);
  std::uniform_real_distribution<float> value(0.2F, 1.7F);
  const auto random = [&](std::vector<std::size_t> shape) {
    std::size_t size = 1;
    for (const std::size_t length : shape) size *= length;
    Tensor tensor{std::move(shape), std::vector<float>(size), 0};
    for (float& one : tensor.values) one = value(engine);
    return tensor;
  };
  const std::size_t phis = std::max<std::size_t>(azimuths.size(), 1);
  Tensors tensors{{"phi_i", {{phis}, azimuths.empty() ? std::vector<float>{0} : azimuths, 0}},
                  {"theta_i", {{4}, {0, 0.5F, 1.1F, 1.5F}, 0}},
                  {"ndf", random({3, 6})},
                  {"sigma", random({4, 5})},
                  {"vndf", random({phis, 4, 9, 12})},
                  {"jacobian", {{1}, {1}, 0}}};
  if (wavelengths.empty()) {
    tensors["rgb"] = random({phis, 4, 3, 5, 7});
    tensors["sigma"].values = std::vector<float>(20, 0.7F);
  } else {
    tensors["spectra"] = random({phis, 4, wavelengths.size(), 5, 7});
    tensors["wavelengths"] = {{wavelengths.size()}, wavelengths, 0};
  }
  return tensors;
}

std::vector<float> azimuths_over(int parts) {
  std::vector<float> azimuths;
  for (int k = 0; k <= 6; ++k) azimuths.push_back(static_cast<float>(-pi + 2 * pi / parts * k / 6));
  return azimuths;
}

TEST_F(Rgl, OfColoursHasTheValuesOfAnIndependentEvaluation) {
  Tensors tensors = random_tensors({}, {}, 1);
  write_file(path(), file_of(tensors));
  expect_reference_values(path(), twenty_geometries(), 0);
}

TEST_F(Rgl, WithoutJacobianHasTheValuesOfAnIndependentEvaluation) {
  Tensors tensors = random_tensors({}, {}, 2);
  tensors["jacobian"].values = {0};
  write_file(path(), file_of(tensors));
  expect_reference_values(path(), twenty_geometries(), 0);
}

TEST_F(Rgl, OfSpectraHasTheValuesOfAnIndependentEvaluation) {
  Tensors tensors = random_tensors({}, {360, 430.5F, 700, 999}, 3);
  tensors["sigma"].values = std::vector<float>(20, 0.9F);
  write_file(path(), file_of(tensors));
  expect_reference_values(path(), twenty_geometries(), 0);
  const BrdfFunction brdf = load_measured(path());
  EXPECT_THAT(brdf.channels, ElementsAre("360 nm", "430.5 nm", "700 nm", "999 nm"));
  EXPECT_THAT(brdf.wavelengths, ElementsAre(360, 430.5, 700, 999));
  const auto all = brdf.at(twenty_geometries()).value;
  const auto between = load_measured(path(), {.wavelengths = {565.25}}).at(twenty_geometries()).value;
  EXPECT_LT((between.col(0) - (all.col(1) + all.col(2)) / 2).cwiseAbs().maxCoeff(), 1e-12 * all.maxCoeff());
}

TEST_F(Rgl, OfAWholeTurnHasTheValuesOfAnIndependentEvaluation) {
  Tensors tensors = random_tensors(azimuths_over(1), {}, 4);
  write_file(path(), file_of(tensors));
  EXPECT_FALSE(load_measured(path()).is_isotropic);
  expect_reference_values(path(), twenty_geometries(), 1);
}

TEST_F(Rgl, OfHalfATurnHasTheValuesOfAnIndependentEvaluation) {
  Tensors tensors = random_tensors(azimuths_over(2), {450, 550}, 5);
  write_file(path(), file_of(tensors));
  expect_reference_values(path(), twenty_geometries(), 2);
}

TEST_F(Rgl, OfAQuarterTurnHasTheValuesOfAnIndependentEvaluation) {
  Tensors tensors = random_tensors(azimuths_over(4), {}, 6);
  write_file(path(), file_of(tensors));
  expect_reference_values(path(), twenty_geometries(), 4);
}

// What is known of a light is kept for the next pair with it: one of another azimuth alone is another light.
TEST_F(Rgl, HasTheValuesOfAnIndependentEvaluationForLightsThatComeAgain) {
  std::vector<Directions> pairs;
  for (const double theta : {0.4, 1.2}) {
    for (const double phi : {0.3, 2.5, 4.0, 5.6}) {
      for (const double delta_phi : {2.9, 0.7}) pairs.push_back({theta, 0.8, delta_phi, phi});
    }
  }
  for (const int parts : {0, 1, 2, 4}) {
    SCOPED_TRACE(parts);
    Tensors tensors = random_tensors(parts == 0 ? std::vector<float>() : azimuths_over(parts), {}, 9);
    write_file(path(), file_of(tensors));
    expect_reference_values(path(), pairs, parts);
  }
}

TEST_F(Rgl, HasOneValueForBothZerosOfTheAzimuth) {
  Tensors tensors = random_tensors(azimuths_over(2), {}, 10);
  write_file(path(), file_of(tensors));
  const BrdfFunction brdf = load_measured(path());
  const Directions plus{0.6, 0.9, 0.4, 0.0};
  const Directions minus{0.6, 0.9, 0.4, -0.0};
  const auto values = brdf.at(std::vector{plus, minus, Directions{0.5, 0.9, 0.4, 1}, minus}).value;
  EXPECT_EQ(values.row(0), values.row(1));
  EXPECT_EQ(values.row(0), values.row(3));
}

TEST_F(Rgl, RepeatsAndMirrorsWhatWasMeasured) {
  const auto values_at = [&](int parts, const Directions& pair) {
    Tensors tensors = random_tensors(azimuths_over(parts), {}, 7);
    write_file(path(), file_of(tensors));
    return Eigen::MatrixXd(load_measured(path()).at(std::vector{pair}).value);
  };
  const Directions pair{0.4, 1.1, 0.8, 0.3};
  const Directions turned{0.4, 1.1, 0.8, 0.3 + pi};
  const Directions mirrored{0.4, 1.1, -0.8, -0.3};
  EXPECT_GT((values_at(1, pair) - values_at(1, turned)).norm(), 0.01);
  EXPECT_LT((values_at(2, pair) - values_at(2, turned)).norm(), 1e-12);
  EXPECT_GT((values_at(2, pair) - values_at(2, mirrored)).norm(), 0.01);
  EXPECT_LT((values_at(4, pair) - values_at(4, turned)).norm(), 1e-12);
  EXPECT_LT((values_at(4, pair) - values_at(4, mirrored)).norm(), 1e-12);
}

TEST_F(Rgl, KeepsNegativeValuesAndCountsThem) {
  Tensors tensors = random_tensors({}, {}, 8);
  for (float& value : tensors["rgb"].values) value = -value;
  write_file(path(), file_of(tensors));
  const BrdfFunction brdf = load_measured(path());
  EXPECT_THAT(brdf.remarks, ElementsAre("420 of 420 values are negative, and kept"));
  EXPECT_LT(brdf.at(twenty_geometries()).value.maxCoeff(), 0);
}

TEST_F(Rgl, IsFiniteUpToTheHorizonAndWhereNoNormalIsVisible) {
  Tensors tensors = random_tensors({}, {}, 9);
  auto& density = tensors["vndf"].values;
  std::fill(density.end() - 12 * 6, density.end(), 0.0F);  // rows of the last angle of the light
  write_file(path(), file_of(tensors));
  const BrdfFunction brdf = load_measured(path());
  std::vector<Directions> pairs;
  for (const double in : {0.0, 1e-14, 0.7, 1.5, pi / 2 - 1e-15}) {
    for (const double out : {0.0, 1e-14, 0.7, 1.5, pi / 2 - 1e-15}) {
      for (const double phi : {0.0, 1e-15, 1.0, pi, -pi, 3 * pi, -1.0}) pairs.push_back({in, out, phi, 0});
    }
  }
  EXPECT_TRUE(brdf.at(pairs).value.allFinite());
}

// --- Damaged files.

TEST_F(Rgl, IsRefusedWhereItIsCut) {
  Tensors tensors = random_tensors({}, {}, 10);
  const std::string whole = file_of(tensors);
  for (std::size_t size = 12; size < whole.size(); size += 97) {
    expect_unreadable(path(), whole.substr(0, size), ": byte ");
  }
  expect_unreadable(path(), whole.substr(0, 20), "byte 20: the file ends within the name of a field");
  expect_unreadable(path(), whole + "x", "byte " + std::to_string(whole.size()) + ": 1 bytes after the last field");
}

TEST_F(Rgl, IsRefusedWhereItsFieldsDoNotFit) {
  Tensors tensors = random_tensors({}, {}, 11);
  const auto refused = [&](const std::function<void(Tensors&)>& change, const std::string& complaint) {
    Tensors changed = tensors;
    change(changed);
    expect_unreadable(path(), file_of(changed), complaint);
  };
  refused([](Tensors& t) { t.erase("vndf"); }, "there is no field 'vndf'");
  refused([](Tensors& t) { t.erase("rgb"); }, "there is no field 'rgb'");
  refused([](Tensors& t) { t["spectra"] = t["rgb"]; }, "there is no field 'wavelengths'");
  refused([](Tensors& t) { t["vndf"].shape = {1, 4, 108}; }, "field 'vndf' has 3 axes; expected 4");
  refused([](Tensors& t) { t["vndf"].shape = {4, 1, 9, 12}; }, "field 'vndf' has 4 x 1 directions of the light");
  refused([](Tensors& t) { t["rgb"].shape = {1, 4, 5, 3, 7}; }, "field 'rgb' has 5 channels; expected 3");
  refused([](Tensors& t) { t["ndf"].shape = {18, 1}; }, "grids of 18 x 1");
  refused([](Tensors& t) { t["theta_i"].values[2] = 0.5F; }, "the angles 'theta_i' do not increase");
  refused([](Tensors& t) { t["theta_i"].values[3] = 30; }, "the angles 'theta_i' do not increase within a turn");
  refused([](Tensors& t) { t["rgb"].values[7] = NAN; }, "a value of 'rgb' is no finite number");
  refused([](Tensors& t) { t["vndf"].values[7] = NAN; }, "a value of 'vndf' is no finite number");
  refused([](Tensors& t) { t["vndf"].values[7] = HUGE_VALF; }, "a value of 'vndf' is no finite number");
  refused([](Tensors& t) { t["vndf"].values[7] = -0.1F; }, "a value of 'vndf' is below 0");
  refused([](Tensors& t) { t["sigma"].values[7] = 0; }, "a value of 'sigma' is below");
  refused([](Tensors& t) { t["vndf"].values.assign(432, 0); }, "a density of 'vndf' has no integral above 0");
  refused([](Tensors& t) { t = random_tensors({0, 1, 2}, {}, 12); }, "azimuths from 0 to 114.6 degrees");
}

TEST_F(Rgl, IsRefusedWhereItsHeaderIsWrong) {
  Tensors tensors = random_tensors({}, {}, 13);
  const std::string whole = file_of(tensors);
  expect_unreadable(path(), with_number(whole, 12, std::uint8_t{2}), "byte 12: version 2.0 of tensor files");
  expect_unreadable(path(), with_number(whole, 14, 0x07000000U), "byte 14: 117440512 fields; expected up to 256");
  // The first field is 'jacobian': its name, number of axes, type, place and length.
  expect_unreadable(path(), with_number(whole, 28, std::uint16_t{900}),
                    "byte 18: a field of 900 axes; expected up to 8");
  expect_unreadable(path(), with_number(whole, 30, std::uint8_t{77}), "byte 18: a field of unknown type");
  expect_unreadable(path(), with_number(whole, 30, std::uint8_t{10}), "field 'jacobian' is of another type");
  expect_unreadable(path(), with_number(whole, 31, std::uint64_t{1} << 60U), "byte 18: a field lies at byte 115292");
  expect_unreadable(path(), with_number(whole, 39, ~std::uint64_t{0}), "byte 18: the field at byte");
  expect_unreadable(path(), with_number(whole, 39, std::uint64_t{0}), "field 'jacobian' is empty");
}

}  // namespace
}  // namespace lobe::test
