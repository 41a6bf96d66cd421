#include "device/map_segments.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <random>
#include <vector>

#include "device/buffers.hpp"
#include "support/device.hpp"

namespace lobe::test {
namespace {

/// Packed rows of random numbers, and the same on the host.
class Rows {
 public:
  Rows(std::size_t packs, std::size_t stride, unsigned seed) {
    const std::size_t width = device().implementation().pack_width;
    std::mt19937 generator(seed);
    std::uniform_real_distribution<double> uniform(-1, 1);
    values_.resize(packs * stride * width);
    for (double& value : values_) value = uniform(generator);
    rows_ = {make_workspace(device(), values_.size() * sizeof(double)), stride, packs, width};
    queue().enqueueWriteBuffer(rows_.values, CL_TRUE, 0, values_.size() * sizeof(double), values_.data());
  }

  [[nodiscard]] const PackedRows& on_device() const { return rows_; }
  [[nodiscard]] double at(std::size_t row, std::size_t column) const {
    const std::size_t width = rows_.width;
    return values_[(row / width * rows_.stride + column) * width + row % width];
  }
  void read() { queue().enqueueReadBuffer(rows_.values, CL_TRUE, 0, values_.size() * sizeof(double), values_.data()); }

 private:
  static cl::CommandQueue& queue() { return device().implementation().queue; }

  std::vector<double> values_;
  PackedRows rows_;
};

struct Segment {
  std::size_t source, step, count, target, columns;
};

TEST(SegmentMap, MapsEverySegmentByItsTableAndNothingElse) {
  constexpr std::size_t kPacks = 5;  // three at a time, and two one by one
  const Rows from(kPacks, 40, 1);
  Rows to(kPacks, 50, 2);
  const Rows before(kPacks, 50, 2);
  // With a step, with one column, with more columns than a tile, without any input.
  const std::vector<Segment> segments{{0, 1, 7, 3, 5}, {7, 3, 11, 8, 17}, {2, 1, 38, 30, 1}, {0, 1, 0, 40, 2}};
  SegmentTable table;
  std::mt19937 generator(3);
  std::uniform_real_distribution<double> uniform(-1, 1);
  for (const auto& [source, step, count, target, columns] : segments) {
    const std::size_t segment = table.add(source, step, count, target, columns);
    for (std::size_t x = 0; x < count; ++x) {
      for (std::size_t y = 0; y < columns; ++y)
        table.table(segment)[x * SegmentTable::padded(columns) + y] = uniform(generator);
    }
  }
  SegmentMap map(device());

  map.apply(from.on_device(), to.on_device(), kPacks, map.place(table));

  to.read();
  for (std::size_t row = 0; row < to.on_device().rows(); ++row) {
    std::vector<bool> is_written(50, false);
    for (std::size_t s = 0; s < segments.size(); ++s) {
      for (std::size_t y = 0; y < segments[s].columns; ++y) {
        double sum = 0;
        for (std::size_t x = 0; x < segments[s].count; ++x) {
          sum += from.at(row, segments[s].source + x * segments[s].step) *
                 table.table(s)[x * SegmentTable::padded(segments[s].columns) + y];
        }
        // At most 38 terms below 1, each rounded to eps/2 of a sum below 38.
        EXPECT_NEAR(to.at(row, segments[s].target + y), sum, 38 * 38 * 1.2e-16) << s << ", " << y;
        is_written[segments[s].target + y] = true;
      }
    }
    for (std::size_t column = 0; column < 50; ++column) {
      if (is_written[column]) continue;
      EXPECT_EQ(to.at(row, column), before.at(row, column)) << column;
    }
  }
}

TEST(SegmentMap, TakesTheFirstRowsAndColumnsOfAnotherSegmentsTable) {
  constexpr std::size_t kPacks = 3;
  const Rows from(kPacks, 12, 1);
  Rows to(kPacks, 40, 2);
  SegmentTable table;
  const std::size_t whole = table.add(0, 1, 6, 0, 19);
  std::mt19937 generator(3);
  std::uniform_real_distribution<double> uniform(-1, 1);
  for (double& entry : table.table()) entry = uniform(generator);
  table.add_as(whole, 1, 2, 5, 19, 10);
  SegmentMap map(device());

  map.apply(from.on_device(), to.on_device(), kPacks, map.place(table));

  to.read();
  for (std::size_t row = 0; row < to.on_device().rows(); ++row) {
    for (std::size_t y = 0; y < 10; ++y) {
      double sum = 0;
      for (std::size_t x = 0; x < 5; ++x) {
        sum += from.at(row, 1 + 2 * x) * table.table(whole)[x * SegmentTable::padded(19) + y];
      }
      // Five terms below 1.
      EXPECT_NEAR(to.at(row, 19 + y), sum, 5 * 5 * 1.2e-16) << y;
    }
  }
}

}  // namespace
}  // namespace lobe::test
