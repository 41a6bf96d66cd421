// Files of azimuthal modes: what netCDF tools and NumPy see of them.
#include "lobe/formats/modes_file.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <fstream>
#include <string>
#include <vector>

#include "formats/npy.hpp"
#include "hdf5/hdf5_input.hpp"
#include "io/command.hpp"
#include "io/synthetic_modes.hpp"
#include "lobe/core/error.hpp"
#include "lobe/hdf5/file_summary.hpp"
#include "support/temporary_directory.hpp"

namespace lobe::test {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::Pair;

/// Two channels, three modes, two viewers, one light; no two numbers the same.
TEST(ModesFile, IsAnArrayOfNumPy) {
  AzimuthalModes modes = synthetic_modes();
  const NpyArray both = read_npy(FileBytes::copy("a.npy", modes_file(modes, ModesFormat::npy)));
  EXPECT_THAT(both.shape, ElementsAre(2U, 3U, 2U, 1U));
  EXPECT_EQ(both.values, modes.values);
  modes.channels.pop_back();
  modes.values.resize(6);
  EXPECT_THAT(read_npy(FileBytes::copy("a.npy", modes_file(modes, ModesFormat::npy))).shape, ElementsAre(3U, 2U, 1U));
}

TEST(ModesFile, IsReadByToolsOfNetCdf) {
  const TemporaryDirectory directory;
  const std::string content = modes_file(synthetic_modes(), ModesFormat::hdf5, "lobe modes paint.toml");
  EXPECT_EQ(content, modes_file(synthetic_modes(), ModesFormat::hdf5, "lobe modes paint.toml"));
  std::ofstream(directory.path() / "modes.nc", std::ios::binary) << content;

  const hdf5::InputFile file(directory.path() / "modes.nc");
  const std::vector<hsize_t> shape{2, 3, 2, 1};
  EXPECT_EQ(file.read("/modes", shape), synthetic_modes().values);
  EXPECT_EQ(file.read("/modes_error", shape), synthetic_modes().errors);
  ASSERT_TRUE(has_program("ncdump")) << "ncdump is missing; install netcdf-bin";
  const auto dump = run_command("cd " + directory.path().string() + " && ncdump modes.nc");
  EXPECT_EQ(dump.status, 0) << dump.output;
  for (const char* line :
       {"double modes(channel, mode, cosine_out, cosine_in) ;", "modes:units = \"sr-1\" ;", ":material = \"paint\" ;",
        ":history = \"lobe modes paint.toml\" ;", " mode = 0, 1, 2 ;", "cosine_out = 0.25, 0.75 ;"}) {
    EXPECT_THAT(dump.output, HasSubstr(line));
  }
}

TEST(ModesFile, HasAFormatByItsEnding) {
  EXPECT_EQ(modes_format_of("a.h5"), ModesFormat::hdf5);
  EXPECT_EQ(modes_format_of("a.nc"), ModesFormat::hdf5);
  EXPECT_EQ(modes_format_of("a.npy"), ModesFormat::npy);
  EXPECT_THROW((void)modes_format_of("a.csv"), ArgumentError);
}

TEST(ModesFile, SaysWhatItIs) {
  const TemporaryDirectory directory;
  const auto path = directory.path() / "modes.h5";
  std::ofstream(path, std::ios::binary) << modes_file(synthetic_modes(), ModesFormat::hdf5, "lobe modes paint.toml");

  ASSERT_TRUE(is_summarised_file(path));
  const FileSummary summary = load_file_summary(path);

  EXPECT_EQ(summary.schema, "lobe-modes/1");
  EXPECT_THAT(summary.attributes, ::testing::IsSupersetOf({Pair("material", "paint"), Pair("tolerance", "1e-08"),
                                                           Pair("history", "lobe modes paint.toml")}));
  EXPECT_THAT(summary.channels, ElementsAre("red", "blue"));
  const auto modes = std::ranges::find(summary.datasets, "modes", &DatasetSummary::name);
  ASSERT_NE(modes, summary.datasets.end());
  EXPECT_THAT(modes->shape, ElementsAre(2U, 3U, 2U, 1U));
  EXPECT_EQ(modes->least, 0.1);
  EXPECT_EQ(modes->largest, 11.1);
  EXPECT_EQ(modes->unit, "sr-1");
  EXPECT_THAT(modes->description, HasSubstr("Fourier coefficient"));

  std::ofstream(directory.path() / "other.h5") << "no HDF5";
  EXPECT_FALSE(is_summarised_file(directory.path() / "other.h5"));
  EXPECT_THROW((void)load_file_summary(directory.path() / "other.h5"), IoError);
}

}  // namespace
}  // namespace lobe::test
