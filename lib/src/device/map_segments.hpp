#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "device/opencl.hpp"
#include "device/packed_rows.hpp"
#include "lobe/device/device.hpp"

namespace lobe {

/// One segment of a map of rows; the layout that kernels/products/map_segments.cl reads.
struct MapSegment {
  std::uint32_t source;   ///< first column read
  std::uint32_t step;     ///< from one column read to the next
  std::uint32_t count;    ///< columns read
  std::uint32_t target;   ///< first column written
  std::uint32_t columns;  ///< columns written
  std::uint32_t entry;    ///< of the table
  std::uint32_t stride;   ///< of the table, from row to row
};

/// Segments and their tables on the host: to[target + y] = sum over x of from[source + x step] table(x, y).
class SegmentTable {
 public:
  static constexpr std::size_t kTile = 8;  ///< columns that map_segments.cl takes at a time
  /// Columns of a table in memory.
  [[nodiscard]] static std::size_t padded(std::size_t columns);

  void clear();
  /// Appends a segment; its table is to be written, and starts with finite numbers.
  /// \return its number
  std::size_t add(std::size_t source, std::size_t step, std::size_t count, std::size_t target, std::size_t columns);

  /// Appends a segment with the first rows and columns of the table of an earlier one.
  void add_as(std::size_t segment, std::size_t source, std::size_t step, std::size_t count, std::size_t target,
              std::size_t columns);

  /// The table of a segment, count x padded(columns); good until the next add().
  [[nodiscard]] double* table(std::size_t segment) { return table_.data() + segments_[segment].entry; }
  [[nodiscard]] std::span<MapSegment> segments() { return segments_; }
  [[nodiscard]] std::span<double> table() { return {table_.data(), size_}; }

 private:
  std::vector<MapSegment> segments_;
  std::vector<double> table_;  ///< keeps its memory from use to use
  std::size_t size_ = 0;       ///< of what is in use
};

/// A SegmentTable as the device sees it: where it lies in memory.
struct DeviceSegments {
  cl::Buffer segments, table;
  std::size_t count = 0;
};

/// Applies linear maps to segments of packed rows (kernels/products/map_segments.cl).
class SegmentMap {
 public:
  /// \throws DeviceError
  explicit SegmentMap(const Device& device);

  /// \param table stays as it is until the device has finished
  [[nodiscard]] DeviceSegments place(SegmentTable& table) const;

  /// Writes the targets of all segments in the first `packs` packs. Returns before the device has finished.
  void apply(const PackedRows& from, const PackedRows& to, std::size_t packs, const DeviceSegments& segments);

 private:
  Device device_;
  cl::Kernel triples_, singles_;
};

}  // namespace lobe
