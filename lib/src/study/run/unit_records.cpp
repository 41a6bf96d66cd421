#include "study/run/unit_records.hpp"

#include <Eigen/Core>
#include <bit>
#include <cstdint>
#include <type_traits>

#include "metric/products.hpp"
#include "study/run/record_stream.hpp"

namespace lobe {
namespace {

// take_item() takes a value of any of these types, for writing (of a const object) and reading.

template <typename Value, typename Type>
concept ItemOf = std::same_as<std::remove_const_t<Value>, Type>;

void take_item(RecordWriter& writer, std::uint64_t number) {
  writer.take(number);
}
void take_item(RecordReader& reader, std::uint64_t& number) {
  reader.take(number);
}
void take_item(RecordWriter& writer, double number) {
  writer.take(number);
}
void take_item(RecordReader& reader, double& number) {
  reader.take(number);
}
void take_item(RecordWriter& writer, const std::string& text) {
  writer.take(std::string_view(text));
}
void take_item(RecordReader& reader, std::string& text) {
  std::string_view found;
  reader.take(found);
  text = found;
}
void take_item(RecordWriter& writer, bool flag) {
  writer.take(std::uint64_t{flag});
}
void take_item(RecordReader& reader, bool& flag) {
  std::uint64_t number = 0;
  reader.take(number);
  if (number > 1) reader.fail();
  flag = number != 0;
}
void take_item(RecordWriter& writer, int number) {
  writer.take(static_cast<std::uint64_t>(number));
}
void take_item(RecordReader& reader, int& number) {
  std::uint64_t found = 0;
  reader.take(found);
  constexpr std::uint64_t kMost = 1000;
  if (found > kMost) reader.fail();
  number = static_cast<int>(found);
}

/// Whether the two triangles of a matrix have the same bits.
bool has_equal_triangles(const Eigen::MatrixXd& matrix) {
  if (matrix.rows() != matrix.cols()) return false;
  for (Eigen::Index j = 0; j < matrix.cols(); ++j) {
    for (Eigen::Index i = 0; i < j; ++i) {
      if (std::bit_cast<std::uint64_t>(matrix(i, j)) != std::bit_cast<std::uint64_t>(matrix(j, i))) return false;
    }
  }
  return true;
}

/// Of products, which are symmetric to the last bit, one triangle.
void take_item(RecordWriter& writer, const Eigen::MatrixXd& matrix) {
  const bool is_triangle = has_equal_triangles(matrix);
  take_item(writer, is_triangle);
  if (!is_triangle) return writer.take(matrix);
  Eigen::VectorXd triangle(matrix.cols() * (matrix.cols() + 1) / 2);
  Eigen::Index at = 0;
  for (Eigen::Index j = 0; j < matrix.cols(); ++j) {
    for (Eigen::Index i = 0; i <= j; ++i) triangle(at++) = matrix(i, j);
  }
  writer.take(std::uint64_t(matrix.cols()));
  writer.take_all(triangle);
}

void take_item(RecordReader& reader, Eigen::MatrixXd& matrix) {
  bool is_triangle = false;
  take_item(reader, is_triangle);
  if (!is_triangle) return reader.take(matrix);
  std::uint64_t size = 0;
  reader.take(size);
  constexpr std::uint64_t kMost = std::uint64_t{1} << 20U;
  if (size > kMost || size * (size + 1) / 2 * sizeof(double) > reader.left()) return reader.fail();
  const auto n = static_cast<Eigen::Index>(size);
  Eigen::VectorXd triangle(n * (n + 1) / 2);
  reader.take_all(triangle);
  matrix.resize(n, n);
  Eigen::Index at = 0;
  for (Eigen::Index j = 0; j < n; ++j) {
    for (Eigen::Index i = 0; i <= j; ++i) matrix(i, j) = matrix(j, i) = triangle(at++);
  }
}

void take_item(auto& stream, ItemOf<Estimate> auto& estimate) {
  take_item(stream, estimate.value);
  take_item(stream, estimate.error);
}

void take_item(auto& stream, ItemOf<MissedTolerance> auto& missed) {
  take_item(stream, missed.quantity);
  take_item(stream, missed.index);
  take_item(stream, missed.relative_error);
  take_item(stream, missed.tolerance);
}

void take_item(auto& stream, ItemOf<ComparisonIntegrals> auto& integrals) {
  take_item(stream, integrals.value);
  take_item(stream, integrals.error);
}

template <typename Item>
void take_item(RecordWriter& writer, const std::vector<Item>& items) {
  writer.take(std::uint64_t(items.size()));
  for (const auto& item : items) take_item(writer, item);
}

template <typename Item>
void take_item(RecordReader& reader, std::vector<Item>& items) {
  std::uint64_t left = 0;
  items.clear();
  for (reader.take(left); left > 0 && reader.is_good(); --left) take_item(reader, items.emplace_back());
}

void take_item(auto& stream, ItemOf<RefinedSlab> auto& slab) {
  take_item(stream, slab.levels);
  take_item(stream, slab.level);
  take_item(stream, slab.difference);
  take_item(stream, slab.nodes);
  take_item(stream, slab.evaluations);
}

void take_item(auto& stream, ItemOf<TileIntegrals> auto& tile) {
  take_item(stream, tile.channels);
  take_item(stream, tile.nodes);
  take_item(stream, tile.evaluations);
}

void take_item(auto& stream, ItemOf<MaterialCurves> auto& curves) {
  take_item(stream, curves.albedo);
  take_item(stream, curves.reflectance);
  take_item(stream, curves.has_delta);
}

void take_item(auto& stream, ItemOf<PublishedCheck> auto& check) {
  take_item(stream, check.value);
  take_item(stream, check.deviation);
  take_item(stream, check.agrees);
  take_item(stream, check.is_as_expected);
}

void take_item(auto& stream, ItemOf<ChartCurveValues> auto& curve) {
  take_item(stream, curve.values);
  take_item(stream, curve.missed);
}

std::string text_of_unit(const auto& value) {
  RecordWriter writer;
  take_item(writer, value);
  return writer.text();
}

bool read_whole(std::string_view content, auto& value) {
  RecordReader reader(content);
  take_item(reader, value);
  return reader.is_good() && reader.left() == 0;
}

}  // namespace

std::string written_unit(const RefinedSlab& slab) {
  return text_of_unit(slab);
}

std::string written_unit(const TileIntegrals& tile) {
  return text_of_unit(tile);
}

std::string written_unit(const MaterialCurves& curves) {
  return text_of_unit(curves);
}

std::string written_unit(const PublishedCheck& check) {
  return text_of_unit(check);
}

std::string written_unit(const ChartCurveValues& curve) {
  return text_of_unit(curve);
}

bool read_unit(std::string_view content, RefinedSlab& slab) {
  return read_whole(content, slab) && slab.levels.size() >= 2 && slab.levels.size() <= kLevelsKept;
}

bool read_unit(std::string_view content, TileIntegrals& tile) {
  return read_whole(content, tile) && !tile.channels.empty();
}

bool read_unit(std::string_view content, MaterialCurves& curves) {
  return read_whole(content, curves);
}

bool read_unit(std::string_view content, PublishedCheck& check) {
  return read_whole(content, check);
}

bool read_unit(std::string_view content, ChartCurveValues& curve) {
  return read_whole(content, curve);
}

}  // namespace lobe
