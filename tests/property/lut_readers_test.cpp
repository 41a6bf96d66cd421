// Files of lookup tables as other programs read them: compilers of C and GLSL, libpng, OpenEXR, tools of HDF5, and
// readers of tests/reference.
#include <ImfChannelList.h>
#include <ImfFrameBuffer.h>
#include <ImfHeader.h>
#include <ImfInputFile.h>
#include <ImfOutputFile.h>
#include <ImfStringAttribute.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <png.h>

#include <csetjmp>
#include <cstdint>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <map>
#include <memory>
#include <sstream>
#include <string>
#include <vector>

#include "io/command.hpp"
#include "lobe/lut.hpp"
#include "reference/lut_files.hpp"
#include "support/device.hpp"
#include "support/temporary_directory.hpp"

namespace lobe::test {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;

/// A table of 3 x 5 entries of scale and bias, whose numbers all differ.
const Lut& split_table() {
  static const Lut kTable = [] {
    LutRequest request{.reflectance = parse_material("ggx:alpha=0.5,f0=1"), .split = "f0"};
    for (const char* axis : {"alpha:count=3,from=0.1", "cos_theta:count=5"}) {
      request.axes.push_back(parse_lut_axis(axis, request.reflectance));
    }
    return make_lut(device(), request);
  }();
  return kTable;
}

class LookupTableElsewhere : public ::testing::Test {
 protected:
  /// Writes the table, and gives what the file is to hold.
  [[nodiscard]] Lut write(const std::string& name, const LutFileOptions& options) {
    const Lut stored = as_stored(split_table(), options);
    const LutErrors errors = lut_errors(device(), stored, split_table(), 1);
    std::ofstream(path(name), std::ios::binary) << lut_file(stored, errors, options);
    return stored;
  }
  [[nodiscard]] std::filesystem::path path(const std::string& name) const { return directory_.path() / name; }
  /// Runs a command in the folder of the file.
  [[nodiscard]] std::string output_of(const std::string& command) const {
    const CommandResult result = run_command("cd '" + directory_.path().string() + "' && " + command + " 2>&1");
    EXPECT_EQ(result.status, 0) << command << ": " << result.output;
    return result.output;
  }

 private:
  TemporaryDirectory directory_;
};

std::vector<float> floats_of(const Lut& table) {
  return {table.values.begin(), table.values.end()};
}

TEST_F(LookupTableElsewhere, IsReadByACompilerOfC) {
  const Lut stored = write("dfg.h", {.format = LutFormat::c, .name = "dfg"});
  std::ofstream(path("main.c")) << R"(#include "dfg.h"
#include <stdio.h>
int main(void) {
  const float* number = &dfg[0][0][0];
  size_t i;
  printf("%zu %zu %zu\n", sizeof dfg / sizeof dfg[0], sizeof dfg[0] / sizeof dfg[0][0], sizeof dfg[0][0] / sizeof(float));
  for (i = 0; i < sizeof dfg / sizeof(float); ++i) printf("%.9g\n", (double)number[i]);
  return 0;
}
)";
  (void)output_of(LOBE_C_COMPILER " -std=c99 -pedantic-errors -Wall -Wextra -Werror main.c -o main");
  std::istringstream printed(output_of("./main"));
  std::string shape;
  std::getline(printed, shape);
  EXPECT_EQ(shape, "3 5 2");
  std::vector<float> numbers;
  for (std::string line; std::getline(printed, line);) numbers.push_back(std::stof(line));
  EXPECT_EQ(numbers, floats_of(stored));
}

// The reference compiler of Khronos, whose module holds the numbers bit by bit.
TEST_F(LookupTableElsewhere, IsReadByACompilerOfGlsl) {
  ASSERT_TRUE(has_program("glslangValidator")) << "glslangValidator is missing; install glslang-tools";
  const Lut stored = write("dfg.glsl", {.format = LutFormat::glsl, .name = "dfg"});
  std::ofstream(path("main.frag")) << "#version 450\n"
                                   << std::ifstream(path("dfg.glsl")).rdbuf()
                                   << "layout(location = 0) flat in int entry;\n"
                                      "layout(location = 0) out vec2 terms;\n"
                                      "void main() { terms = dfg[entry]; }\n";
  (void)output_of("glslangValidator -V main.frag -o main.spv");
  EXPECT_EQ(reference::constants_of_module(path("main.spv")), floats_of(stored));
}

/// What libpng says of a file.
struct PngAccount {
  std::size_t width = 0;
  std::size_t height = 0;
  int bits = 0;
  int color_type = 0;
  double gamma = 0;  ///< 0 without the chunk
  bool is_srgb = false;
  std::map<std::string, std::string> texts;
  std::vector<unsigned> levels;
};

void read_all(const std::filesystem::path& path, PngAccount& account) {
  const std::unique_ptr<std::FILE, int (*)(std::FILE*)> file(std::fopen(path.c_str(), "rb"), std::fclose);
  ASSERT_NE(file, nullptr);
  png_structp png = png_create_read_struct(PNG_LIBPNG_VER_STRING, nullptr, nullptr, nullptr);
  png_infop info = png_create_info_struct(png);
  if (setjmp(png_jmpbuf(png)) != 0) FAIL() << "libpng refuses " << path;
  png_init_io(png, file.get());
  png_read_png(png, info, PNG_TRANSFORM_IDENTITY, nullptr);
  account.width = png_get_image_width(png, info);
  account.height = png_get_image_height(png, info);
  account.bits = png_get_bit_depth(png, info);
  account.color_type = png_get_color_type(png, info);
  png_get_gAMA(png, info, &account.gamma);
  account.is_srgb = png_get_valid(png, info, PNG_INFO_sRGB) != 0;
  png_textp texts = nullptr;
  const int count = png_get_text(png, info, &texts, nullptr);
  for (int i = 0; i < count; ++i) account.texts[texts[i].key] = texts[i].text;
  const png_bytepp rows = png_get_rows(png, info);
  const std::size_t bytes = png_get_rowbytes(png, info);
  for (std::size_t y = 0; y < account.height; ++y) {
    for (std::size_t i = 0; i < bytes; i += account.bits == 16 ? 2 : 1) {
      const unsigned high = rows[y][i];
      account.levels.push_back(account.bits == 16 ? high << 8U | rows[y][i + 1] : high);
    }
  }
  png_destroy_read_struct(&png, &info, nullptr);
}

TEST_F(LookupTableElsewhere, IsReadByLibpngWithItsLevelsAndItsGamma) {
  for (const int bits : {8, 16}) {
    const Lut stored = write("dfg.png", {.format = LutFormat::png, .bits = bits});
    PngAccount account;
    read_all(path("dfg.png"), account);
    EXPECT_EQ(account.width, 5U) << bits;
    EXPECT_EQ(account.height, 3U) << bits;
    EXPECT_EQ(account.bits, bits);
    EXPECT_EQ(account.color_type, PNG_COLOR_TYPE_RGB) << bits;
    EXPECT_EQ(account.gamma, 1.0) << bits;
    EXPECT_FALSE(account.is_srgb) << bits;
    EXPECT_THAT(account.texts["Description"], HasSubstr("axis 2: cos_theta from 0 to 1, 5 cell centres")) << bits;
    ASSERT_EQ(account.levels.size(), 45U) << bits;
    const double most = bits == 16 ? 65535 : 255;
    for (std::size_t i = 0; i < 15; ++i) {
      EXPECT_EQ(account.levels[3 * i] / most, stored.values[2 * i]) << bits << ", scale " << i;
      EXPECT_EQ(account.levels[3 * i + 1] / most, stored.values[2 * i + 1]) << bits << ", bias " << i;
      EXPECT_EQ(account.levels[3 * i + 2], 0U) << bits << ", blue " << i;
    }
  }
}

TEST_F(LookupTableElsewhere, IsReadByTheLibraryOfOpenexr) {
  for (const int bits : {16, 32}) {
    const Lut stored = write("dfg.exr", {.format = LutFormat::exr, .bits = bits});
    Imf::InputFile file(path("dfg.exr").c_str());
    const auto& window = file.header().dataWindow();
    ASSERT_EQ(window.max.x - window.min.x + 1, 5) << bits;
    ASSERT_EQ(window.max.y - window.min.y + 1, 3) << bits;
    const auto& channels = file.header().channels();
    std::string names;
    for (auto channel = channels.begin(); channel != channels.end(); ++channel) names += channel.name();
    ASSERT_EQ(names, "GR") << bits;
    EXPECT_EQ(channels["R"].type, bits == 16 ? Imf::HALF : Imf::FLOAT) << bits;
    EXPECT_THAT(file.header().typedAttribute<Imf::StringAttribute>("comments").value(),
                HasSubstr("axis 1: alpha from 0.1 to 1, 3 cell centres, from the top down"))
        << bits;
    std::vector<float> red(15);
    std::vector<float> green(15);
    Imf::FrameBuffer buffer;
    buffer.insert("R", Imf::Slice(Imf::FLOAT, reinterpret_cast<char*>(red.data()), sizeof(float), 5 * sizeof(float)));
    buffer.insert("G", Imf::Slice(Imf::FLOAT, reinterpret_cast<char*>(green.data()), sizeof(float), 5 * sizeof(float)));
    file.setFrameBuffer(buffer);
    file.readPixels(0, 2);
    for (std::size_t i = 0; i < 15; ++i) {
      EXPECT_EQ(static_cast<double>(red[i]), stored.values[2 * i]) << bits << ", scale " << i;
      EXPECT_EQ(static_cast<double>(green[i]), stored.values[2 * i + 1]) << bits << ", bias " << i;
    }
  }
}

// Lines of others, without compression and by the line, whose window does not begin at 0.
TEST_F(LookupTableElsewhere, MayBeAnImageOfOthers) {
  LutRequest request{.reflectance = make_material("lambert")};
  request.axes = {{.name = "y", .count = 20}, {.name = "theta", .count = 7}};
  for (const Imf::Compression compression : {Imf::NO_COMPRESSION, Imf::ZIPS_COMPRESSION, Imf::ZIP_COMPRESSION}) {
    const Imath::Box2i window({-3, 5}, {3, 24});
    Imf::Header header(window, window);
    header.compression() = compression;
    header.channels().insert("Y", Imf::Channel(Imf::HALF));
    header.channels().insert("Z", Imf::Channel(Imf::FLOAT));
    std::vector<Imath::half> values;
    for (int i = 0; i < 140; ++i) values.emplace_back(static_cast<float>(i) / 256);
    const std::vector<float> others(140, 7);
    Imf::FrameBuffer buffer;
    const auto base = [](const auto* numbers) {
      return const_cast<char*>(reinterpret_cast<const char*>(numbers + 3 - 5 * 7));
    };
    buffer.insert("Y", Imf::Slice(Imf::HALF, base(values.data()), 2, 14));
    buffer.insert("Z", Imf::Slice(Imf::FLOAT, base(others.data()), 4, 28));
    {
      Imf::OutputFile file(path("other.exr").c_str(), header, 0);
      file.setFrameBuffer(buffer);
      file.writePixels(20);
    }
    const Lut read = read_lut(path("other.exr"), request);
    ASSERT_EQ(read.values.size(), 140U) << compression;
    for (std::size_t i = 0; i < 140; ++i) EXPECT_EQ(read.values[i], static_cast<double>(i) / 256) << compression;
  }
}

// No library of Debian 12 reads KTX 2.0; the reader is ours, written from its specification.
TEST_F(LookupTableElsewhere, IsReadAsATexture) {
  struct Case {
    int bits;
    bool is_float;
    std::uint32_t format;  // of Vulkan, for two channels
  };
  for (const auto& [bits, is_float, format] :
       {Case{8, false, 16}, Case{16, false, 77}, Case{16, true, 83}, Case{32, true, 103}}) {
    const Lut stored = write("dfg.ktx2", {.format = LutFormat::ktx2, .bits = bits, .is_float = is_float});
    const reference::KtxFile file = reference::read_ktx(path("dfg.ktx2"));
    EXPECT_EQ(file.format, format);
    EXPECT_THAT((std::vector{file.width, file.height, file.depth, file.levels}), ElementsAre(5, 3, 0, 1)) << format;
    EXPECT_THAT((std::vector{file.color_model, file.primaries, file.transfer}), ElementsAre(1, 0, 1)) << format;
    ASSERT_EQ(file.samples.size(), 2U) << format;
    EXPECT_EQ(file.samples[1].offset, static_cast<std::uint32_t>(bits)) << format;
    EXPECT_EQ(file.samples[1].channel, is_float ? 0xC1U : 1U) << format;
    EXPECT_EQ(file.samples[1].upper, is_float ? 0x3F800000U : (1U << bits) - 1) << format;
    EXPECT_EQ(file.samples[1].lower, is_float ? 0xBF800000U : 0U) << format;
    EXPECT_EQ(file.texts.at("KTXorientation"), "rd") << format;
    EXPECT_THAT(file.texts.at("KTXwriter"), HasSubstr("lobe ")) << format;
    EXPECT_THAT(file.texts.at("Description"), HasSubstr("largest error of an entry as stored: ")) << format;
    EXPECT_EQ(file.values, stored.values) << format;
  }
}

// The width is the last axis; three columns have a fourth.
TEST_F(LookupTableElsewhere, IsReadAsATextureOfThreeDimensionsAndOfThreeColumns) {
  Lut solid{
      .request = {.reflectance = make_material("lambert")}, .columns = {"r", "g", "b"}, .values = {}, .errors = {}};
  solid.request.axes = {{.name = "z", .count = 2}, {.name = "y", .count = 3}, {.name = "theta", .count = 4}};
  for (int i = 0; i < 72; ++i) solid.values.push_back(i / 128.0);
  const LutFileOptions options{.format = LutFormat::ktx2, .is_float = true};
  std::ofstream(path("solid.ktx2"), std::ios::binary) << lut_file(as_stored(solid, options), std::nullopt, options);
  const reference::KtxFile file = reference::read_ktx(path("solid.ktx2"));
  EXPECT_THAT((std::vector{file.width, file.height, file.depth}), ElementsAre(4, 3, 2));
  EXPECT_EQ(file.format, 97U);
  EXPECT_EQ(file.samples.at(3).channel, 0xCFU);
  ASSERT_EQ(file.values.size(), 96U);
  for (std::size_t i = 0; i < 24; ++i) {
    for (std::size_t c = 0; c < 3; ++c) EXPECT_EQ(file.values[4 * i + c], solid.values[3 * i + c]) << i << ", " << c;
    EXPECT_EQ(file.values[4 * i + 3], 1) << i;
  }
  EXPECT_EQ(read_lut(path("solid.ktx2"), solid.request).values.size(), 24U);  // its definition has one column
}

TEST_F(LookupTableElsewhere, IsReadByTheToolsOfHdf5AndNetcdf) {
  ASSERT_TRUE(has_program("h5dump")) << "h5dump is missing; install hdf5-tools";
  ASSERT_TRUE(has_program("ncdump")) << "ncdump is missing; install netcdf-bin";
  const Lut stored = write("dfg.h5", {.format = LutFormat::hdf5});
  for (const std::size_t column : {0U, 1U}) {
    std::istringstream dump(output_of("h5dump -y -w 1 -m %.17g -d /" + stored.columns[column] + " dfg.h5"));
    std::vector<double> numbers;
    bool is_data = false;
    for (std::string line; std::getline(dump, line);) {
      if (line.find("DATA {") != std::string::npos) {
        is_data = true;
      } else if (line.find('}') != std::string::npos) {
        is_data = false;
      } else if (is_data) {
        numbers.push_back(std::stod(line));
      }
      if (numbers.size() == 15) break;
    }
    ASSERT_EQ(numbers.size(), 15U) << column;
    for (std::size_t i = 0; i < 15; ++i) EXPECT_EQ(numbers[i], stored.values[2 * i + column]) << column << ", " << i;
  }
  const std::string header = output_of("ncdump -h dfg.h5");
  for (const char* line : {"alpha = 3 ;", "double cos_theta(cos_theta) ;", "double scale(alpha, cos_theta) ;",
                           "double bias_error(alpha, cos_theta) ;", ":quantity = \"albedo\" ;",
                           "alpha:map = \"linear\" ;", ":error_of_interpolation = "}) {
    EXPECT_THAT(header, HasSubstr(line));
  }
}

TEST_F(LookupTableElsewhere, IsReadAsAnArrayOfNumpy) {
  const Lut stored = write("dfg.npy", {.format = LutFormat::npy});
  const reference::DoubleArray array = reference::read_double_array(path("dfg.npy"));
  EXPECT_THAT(array.shape, ElementsAre(3, 5, 2));
  EXPECT_EQ(array.values, stored.values);
}

}  // namespace
}  // namespace lobe::test
