#include "lobe/hdf5/table_file.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <string>
#include <vector>

#include "command.hpp"
#include "core/files.hpp"
#include "golden.hpp"
#include "hdf5/hdf5.hpp"
#include "hdf5/hdf5_output.hpp"
#include "lobe/core/error.hpp"
#include "lobe/formats/measurement.hpp"
#include "support/environment.hpp"
#include "support/full_disk.hpp"
#include "support/temporary_directory.hpp"
#include "synthetic_table.hpp"

namespace lobe::test {
namespace {

namespace fs = std::filesystem;

std::vector<std::uint64_t> bits(std::span<const double> values) {
  std::vector<std::uint64_t> result;
  std::ranges::transform(values, std::back_inserter(result), [](double x) { return std::bit_cast<std::uint64_t>(x); });
  return result;
}

void expect_same_header(const BrdfTable& a, const BrdfTable& b) {
  EXPECT_EQ(a.grid, b.grid);
  EXPECT_EQ(a.form, b.form);
  EXPECT_EQ(a.channels, b.channels);
  EXPECT_EQ(bits(a.mirror), bits(b.mirror));
  EXPECT_EQ(bits(a.retro), bits(b.retro));
  EXPECT_EQ(bits(a.error), bits(b.error));
  EXPECT_EQ(a.expression, b.expression);
  EXPECT_EQ(bits({&a.resolution_error, 1}), bits({&b.resolution_error, 1}));
  EXPECT_EQ(a.is_unresolved, b.is_unresolved);
  ASSERT_EQ(a.source.size(), b.source.size());
  for (std::size_t i = 0; i < a.source.size(); ++i) EXPECT_EQ(to_json(a.source[i]), to_json(b.source[i])) << i;
  ASSERT_EQ(a.factors.size(), b.factors.size());
  for (std::size_t i = 0; i < a.factors.size(); ++i) {
    EXPECT_EQ(a.factors[i].expression, b.factors[i].expression) << i;
    EXPECT_EQ(bits(a.factors[i].in), bits(b.factors[i].in)) << i;
    EXPECT_EQ(bits(a.factors[i].out), bits(b.factors[i].out)) << i;
  }
}

void expect_same(const BrdfTable& a, const BrdfTable& b) {
  expect_same_header(a, b);
  EXPECT_EQ(bits(a.values), bits(b.values));
}

/// What is thrown of a kind, as text.
template <typename Kind>
std::string message_of(const std::function<void()>& action) {
  try {
    action();
  } catch (const Kind& error) {
    return error.what();
  }
  return "nothing was thrown";
}

class TableFile : public ::testing::Test {
 protected:
  [[nodiscard]] BrdfTable saved_and_loaded(const BrdfTable& table, const TableFileOptions& options = {}) const {
    save(table, path_, options);
    return load_table(path_);
  }

  [[nodiscard]] std::size_t file_count() const {
    return static_cast<std::size_t>(std::distance(fs::directory_iterator(directory_.path()), fs::directory_iterator()));
  }

  /// Opens the file by the C library to change it.
  void change(const std::function<void(hid_t file)>& action) const {
    const hdf5::File file(H5Fopen(path_.c_str(), H5F_ACC_RDWR, H5P_DEFAULT), "open the file");
    action(file.id());
  }

  void set_text(const char* attribute, std::string_view text) const {
    change([&](hid_t file) {
      const hdf5::Group root(H5Gopen2(file, "/", H5P_DEFAULT), "open the root group");
      H5Adelete(root.id(), attribute);
      hdf5::write_attribute(root.id(), attribute, text);
    });
  }

  void remove_object(const char* name) const {
    change([&](hid_t file) { hdf5::check(H5Ldelete(file, name, H5P_DEFAULT), "delete the object"); });
  }

  /// Flips a bit in the middle of the n-th chunk of brdf.
  void damage_chunk(hsize_t n) const {
    haddr_t address = 0;
    hsize_t size = 0;
    change([&](hid_t file) {
      const hdf5::Dataset dataset(H5Dopen2(file, "/brdf", H5P_DEFAULT), "open the dataset");
      const hdf5::Space space(H5Dget_space(dataset.id()), "get the space");
      unsigned filters = 0;
      hdf5::check(H5Dget_chunk_info(dataset.id(), space.id(), n, nullptr, &filters, &address, &size), "find the chunk");
    });
    std::string bytes = read_text(path_);
    bytes[static_cast<std::size_t>(address + size / 2)] ^= 1;
    write_text(path_, true, bytes);
  }

  [[nodiscard]] std::string complaint() const {
    return message_of<IoError>([&] { (void)load_table(path_); });
  }

  /// The sentence every complaint begins with.
  [[nodiscard]] std::string refusal(const std::string& why) const {
    return "cannot read " + path_.string() + ": " + why;
  }

  const TemporaryDirectory directory_;
  const fs::path path_ = directory_.path() / "table.h5";
  const HemisphereGrid gauss_ = HemisphereGrid::gauss(6, 8);
  const BrdfTable isotropic_ = synthetic_composition(gauss_, TableForm::isotropic);
};

TEST_F(TableFile, KeepsAnIsotropicTableBitForBit) {
  expect_same(saved_and_loaded(isotropic_), isotropic_);
}

TEST_F(TableFile, KeepsSeveralChannelsBitForBit) {
  const BrdfTable table = synthetic_composition(gauss_, TableForm::isotropic, 3);
  expect_same(saved_and_loaded(table), table);
}

TEST_F(TableFile, KeepsAGeneralTableOnAProductGridBitForBit) {
  const BrdfTable table = synthetic_composition(HemisphereGrid::cells(4, 6), TableForm::general, 2);
  expect_same(saved_and_loaded(table), table);
}

TEST_F(TableFile, KeepsAKlemsTableBitForBit) {
  const BrdfTable table = synthetic_composition(HemisphereGrid::klems(41), TableForm::general, 2);
  expect_same(saved_and_loaded(table), table);
}

TEST_F(TableFile, KeepsAShirleyChiuTableBitForBit) {
  const BrdfTable table = synthetic_composition(HemisphereGrid::shirley_chiu(8), TableForm::general);
  expect_same(saved_and_loaded(table), table);
}

TEST_F(TableFile, KeepsATableThatIsNoComposition) {
  const BrdfTable table = synthetic_table(gauss_, TableForm::isotropic);
  expect_same(saved_and_loaded(table), table);
}

TEST_F(TableFile, KeepsATableOfOneNumber) {
  const BrdfTable table = synthetic_table(HemisphereGrid::gauss(1, 2), TableForm::isotropic);
  expect_same(saved_and_loaded(table), table);
}

TEST_F(TableFile, KeepsRowsThatExceedAChunk) {
  const BrdfTable table = synthetic_table(HemisphereGrid::gauss(5, 60000), TableForm::isotropic);
  expect_same(saved_and_loaded(table), table);
}

TEST_F(TableFile, KeepsMoreChunksThanOneBatch) {
  const BrdfTable table = synthetic_table(HemisphereGrid::gauss(32, 4096), TableForm::isotropic);
  expect_same(saved_and_loaded(table, {.compress = false}), table);
}

TEST_F(TableFile, KeepsATableThatIsNotCompressed) {
  expect_same(saved_and_loaded(isotropic_, {.compress = false}), isotropic_);
}

TEST_F(TableFile, WritesTheGeneralFormOfAnIsotropicTable) {
  const BrdfTable table = synthetic_composition(gauss_, TableForm::isotropic, 2);
  expect_same(saved_and_loaded(table, {.dense = true}), to_general(table));
}

TEST_F(TableFile, LeavesAGeneralTableAsItIsWhenDense) {
  const BrdfTable table = synthetic_composition(HemisphereGrid::klems(41), TableForm::general);
  expect_same(saved_and_loaded(table, {.dense = true}), table);
}

TEST_F(TableFile, HasAHeaderWithoutValues) {
  save(isotropic_, path_);
  const BrdfTable header = load_table_header(path_);
  expect_same_header(header, isotropic_);
  EXPECT_TRUE(header.values.empty());
}

TEST_F(TableFile, GivesARowOfAnIsotropicTable) {
  const BrdfTable table = synthetic_table(gauss_, TableForm::isotropic, 2);
  save(table, path_);
  const std::size_t length = table.size() / table.rows();
  EXPECT_EQ(bits(load_table_row(path_, 1, 4)), bits(table.channel(1).subspan(4 * length, length)));
}

TEST_F(TableFile, GivesARowOfAGeneralTableOnAProductGrid) {
  const BrdfTable table = synthetic_table(gauss_, TableForm::general);
  save(table, path_);
  EXPECT_EQ(bits(load_table_row(path_, 0, 21)), bits(table.channel(0).subspan(21 * table.rows(), table.rows())));
}

TEST_F(TableFile, GivesARowOfAKlemsTable) {
  const BrdfTable table = synthetic_table(HemisphereGrid::klems(41), TableForm::general, 2);
  save(table, path_);
  EXPECT_EQ(bits(load_table_row(path_, 1, 40)), bits(table.channel(1).subspan(40 * 41, 41)));
}

TEST_F(TableFile, RefusesARowItDoesNotHave) {
  save(isotropic_, path_);
  EXPECT_EQ(message_of<ArgumentError>([&] { (void)load_table_row(path_, 0, 6); }),
            "the table has no row 6; its rows are 0 to 5");
}

TEST_F(TableFile, RefusesAChannelItDoesNotHave) {
  save(isotropic_, path_);
  EXPECT_EQ(message_of<ArgumentError>([&] { (void)load_table_row(path_, 1, 0); }),
            "the table has no channel 1; its channels are 0 to 0");
}

TEST_F(TableFile, RevealsADamagedRow) {
  save(isotropic_, path_);
  damage_chunk(2);
  // In the words of HDF5 1.10 and of 1.14.
  const auto is_refused = ::testing::AnyOf(refusal("dataset /brdf: data error detected by Fletcher32 checksum"),
                                           refusal("dataset /brdf: filter returned failure during read"));
  EXPECT_THAT(message_of<IoError>([&] { (void)load_table_row(path_, 0, 2); }), is_refused);
  EXPECT_THAT(complaint(), is_refused);
}

TEST_F(TableFile, ReadsNoOtherRowThanTheOneAskedFor) {
  save(isotropic_, path_);
  damage_chunk(2);
  EXPECT_EQ(load_table_row(path_, 0, 3).size(), 6U * 5U);
}

TEST_F(TableFile, ReadsNoValuesForTheHeader) {
  save(isotropic_, path_);
  damage_chunk(2);
  expect_same_header(load_table_header(path_), isotropic_);
}

TEST_F(TableFile, RefusesAFileThatIsNotThere) {
  EXPECT_EQ(complaint(), refusal("No such file or directory"));
}

TEST_F(TableFile, RefusesADirectory) {
  EXPECT_EQ(message_of<IoError>([&] { (void)load_table(directory_.path()); }),
            "cannot read " + directory_.path().string() + ": is a directory");
}

TEST_F(TableFile, RefusesAFileThatIsNoHdf5) {
  write_text(path_, false, "theta_in,theta_out\n");
  EXPECT_EQ(complaint(), "cannot read " + path_.string() + " as an HDF5 file: file signature not found");
}

TEST_F(TableFile, RefusesATruncatedFile) {
  save(isotropic_, path_);
  fs::resize_file(path_, fs::file_size(path_) / 2);
  const std::string text = complaint();
  EXPECT_EQ(text.find("cannot read " + path_.string() + " as an HDF5 file: truncated file"), 0U) << text;
}

TEST_F(TableFile, RefusesAnotherHdf5File) {
  write_text(path_, false, hdf5::file_image([](hid_t) {}));
  EXPECT_EQ(complaint(), refusal("it is no table: attribute grid of /, such as 'gauss:64x128', and dataset /brdf are "
                                 "missing (all that a table needs, see docs/file-formats.md)"));
}

// --- Files of other programs, as h5py, Matlab and R write them.

/// A text of a fixed length, padded as asked for; `count` texts make an array.
void put_text(hid_t file, const char* name, const std::vector<std::string>& texts, H5T_str_t padding) {
  const std::size_t length = std::ranges::max(texts, {}, &std::string::size).size() + 1;
  std::string bytes;
  for (const auto& text : texts)
    bytes += text + std::string(length - text.size(), padding == H5T_STR_SPACEPAD ? ' ' : '\0');
  const hid_t type = H5Tcopy(H5T_C_S1);
  H5Tset_size(type, length);
  H5Tset_strpad(type, padding);
  const hsize_t count = texts.size();
  const hid_t space = count == 1 ? H5Screate(H5S_SCALAR) : H5Screate_simple(1, &count, nullptr);
  const hid_t attribute = H5Acreate2(file, name, type, space, H5P_DEFAULT, H5P_DEFAULT);
  hdf5::check(H5Awrite(attribute, type, bytes.data()), "write an attribute");
  H5Aclose(attribute);
  H5Sclose(space);
  H5Tclose(type);
}

template <typename Number>
void put_numbers(hid_t file, const char* name, hid_t type, const std::vector<hsize_t>& shape,
                 const std::vector<Number>& numbers) {
  const hid_t space = H5Screate_simple(static_cast<int>(shape.size()), shape.data(), nullptr);
  const hid_t dataset = H5Dcreate2(file, name, type, space, H5P_DEFAULT, H5P_DEFAULT, H5P_DEFAULT);
  hdf5::check(H5Dwrite(dataset, type, H5S_ALL, H5S_ALL, H5P_DEFAULT, numbers.data()), "write numbers");
  H5Dclose(dataset);
  H5Sclose(space);
}

class PlainTable : public TableFile {
 protected:
  /// A file with what `fill` puts into it.
  void make(const std::function<void(hid_t)>& fill) const {
    fs::remove(path_);
    write_text(path_, false, hdf5::file_image(fill));
  }
  [[nodiscard]] std::string refused(const std::function<void(hid_t)>& fill) const {
    make(fill);
    return complaint();
  }
};

TEST_F(PlainTable, NeedsNoMoreThanAGridAndValues) {
  // gauss:3x4 has three azimuths from 0 to half a turn.
  make([](hid_t file) {
    put_text(file, "grid", {"gauss:3x4"}, H5T_STR_NULLTERM);
    std::vector<float> values;
    for (int i = 0; i < 27; ++i) values.push_back(0.25F * static_cast<float>(i));
    put_numbers(file, "brdf", H5T_NATIVE_FLOAT, {3, 3, 3}, values);
  });
  EXPECT_TRUE(is_table_file(path_));
  const BrdfTable table = load_table(path_);
  EXPECT_EQ(table.grid, HemisphereGrid::gauss(3, 4));
  EXPECT_EQ(table.form, TableForm::isotropic);
  EXPECT_EQ(table.channels, 1U);
  EXPECT_EQ(table.expression, path_.stem().string());
  ASSERT_EQ(table.values.size(), 27U);
  EXPECT_EQ(table.values[26], 6.5);
  // theta_in is the slowest, delta_phi the quickest.
  EXPECT_EQ(table.values[(1 * 3 + 2) * 3 + 1], 0.25 * 16);
  ASSERT_EQ(table.error.size(), 9U);
  EXPECT_TRUE(std::ranges::all_of(table.error, [](double error) { return std::isnan(error); }));
  EXPECT_TRUE(std::isnan(table.resolution_error));
  EXPECT_FALSE(table.is_unresolved);
  EXPECT_TRUE(table.source.empty());
  EXPECT_EQ(load_table_row(path_, 0, 1), (std::vector<double>{2.25, 2.5, 2.75, 3, 3.25, 3.5, 3.75, 4, 4.25}));
}

TEST_F(PlainTable, StatesStandardDeviationsOfItsValues) {
  const auto with_deviations = [&](double deviation) {
    make([&](hid_t file) {
      put_text(file, "grid", {"gauss:3x4"}, H5T_STR_NULLTERM);
      put_numbers(file, "brdf", H5T_NATIVE_DOUBLE, {3, 3, 3}, std::vector<double>(27, 0.2));
      put_numbers(file, "brdf_std", H5T_NATIVE_DOUBLE, {3, 3, 3}, std::vector<double>(27, deviation));
    });
  };
  with_deviations(0.01);
  EXPECT_TRUE(states_deviations(path_));
  EXPECT_EQ(load_table_deviations(path_), TableValues(27, 0.01));
  EXPECT_EQ(load_table(path_).values[5], 0.2);

  const BrdfFunction brdf = load_replicated_table(path_, {.replicates = 2000});
  ASSERT_EQ(brdf.replicates, 2000U);
  EXPECT_EQ(own_channels(brdf), 1U);
  const double theta = HemisphereGrid::gauss(3, 4).rings()[1].theta;
  const auto values = brdf.at(std::vector<Directions>{{theta, theta, 0}}).value;
  EXPECT_NEAR(values(0, 0), 0.2, 1e-12);
  const std::vector<double> numbers(values.row(0).begin(), values.row(0).end());
  EXPECT_NEAR(measurement_deviations(brdf, numbers)[0], 0.01, 4 * 0.01 / std::sqrt(4000.0));

  with_deviations(-1);
  EXPECT_THAT([&] { (void)load_table_deviations(path_); },
              ::testing::ThrowsMessage<IoError>(
                  ::testing::HasSubstr("dataset /brdf_std has a standard deviation of -1; expected 0 or more")));
}

TEST_F(PlainTable, StatesNoneAsARule) {
  make([](hid_t file) {
    put_text(file, "grid", {"gauss:3x4"}, H5T_STR_NULLTERM);
    put_numbers(file, "brdf", H5T_NATIVE_DOUBLE, {3, 3, 3}, std::vector<double>(27, 0.2));
  });
  EXPECT_FALSE(states_deviations(path_));
  EXPECT_TRUE(load_table_deviations(path_).empty());
  EXPECT_EQ(load_replicated_table(path_, {.replicates = 50}).replicates, 0U);
}

TEST_F(PlainTable, TakesIntegersNamesAndErrors) {
  make([](hid_t file) {
    put_text(file, "grid", {"uniform:2x4"}, H5T_STR_SPACEPAD);
    put_text(file, "name", {"ground"}, H5T_STR_SPACEPAD);
    put_text(file, "channel_names", {"red", "blue"}, H5T_STR_NULLPAD);
    std::vector<std::int32_t> values;
    for (int i = 0; i < 2 * 2 * 4 * 2 * 4; ++i) values.push_back(i);
    put_numbers(file, "brdf", H5T_NATIVE_INT32, {2, 2, 4, 2, 4}, values);
    put_numbers(file, "brdf_error", H5T_NATIVE_DOUBLE, {2, 2, 2}, std::vector<double>(8, 0.5));
    const HemisphereGrid grid = HemisphereGrid::uniform(2, 4);
    const auto rings = grid.rings();
    put_numbers(file, "theta_in", H5T_NATIVE_FLOAT, {2},
                std::vector<float>{static_cast<float>(rings[0].theta), static_cast<float>(rings[1].theta)});
  });
  const BrdfTable table = load_table(path_);
  EXPECT_EQ(table.form, TableForm::general);
  EXPECT_EQ(table.channels, 2U);
  EXPECT_EQ(table.channel_names, (std::vector<std::string>{"red", "blue"}));
  EXPECT_EQ(table.expression, "ground");
  EXPECT_EQ(table.channel(1)[0], 64);
  EXPECT_EQ(table.error, std::vector<double>(8, 0.5));
}

TEST_F(PlainTable, SaysAtOnceWhatShapesAGridHas) {
  const auto with_shape = [](const std::vector<hsize_t>& shape) {
    return [shape](hid_t file) {
      put_text(file, "grid", {"gauss:6x8"}, H5T_STR_NULLTERM);
      std::size_t size = 1;
      for (const hsize_t length : shape) size *= length;
      put_numbers(file, "brdf", H5T_NATIVE_DOUBLE, shape, std::vector<double>(size, 1));
    };
  };
  EXPECT_EQ(
      refused(with_shape({6, 6, 8})),
      refusal("dataset /brdf has the shape 6 x 6 x 8; expected 6 x 6 x 5 (theta_in x theta_out x delta_phi) or "
              "6 x 8 x 6 x 8 (theta_in x phi_in x theta_out x phi_out), on grid gauss:6x8, with channels in front"));
  // The other order, which Matlab and R have.
  EXPECT_EQ(refused(with_shape({5, 6, 6})).find(refusal("dataset /brdf has the shape 5 x 6 x 6; expected")), 0U);
}

TEST_F(PlainTable, OfOtherAnglesIsRefused) {
  EXPECT_EQ(refused([](hid_t file) {
              put_text(file, "grid", {"gauss:2x4"}, H5T_STR_NULLTERM);
              put_numbers(file, "brdf", H5T_NATIVE_DOUBLE, {2, 2, 3}, std::vector<double>(12, 1));
              put_numbers(file, "theta_in", H5T_NATIVE_FLOAT, {2}, std::vector<float>{0.5F, 1});
            }),
            refusal("dataset /theta_in does not hold the numbers of grid gauss:2x4"));
}

TEST_F(TableFile, RefusesAnotherSchema) {
  save(isotropic_, path_);
  set_text("lobe_schema", "lobe-study/1");
  EXPECT_EQ(complaint(), refusal("it is the result of a study; expected a table"));
  set_text("lobe_schema", "lobe-table/2");
  EXPECT_EQ(complaint(),
            refusal("it was written by a newer lobe, as lobe-table/2; read it with that one (this one reads "
                    "lobe-table/1)"));
  set_text("lobe_schema", "others/1");
  EXPECT_EQ(complaint(), refusal("its schema is 'others/1'; expected lobe-table/1"));
}

TEST_F(TableFile, RefusesAnUnknownGrid) {
  save(isotropic_, path_);
  set_text("grid", "gaus:6x8");
  EXPECT_EQ(complaint(), refusal("attribute grid of /: unknown grid 'gaus'; did you mean 'gauss'?"));
}

TEST_F(TableFile, RefusesAnUnknownForm) {
  save(isotropic_, path_);
  set_text("form", "4D");
  EXPECT_EQ(complaint(), refusal("attribute form of / is '4D'; expected isotropic or general"));
}

TEST_F(TableFile, RefusesAMissingGrid) {
  save(isotropic_, path_);
  change([](hid_t file) { hdf5::check(H5Adelete_by_name(file, "/", "grid", H5P_DEFAULT), "delete"); });
  EXPECT_EQ(complaint(), refusal("it is no table: attribute grid of /, such as 'gauss:64x128', is missing (all that a "
                                 "table needs, see docs/file-formats.md)"));
}

TEST_F(TableFile, RefusesAnAttributeOfAnotherType) {
  save(isotropic_, path_);
  set_text("resolution_error", "small");
  EXPECT_EQ(complaint(), refusal("attribute resolution_error of / is no number"));
}

TEST_F(TableFile, RefusesAnUnknownModel) {
  save(isotropic_, path_);
  set_text("material_json",
           R"({"name": "x", "family": "", "terms": [{"model": "wart", "parameters": {}, "weight": [1]}]})");
  const std::string text = complaint();
  EXPECT_EQ(text.find(refusal("attribute material_json of /: unknown model 'wart'")), 0U) << text;
}

TEST_F(TableFile, RefusesAMissingDataset) {
  save(isotropic_, path_);
  remove_object("/brdf");
  EXPECT_EQ(complaint(),
            refusal("it is no table: dataset /brdf is missing (all that a table needs, see docs/file-formats.md)"));
}

TEST_F(TableFile, RefusesAFactorThatIsMissing) {
  save(isotropic_, path_);
  remove_object("/factors/second/out");
  EXPECT_EQ(complaint(), refusal("dataset /factors/second/out is missing"));
}

TEST_F(TableFile, RefusesValuesOfAnotherShape) {
  save(isotropic_, path_);
  set_text("form", "general");
  EXPECT_EQ(complaint(), refusal("the shape of dataset /brdf is not that of general tables on grid gauss:6x8"));
}

TEST_F(TableFile, RefusesAPartOfAnotherShape) {
  save(isotropic_, path_);
  change([](hid_t file) {
    hdf5::check(H5Ldelete(file, "/mirror", H5P_DEFAULT), "delete");
    hdf5::check(H5Lmove(file, "/multiplicity", file, "/mirror", H5P_DEFAULT, H5P_DEFAULT), "move");
    hdf5::check(H5Lmove(file, "/factors/first/in", file, "/multiplicity", H5P_DEFAULT, H5P_DEFAULT), "move");
  });
  EXPECT_EQ(complaint(), refusal("dataset /multiplicity has the shape 6; expected 5"));
}

TEST_F(TableFile, RefusesAnAxisThatIsNotTheGrids) {
  save(isotropic_, path_);
  set_text("grid", "uniform:6x8");
  EXPECT_EQ(complaint(), refusal("dataset /theta_in does not hold the numbers of grid uniform:6x8"));
}

TEST_F(TableFile, ToleratesAxesRoundedByOtherPrograms) {
  save(isotropic_, path_);
  change([](hid_t file) {
    const hdf5::Dataset theta(H5Dopen2(file, "/theta_in", H5P_DEFAULT), "open the axis");
    std::vector<double> values(6);
    H5Dread(theta.id(), H5T_NATIVE_DOUBLE, H5S_ALL, H5S_ALL, H5P_DEFAULT, values.data());
    values[3] += 1e-14;
    H5Dwrite(theta.id(), H5T_NATIVE_DOUBLE, H5S_ALL, H5S_ALL, H5P_DEFAULT, values.data());
  });
  expect_same(load_table(path_), isotropic_);
}

TEST_F(TableFile, RefusesATableThatIsInconsistent) {
  BrdfTable table = isotropic_;
  table.error.pop_back();
  EXPECT_THROW(save(table, path_), ArgumentError);
  EXPECT_EQ(file_count(), 0U);
}

TEST_F(TableFile, RefusesAGridWithoutAName) {
  EXPECT_THROW(save(synthetic_table(HemisphereGrid::klems(41).refined(), TableForm::general), path_), ArgumentError);
  EXPECT_EQ(file_count(), 0U);
}

TEST_F(TableFile, IsKnownAsATable) {
  save(isotropic_, path_);
  EXPECT_TRUE(is_table_file(path_));
}

TEST_F(TableFile, IsNoTableWhenItIsSomethingElse) {
  EXPECT_FALSE(is_table_file(path_));
  EXPECT_FALSE(is_table_file(directory_.path()));
  write_text(path_, false, "");
  EXPECT_FALSE(is_table_file(path_));
  write_text(path_, true, hdf5::file_image([](hid_t root) { hdf5::write_attribute(root, "lobe_schema", 1.0); }));
  EXPECT_FALSE(is_table_file(path_));
}

TEST_F(TableFile, StaysUnlessToldToBeReplaced) {
  write_text(path_, false, "mine");
  EXPECT_THROW(save(isotropic_, path_), IoError);
  EXPECT_EQ(read_text(path_), "mine");
  save(isotropic_, path_, {.overwrite = true});
  expect_same(load_table(path_), isotropic_);
}

TEST_F(TableFile, HasTheSameBytesAgain) {
  const ScopedVariable epoch("SOURCE_DATE_EPOCH", "1000000000");
  save(isotropic_, path_);
  const fs::path again = directory_.path() / "again.h5";
  save(isotropic_, again);
  EXPECT_EQ(read_text(path_), read_text(again));
}

TEST_F(TableFile, FailsWhereItMayNotBe) {
  const fs::path nowhere = directory_.path() / "absent" / "table.h5";
  EXPECT_EQ(message_of<IoError>([&] { save(isotropic_, nowhere); }),
            "cannot write " + nowhere.string() + ": No such file or directory");
}

/// Sizes at which the disk is full: while the attributes, the first axes or the values are written, or at the end.
class TableFileOnAFullDisk : public TableFile, public ::testing::WithParamInterface<rlim_t> {};

TEST_P(TableFileOnAFullDisk, LeavesNothing) {
  const BrdfTable table = synthetic_composition(HemisphereGrid::gauss(24, 32), TableForm::isotropic);
  const FullDisk disk(GetParam());
  EXPECT_EQ(message_of<IoError>([&] { save(table, path_); }), "cannot write " + path_.string() + ": File too large");
  EXPECT_EQ(file_count(), 0U);
}

INSTANTIATE_TEST_SUITE_P(Bytes, TableFileOnAFullDisk, ::testing::Values(0, 10, 4000, 12000, 30000, 60000));

TEST_F(TableFile, KeepsTheOlderFileOnAFullDisk) {
  save(isotropic_, path_);
  {
    const FullDisk disk(12000);
    EXPECT_THROW(save(isotropic_, path_, {.overwrite = true}), IoError);
  }
  expect_same(load_table(path_), isotropic_);
}

class TableFileHeader : public TableFile {
 protected:
  [[nodiscard]] std::string dump(const std::string& command) const {
    const auto run = run_command("cd " + directory_.path().string() + " && " + command + " table.h5");
    EXPECT_EQ(run.status, 0) << command;
    return run.output;
  }

  const ScopedVariable epoch_{"SOURCE_DATE_EPOCH", "1000000000"};
  const TableFileOptions options_{.command_line = "lobe compose phong:n=20 ward:m=0.2"};
};

TEST_F(TableFileHeader, IsTheGoldenOne) {
  ASSERT_TRUE(has_program("h5dump")) << "h5dump is missing; install hdf5-tools";
  save(isotropic_, path_, options_);
  expect_golden("table_header.txt", compact(without_versions(dump("h5dump -H -p"))));
}

TEST_F(TableFileHeader, IsThatOfANetcdfFile) {
  ASSERT_TRUE(has_program("ncdump")) << "ncdump is missing; install netcdf-bin";
  save(isotropic_, path_, options_);
  expect_golden("table_netcdf_header.txt", without_versions(dump("ncdump -h")));
}

TEST_F(TableFileHeader, NamesAllAxesOfAGeneralTable) {
  ASSERT_TRUE(has_program("ncdump")) << "ncdump is missing; install netcdf-bin";
  save(synthetic_composition(gauss_, TableForm::isotropic, 3), path_, {.dense = true});
  EXPECT_NE(dump("ncdump -h").find("double brdf(channel, theta_in, phi_in, theta_out, phi_out) ;"), std::string::npos);
}

TEST_F(TableFileHeader, NamesTheDirectionsOfPatches) {
  ASSERT_TRUE(has_program("ncdump")) << "ncdump is missing; install netcdf-bin";
  save(synthetic_composition(HemisphereGrid::klems(41), TableForm::general), path_, options_);
  expect_golden("table_klems_netcdf_header.txt", without_versions(dump("ncdump -h")));
}

}  // namespace
}  // namespace lobe::test
