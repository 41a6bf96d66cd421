#include "study/run/checkpoint_records.hpp"

#include <fmt/format.h>

#include <Eigen/Core>
#include <algorithm>
#include <concepts>
#include <cstdint>
#include <string>
#include <type_traits>
#include <vector>

#include "core/checksum.hpp"
#include "lobe/core/error.hpp"
#include "lobe/hemisphere/grid.hpp"
#include "study/run/record_stream.hpp"

namespace lobe {
namespace {

// The file: the identity, then results in the order in which they came, each a record of its own: sizes of name and
// content, name, content, checksum. A record whose end is missing counts as not there.
constexpr std::string_view kMagic = "lobe-checkpoint/3\n";
constexpr std::string_view kOfLightings = "lighting ";      // begins the names of their results
constexpr std::string_view kOfComparisons = "comparison ";  // begins the names of theirs

// The members of each type, for writing (of a const object) and reading.
template <typename Value, typename Type>
concept Of = std::same_as<std::remove_const_t<Value>, Type>;

void take_fields(auto& stream, Of<Unresolved> auto& pair) {
  stream.take(pair.first);
  stream.take(pair.second);
  stream.take(pair.relative_error);
}

void take_fields(auto& stream, Of<WorkDone> auto& work) {
  stream.take(work.nodes);
  stream.take(work.evaluations);
  stream.take(work.seconds_nodes);
  stream.take(work.seconds_values);
  stream.take(work.seconds_gram);
  stream.take(work.seconds_host);
}

void take_fields(auto& stream, Of<Metric> auto& metric) {
  stream.take(metric.gram);
  stream.take(metric.gram_error);
  stream.take(metric.norm);
  stream.take(metric.norm_error);
  stream.take(metric.distance);
  stream.take(metric.distance_error);
}

void take_fields(auto& stream, Of<LiteratureMatrix> auto& matrix) {
  stream.take(matrix.distance);
  stream.take(matrix.distance_error);
  stream.take(matrix.size);
  stream.take(matrix.size_error);
}

void take_fields(auto& stream, Of<std::size_t> auto& index) {
  stream.take(index);
}

template <typename Item>
void take_list(RecordWriter& writer, const std::vector<Item>& items) {
  writer.take(items.size());
  for (const auto& item : items) take_fields(writer, item);
}

template <typename Item>
void take_list(RecordReader& reader, std::vector<Item>& items) {
  std::uint64_t left = 0;
  for (reader.take(left); left > 0 && reader.is_good(); --left) take_fields(reader, items.emplace_back());
}

void take_route(RecordWriter& writer, const auto& result) {
  writer.take(static_cast<std::uint64_t>(result.route));
  writer.take(result.grid ? result.grid->name() : std::string());
}

void take_route(RecordReader& reader, auto& result) {
  std::uint64_t route = 0;
  std::string_view grid;
  reader.take(route);
  reader.take(grid);
  if (route > static_cast<std::uint64_t>(Route::tables)) return reader.fail();
  result.route = static_cast<Route>(route);
  if (grid.empty()) return;
  try {
    result.grid = HemisphereGrid::parse(grid);
  } catch (const ArgumentError&) {
    return reader.fail();
  }
  if (result.grid->name() != grid) reader.fail();
}

void take_own_fields(auto& stream, Of<MetricResult> auto& result) {
  stream.take(result.tolerance);
  take_list(stream, result.coarse);
}

void take_own_fields(auto&, Of<LiteratureResult> auto&) {}

void take_result(auto& stream, auto& result) {
  take_fields(stream, result.combined);
  take_list(stream, result.channels);
  take_list(stream, result.unresolved);
  take_fields(stream, result.work);
  take_route(stream, result);
  take_own_fields(stream, result);
}

bool is_square(const Eigen::MatrixXd& matrix, std::size_t size) {
  const auto n = static_cast<Eigen::Index>(size);
  return matrix.rows() == n && matrix.cols() == n;
}

bool is_of(const Metric& metric, std::size_t materials) {
  const auto n = static_cast<Eigen::Index>(materials);
  return is_square(metric.gram, materials) && is_square(metric.gram_error, materials) && metric.norm.size() == n &&
         metric.norm_error.size() == n && is_square(metric.distance, materials) &&
         is_square(metric.distance_error, materials);
}

bool is_of(const LiteratureMatrix& matrix, std::size_t materials) {
  const auto n = static_cast<Eigen::Index>(materials);
  return is_square(matrix.distance, materials) && is_square(matrix.distance_error, materials) &&
         matrix.size.size() == n && matrix.size_error.size() == n;
}

std::string written(const auto& result) {
  RecordWriter writer;
  take_result(writer, result);
  return writer.text();
}

MetricResult result_of_nothing() {
  return {.lighting = Lighting::point(), .combined = {}, .channels = {}, .unresolved = {}, .work = {}};
}

std::size_t materials_of(const Metric& metric) {
  return static_cast<std::size_t>(metric.gram.rows());
}

std::size_t materials_of(const LiteratureMatrix& matrix) {
  return static_cast<std::size_t>(matrix.distance.rows());
}

bool has_known_places(const MetricResult& result, std::size_t materials) {
  return std::ranges::all_of(result.coarse, [&](std::size_t i) { return i < materials && result.grid; });
}

bool has_known_places(const LiteratureResult&, std::size_t) {
  return true;
}

bool read(std::string_view content, auto& result) {
  RecordReader reader(content);
  take_result(reader, result);
  if (!reader.is_good() || reader.left() > 0) return false;
  const std::size_t materials = materials_of(result.combined);
  const auto is_known = [&](const auto& one) { return is_of(one, materials); };
  return has_known_places(result, materials) && is_known(result.combined) &&
         std::ranges::all_of(result.channels, is_known) &&
         std::ranges::all_of(result.unresolved,
                             [&](const Unresolved& pair) { return pair.first < materials && pair.second < materials; });
}

}  // namespace

std::uint64_t record_checksum(std::string_view name, std::string_view content) {
  Checksum sum;
  for (const std::string_view bytes : {name, std::string_view("\0", 1), content}) sum.add(bytes);
  return sum.value();
}

CheckpointRecords read_checkpoint(std::string_view text, std::string_view identity) {
  CheckpointRecords found;
  found.is_checkpoint = text.starts_with(kMagic);
  if (!found.is_checkpoint) return found;
  RecordReader reader(text.substr(kMagic.size()));
  std::string_view written_for;
  reader.take(written_for);
  found.is_ours = reader.is_good() && written_for == identity;
  if (!found.is_ours) return found;
  found.sound_bytes = text.size() - reader.left();
  while (reader.is_good() && reader.left() > 0) {
    std::string_view name;
    std::string_view content;
    std::uint64_t sum = 0;
    reader.take(name);
    reader.take(content);
    reader.take(sum);
    if (!reader.is_good() || sum != record_checksum(name, content)) break;
    found.contents.insert_or_assign(std::string(name), std::string(content));
    found.sound_bytes = text.size() - reader.left();
  }
  return found;
}

std::string checkpoint_head(std::string_view identity) {
  RecordWriter head;
  head.take(identity);
  return std::string(kMagic) + head.text();
}

std::string checkpoint_record(std::string_view name, std::string_view content) {
  RecordWriter writer;
  writer.take(name);
  writer.take(content);
  writer.take(record_checksum(name, content));
  return writer.text();
}

std::string record_name(const Lighting& lighting) {
  return fmt::format("{}{}", kOfLightings, lighting.name());
}

std::string record_name(LiteratureMetric comparison) {
  return fmt::format("{}{}", kOfComparisons, to_string(comparison));
}

std::string written_result(const MetricResult& result) {
  return written(result);
}

std::string written_result(const LiteratureResult& result) {
  return written(result);
}

bool read_result(std::string_view content, MetricResult& result) {
  return read(content, result);
}

bool read_result(std::string_view content, LiteratureResult& result) {
  return read(content, result);
}

void keep_results_of(std::size_t materials, CheckpointRecords& records) {
  const auto is_of_study = [&](const std::string& content, auto result) {
    return read(content, result) && materials_of(result.combined) == materials;
  };
  std::erase_if(records.contents, [&](const auto& record) {
    const auto& [name, content] = record;
    if (name.starts_with(kOfComparisons)) return !is_of_study(content, LiteratureResult{});
    return name.starts_with(kOfLightings) && !is_of_study(content, result_of_nothing());
  });
}

}  // namespace lobe
