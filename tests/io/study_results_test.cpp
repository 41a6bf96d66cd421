#include "lobe/study/study_results.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <string>

#include "core/files.hpp"
#include "hdf5/hdf5.hpp"
#include "lobe/core/error.hpp"
#include "study/write/study_hdf5.hpp"
#include "support/temporary_directory.hpp"
#include "synthetic_study.hpp"

namespace lobe::test {
namespace {

namespace fs = std::filesystem;
using ::testing::HasSubstr;

constexpr const char* kCommandLine = "lobe run synthetic.toml";
constexpr const char* kCreated = "2001-02-03T04:05:06Z";

class StudyResultsTest : public ::testing::Test {
 protected:
  [[nodiscard]] StudyResults written_and_read(const StudyResult& result) const {
    write_text(path_, true, study_table(result, kCommandLine, kCreated));
    return load_study_results(path_);
  }

  /// \param change of the file, by the C library
  template <typename Change>
  void write_changed(const StudyResult& result, const Change& change) const {
    write_text(path_, true, study_table(result, kCommandLine, kCreated));
    const hdf5::File file(H5Fopen(path_.c_str(), H5F_ACC_RDWR, H5P_DEFAULT), "open the file");
    change(file.id());
  }

  [[nodiscard]] std::string refusal() const {
    try {
      (void)load_study_results(path_);
    } catch (const IoError& error) {
      return error.what();
    }
    return "none";
  }

  [[nodiscard]] const fs::path& path() const { return path_; }

 private:
  TemporaryDirectory directory_;
  fs::path path_ = directory_.path() / "synthetic.h5";
};

void expect_equal(const Estimate& found, const Estimate& expected) {
  EXPECT_EQ(found.value, expected.value);
  EXPECT_EQ(found.error, expected.error);
}

TEST_F(StudyResultsTest, AreWhatWasWritten) {
  const StudyResult result = synthetic_study();
  const StudyResults read = written_and_read(result);
  EXPECT_EQ(read.name, "synthetic");
  EXPECT_EQ(read.title, "Synthetic study");
  EXPECT_EQ(read.references, "Somebody: Something, 1999\nÄhnliches, 2001");
  EXPECT_EQ(read.channels, result.study.channels);
  EXPECT_EQ(read.channel_weights, result.study.channel_weights);
  ASSERT_EQ(read.materials.size(), 6U);
  EXPECT_EQ(read.materials[3].name, "Ward, \"no\" 4");
  EXPECT_EQ(read.materials[3].family, "Ward");
  EXPECT_EQ(read.materials[3].json, to_json(result.study.materials[3]));
}

TEST_F(StudyResultsTest, HaveTheDistancesOfLightingsAndComparisonMetrics) {
  const StudyResult result = synthetic_study();
  const StudyResults read = written_and_read(result);
  ASSERT_EQ(read.distances.size(), 4U);
  for (std::size_t i = 0; i < 2; ++i) {
    const StudyDistances& distances = read.distances[i];
    EXPECT_TRUE(distances.is_lighting);
    EXPECT_EQ(distances.name, result.metrics[i].lighting.name());
    EXPECT_EQ(distances.definition, result.metrics[i].lighting.definition());
    EXPECT_EQ(distances.distance, result.metrics[i].combined.distance);
    EXPECT_EQ(distances.distance_error, result.metrics[i].combined.distance_error);
    EXPECT_EQ(distances.norm, result.metrics[i].combined.norm);
    EXPECT_EQ(distances.norm_error, result.metrics[i].combined.norm_error);
    EXPECT_EQ(distances.unresolved_pairs, result.metrics[i].unresolved.size());
    EXPECT_EQ(distances.embedding->coordinates, result.embeddings[i].coordinates);
    EXPECT_EQ(distances.embedding->explained_share, result.embeddings[i].explained_share);
    EXPECT_EQ(distances.residuals[1].relative_residual, result.residuals[2 * i + 1].relative_residual);
    EXPECT_EQ(distances.residuals[1].rank, result.residuals[2 * i + 1].rank);
    EXPECT_TRUE(distances.residuals[1].non_negative);
  }
  EXPECT_EQ(read.distances[1].unit, "sr^0.5");
  EXPECT_FALSE(read.distances[2].is_lighting);
  EXPECT_EQ(read.distances[2].name, "ngan-l2");
  EXPECT_EQ(read.distances[2].distance, result.comparisons[0].combined.distance);
  EXPECT_EQ(read.distances[2].norm, result.comparisons[0].combined.size);
  EXPECT_FALSE(read.distances[2].clustering.has_value());
}

TEST_F(StudyResultsTest, HaveTheTreeTheMedoidsAndTheNeighbours) {
  const StudyResult result = synthetic_study();
  const StudyResults read = written_and_read(result);
  const Clustering& found = read.distances[0].clustering.value();
  const Clustering& expected = result.clusterings[0];
  ASSERT_EQ(found.tree.merges.size(), expected.tree.merges.size());
  for (std::size_t i = 0; i < found.tree.merges.size(); ++i) {
    EXPECT_EQ(found.tree.merges[i].first, expected.tree.merges[i].first);
    EXPECT_EQ(found.tree.merges[i].second, expected.tree.merges[i].second);
    EXPECT_EQ(found.tree.merges[i].size, expected.tree.merges[i].size);
    expect_equal(found.tree.merges[i].height, expected.tree.merges[i].height);
  }
  EXPECT_EQ(found.leaf_order, expected.leaf_order);
  EXPECT_EQ(found.tree_cluster, expected.tree_cluster);
  EXPECT_EQ(found.medoids.medoid, expected.medoids.medoid);
  EXPECT_EQ(found.medoids.cluster, expected.medoids.cluster);
  expect_equal(found.mean_silhouette, expected.mean_silhouette);
  ASSERT_EQ(found.candidates.size(), expected.candidates.size());
  EXPECT_EQ(found.candidates.back().clusters, expected.candidates.back().clusters);
  ASSERT_EQ(found.neighbours[4].size(), expected.neighbours[4].size());
  EXPECT_EQ(found.neighbours[4][1].material, expected.neighbours[4][1].material);
  EXPECT_EQ(found.neighbours[4][1].is_rank_uncertain, expected.neighbours[4][1].is_rank_uncertain);
  expect_equal(found.neighbours[4][1].distance, expected.neighbours[4][1].distance);
}

TEST_F(StudyResultsTest, HaveTheCurvesOfEveryMaterialAndChannel) {
  const StudyResult result = synthetic_study();
  const StudyResults read = written_and_read(result);
  EXPECT_EQ(read.curve_angles.theta_out, result.curve_angles.theta_out);
  ASSERT_EQ(read.curves.size(), result.curves.size());
  for (std::size_t i = 0; i < read.curves.size(); ++i) {
    EXPECT_EQ(read.curves[i].has_delta, result.curves[i].has_delta);
    expect_equal(read.curves[i].albedo[1][2], result.curves[i].albedo[1][2]);
    expect_equal(read.curves[i].reflectance[1][0][3], result.curves[i].reflectance[1][0][3]);
    expect_equal(read.curves[i].reflectance[0][1][2], result.curves[i].reflectance[0][1][2]);
  }
}

TEST_F(StudyResultsTest, GiveMaterialsOfOneChannelAllChannels) {
  StudyResult result = synthetic_study();
  result.curves[2].albedo.resize(1);
  result.curves[2].reflectance.resize(1);
  const StudyResults read = written_and_read(result);
  expect_equal(read.curves[2].albedo[1][0], result.curves[2].albedo[0][0]);
}

TEST_F(StudyResultsTest, KnowHowTheyCameAbout) {
  const StudyResults read = written_and_read(synthetic_study());
  EXPECT_EQ(read.provenance.command_line, kCommandLine);
  EXPECT_EQ(read.provenance.created, kCreated);
  EXPECT_EQ(read.provenance.configuration, "[study]\nname = \"synthetic\"\n");
  EXPECT_EQ(read.provenance.device, "Made-up device");
  EXPECT_EQ(read.provenance.precision, "double");
  EXPECT_EQ(read.provenance.tolerance, 1e-6);
  EXPECT_EQ(read.provenance.grid, "");
}

StudyResult with_origins() {
  StudyResult result = synthetic_study();
  Study& study = result.study;
  study.texts = {{"main.toml", "include = [\"a.toml\"]\n"}, {"sub/a.toml", "# text\n"}};
  study.overrides = {"family.Ward.m=0.1"};
  for (std::size_t i = 0; i < study.materials.size(); ++i) {
    study.origins.materials.push_back({.file = "sub/a.toml", .line = i + 1, .swept = "", .overrides = {}});
  }
  study.origins.materials[2].swept = "m=0.1";
  study.origins.materials[2].overrides = {"family.Ward.m"};
  study.origins.lightings.resize(2);
  study.origins.comparison_metrics.resize(2);
  study.origins.comparison_metrics[1] = {.file = "main.toml", .line = 7, .swept = "", .overrides = {}};
  return result;
}

TEST_F(StudyResultsTest, SayWhereInTheStudyTheyComeFrom) {
  const StudyResults read = written_and_read(with_origins());
  EXPECT_EQ(read.materials[1].origin, "sub/a.toml:2");
  EXPECT_EQ(read.materials[2].origin, "sub/a.toml:3 (m=0.1), --set family.Ward.m");
  EXPECT_EQ(read.distances[0].origin, "default");
  EXPECT_EQ(read.distances[3].origin, "main.toml:7");
  ASSERT_EQ(read.provenance.texts.size(), 2U);
  EXPECT_EQ(read.provenance.texts[1].name, "sub/a.toml");
  EXPECT_EQ(read.provenance.texts[1].text, "# text\n");
  EXPECT_EQ(read.provenance.overrides, std::vector<std::string>{"family.Ward.m=0.1"});

  const StudySummary summary = load_study_summary(path());
  EXPECT_EQ(summary.materials[2].origin, read.materials[2].origin);
  ASSERT_EQ(summary.metrics.size(), 4U);
  EXPECT_EQ(summary.metrics[3].first, read.distances[3].name);
  EXPECT_EQ(summary.metrics[3].second, "main.toml:7");
  EXPECT_TRUE(is_study_results(path()));
}

TEST_F(StudyResultsTest, SayNothingOfTheirOriginInOlderFiles) {
  const StudyResult result = with_origins();
  write_changed(result, [](hid_t file) {
    for (const char* name : {"/origin", "/provenance/study_text", "/provenance/study_file", "/provenance/override"}) {
      H5Ldelete(file, name, H5P_DEFAULT);
    }
    H5Adelete_by_name(file, "/point", "origin", H5P_DEFAULT);
    H5Adelete_by_name(file, "/comparison/ngan-l2", "origin", H5P_DEFAULT);
  });
  const StudyResults read = load_study_results(path());
  EXPECT_EQ(read.materials[2].origin, "");
  EXPECT_EQ(read.distances[0].origin, "");
  EXPECT_EQ(read.distances[2].origin, "");
  EXPECT_TRUE(read.provenance.texts.empty());
  EXPECT_TRUE(read.provenance.overrides.empty());
  EXPECT_EQ(read.distances[0].distance, result.metrics[0].combined.distance);
}

TEST_F(StudyResultsTest, RefuseOriginsOfAnotherNumber) {
  write_changed(with_origins(), [](hid_t file) {
    H5Ldelete(file, "/origin", H5P_DEFAULT);
    H5Lcreate_hard(file, "/provenance/study_text", file, "/origin", H5P_DEFAULT, H5P_DEFAULT);
  });
  EXPECT_THAT(refusal(), HasSubstr("dataset /origin has 2 texts; expected 6"));
}

TEST_F(StudyResultsTest, AreSummedUpWithoutMaterialsToo) {
  StudyResult result;
  result.study.title = "figures";
  write_text(path(), true, study_table(result, kCommandLine, kCreated));
  const StudySummary summary = load_study_summary(path());
  EXPECT_EQ(summary.title, "figures");
  EXPECT_TRUE(summary.materials.empty());
  write_text(path(), true, "no HDF5");
  EXPECT_FALSE(is_study_results(path()));
}

TEST_F(StudyResultsTest, ExistOfASingleMaterialInAFamily) {
  const StudyResults read = written_and_read(synthetic_study(1));
  EXPECT_EQ(read.materials.size(), 2U);
  EXPECT_EQ(read.distances[0].clustering->tree.merges.size(), 1U);
}

TEST_F(StudyResultsTest, HaveNoCurvesInOlderFiles) {
  StudyResult result = synthetic_study();
  result.curves.clear();
  EXPECT_TRUE(written_and_read(result).curves.empty());
}

TEST_F(StudyResultsTest, NameLightingsByTheirGroupsInOlderFiles) {
  write_changed(synthetic_study(), [](hid_t file) {
    H5Adelete_by_name(file, "/daylight", "lighting", H5P_DEFAULT);
    H5Adelete_by_name(file, "/provenance", "grid", H5P_DEFAULT);
  });
  const StudyResults read = load_study_results(path());
  EXPECT_EQ(read.distances[1].name, "daylight");
  EXPECT_FALSE(read.provenance.grid.has_value());
}

TEST_F(StudyResultsTest, RefuseOtherFiles) {
  write_text(path(), true, "no HDF5");
  EXPECT_THAT(refusal(), HasSubstr("synthetic.h5 as an HDF5 file"));
  write_text(path(), true, hdf5::file_image([](hid_t) {}));
  EXPECT_THAT(refusal(), HasSubstr("it is no study of lobe; expected what 'lobe run' left"));
  write_text(path(), true, hdf5::file_image([](hid_t root) {
               hdf5::write_attribute(root, "lobe_schema", std::string_view("lobe-table/1"));
             }));
  EXPECT_THAT(refusal(), HasSubstr("its schema is 'lobe-table/1'; expected lobe-study/1"));
}

TEST_F(StudyResultsTest, RefuseFilesOfNewerVersions) {
  write_text(path(), true, hdf5::file_image([](hid_t root) {
               hdf5::write_attribute(root, "lobe_schema", std::string_view("lobe-study/2"));
             }));
  EXPECT_THAT(refusal(), HasSubstr("its schema is 'lobe-study/2', of another version of lobe; expected lobe-study/1"));
}

TEST_F(StudyResultsTest, RefuseStudiesWithoutMaterials) {
  StudyResult result;
  result.study.name = "none";
  write_text(path(), true, study_table(result, kCommandLine, kCreated));
  EXPECT_THAT(refusal(), HasSubstr("the study has no materials"));
}

TEST_F(StudyResultsTest, RefuseWhatLacksADataset) {
  write_changed(synthetic_study(), [](hid_t file) { H5Ldelete(file, "/point/norm_error", H5P_DEFAULT); });
  EXPECT_THAT(refusal(), HasSubstr("dataset /point/norm_error is missing"));
}

TEST_F(StudyResultsTest, RefuseTreesThatAreNone) {
  write_changed(synthetic_study(), [](hid_t file) {
    const hdf5::Dataset linkage(H5Dopen2(file, "/point/linkage", H5P_DEFAULT), "open");
    std::vector<double> numbers(20, 0);
    H5Dwrite(linkage.id(), H5T_NATIVE_DOUBLE, H5S_ALL, H5S_ALL, H5P_DEFAULT, numbers.data());
  });
  EXPECT_THAT(refusal(), HasSubstr("/point/linkage is no tree of the materials"));
}

TEST_F(StudyResultsTest, RefuseOrdersThatAreNone) {
  write_changed(synthetic_study(), [](hid_t file) {
    const hdf5::Dataset order(H5Dopen2(file, "/point/leaf_order", H5P_DEFAULT), "open");
    std::vector<int> numbers(6, 3);
    H5Dwrite(order.id(), H5T_NATIVE_INT, H5S_ALL, H5S_ALL, H5P_DEFAULT, numbers.data());
  });
  EXPECT_THAT(refusal(), HasSubstr("/point/leaf_order is no order of the materials"));
}

// Cut anywhere: one line of complaint, or, where only slack at the end is missing, the numbers as they were.
TEST_F(StudyResultsTest, AreNeverThoseOfHalfAFile) {
  const StudyResult result = synthetic_study();
  const std::string image = study_table(result, kCommandLine, kCreated);
  for (std::size_t at = 1; at < image.size(); at += image.size() / 50) {
    write_text(path(), true, image.substr(0, at));
    const std::string complaint = refusal();
    EXPECT_EQ(complaint.find('\n'), std::string::npos) << complaint;
    if (complaint != "none") continue;
    EXPECT_GT(at, 9 * image.size() / 10);
    EXPECT_EQ(load_study_results(path()).distances[0].distance, result.metrics[0].combined.distance) << at;
  }
}

// Chunks carry checksums.
TEST_F(StudyResultsTest, RefuseNumbersThatAreDamaged) {
  std::size_t offset = 0;
  write_changed(synthetic_study(), [&](hid_t file) {
    const hdf5::Dataset distance(H5Dopen2(file, "/daylight/distance", H5P_DEFAULT), "open");
    haddr_t address = 0;
    hsize_t bytes = 0;
    unsigned mask = 0;
    const hsize_t first[2] = {0, 0};
    H5Dget_chunk_info_by_coord(distance.id(), first, &mask, &address, &bytes);
    offset = static_cast<std::size_t>(address + bytes / 2);
  });
  std::string image = read_text(path());
  image.at(offset) = static_cast<char>(~static_cast<unsigned char>(image.at(offset)));
  write_text(path(), true, image);
  EXPECT_THAT(refusal(), HasSubstr("synthetic.h5: dataset /daylight/distance: "));
}

}  // namespace
}  // namespace lobe::test
