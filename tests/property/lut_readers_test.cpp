// Files of lookup tables as other programs read them: compilers of C and GLSL, libpng, and readers of tests/reference.
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <png.h>

#include <csetjmp>
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

TEST_F(LookupTableElsewhere, IsReadAsAnArrayOfNumpy) {
  const Lut stored = write("dfg.npy", {.format = LutFormat::npy});
  const reference::DoubleArray array = reference::read_double_array(path("dfg.npy"));
  EXPECT_THAT(array.shape, ElementsAre(3, 5, 2));
  EXPECT_EQ(array.values, stored.values);
}

}  // namespace
}  // namespace lobe::test
