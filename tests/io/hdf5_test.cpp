#include "hdf5/hdf5.hpp"

#include <gtest/gtest.h>
#include <unistd.h>

#include <array>
#include <cstdlib>
#include <filesystem>
#include <stdexcept>
#include <string>
#include <vector>

#include "command.hpp"
#include "core/files.hpp"
#include "golden.hpp"
#include "hdf5/hdf5_output.hpp"
#include "lobe/core/error.hpp"
#include "lobe/hdf5/table_file.hpp"
#include "study/write/study_hdf5.hpp"
#include "support/temporary_directory.hpp"
#include "synthetic_study.hpp"

namespace lobe::test {
namespace {

constexpr const char* kWritten = "2001-02-03T04:05:06Z";
constexpr const char* kWritingCommand = "lobe run synthetic.toml";

std::string synthetic_image() {
  return study_table(synthetic_study(), kWritingCommand, kWritten);
}

/// A study file opened by the C library, as any other program would.
class OpenStudy {
 public:
  explicit OpenStudy(const std::filesystem::path& path)
      : file_(H5Fopen(path.c_str(), H5F_ACC_RDONLY, H5P_DEFAULT), "open the file") {}

  [[nodiscard]] std::vector<hsize_t> shape(const std::string& name) const {
    const hdf5::Dataset dataset = open(name);
    const hdf5::Space space(H5Dget_space(dataset.id()), "get the space");
    std::vector<hsize_t> shape(static_cast<std::size_t>(H5Sget_simple_extent_ndims(space.id())));
    H5Sget_simple_extent_dims(space.id(), shape.data(), nullptr);
    return shape;
  }

  [[nodiscard]] std::vector<double> numbers(const std::string& name) const {
    std::size_t count = 1;
    for (const auto length : shape(name)) count *= length;
    std::vector<double> values(count);
    const hdf5::Dataset dataset = open(name);
    hdf5::check(H5Dread(dataset.id(), H5T_NATIVE_DOUBLE, H5S_ALL, H5S_ALL, H5P_DEFAULT, values.data()), "read " + name);
    return values;
  }

  [[nodiscard]] std::vector<std::string> texts(const std::string& name) const {
    const hdf5::Dataset dataset = open(name);
    const hdf5::Type type(H5Dget_type(dataset.id()), "get the type");
    std::vector<char*> pointers(shape(name).front());
    hdf5::check(H5Dread(dataset.id(), type.id(), H5S_ALL, H5S_ALL, H5P_DEFAULT, pointers.data()), "read " + name);
    std::vector<std::string> values(pointers.begin(), pointers.end());
    const hdf5::Space space(H5Dget_space(dataset.id()), "get the space");
    H5Dvlen_reclaim(type.id(), space.id(), H5P_DEFAULT, pointers.data());
    return values;
  }

  [[nodiscard]] std::string text_attribute(const std::string& object, const char* name) const {
    const hdf5::Attribute attribute(H5Aopen_by_name(file_.id(), object.c_str(), name, H5P_DEFAULT, H5P_DEFAULT),
                                    "open the attribute");
    const hdf5::Type type(H5Aget_type(attribute.id()), "get the type");
    char* pointer = nullptr;
    hdf5::check(H5Aread(attribute.id(), type.id(), &pointer), "read the attribute");
    std::string value = pointer;
    H5free_memory(pointer);
    return value;
  }

  [[nodiscard]] double number_attribute(const std::string& object, const char* name) const {
    const hdf5::Attribute attribute(H5Aopen_by_name(file_.id(), object.c_str(), name, H5P_DEFAULT, H5P_DEFAULT),
                                    "open the attribute");
    double value = 0;
    hdf5::check(H5Aread(attribute.id(), H5T_NATIVE_DOUBLE, &value), "read the attribute");
    return value;
  }

 private:
  [[nodiscard]] hdf5::Dataset open(const std::string& name) const {
    return {H5Dopen2(file_.id(), name.c_str(), H5P_DEFAULT), "open " + name};
  }

  hdf5::File file_;
};

std::vector<double> row_major(const Eigen::MatrixXd& matrix) {
  std::vector<double> values;
  for (Eigen::Index i = 0; i < matrix.rows(); ++i) {
    for (Eigen::Index j = 0; j < matrix.cols(); ++j) values.push_back(matrix(i, j));
  }
  return values;
}

std::vector<double> numbers_of(const std::vector<std::size_t>& integers) {
  return {integers.begin(), integers.end()};
}

std::vector<double> values_of(const std::vector<Estimate>& estimates) {
  std::vector<double> values;
  for (const auto& estimate : estimates) values.push_back(estimate.value);
  return values;
}

std::vector<double> errors_of(const std::vector<Estimate>& estimates) {
  std::vector<double> errors;
  for (const auto& estimate : estimates) errors.push_back(estimate.error);
  return errors;
}

class StudyTable : public ::testing::Test {
 protected:
  StudyTable() { write_text(path_, false, synthetic_image()); }

  const TemporaryDirectory directory_;
  const std::filesystem::path path_ = directory_.path() / "synthetic.h5";
  const StudyResult result_ = synthetic_study();
};

TEST_F(StudyTable, KeepsEveryNumberBitForBit) {
  const OpenStudy file(path_);
  for (const auto& metric : result_.metrics) {
    SCOPED_TRACE(metric.lighting.name());
    const std::string group = "/" + std::string(metric.lighting.name()) + "/";
    EXPECT_EQ(file.numbers(group + "gram"), row_major(metric.combined.gram));
    EXPECT_EQ(file.numbers(group + "gram_error"), row_major(metric.combined.gram_error));
    EXPECT_EQ(file.numbers(group + "norm"), row_major(metric.combined.norm));
    EXPECT_EQ(file.numbers(group + "norm_error"), row_major(metric.combined.norm_error));
    EXPECT_EQ(file.numbers(group + "distance"), row_major(metric.combined.distance));
    EXPECT_EQ(file.numbers(group + "distance_error"), row_major(metric.combined.distance_error));
  }
}

TEST_F(StudyTable, KeepsEveryChannelBitForBit) {
  const OpenStudy file(path_);
  std::vector<double> expected = row_major(result_.metrics[1].channels[0].distance_error);
  const std::vector<double> second = row_major(result_.metrics[1].channels[1].distance_error);
  expected.insert(expected.end(), second.begin(), second.end());
  EXPECT_EQ(file.numbers("/daylight/distance_error_by_channel"), expected);
  EXPECT_EQ(file.shape("/daylight/gram_by_channel"), (std::vector<hsize_t>{2, 6, 6}));
  EXPECT_EQ(file.shape("/daylight/norm_by_channel"), (std::vector<hsize_t>{2, 6}));
  EXPECT_EQ(file.numbers("/channel_weight"), result_.study.channel_weights);
}

TEST_F(StudyTable, KeepsTheEmbedding) {
  const OpenStudy file(path_);
  EXPECT_EQ(file.numbers("/point/embedding"), row_major(result_.embeddings[0].coordinates));
  EXPECT_EQ(file.numbers("/point/eigenvalue"), row_major(result_.embeddings[0].eigenvalues));
  EXPECT_EQ(file.number_attribute("/point/embedding", "explained_share"), result_.embeddings[0].explained_share);
}

TEST_F(StudyTable, KeepsTheTreeAsScipyDoes) {
  const OpenStudy file(path_);
  const Clustering& clustering = result_.clusterings[0];
  std::vector<double> linkage;
  std::vector<double> errors;
  for (const auto& merge : clustering.tree.merges) {
    linkage.insert(linkage.end(), {static_cast<double>(merge.first), static_cast<double>(merge.second),
                                   merge.height.value, static_cast<double>(merge.size)});
    errors.push_back(merge.height.error);
  }
  EXPECT_EQ(file.shape("/point/linkage"), (std::vector<hsize_t>{5, 4}));
  EXPECT_EQ(file.numbers("/point/linkage"), linkage);
  EXPECT_EQ(file.numbers("/point/linkage_height_error"), errors);
  EXPECT_EQ(file.number_attribute("/point/linkage", "cophenetic_correlation"), clustering.cophenetic_correlation.value);
  EXPECT_EQ(file.numbers("/point/leaf_order"), numbers_of(clustering.leaf_order));
  EXPECT_EQ(file.numbers("/point/tree_cluster"), numbers_of(clustering.tree_cluster));
}

TEST_F(StudyTable, KeepsTheMedoids) {
  const OpenStudy file(path_);
  const Clustering& clustering = result_.clusterings[0];
  std::vector<std::string> names;
  for (const auto medoid : clustering.medoids.medoid) names.push_back(result_.study.materials[medoid].name());
  EXPECT_EQ(file.texts("/point/medoid"), names);
  EXPECT_EQ(file.numbers("/point/cluster"), numbers_of(clustering.medoids.cluster));
  EXPECT_EQ(file.numbers("/point/silhouette"), values_of(clustering.silhouette));
  EXPECT_EQ(file.numbers("/point/silhouette_error"), errors_of(clustering.silhouette));
  EXPECT_EQ(file.number_attribute("/point/medoid", "mean_silhouette"), clustering.mean_silhouette.value);
  EXPECT_EQ(file.text_attribute("/point/medoid", "chosen_by"), "silhouette");
  EXPECT_EQ(file.numbers("/point/cluster_count"), (std::vector<double>{2, 3, 4, 5}));
  EXPECT_EQ(file.numbers("/point/silhouette_by_count")[1], clustering.candidates[1].silhouette.value);
}

TEST_F(StudyTable, KeepsTheNeighbours) {
  const OpenStudy file(path_);
  std::vector<std::size_t> materials;
  std::vector<Estimate> distances;
  std::vector<std::size_t> is_uncertain;
  for (const auto& list : result_.clusterings[1].neighbours) {
    for (const auto& neighbour : list) {
      materials.push_back(neighbour.material);
      distances.push_back(neighbour.distance);
      is_uncertain.push_back(neighbour.is_rank_uncertain ? 1 : 0);
    }
  }
  EXPECT_EQ(file.shape("/daylight/neighbour"), (std::vector<hsize_t>{6, 3}));
  EXPECT_EQ(file.numbers("/daylight/neighbour"), numbers_of(materials));
  EXPECT_EQ(file.numbers("/daylight/neighbour_distance"), values_of(distances));
  EXPECT_EQ(file.numbers("/daylight/neighbour_distance_error"), errors_of(distances));
  EXPECT_EQ(file.numbers("/daylight/neighbour_rank_uncertain"), numbers_of(is_uncertain));
}

TEST_F(StudyTable, KeepsLabelsAndMaterials) {
  const OpenStudy file(path_);
  std::vector<std::string> names;
  std::vector<std::string> families;
  std::vector<std::string> json;
  for (const auto& material : result_.study.materials) {
    names.push_back(material.name());
    families.push_back(material.family());
    json.push_back(to_json(*material.formula()));
  }
  EXPECT_EQ(file.texts("/material"), names);
  EXPECT_EQ(file.texts("/material_other"), names);
  EXPECT_EQ(file.texts("/family"), families);
  EXPECT_EQ(file.texts("/material_json"), json);
  EXPECT_EQ(file.texts("/channel"), result_.study.channels);
}

TEST_F(StudyTable, NamesPairsThatAreUnresolved) {
  const OpenStudy file(path_);
  const auto& materials = result_.study.materials;
  EXPECT_EQ(file.number_attribute("/point", "unresolved_pairs"), 2);
  EXPECT_EQ(file.texts("/point/unresolved_first"),
            (std::vector<std::string>{materials[0].name(), materials[1].name()}));
  EXPECT_EQ(file.texts("/point/unresolved_second"),
            (std::vector<std::string>{materials[1].name(), materials[1].name()}));
  EXPECT_EQ(file.numbers("/point/unresolved_error"), (std::vector<double>{3e-5, 2e-6}));
  EXPECT_EQ(file.number_attribute("/daylight", "unresolved_pairs"), 0);
}

TEST_F(StudyTable, TellsWhereItComesFrom) {
  const OpenStudy file(path_);
  EXPECT_EQ(file.text_attribute("/", "lobe_schema"), "lobe-study/1");
  EXPECT_EQ(file.text_attribute("/", "title"), "Synthetic study");
  EXPECT_EQ(file.text_attribute("/", "history"), std::string(kWritten) + ": " + kWritingCommand);
  EXPECT_EQ(file.text_attribute("/", "date_created"), kWritten);
  EXPECT_EQ(file.text_attribute("/", "references"), "Somebody: Something, 1999\nÄhnliches, 2001");
  EXPECT_EQ(file.text_attribute("/provenance", "effective_config"), result_.study.configuration);
  EXPECT_EQ(file.text_attribute("/provenance", "opencl_device"), "Made-up device");
  EXPECT_EQ(file.text_attribute("/provenance", "opencl_driver"), "7.0");
  EXPECT_EQ(file.text_attribute("/provenance", "precision"), "double");
  EXPECT_EQ(file.number_attribute("/provenance", "tolerance"), 1e-6);
}

TEST_F(StudyTable, GivesEveryNumberAUnitAndLinksItsError) {
  const OpenStudy file(path_);
  EXPECT_EQ(file.text_attribute("/point/gram", "units"), "1");
  EXPECT_EQ(file.text_attribute("/daylight/gram", "units"), "sr");
  EXPECT_EQ(file.text_attribute("/daylight/distance", "units"), "sr^0.5");
  EXPECT_EQ(file.text_attribute("/point/gram", "ancillary_variables"), "gram_error");
  EXPECT_EQ(file.text_attribute("/point/norm_by_channel", "ancillary_variables"), "norm_error_by_channel");
}

TEST_F(StudyTable, KeepsTheComparisonMetrics) {
  const OpenStudy file(path_);
  const LiteratureResult& ngan = result_.comparisons[0];
  const std::string group = "/comparison/ngan-l2/";
  EXPECT_EQ(file.numbers(group + "distance"), row_major(ngan.combined.distance));
  EXPECT_EQ(file.numbers(group + "distance_error"), row_major(ngan.combined.distance_error));
  EXPECT_EQ(file.numbers(group + "size"), row_major(ngan.combined.size));
  EXPECT_EQ(file.shape(group + "distance_by_channel"), (std::vector<hsize_t>{2, 6, 6}));
  EXPECT_EQ(file.text_attribute(group + "distance", "units"), "sr^-1 rad^1.5");
  EXPECT_EQ(file.text_attribute(group + "distance", "ancillary_variables"), "distance_error");
  EXPECT_EQ(file.text_attribute("/comparison/log-relative/distance", "units"), "1");
  EXPECT_EQ(file.number_attribute(group, "unresolved_pairs"), 1);
  EXPECT_EQ(file.numbers(group + "unresolved_error"), std::vector<double>{2e-3});
}

TEST_F(StudyTable, KeepsTheRankCorrelationsOfAllMetrics) {
  const OpenStudy file(path_);
  EXPECT_EQ(file.texts("/agreement/metric"),
            (std::vector<std::string>{"point", "daylight", "ngan-l2", "log-relative"}));
  EXPECT_EQ(file.numbers("/agreement/spearman"), row_major(result_.agreement.all_pairs.spearman));
  EXPECT_EQ(file.numbers("/agreement/kendall"), row_major(result_.agreement.all_pairs.kendall));
  EXPECT_EQ(file.numbers("/agreement/kendall_within_families"), row_major(result_.agreement.within_families.kendall));
}

TEST_F(StudyTable, KeepsTheResidualsOfFamiliesUnderEachLighting) {
  const OpenStudy file(path_);
  EXPECT_EQ(file.texts("/basis_family"), (std::vector<std::string>{"Phong", "Ward"}));
  EXPECT_EQ(file.numbers("/point/linear_residual"), row_major(result_.residuals[0].relative_residual));
  EXPECT_EQ(file.numbers("/daylight/non_negative_residual"), row_major(result_.residuals[3].relative_residual));
  EXPECT_EQ(file.numbers("/daylight/non_negative_residual_error"),
            row_major(result_.residuals[3].relative_residual_error));
  EXPECT_EQ(file.numbers("/point/linear_rank"), row_major(result_.residuals[0].rank.cast<double>()));
}

TEST_F(StudyTable, LeavesOutWhatTheStudyDoesNotAskFor) {
  StudyResult plain = synthetic_study();
  plain.study.comparison_metrics.clear();
  plain.study.approximations.clear();
  plain.comparisons.clear();
  plain.residuals.clear();
  plain.agreement = {};
  const auto path = directory_.path() / "plain.h5";
  write_text(path, false, study_table(plain, kWritingCommand, kWritten));
  const hdf5::File file(H5Fopen(path.c_str(), H5F_ACC_RDONLY, H5P_DEFAULT), "open the file");
  for (const char* name : {"comparison", "agreement", "basis_family"}) {
    EXPECT_EQ(H5Lexists(file.id(), name, H5P_DEFAULT), 0) << name;
  }
  EXPECT_GT(H5Lexists(file.id(), "point", H5P_DEFAULT), 0);
}

TEST_F(StudyTable, HoldsCharts) {
  StudyResult drawn;
  drawn.study.name = "drawn";
  drawn.study.channels = {"value"};
  drawn.study.channel_weights = {1};
  Chart chart;
  chart.name = "2.7";
  chart.title = "Radiance";
  chart.quantity = ChartQuantity::radiance;
  chart.x = {-0.5, 0, 0.5};
  chart.curves = {{"a", {make_material("lambert")}, 0.25}, {"b", {make_material("phong", {{"n", 2}})}, 0.75}};
  drawn.study.charts = {chart};
  drawn.charts = {{{{1, 0.1}, {2, 0.2}, {3, 0.3}}, {{4, 0.4}, {5, 0.5}, {6, 0.6}}}};
  const auto path = directory_.path() / "drawn.h5";
  write_text(path, false, study_table(drawn, kWritingCommand, kWritten));

  const OpenStudy file(path);
  EXPECT_EQ(file.text_attribute("/charts/2.7", "quantity"), "radiance");
  EXPECT_EQ(file.texts("/charts/2.7/curve"), (std::vector<std::string>{"a", "b"}));
  EXPECT_EQ(file.texts("/charts/2.7/material_json").at(1), to_json(chart.curves[1].materials[0]));
  EXPECT_EQ(file.numbers("/charts/2.7/theta_in"), (std::vector{0.25, 0.75}));
  EXPECT_EQ(file.numbers("/charts/2.7/x"), chart.x);
  EXPECT_EQ(file.text_attribute("/charts/2.7/x", "units"), "rad");
  EXPECT_EQ(file.shape("/charts/2.7/value"), (std::vector<hsize_t>{2, 3}));
  EXPECT_EQ(file.numbers("/charts/2.7/value"), (std::vector<double>{1, 2, 3, 4, 5, 6}));
  EXPECT_EQ(file.numbers("/charts/2.7/value_error"), (std::vector{0.1, 0.2, 0.3, 0.4, 0.5, 0.6}));
  EXPECT_EQ(file.text_attribute("/charts/2.7/value", "units"), "sr-1");
}

TEST_F(StudyTable, HasTheBytesOfItsContentAndNothingElse) {
  EXPECT_EQ(synthetic_image(), read_text(path_));
}

TEST_F(StudyTable, RevealsAFlippedByte) {
  std::string bytes = read_text(path_);
  const OpenStudy intact(path_);
  // The chunk's place in the file, from the library itself.
  const hdf5::File file(H5Fopen(path_.c_str(), H5F_ACC_RDONLY, H5P_DEFAULT), "open the file");
  const hdf5::Dataset dataset(H5Dopen2(file.id(), "/point/gram", H5P_DEFAULT), "open the dataset");
  const hdf5::Space space(H5Dget_space(dataset.id()), "get the space");
  haddr_t address = 0;
  hsize_t size = 0;
  std::array<hsize_t, 2> offset{};
  unsigned filters = 0;
  ASSERT_GE(H5Dget_chunk_info(dataset.id(), space.id(), 0, offset.data(), &filters, &address, &size), 0);
  bytes[static_cast<std::size_t>(address + size / 2)] ^= 1;
  const auto damaged_path = directory_.path() / "damaged.h5";
  write_text(damaged_path, false, bytes);

  const hdf5::QuietErrors quiet;
  const OpenStudy damaged(damaged_path);
  EXPECT_THROW((void)damaged.numbers("/point/gram"), IoError);
  EXPECT_NO_THROW((void)damaged.numbers("/point/distance"));
}

TEST_F(StudyTable, HasTheGoldenHeader) {
  ASSERT_TRUE(has_program("h5dump")) << "h5dump is missing; install hdf5-tools";
  const auto dump = run_command("cd " + directory_.path().string() + " && h5dump -H -p synthetic.h5");
  ASSERT_EQ(dump.status, 0);
  expect_golden("study_header.txt", compact(without_versions(dump.output)));
}

TEST_F(StudyTable, IsANetcdfFile) {
  ASSERT_TRUE(has_program("ncdump")) << "ncdump is missing; install netcdf-bin";
  const auto dump = run_command("cd " + directory_.path().string() + " && ncdump -h synthetic.h5");
  ASSERT_EQ(dump.status, 0);
  expect_golden("study_netcdf_header.txt", without_versions(dump.output));
}

TEST(FileImage, FailsWithTheCauseOfTheLibrary) {
  const auto fill = [](hid_t root) {
    (void)hdf5::create_group(root, "twice");
    (void)hdf5::create_group(root, "twice");
  };
  try {
    (void)hdf5::file_image(fill);
    FAIL() << "no error";
  } catch (const IoError& error) {
    EXPECT_EQ(std::string(error.what()).find("cannot create group twice: "), 0U) << error.what();
    EXPECT_NE(std::string(error.what()).find("already exists"), std::string::npos) << error.what();
  }
}

TEST(FileImage, LeavesTheErrorHandlerOfTheProgramAlone) {
  H5E_auto2_t before = nullptr;
  H5E_auto2_t after = nullptr;
  void* data = nullptr;
  H5Eget_auto2(H5E_DEFAULT, &before, &data);
  (void)hdf5::file_image([](hid_t) {});
  H5Eget_auto2(H5E_DEFAULT, &after, &data);
  EXPECT_EQ(before, after);
}

/// Takes root's rights from the process as long as it lives.
class WithoutPrivileges {
 public:
  WithoutPrivileges() {
    if (user_ == 0 && ::seteuid(65534) != 0) throw std::runtime_error("cannot become another user");
  }
  ~WithoutPrivileges() {
    if (::seteuid(user_) != 0) std::abort();
  }
  WithoutPrivileges(const WithoutPrivileges&) = delete;
  WithoutPrivileges& operator=(const WithoutPrivileges&) = delete;

 private:
  uid_t user_ = ::geteuid();
};

TEST(InputFile, SaysThatPermissionIsDenied) {
  const TemporaryDirectory directory;
  const auto path = directory.path() / "t.h5";
  write_text(path, false, "");
  std::filesystem::permissions(directory.path(), std::filesystem::perms::others_exec,
                               std::filesystem::perm_options::add);
  std::filesystem::permissions(path, std::filesystem::perms::none);
  const WithoutPrivileges nobody;
  try {
    static_cast<void>(load_table(path));
    FAIL() << "it was read";
  } catch (const IoError& error) {
    EXPECT_EQ(error.fault(), Fault::not_permitted);
    EXPECT_EQ(std::string(error.what()), "cannot read " + path.string() + ": Permission denied");
  }
}

TEST(CreateDataset, RefusesValuesThatDoNotFillTheAxes) {
  const auto fill = [](hid_t root) {
    const auto axis = hdf5::create_index_axis(root, "axis", 3);
    const hdf5::Dataset* const along[] = {&axis};
    (void)hdf5::create_dataset(root, "numbers", std::vector<double>{1, 2}, along);
  };
  EXPECT_THROW((void)hdf5::file_image(fill), ArgumentError);
}

TEST(ChunkShape, HoldsASmallArrayWhole) {
  EXPECT_EQ(hdf5::chunk_shape(std::vector<hsize_t>{344, 344}), (std::vector<hsize_t>{344, 344}));
}

TEST(ChunkShape, CutsALargeArrayIntoRowsOfAtMostOneMebibyte) {
  const auto chunk = hdf5::chunk_shape(std::vector<hsize_t>{3, 1000, 1000});
  EXPECT_EQ(chunk, (std::vector<hsize_t>{1, 131, 1000}));
}

TEST(ChunkShape, CutsARowThatIsTooLong) {
  EXPECT_EQ(hdf5::chunk_shape(std::vector<hsize_t>{2, 1000000}), (std::vector<hsize_t>{1, 131072}));
}

}  // namespace
}  // namespace lobe::test
