#pragma once

#include <Eigen/Core>
#include <cstddef>

#include "device/evaluate_lobes.hpp"
#include "device/packed_rows.hpp"

namespace lobe {

/// Sums products of values over nodes: gram += S S^T, for a range of rows. Double precision throughout.
class GramAccumulator {
 public:
  /// [first_row, first_row + rows) must be whole packs.
  GramAccumulator(const Device& device, const PackedRows& values, std::size_t first_row, std::size_t rows);
  /// Accumulates products of the evaluator's padded lobes.
  GramAccumulator(const LobeEvaluator& evaluator, std::size_t first_row, std::size_t rows);

  /// Adds the products of the current values at the first `nodes` nodes.
  void add(std::size_t nodes);

  /// The sums so far as rows x rows of the values, then zero again. Only entries on and right of the diagonal of the
  /// whole matrix are meant.
  [[nodiscard]] Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor> take();

 private:
  Device device_;
  PackedRows values_;
  std::size_t first_row_;
  std::size_t rows_;
  cl::Kernel kernel_;
  cl::Buffer gram_;
};

}  // namespace lobe
