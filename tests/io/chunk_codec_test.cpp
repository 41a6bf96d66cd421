#include "hdf5/chunk_codec.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <string>
#include <vector>

#include "core/files.hpp"
#include "hdf5/hdf5.hpp"
#include "hdf5/hdf5_input.hpp"
#include "hdf5/hdf5_output.hpp"
#include "support/temporary_directory.hpp"

namespace lobe::test {
namespace {

/// Numbers with runs, as tables have, and without.
std::vector<double> numbers(std::size_t count) {
  std::vector<double> values;
  for (std::size_t i = 0; i < count; ++i) values.push_back(i % 3 == 0 ? 0.25 : std::sin(static_cast<double>(i)));
  return values;
}

/// What HDF5 makes of one encoded chunk.
std::vector<double> decoded(std::span<const double> values, bool compress) {
  const TemporaryDirectory directory;
  const auto path = directory.path() / "chunk.h5";
  const hsize_t shape = values.size();
  {
    hdf5::OutputFile file(path, "chunk.h5");
    {
      const auto axis = hdf5::create_index_axis(file.root(), "axis", values.size());
      const hdf5::Dataset* const along[] = {&axis};
      const auto dataset = hdf5::define_dataset(file.root(), "numbers", along, {&shape, 1}, compress);
      const hsize_t origin = 0;
      file.write_chunk(dataset, {&origin, 1}, hdf5::encode_chunk(values, compress));
    }
    file.close();
  }
  return hdf5::InputFile(path).read("/numbers", {&shape, 1});
}

class EncodedChunk : public ::testing::TestWithParam<std::size_t> {};

TEST_P(EncodedChunk, IsDecodedByHdf5WhenCompressed) {
  EXPECT_EQ(decoded(numbers(GetParam()), true), numbers(GetParam()));
}

TEST_P(EncodedChunk, IsDecodedByHdf5WhenNotCompressed) {
  EXPECT_EQ(decoded(numbers(GetParam()), false), numbers(GetParam()));
}

// Lengths about a block of the checksum (90 numbers), and odd numbers of compressed bytes among them.
INSTANTIATE_TEST_SUITE_P(Lengths, EncodedChunk, ::testing::Values(1, 2, 3, 5, 89, 90, 91, 1000, 131072));

TEST(EncodedChunk, KeepsInfinitiesAndSignedZeros) {
  const std::vector<double> values = {std::numeric_limits<double>::infinity(), -0.0, 5e-324};
  const auto seen = decoded(values, true);
  EXPECT_EQ(seen, values);
  EXPECT_TRUE(std::signbit(seen[1]));
}

}  // namespace
}  // namespace lobe::test
