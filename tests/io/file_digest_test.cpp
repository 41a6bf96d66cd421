// Checksums behind HDF5 files: every changed byte of a table and of results is found, or harmless.
#include "hdf5/file_digest.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iostream>
#include <string>
#include <utility>
#include <vector>

#include "core/files.hpp"
#include "io/synthetic_study.hpp"
#include "lobe/core/error.hpp"
#include "lobe/hdf5/table_file.hpp"
#include "lobe/reflectance/tabulate.hpp"
#include "lobe/study/study_results.hpp"
#include "lobe/table/table.hpp"
#include "support/device.hpp"
#include "support/materials.hpp"
#include "support/temporary_directory.hpp"

namespace lobe::test {
namespace {

namespace fs = std::filesystem;
using ::testing::HasSubstr;

/// Every how many bits one is changed; 1: every bit.
std::size_t step() {
  const char* text = std::getenv("LOBE_FLIP_EVERY");
  return text == nullptr ? 89 : std::stoul(text);
}

class FileDigest : public ::testing::Test {
 protected:
  [[nodiscard]] fs::path path() const { return directory_.path() / "file.h5"; }

  /// Changes a byte in its place.
  void put(std::size_t place, char byte) const {
    std::fstream file(path(), std::ios::binary | std::ios::in | std::ios::out);
    file.seekp(static_cast<std::streamoff>(place)).put(byte);
  }

  /// \param is_harmless reads the file, which has a changed bit, and compares it with what it was
  template <typename IsHarmless>
  void expect_all_found(const IsHarmless& is_harmless) const {
    const std::string sound = read_text(path());
    ASSERT_EQ(check_digest(path()), DigestState::sound);
    std::size_t found = 0;
    std::size_t harmless = 0;
    for (std::size_t bit = 0; bit < 8 * sound.size(); bit += step()) {
      put(bit / 8, static_cast<char>(sound[bit / 8] ^ (1 << (bit % 8))));
      try {
        ASSERT_TRUE(is_harmless()) << "bit " << bit << " of " << 8 * sound.size();
        ++harmless;
      } catch (const IoError&) {
        ++found;
      }
      put(bit / 8, sound[bit / 8]);
    }
    std::cout << "  " << found + harmless << " bits changed, " << found << " found, " << harmless << " harmless\n";
    EXPECT_GT(found, 20 * harmless);
  }

  TemporaryDirectory directory_;
};

TEST_F(FileDigest, FindsEveryChangeOfATable) {
  for (const bool compress : {true, false}) {
    const BrdfTable table =
        tabulate(device(), parse_material("phong:n=20,scale=0.5+mirror:scale=0.2"), HemisphereGrid::gauss(12, 24));
    save(table, path(), {.compress = compress, .overwrite = true, .command_line = "lobe tabulate"});
    expect_all_found([&] {
      const BrdfTable read = load_table(path());
      return read.values == table.values && read.error == table.error && read.mirror == table.mirror &&
             read.expression == table.expression && read.grid == table.grid && read.source.size() == 1 &&
             read.source[0].terms[0].values == table.source[0].terms[0].values;
    });
  }
}

TEST_F(FileDigest, FindsEveryChangeOfResults) {
  const StudyResult result = synthetic_study();
  const StudyFiles files = write_study(result, directory_.path(), {.command_line = "lobe run"});
  fs::rename(files.table, path());
  const StudyResult sound = load_study_results(path());
  expect_all_found([&] {
    const StudyResult read = load_study_results(path());
    return read.study.name == sound.study.name && read.study.materials.size() == sound.study.materials.size() &&
           read.study.materials.front().name() == sound.study.materials.front().name() &&
           read.metrics.size() == sound.metrics.size() &&
           read.metrics.front().combined.distance == sound.metrics.front().combined.distance;
  });
}

TEST_F(FileDigest, IsCheckedBeforeTheKindOfAFile) {
  const BrdfTable table = tabulate(device(), parse_material("lambert"), HemisphereGrid::gauss(4, 8));
  save(table, path());
  std::string bytes = read_text(path());
  bytes[40] = static_cast<char>(bytes[40] ^ 1);  // of HDF5's superblock
  std::ofstream(path(), std::ios::binary) << bytes;

  const std::vector<std::pair<std::string, bool (*)(const std::filesystem::path&)>> readers{
      {"table", is_table_file}, {"results", is_study_results}};
  for (const auto& [kind, read] : readers) {
    SCOPED_TRACE(kind);
    try {
      (void)read(path());
      FAIL() << "not refused";
    } catch (const IoError& error) {
      EXPECT_THAT(error.what(), HasSubstr("bytes of it have changed since it was written"));
    }
  }
}

TEST_F(FileDigest, OfOtherProgramsThereIsNone) {
  std::ofstream(path()) << "short";
  EXPECT_EQ(check_digest(path()), DigestState::none);
  EXPECT_EQ(check_digest(directory_.path() / "absent.h5"), DigestState::none);
  EXPECT_EQ(check_digest(directory_.path()), DigestState::none);
  // Without its end a table is one of a program that knows of none.
  const BrdfTable table = tabulate(device(), parse_material("lambert"), HemisphereGrid::gauss(4, 8));
  save(table, path(), {.overwrite = true});
  const std::string bytes = read_text(path());
  std::ofstream(path(), std::ios::binary) << bytes.substr(0, bytes.size() - 8);
  EXPECT_EQ(check_digest(path()), DigestState::none);
  EXPECT_EQ(load_table(path()).values, table.values);
}

}  // namespace
}  // namespace lobe::test
