// HDF5 files that lead elsewhere, or claim more than they hold.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <array>
#include <filesystem>
#include <fstream>
#include <limits>
#include <string>
#include <vector>

#include "core/files.hpp"
#include "hdf5/hdf5.hpp"
#include "hdf5/hdf5_input.hpp"
#include "lobe/core/error.hpp"
#include "lobe/hdf5/table_file.hpp"
#include "lobe/study/study_results.hpp"
#include "study/write/study_hdf5.hpp"
#include "support/temporary_directory.hpp"
#include "synthetic_study.hpp"
#include "synthetic_table.hpp"

namespace lobe::test {
namespace {

namespace fs = std::filesystem;
using ::testing::HasSubstr;

class Hdf5Values : public ::testing::Test {
 protected:
  Hdf5Values() {
    save(synthetic_table(HemisphereGrid::gauss(4, 8), TableForm::isotropic), table());
    save(synthetic_table(HemisphereGrid::gauss(4, 8), TableForm::isotropic), other());
    write_text(study(), false, study_table(synthetic_study(), "lobe run synthetic.toml", "2001-02-03T04:05:06Z"));
  }
  [[nodiscard]] fs::path table() const { return directory_.path() / "table.h5"; }
  [[nodiscard]] fs::path other() const { return directory_.path() / "other.h5"; }
  [[nodiscard]] fs::path study() const { return directory_.path() / "study.h5"; }
  [[nodiscard]] fs::path raw() const { return directory_.path() / "raw"; }

  template <typename Change>
  static void change(const fs::path& path, const Change& change) {
    const hdf5::File file(H5Fopen(path.c_str(), H5F_ACC_RDWR, H5P_DEFAULT), "open the file");
    change(file.id());
  }

  /// Another dataset in the place of one, of the same shape where none is
  /// given, and without values.
  void replace(const fs::path& path, const std::string& name, hid_t creation, std::vector<hsize_t> shape = {},
               hid_t type = -1) const {
    change(path, [&](hid_t file) {
      const hdf5::Dataset old(H5Dopen2(file, name.c_str(), H5P_DEFAULT), "open " + name);
      const hdf5::Space old_space(H5Dget_space(old.id()), "space");
      if (shape.empty()) {
        shape.resize(static_cast<std::size_t>(H5Sget_simple_extent_ndims(old_space.id())));
        H5Sget_simple_extent_dims(old_space.id(), shape.data(), nullptr);
      }
      const hdf5::Type kind(type >= 0 ? H5Tcopy(type) : H5Dget_type(old.id()), "type");
      hdf5::check(H5Ldelete(file, name.c_str(), H5P_DEFAULT), "delete " + name);
      const hdf5::Space space(H5Screate_simple(static_cast<int>(shape.size()), shape.data(), nullptr), "space");
      const hdf5::Dataset made(
          H5Dcreate2(file, name.c_str(), kind.id(), space.id(), H5P_DEFAULT, creation, H5P_DEFAULT), "create " + name);
    });
  }

  template <typename Read>
  static std::string refusal(const Read& read) {
    try {
      read();
    } catch (const IoError& error) {
      return error.what();
    }
    return "none";
  }
  [[nodiscard]] std::string table_refusal() const {
    return refusal([&] { (void)load_table(table()); });
  }
  [[nodiscard]] std::string study_refusal() const {
    return refusal([&] { (void)load_study_results(study()); });
  }

 private:
  TemporaryDirectory directory_;
};

TEST_F(Hdf5Values, BehindExternalLinksAreRefused) {
  change(table(), [&](hid_t file) {
    H5Ldelete(file, "/brdf", H5P_DEFAULT);
    hdf5::check(H5Lcreate_external(other().c_str(), "/brdf", file, "/brdf", H5P_DEFAULT, H5P_DEFAULT), "link");
  });
  EXPECT_THAT(table_refusal(), HasSubstr("/brdf is a link to another file; expected all in one file"));
}

TEST_F(Hdf5Values, BehindSoftLinksToExternalOnesAreRefused) {
  change(table(), [&](hid_t file) {
    H5Ldelete(file, "/brdf", H5P_DEFAULT);
    hdf5::check(H5Lcreate_external(other().c_str(), "/", file, "/there", H5P_DEFAULT, H5P_DEFAULT), "link");
    hdf5::check(H5Lcreate_soft("/there/brdf", file, "/brdf", H5P_DEFAULT, H5P_DEFAULT), "link");
  });
  EXPECT_THAT(table_refusal(), HasSubstr("table.h5: dataset /brdf"));
}

TEST_F(Hdf5Values, OfGroupsBehindExternalLinksAreRefused) {
  change(study(), [&](hid_t file) {
    hdf5::check(H5Lcreate_external(other().c_str(), "/", file, "/there", H5P_DEFAULT, H5P_DEFAULT), "link");
  });
  EXPECT_THAT(study_refusal(), HasSubstr("'there' in group / is a link to another file"));
}

TEST_F(Hdf5Values, InOtherFilesAreRefused) {
  constexpr std::size_t kBytes = 1 << 20;
  std::ofstream(raw(), std::ios::binary) << std::string(kBytes, '\0');
  const hdf5::Properties creation(H5Pcreate(H5P_DATASET_CREATE), "properties");
  hdf5::check(H5Pset_external(creation.id(), raw().c_str(), 0, kBytes), "external");
  replace(table(), "/brdf", creation.id());
  EXPECT_THAT(table_refusal(), HasSubstr("dataset /brdf has its values in other files; expected "
                                         "them in this one"));
}

TEST_F(Hdf5Values, OfVirtualDatasetsAreRefused) {
  std::array<hsize_t, 8> shape{};
  int rank = 0;
  change(table(), [&](hid_t file) {
    const hdf5::Dataset brdf(H5Dopen2(file, "/brdf", H5P_DEFAULT), "open");
    const hdf5::Space space(H5Dget_space(brdf.id()), "space");
    rank = H5Sget_simple_extent_dims(space.id(), shape.data(), nullptr);
  });
  const hdf5::Space space(H5Screate_simple(rank, shape.data(), nullptr), "space");
  const hdf5::Properties creation(H5Pcreate(H5P_DATASET_CREATE), "properties");
  hdf5::check(H5Pset_virtual(creation.id(), space.id(), other().c_str(), "/brdf", space.id()), "virtual");
  replace(table(), "/brdf", creation.id());
  EXPECT_THAT(table_refusal(), HasSubstr("dataset /brdf has its values in other files"));
}

TEST_F(Hdf5Values, ThatAreClaimedOnlyAreRefused) {
  replace(table(), "/brdf", H5P_DEFAULT);
  EXPECT_EQ(table_refusal(), "none") << "a few kilobytes do no harm; they are zeros";

  change(table(), [](hid_t file) {
    H5Adelete(file, "grid");
    hdf5::write_attribute(file, "grid", std::string_view("gauss:256x512"));
    for (const char* axis : {"/theta_in", "/theta_out", "/delta_phi", "/weight_in", "/weight_out", "/multiplicity"}) {
      if (H5Lexists(file, axis, H5P_DEFAULT) > 0) H5Ldelete(file, axis, H5P_DEFAULT);
    }
  });
  replace(table(), "/brdf", H5P_DEFAULT, {256, 256, 257});
  EXPECT_THAT(table_refusal(), HasSubstr("dataset /brdf claims to have 256 x 256 x 257 values, "
                                         "which are not in the "
                                         "file"));
}

/// A file with a chunk of a mebibyte of zeros, compressed, in a dataset that claims so many.
void write_zeros(const fs::path& path, hsize_t claimed) {
  constexpr hsize_t kChunk = hsize_t{1} << 20;
  const hdf5::File file(H5Fcreate(path.c_str(), H5F_ACC_TRUNC, H5P_DEFAULT, H5P_DEFAULT), "create the file");
  const hsize_t size = claimed * kChunk;
  const hdf5::Space space(H5Screate_simple(1, &size, nullptr), "space");
  const hdf5::Properties creation(H5Pcreate(H5P_DATASET_CREATE), "properties");
  hdf5::check(H5Pset_chunk(creation.id(), 1, &kChunk), "chunk");
  hdf5::check(H5Pset_deflate(creation.id(), 9), "deflate");
  const hdf5::Dataset made(
      H5Dcreate2(file.id(), "/zeros", H5T_NATIVE_SCHAR, space.id(), H5P_DEFAULT, creation.id(), H5P_DEFAULT), "create");
  const hsize_t start = 0;
  hdf5::check(H5Sselect_hyperslab(space.id(), H5S_SELECT_SET, &start, nullptr, &kChunk, nullptr), "select");
  const hdf5::Space memory(H5Screate_simple(1, &kChunk, nullptr), "space");
  const std::vector<signed char> zeros(kChunk, 0);
  hdf5::check(H5Dwrite(made.id(), H5T_NATIVE_SCHAR, memory.id(), space.id(), H5P_DEFAULT, zeros.data()), "write");
}

/// What is said of so many mebibytes, one of which is in the file.
std::string complaint_on_zeros(const fs::path& path, hsize_t claimed) {
  write_zeros(path, claimed);
  try {
    const hdf5::InputFile file(path);
    (void)file.read("/zeros", std::vector<hsize_t>{claimed << 20U});
  } catch (const IoError& error) {
    return error.what();
  }
  return "none";
}

// Deflate makes 1029 bytes of each here.
TEST_F(Hdf5Values, ThatArePackedAsTightlyAsCanBeAreRead) {
  EXPECT_EQ(complaint_on_zeros(raw(), 1), "none");
}

TEST_F(Hdf5Values, ThatAreTwiceWhatCanBePackedAreRefused) {
  EXPECT_THAT(complaint_on_zeros(raw(), 2), HasSubstr("dataset /zeros claims to have 2097152 values"));
}

TEST_F(Hdf5Values, OfListsThatAreClaimedOnlyAreRefused) {
  constexpr hsize_t kMany = hsize_t{1} << 40;
  replace(study(), "/material", H5P_DEFAULT, {kMany});
  EXPECT_THAT(study_refusal(), HasSubstr("dataset /material claims to have 1099511627776 values"));
}

TEST_F(Hdf5Values, OfStudiesAreNumbers) {
  for (const double value : {std::numeric_limits<double>::quiet_NaN(), std::numeric_limits<double>::infinity(),
                             -std::numeric_limits<double>::infinity(), -1e-9}) {
    for (const std::string name : {"/point/distance", "/daylight/norm", "/comparison/ngan-l2/distance"}) {
      write_text(study(), true, study_table(synthetic_study(), "lobe run synthetic.toml", "2001-02-03T04:05:06Z"));
      change(study(), [&](hid_t file) {
        const hdf5::Dataset dataset(H5Dopen2(file, name.c_str(), H5P_DEFAULT), "open");
        const hdf5::Space space(H5Dget_space(dataset.id()), "space");
        std::vector<double> values(static_cast<std::size_t>(H5Sget_simple_extent_npoints(space.id())), 1.0);
        values.back() = value;
        hdf5::check(H5Dwrite(dataset.id(), H5T_NATIVE_DOUBLE, H5S_ALL, H5S_ALL, H5P_DEFAULT, values.data()), "write");
      });
      EXPECT_THAT(study_refusal(), HasSubstr("dataset " + name + " has ")) << value;
      EXPECT_THAT(study_refusal(), HasSubstr("expected finite numbers of at least 0")) << value;
    }
  }
}

}  // namespace
}  // namespace lobe::test
