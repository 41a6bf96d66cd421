#include "lobe/study/study_results.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <string>

#include "core/files.hpp"
#include "hdf5/hdf5.hpp"
#include "hdf5/hdf5_output.hpp"
#include "lobe/core/directions.hpp"
#include "lobe/core/error.hpp"
#include "study/read/origin.hpp"
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
  [[nodiscard]] StudyResult written_and_read(const StudyResult& result) const {
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
  const StudyResult read = written_and_read(result);
  EXPECT_EQ(read.study.name, "synthetic");
  EXPECT_EQ(read.study.title, "Synthetic study");
  EXPECT_EQ(read.study.references, result.study.references);
  EXPECT_EQ(read.study.channels, result.study.channels);
  EXPECT_EQ(read.study.channel_weights, result.study.channel_weights);
  ASSERT_EQ(read.study.materials.size(), 6U);
  EXPECT_EQ(read.study.materials[3].name(), "Ward, \"no\" 4");
  EXPECT_EQ(read.study.materials[3].family(), "Ward");
  EXPECT_EQ(to_json(*read.study.materials[3].formula()), to_json(*result.study.materials[3].formula()));
  EXPECT_EQ(read.study.lightings, result.study.lightings);
  EXPECT_EQ(read.study.comparison_metrics, result.study.comparison_metrics);
  EXPECT_EQ(read.study.approximations, result.study.approximations);
}

/// A study with everything that results can hold.
StudyResult complete_study() {
  StudyResult result = synthetic_study();
  Study& study = result.study;
  study.grid = HemisphereGrid::gauss(8, 16);
  study.precision = Precision::single_precision;
  study.domain_theta_max = 80 * kDegree;
  for (MetricResult& metric : result.metrics) metric.theta_max = study.domain_theta_max;
  result.metrics[1].route = Route::tables;
  result.metrics[1].grid = study.grid;
  study.texts = {{"main.toml", "[study]\n"}};
  study.overrides = {"family.Ward.m=0.1"};
  study.function_tolerance = 0.02;
  study.materials[5] = {{"felt", study.materials[5].family()},
                        MaterialFile{"/somewhere/felt.binary", "felt.binary", {}}};
  result.files.resize(study.materials.size());
  result.files[5] = R"({"name":"felt","family":"Ward","file":"felt.binary","format":"merl"})";
  study.origins.materials.assign(study.materials.size(),
                                 {.file = "main.toml", .line = 3, .swept = "m=0.1", .overrides = {}});
  study.origins.lightings.assign(2, {});
  study.origins.comparison_metrics.assign(2, {.file = "main.toml", .line = 7, .swept = "", .overrides = {"a", "b"}});
  study.origins.published.assign(2, {.file = "main.toml", .line = 20, .swept = "", .overrides = {}});
  study.origins.charts.assign(2, {.file = "main.toml", .line = 30, .swept = "", .overrides = {}});
  study.origins.curves = {{{.file = "main.toml", .line = 31, .swept = "", .overrides = {}}},
                          {{.file = "main.toml", .line = 41, .swept = "", .overrides = {}}}};
  for (const char* corrected : {"", "0.42"}) {
    PublishedFigure figure;
    figure.table = "Table 1";
    figure.label = std::string("figure") + corrected;
    figure.quantity = PublishedQuantity::mean_albedo;
    figure.material = *study.materials[0].formula();
    figure.printed = "0.40";
    figure.corrected = corrected;
    study.published.push_back(std::move(figure));
  }
  result.published = {{{0.4, 1e-6}, 0.1, true, true}, {{0.42, 1e-6}, 2, false, true}};
  Chart slice;
  slice.name = "slice";
  slice.title = "A slice";
  slice.quantity = ChartQuantity::reflectance;
  slice.x = {-0.5, 0, 0.5};
  slice.curves = {{"Phong", {*study.materials[0].formula()}, 0.25}};
  slice.unit = *study.materials[1].formula();
  Chart swept;
  swept.name = "swept";
  swept.quantity = ChartQuantity::mean_albedo;
  swept.parameter = "n";
  swept.x = {1, 2};
  swept.curves = {{"Phong", {*study.materials[0].formula()}, 0}};
  study.charts = {slice, swept};
  result.charts = {{{{1, 0.1}, {2, 0.1}, {3, 0.1}}}, {{{0.5, 1e-5}, {0.25, 1e-5}}}};
  return result;
}

TEST_F(StudyResultsTest, AreTheSameFileWhenWrittenAgain) {
  const std::string image = study_table(complete_study(), kCommandLine, kCreated);
  write_text(path(), true, image);
  const StudyResult read = load_study_results(path());
  EXPECT_EQ(read.study.charts[0].curves[0].theta_in, 0.25);
  EXPECT_EQ(read.published[1].deviation, 2);
  // Compared as a truth value: the bytes of a file are no message.
  EXPECT_TRUE(study_table(read, read.provenance.command_line, read.provenance.created) == image);
}

TEST_F(StudyResultsTest, HaveTheDistancesOfLightingsAndComparisonMetrics) {
  const StudyResult result = synthetic_study();
  const StudyResult read = written_and_read(result);
  ASSERT_EQ(read.metrics.size(), 2U);
  for (std::size_t i = 0; i < 2; ++i) {
    const MetricResult& metric = read.metrics[i];
    SCOPED_TRACE(metric.lighting.name());
    EXPECT_EQ(metric.lighting, result.metrics[i].lighting);
    EXPECT_EQ(metric.combined.gram, result.metrics[i].combined.gram);
    EXPECT_EQ(metric.combined.distance, result.metrics[i].combined.distance);
    EXPECT_EQ(metric.combined.distance_error, result.metrics[i].combined.distance_error);
    EXPECT_EQ(metric.combined.norm, result.metrics[i].combined.norm);
    EXPECT_EQ(metric.combined.norm_error, result.metrics[i].combined.norm_error);
    ASSERT_EQ(metric.channels.size(), 2U);
    EXPECT_EQ(metric.channels[1].norm, result.metrics[i].channels[1].norm);
    EXPECT_EQ(metric.unresolved.size(), result.metrics[i].unresolved.size());
    EXPECT_EQ(read.embeddings[i].coordinates, result.embeddings[i].coordinates);
    EXPECT_EQ(read.embeddings[i].explained_share, result.embeddings[i].explained_share);
    EXPECT_EQ(read.residuals[2 * i + 1].relative_residual, result.residuals[2 * i + 1].relative_residual);
    EXPECT_EQ(read.residuals[2 * i + 1].rank, result.residuals[2 * i + 1].rank);
    EXPECT_TRUE(read.residuals[2 * i + 1].non_negative);
  }
  EXPECT_EQ(read.metrics[0].unresolved[1].first, 1U);
  ASSERT_EQ(read.comparisons.size(), 2U);
  EXPECT_EQ(read.comparisons[0].metric, LiteratureMetric::ngan_l2);
  EXPECT_EQ(read.comparisons[0].combined.distance, result.comparisons[0].combined.distance);
  EXPECT_EQ(read.comparisons[0].combined.size, result.comparisons[0].combined.size);
}

TEST_F(StudyResultsTest, HaveTheTreeTheMedoidsAndTheNeighbours) {
  const StudyResult result = synthetic_study();
  const StudyResult read = written_and_read(result);
  const Clustering& found = read.clusterings[0];
  const Clustering& expected = result.clusterings[0];
  ASSERT_EQ(found.tree.merges.size(), expected.tree.merges.size());
  for (std::size_t i = 0; i < found.tree.merges.size(); ++i) {
    EXPECT_EQ(found.tree.merges[i].first, expected.tree.merges[i].first) << i;
    EXPECT_EQ(found.tree.merges[i].second, expected.tree.merges[i].second) << i;
    EXPECT_EQ(found.tree.merges[i].size, expected.tree.merges[i].size) << i;
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
  const StudyResult read = written_and_read(result);
  EXPECT_EQ(read.curve_angles.theta_out, result.curve_angles.theta_out);
  ASSERT_EQ(read.curves.size(), result.curves.size());
  for (std::size_t i = 0; i < read.curves.size(); ++i) {
    EXPECT_EQ(read.curves[i].has_delta, result.curves[i].has_delta) << i;
    expect_equal(read.curves[i].albedo[1][2], result.curves[i].albedo[1][2]);
    expect_equal(read.curves[i].reflectance[1][0][3], result.curves[i].reflectance[1][0][3]);
    expect_equal(read.curves[i].reflectance[0][1][2], result.curves[i].reflectance[0][1][2]);
  }
}

TEST_F(StudyResultsTest, GiveMaterialsOfOneChannelAllChannels) {
  StudyResult result = synthetic_study();
  result.curves[2].albedo.resize(1);
  result.curves[2].reflectance.resize(1);
  const StudyResult read = written_and_read(result);
  expect_equal(read.curves[2].albedo[1][0], result.curves[2].albedo[0][0]);
}

TEST_F(StudyResultsTest, KnowHowTheyCameAbout) {
  const StudyResult read = written_and_read(synthetic_study());
  EXPECT_EQ(read.provenance.command_line, kCommandLine);
  EXPECT_EQ(read.provenance.created, kCreated);
  EXPECT_EQ(read.study.configuration, "[study]\nname = \"synthetic\"\n");
  EXPECT_EQ(read.device.name, "Made-up device");
  EXPECT_EQ(read.study.precision, Precision::double_precision);
  EXPECT_EQ(read.study.tolerance, 1e-6);
  EXPECT_TRUE(read.provenance.states_grid);
  EXPECT_FALSE(read.study.grid.has_value());
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
  const StudyResult read = written_and_read(with_origins());
  EXPECT_EQ(to_string(read.study.origins.materials[1]), "sub/a.toml:2");
  EXPECT_EQ(read.study.origins.materials[1].line, 2U);
  EXPECT_EQ(to_string(read.study.origins.materials[2]), "sub/a.toml:3 (m=0.1), --set family.Ward.m");
  EXPECT_EQ(read.study.origins.materials[2].overrides, std::vector<std::string>{"family.Ward.m"});
  EXPECT_EQ(to_string(read.study.origins.lightings[0]), "default");
  EXPECT_EQ(to_string(read.study.origins.comparison_metrics[1]), "main.toml:7");
  ASSERT_EQ(read.study.texts.size(), 2U);
  EXPECT_EQ(read.study.texts[1].name, "sub/a.toml");
  EXPECT_EQ(read.study.texts[1].text, "# text\n");
  EXPECT_EQ(read.study.overrides, std::vector<std::string>{"family.Ward.m=0.1"});

  const StudyResult summary = load_study_summary(path());
  EXPECT_EQ(to_string(summary.study.origins.materials[2]), to_string(read.study.origins.materials[2]));
  EXPECT_EQ(summary.study.comparison_metrics, read.study.comparison_metrics);
  EXPECT_TRUE(summary.metrics.empty());
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
  const StudyResult read = load_study_results(path());
  EXPECT_TRUE(read.study.origins.materials.empty());
  EXPECT_TRUE(read.study.origins.lightings.empty());
  EXPECT_TRUE(read.study.origins.comparison_metrics.empty());
  EXPECT_TRUE(read.study.texts.empty());
  EXPECT_TRUE(read.study.overrides.empty());
  EXPECT_EQ(read.metrics[0].combined.distance, result.metrics[0].combined.distance);
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
  const StudyResult summary = load_study_summary(path());
  EXPECT_EQ(summary.study.title, "figures");
  EXPECT_TRUE(summary.study.materials.empty());
  write_text(path(), true, "no HDF5");
  EXPECT_FALSE(is_study_results(path()));
}

TEST_F(StudyResultsTest, ExistOfASingleMaterialInAFamily) {
  const StudyResult read = written_and_read(synthetic_study(1));
  EXPECT_EQ(read.study.materials.size(), 2U);
  EXPECT_EQ(read.clusterings[0].tree.merges.size(), 1U);
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
  const StudyResult read = load_study_results(path());
  EXPECT_EQ(read.metrics[1].lighting, Lighting::daylight());
  EXPECT_FALSE(read.provenance.states_grid);
}

TEST_F(StudyResultsTest, KnowTabulatedLightingsByNameAlone) {
  StudyResult result = synthetic_study();
  result.metrics[0].lighting = result.study.lightings[0] = Lighting::recorded("table:w.h5", "f.g = something");
  const StudyResult read = written_and_read(result);
  EXPECT_EQ(read.study.lightings[0].name(), "table:w.h5");
  EXPECT_EQ(read.study.lightings[0].definition(), "f.g = something");
  EXPECT_EQ(read.metrics[0].combined.distance, result.metrics[0].combined.distance);
  try {
    (void)read.study.lightings[0].table();
    FAIL() << "not refused";
  } catch (const ArgumentError& error) {
    EXPECT_STREQ(error.what(), "lighting 'table:w.h5' is known by name alone; expected its table");
  }
}

TEST_F(StudyResultsTest, KeepFormulasWithUnknownModelsAsTheyAre) {
  StudyResult result = synthetic_study();
  result.files.resize(6);
  result.files[2] = R"({"name":"x","family":"Phong","terms":[{"model":"of tomorrow"}]})";
  const StudyResult read = written_and_read(result);
  EXPECT_EQ(read.study.materials[2].name(), result.study.materials[2].name());
  EXPECT_EQ(read.study.materials[2].formula(), nullptr);
  EXPECT_EQ(read.files[2], result.files[2]);
  EXPECT_EQ(read.study.materials[2].file(), nullptr);
}

/// Origins as studies state them.
class OriginTexts : public ::testing::TestWithParam<Origin> {};

TEST_P(OriginTexts, AreReadAsTheyWereWritten) {
  const Origin& origin = GetParam();
  const Origin read = read_origin(to_string(origin));
  EXPECT_EQ(read.file, origin.file);
  EXPECT_EQ(read.line, origin.line);
  EXPECT_EQ(read.swept, origin.swept);
  EXPECT_EQ(read.overrides, origin.overrides);
}

INSTANTIATE_TEST_SUITE_P(study, OriginTexts,
                         ::testing::Values(Origin{}, Origin{"a.toml", 3, "", {}}, Origin{"a:1 (b).toml", 12, "", {}},
                                           Origin{"a (b:2.toml", 7, "m=0.1, scale=(1)", {"family.a.m", "study.x"}},
                                           Origin{"", 0, "", {"study.tolerance"}}, Origin{"", 0, "m=1", {"a", "b"}},
                                           Origin{"no line", 0, "", {}}));

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

TEST_F(StudyResultsTest, RefuseMetricsThatThisVersionDoesNotKnow) {
  write_changed(synthetic_study(), [](hid_t file) {
    H5Lmove(file, "/comparison/ngan-l2", file, "/comparison/tomorrow", H5P_DEFAULT, H5P_DEFAULT);
  });
  EXPECT_THAT(refusal(), HasSubstr("/comparison/tomorrow: unknown comparison metric 'tomorrow'"));
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
    EXPECT_GT(at, 9 * image.size() / 10) << at;
    EXPECT_EQ(load_study_results(path()).metrics[0].combined.distance, result.metrics[0].combined.distance) << at;
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
