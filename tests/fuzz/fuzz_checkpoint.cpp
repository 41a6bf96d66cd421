#include "fuzz/fuzz_checkpoint.hpp"

#include <cstdio>
#include <cstdlib>
#include <string_view>

#include "study/run/checkpoint_records.hpp"

namespace lobe::test {
namespace {

constexpr std::size_t kMaterials = 2;
constexpr std::string_view kIdentity = "a study";
constexpr std::string_view kMetric = "lighting point";
constexpr std::string_view kLiterature = "comparison cube-root";

[[noreturn]] void fail(std::string_view what) {
  std::fprintf(stderr, "lobe_fuzz: a checkpoint: %.*s\n", static_cast<int>(what.size()), what.data());
  std::abort();
}

void expect_square(const Eigen::MatrixXd& matrix) {
  if (matrix.rows() != kMaterials || matrix.cols() != kMaterials) fail("a matrix of other materials");
}

void expect_sizes(const Metric& metric) {
  for (const Eigen::MatrixXd& matrix : {metric.gram, metric.gram_error, metric.distance, metric.distance_error}) {
    expect_square(matrix);
  }
  if (metric.norm.size() != kMaterials || metric.norm_error.size() != kMaterials) fail("norms of other materials");
}

void expect_sizes(const LiteratureMatrix& matrix) {
  expect_square(matrix.distance);
  expect_square(matrix.distance_error);
  if (matrix.size.size() != kMaterials || matrix.size_error.size() != kMaterials) fail("sizes of other materials");
}

template <typename Result>
void expect_sound(std::string_view content, Result result) {
  if (!read_result(content, result)) fail("a result that cannot be read is kept");
  expect_sizes(result.combined);
  for (const auto& channel : result.channels) expect_sizes(channel);
  for (const Unresolved& pair : result.unresolved) {
    if (pair.first >= kMaterials || pair.second >= kMaterials) fail("a pair of other materials");
  }
  if (written_result(result) != content) fail("a result is written as something else");
}

Metric metric_of(double value) {
  const Eigen::MatrixXd matrix = Eigen::MatrixXd::Constant(kMaterials, kMaterials, value);
  return {matrix, matrix, matrix.col(0), matrix.col(0), matrix, matrix};
}

}  // namespace

std::vector<std::string> checkpoint_seeds() {
  const MetricResult metric{.lighting = Lighting::point(),
                            .combined = metric_of(1),
                            .channels = {metric_of(0.5), metric_of(2)},
                            .unresolved = {{0, 1, 1e-3}},
                            .work = {},
                            .route = Route::tables,
                            .grid = HemisphereGrid::gauss(4, 8),
                            .coarse = {1}};
  const Eigen::MatrixXd matrix = Eigen::MatrixXd::Identity(kMaterials, kMaterials);
  const LiteratureResult literature{.metric = LiteratureMetric::cube_root,
                                    .combined = {matrix, matrix, matrix.col(0), matrix.col(0)},
                                    .channels = {},
                                    .unresolved = {},
                                    .work = {}};
  const std::string of_metric = written_result(metric);
  const std::string of_literature = written_result(literature);
  const std::string records = checkpoint_record(kMetric, of_metric) + checkpoint_record(kLiterature, of_literature);
  return {std::string(1, '\0') + checkpoint_head(kIdentity) + records, "\1" + records, "\2" + of_metric,
          "\2" + of_literature};
}

void fuzz_checkpoint(std::span<const std::uint8_t> data) {
  const std::string_view bytes(reinterpret_cast<const char*>(data.data()), data.size());
  if (bytes.empty()) return;
  const std::string rest(bytes.substr(1));
  std::string text = rest;
  if (bytes[0] == 1) text = checkpoint_head(kIdentity) + rest;
  if (bytes[0] > 1 || bytes[0] < 0) {
    text = checkpoint_head(kIdentity) + checkpoint_record(kMetric, rest) + checkpoint_record(kLiterature, rest);
  }
  CheckpointRecords found = read_checkpoint(text, kIdentity);
  if (found.sound_bytes > text.size()) fail("more than all of it is sound");
  if ((bytes[0] > 1 || bytes[0] < 0) && found.contents.size() != 2) fail("a record is lost");
  keep_results_of(kMaterials, found);
  for (const auto& [name, content] : found.contents) {
    if (name.starts_with("comparison")) {
      expect_sound(content,
                   LiteratureResult{.metric = {}, .combined = {}, .channels = {}, .unresolved = {}, .work = {}});
    } else {
      expect_sound(
          content,
          MetricResult{.lighting = Lighting::point(), .combined = {}, .channels = {}, .unresolved = {}, .work = {}});
    }
  }
}

}  // namespace lobe::test
