// Tensor files of RGL, written: held byte by byte against their layout, evaluated and sampled as renderers do.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <limits>
#include <numbers>
#include <ostream>
#include <random>
#include <string>
#include <string_view>
#include <vector>

#include "io/measured_files.hpp"
#include "lobe/energy/albedo.hpp"
#include "lobe/formats/measured_export.hpp"
#include "lobe/model/specification.hpp"
#include "lobe/reflectance/as_function.hpp"
#include "reference/rgl_renderer.hpp"
#include "support/device.hpp"
#include "support/full_disk.hpp"
#include "support/functions.hpp"
#include "support/measured_data.hpp"
#include "support/tables.hpp"
#include "support/temporary_directory.hpp"

namespace lobe::test {
namespace {

namespace fs = std::filesystem;
using reference::RglRenderer;
using reference::tensor_fields_of;
using reference::TensorField;
using reference::Vec3f;
using std::numbers::pi;
using ::testing::ElementsAre;
using ::testing::HasSubstr;

Vec3f unit(double theta, double phi) {
  return {static_cast<float>(std::sin(theta) * std::cos(phi)), static_cast<float>(std::sin(theta) * std::sin(phi)),
          static_cast<float>(std::cos(theta))};
}

/// A function with channels in these proportions.
BrdfFunction coloured(std::vector<double> factors, std::vector<double> wavelengths = {}) {
  BrdfFunction brdf;
  brdf.name = "coloured";
  for (std::size_t c = 0; c < factors.size(); ++c) brdf.channels.push_back(std::to_string(c));
  brdf.wavelengths = std::move(wavelengths);
  brdf.is_bilateral = true;
  brdf.at = [factors = std::move(factors)](std::span<const Directions> pairs) {
    BrdfValues values;
    values.value.resize(static_cast<Eigen::Index>(pairs.size()), static_cast<Eigen::Index>(factors.size()));
    for (Eigen::Index i = 0; i < values.value.rows(); ++i) {
      const Directions& pair = pairs[static_cast<std::size_t>(i)];
      const double common = 0.2 + 0.1 * std::cos(pair.theta_in) * std::cos(pair.theta_out);
      for (Eigen::Index c = 0; c < values.value.cols(); ++c) {
        values.value(i, c) = factors[static_cast<std::size_t>(c)] * common;
      }
    }
    return values;
  };
  return brdf;
}

const TensorField& field_of(const std::vector<TensorField>& fields, std::string_view name) {
  const auto found = std::ranges::find(fields, name, &TensorField::name);
  if (found == fields.end()) throw std::runtime_error("no field " + std::string(name));
  return *found;
}

/// Integral over the unit square of what is bilinear between the nodes of a grid.
double integral_of(const float* grid, std::size_t width, std::size_t height) {
  double sum = 0;
  for (std::size_t y = 0; y + 1 < height; ++y) {
    for (std::size_t x = 0; x + 1 < width; ++x) {
      const float* const corner = grid + y * width + x;
      sum += (static_cast<double>(corner[0]) + static_cast<double>(corner[1]) + static_cast<double>(corner[width]) +
              static_cast<double>(corner[width + 1])) /
             4;
    }
  }
  return sum / static_cast<double>((width - 1) * (height - 1));
}

class RglWriter : public ::testing::Test {
 protected:
  [[nodiscard]] fs::path path() const { return directory_.path() / "written.bsdf"; }

  /// Content of the file with a reflectance.
  std::string write(const Reflectance& reflectance, WriteOptions options = {}) const {
    options.overwrite = true;
    save_measured(device(), reflectance, "rgl", path(), options);
    return read_file(path());
  }

  /// Values of the renderer over the viewer's cosine, against the material's.
  static Deviation seen_by(const RglRenderer& renderer, const BrdfFunction& exact) {
    std::mt19937 engine(3);
    std::uniform_real_distribution<double> theta(0, 75 * kDegree);
    std::uniform_real_distribution<double> phi(-pi, pi);
    std::vector<Directions> pairs(3000);
    for (Directions& pair : pairs) pair = {theta(engine), theta(engine), phi(engine), phi(engine)};
    const Eigen::MatrixXd values = exact.at(pairs).value;
    std::vector<double> relative;
    double off = 0;
    double all = 0;
    for (std::size_t i = 0; i < pairs.size(); ++i) {
      const Directions& pair = pairs[i];
      const auto seen =
          renderer.eval(unit(pair.theta_in, pair.phi_in), unit(pair.theta_out, pair.phi_in + pair.delta_phi));
      for (Eigen::Index c = 0; c < values.cols(); ++c) {
        const double value = values(static_cast<Eigen::Index>(i), c);
        const double difference =
            static_cast<double>(seen[static_cast<std::size_t>(c)]) / std::cos(pair.theta_out) - value;
        relative.push_back(std::abs(difference / value));
        off += difference * difference;
        all += value * value;
      }
    }
    std::ranges::nth_element(relative, relative.begin() + static_cast<std::ptrdiff_t>(relative.size() / 2));
    return {.median = relative[relative.size() / 2], .rms = std::sqrt(off / all)};
  }

  TemporaryDirectory directory_;
};

struct Written {
  const char* name;
  const char* material;  ///< specification
  double rms;            ///< bound
  double median;         ///< bound
  double albedo;         ///< bound on the difference of directional albedos, relative
  bool is_table = false;

  friend std::ostream& operator<<(std::ostream& stream, const Written& written) { return stream << written.name; }
};

/// Bounds are those measured, doubled and rounded.
const Written kWritten[]{
    {"lambert", "lambert:scale=0.7", 6e-3, 1.5e-3, 1e-3},
    {"ggx", "ggx:alpha=0.3", 3e-3, 1.5e-3, 5e-3},
    {"narrow_ggx", "ggx:alpha=0.05", 2e-3, 6e-3, 5e-3},
    {"anisotropic_ggx", "ggx_anisotropic:alpha_x=0.1,alpha_y=0.3", 2e-2, 1e-2, 1e-2},
    {"colours", "lambert:scale=0.3/0.2/0.1+ggx:alpha=0.2,scale=0.3", 5e-3, 2e-3, 5e-3},
    // Far from the mirror direction its values are as small as 1e-30, and at the horizon it ends within a cell.
    {"mirrored_lobe", "phong:n=50", 1e-2, 10, 0.07},
    {"table", "ggx:alpha=0.5", 4e-3, 1.5e-3, 2e-3, true},
};

class RglWriterOf : public RglWriter, public ::testing::WithParamInterface<Written> {
 protected:
  static Reflectance subject() {
    const Written& written = GetParam();
    if (written.is_table) return table_of(written.material, "gauss:32x64");
    return parse_material(written.material);
  }
};

TEST_P(RglWriterOf, HasForRenderersTheValuesThatItStates) {
  const Reflectance subject = RglWriterOf::subject();
  const RglRenderer renderer(write(subject));
  const Deviation stated = deviation(device(), subject, load_measured(path()));
  const Deviation seen = seen_by(renderer, as_function(device(), subject));

  // Single precision, where an inverse is steep.
  EXPECT_LT(seen_by(renderer, load_measured(path())).rms, 1e-3);
  // Other pairs, of which more or fewer meet a highlight.
  EXPECT_LT(seen.rms, 2 * stated.rms + 1e-4);
  EXPECT_LT(seen.median, 1.3 * stated.median + 1e-5);
  EXPECT_LT(stated.rms, GetParam().rms);
  EXPECT_LT(stated.median, GetParam().median);
  EXPECT_GE(stated.largest, stated.rms / 100);
  RecordProperty("rms", std::to_string(stated.rms));
}

TEST_P(RglWriterOf, GivesSamplesTheDensityThatRenderersState) {
  const Reflectance subject = RglWriterOf::subject();
  const RglRenderer renderer(write(subject));
  const BrdfFunction back = load_measured(path());
  constexpr std::size_t kSamples = 40000;
  std::mt19937 engine(7);
  std::uniform_real_distribution<float> uniform(0, 1);
  const std::vector<Direction> lights{{0.001, 0.4}, {0.5, 2}, {1, -1}, {1.3, 0.2}};
  const auto exact = albedo(device(), subject, lights);
  const auto file = albedo(device(), back, lights);
  for (std::size_t l = 0; l < lights.size(); ++l) {
    SCOPED_TRACE(to_degrees(lights[l].theta));
    const Vec3f in = unit(lights[l].theta, lights[l].phi);
    double sum = 0;
    double squares = 0;
    std::size_t different = 0;
    for (std::size_t i = 0; i < kSamples; ++i) {
      const auto drawn = renderer.sample(in, uniform(engine), uniform(engine));
      if (!drawn) continue;
      sum += static_cast<double>(drawn->weight[0]);
      squares += static_cast<double>(drawn->weight[0]) * static_cast<double>(drawn->weight[0]);
      if (std::abs(renderer.pdf(in, drawn->out) / drawn->pdf - 1) > 0.01F) ++different;
    }
    const double mean = sum / kSamples;
    const double deviation = std::sqrt(squares / kSamples - mean * mean);
    EXPECT_NEAR(mean, file[0][l].value, 4 * deviation / std::sqrt(kSamples) + file[0][l].error + 1e-4);
    EXPECT_NEAR(mean, exact[0][l].value, 4 * deviation / std::sqrt(kSamples) + GetParam().albedo * exact[0][l].value);
    // Sampling by cosines, of a lobe as narrow as 0.05, would deviate by several times the mean.
    EXPECT_LT(deviation, mean);
    // The half-vector of a drawn direction is rounded, and its azimuth lost about the normal.
    EXPECT_LT(different, kSamples / 100);
  }
}

TEST_P(RglWriterOf, HasDensitiesOfUnitMass) {
  const auto fields = tensor_fields_of(write(subject(), {.light_angles = 6, .light_azimuths = 6, .nodes = 16}));
  for (const char* name : {"vndf", "luminance"}) {
    const TensorField& field = field_of(fields, name);
    const std::size_t size = field.shape[2] * field.shape[3];
    for (std::size_t slice = 0; slice < field.shape[0] * field.shape[1]; ++slice) {
      // Sums of single precision.
      EXPECT_NEAR(integral_of(&field.floats[slice * size], field.shape[3], field.shape[2]), 1, 1e-6)
          << name << " " << slice;
    }
    EXPECT_GE(std::ranges::min(field.floats), 0) << name;
  }
  EXPECT_GT(std::ranges::min(field_of(fields, "luminance").floats), 0);
  EXPECT_GT(std::ranges::min(field_of(fields, "ndf").floats), 0);
  EXPECT_GT(std::ranges::min(field_of(fields, "sigma").floats), 0);
  // The area of a level surface seen from above.
  EXPECT_NEAR(static_cast<double>(field_of(fields, "sigma").floats[0]), 1, 1e-5);
}

INSTANTIATE_TEST_SUITE_P(Materials, RglWriterOf, ::testing::ValuesIn(kWritten),
                         [](const auto& written) { return std::string(written.param.name); });

TEST_F(RglWriter, LaysOutFieldsWithoutGapsButForAlignment) {
  const std::string content =
      write(coloured({0.2, 0.5, 0.7}), {.command_line = "lobe export\nx", .light_angles = 3, .nodes = 4});
  const auto fields = tensor_fields_of(content);
  std::vector<std::string> names;
  std::size_t list = 18;
  for (const TensorField& field : fields) {
    names.push_back(field.name);
    list += 2 + field.name.size() + 2 + 1 + 8 + 8 * field.shape.size();
  }
  EXPECT_THAT(names, ElementsAre("version", "description", "phi_i", "theta_i", "sigma", "ndf", "vndf", "luminance",
                                 "rgb", "jacobian"));
  std::size_t end = list;
  for (const TensorField& field : fields) {
    EXPECT_EQ(field.offset % 8, 0U) << field.name;
    EXPECT_GE(field.offset, end) << field.name;
    EXPECT_LT(field.offset, end + 8) << field.name;
    for (std::size_t at = end; at < field.offset; ++at) EXPECT_EQ(content[at], 0) << field.name << " " << at;
    end = field.offset + field.bytes.size();
  }
  EXPECT_EQ(end, content.size());
  EXPECT_EQ(field_of(fields, "version").bytes, std::string("\1\0\0\0\0\0\0\0", 8));
  EXPECT_EQ(field_of(fields, "description").bytes, "coloured; lobe export\\x0ax");
  EXPECT_EQ(field_of(fields, "jacobian").bytes, "\1");
  EXPECT_THAT(field_of(fields, "phi_i").floats, ElementsAre(0.0F));
  EXPECT_THAT(field_of(fields, "theta_i").floats,
              ElementsAre(0.0F, static_cast<float>(44.5 * kDegree), static_cast<float>(89 * kDegree)));
  EXPECT_THAT(field_of(fields, "vndf").shape, ElementsAre(1U, 3U, 128U, 128U));
  EXPECT_THAT(field_of(fields, "luminance").shape, ElementsAre(1U, 3U, 4U, 4U));
  EXPECT_THAT(field_of(fields, "rgb").shape, ElementsAre(1U, 3U, 3U, 4U, 4U));
}

TEST_F(RglWriter, TurnsTheLightOnceAroundAnisotropicMaterials) {
  const auto fields = tensor_fields_of(
      write(parse_material("ward_anisotropic:m_x=0.1,m_y=0.3"), {.light_angles = 3, .light_azimuths = 4, .nodes = 5}));
  const auto f = [](double x) { return static_cast<float>(x); };
  EXPECT_THAT(field_of(fields, "phi_i").floats, ElementsAre(f(-pi), f(-pi / 2), f(0), f(pi / 2), f(pi)));
  for (const char* name : {"vndf", "luminance", "rgb"}) {
    const auto& floats = field_of(fields, name).floats;
    const auto turn = static_cast<std::ptrdiff_t>(floats.size() / 5);
    EXPECT_TRUE(std::equal(floats.begin(), floats.begin() + turn, floats.end() - turn)) << name;
    EXPECT_FALSE(std::equal(floats.begin(), floats.begin() + turn, floats.begin() + turn)) << name;
  }
}

TEST_F(RglWriter, IsExactWhereTheLightHasItsAngles) {
  const BrdfFunction exact = as_function(device(), parse_material("ggx:alpha=0.3"));
  write(exact);
  const BrdfFunction back = load_measured(path());
  // The sampled point (0, 0) of every light is the normal as half-vector.
  for (const std::size_t t : {1U, 7U, 15U, 20U}) {
    const double theta = static_cast<double>(static_cast<float>(89 * kDegree * static_cast<double>(t) / 23));
    const std::vector<Directions> pair{{theta, theta, pi, 0}};
    const double value = exact.at(pair).value(0, 0);
    EXPECT_NEAR(back.at(pair).value(0, 0), value, 1e-5 * value) << t;
  }
}

TEST_F(RglWriter, WritesAFileOfRglAgain) {
  const fs::path original = measured_data("rgl_bsdf/vch_golden_yellow_rgb.bsdf");
  if (original.empty()) GTEST_SKIP() << kNoData;
  const BrdfFunction exact = load_measured(original);
  const RglRenderer renderer(write(exact));
  const Deviation stated = deviation(device(), exact, load_measured(path()));
  EXPECT_LT(stated.rms, 0.05);
  EXPECT_LT(seen_by(renderer, exact).rms, 1.5 * stated.rms);
}

TEST_F(RglWriter, SortsWavelengths) {
  write(coloured({0.6, 0.2, 0.4}, {650, 450, 550.5}));
  const BrdfFunction back = load_measured(path());
  EXPECT_THAT(back.wavelengths, ElementsAre(450, 550.5, 650));
  const auto values = back.at(twenty_geometries()).value;
  EXPECT_LT((3 * values.col(0) - values.col(2)).cwiseAbs().maxCoeff(), 1e-6);
  EXPECT_LT((2 * values.col(0) - values.col(1)).cwiseAbs().maxCoeff(), 1e-6);
  const RglRenderer renderer(read_file(path()));
  EXPECT_EQ(renderer.channels(), 3U);
}

TEST_F(RglWriter, TakesOneChannelAsGreyOrAsASpectrum) {
  const BrdfFunction grey = coloured({0.5});
  write(grey);
  const BrdfFunction colours = load_measured(path());
  EXPECT_THAT(colours.channels, ElementsAre("red", "green", "blue"));
  const auto values = colours.at(twenty_geometries()).value;
  EXPECT_EQ(values.col(0), values.col(2));
  const RglRenderer spectral(write(grey, {.spectra = true}));
  EXPECT_EQ(spectral.channels(), 1U);
  const BrdfFunction spectrum = load_measured(path());
  EXPECT_THAT(spectrum.wavelengths, ElementsAre(550));
  EXPECT_EQ(spectrum.at(twenty_geometries()).value.col(0), values.col(0));
}

TEST_F(RglWriter, WritesABlackMaterial) {
  const RglRenderer renderer(write(coloured({0})));
  EXPECT_EQ(load_measured(path()).at(twenty_geometries()).value.cwiseAbs().maxCoeff(), 0);
  EXPECT_GT(renderer.pdf(unit(0.3, 0), unit(0.5, 1)), 0.0F);
}

TEST_F(RglWriter, RefusesWhatTheFormatDoesNotHold) {
  const auto refuses = [&](const Reflectance& reflectance, const std::string& complaint, WriteOptions options = {}) {
    expect_complaint([&] { static_cast<void>(write(reflectance, options)); }, complaint);
    EXPECT_FALSE(fs::exists(path())) << complaint;
  };
  refuses(coloured({1, 2}),
          "'coloured' has 2 channels; RGL files hold red, green and blue, wavelengths, or one channel");
  refuses(coloured({1, 2, 3}), "has 3 channels without wavelengths", {.spectra = true});
  refuses(coloured({1, 2}, {550, 550}), "two channels of 550 nm");
  refuses(parse_material("mirror"), "has delta parts");
  refuses(coloured({1}), "1 angles of the light for an RGL file; expected 2 to 4096", {.light_angles = 1});
  refuses(coloured({1}), "1 nodes of values for an RGL file; expected 2 to 4096", {.nodes = 1});
  refuses(coloured({1}), "5.0 GiB; expected up to 1", {.light_angles = 80, .nodes = 2048});
  refuses(parse_material("ward_anisotropic:m_x=0.1,m_y=0.3"), "2 azimuths of the light", {.light_azimuths = 2});
  refuses(function_of([](const Directions&) { return std::numeric_limits<double>::quiet_NaN(); }), "no finite numbers");
  refuses(function_of([](const Directions&) { return 1e60; }), "too large for single precision");
}

TEST_F(RglWriter, LeavesTheOlderFileOnAFullDisk) {
  write_file(path(), "old");
  EXPECT_THROW(save_measured(device(), coloured({0.5}), "rgl", path()), IoError);
  EXPECT_EQ(read_file(path()), "old");
  {
    const FullDisk disk(20000);
    EXPECT_THROW(save_measured(device(), coloured({0.5}), "rgl", path(), {.overwrite = true}), IoError);
  }
  EXPECT_EQ(read_file(path()), "old");
  EXPECT_EQ(std::distance(fs::directory_iterator(directory_.path()), {}), 1);
}

}  // namespace
}  // namespace lobe::test
