#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <utility>
#include <vector>

#include "device/packed_rows.hpp"
#include "device/sampler.hpp"

namespace lobe {

/// Sums products of samples over nodes: gram += S S^T, for a range of rows. Double precision throughout.
class GramAccumulator {
 public:
  /// [first_row, first_row + rows) must be whole packs.
  GramAccumulator(const Device& device, const PackedRows& samples, std::size_t first_row, std::size_t rows);
  /// Of the sampler's padded lobes.
  GramAccumulator(const Sampler& sampler, std::size_t first_row, std::size_t rows);

  /// Adds the products of the current samples at the first `nodes` nodes.
  void add(std::size_t nodes);

  /// The sums so far as rows x rows of the samples, then zero again. Only entries on and right of the diagonal of the
  /// whole matrix are meant.
  [[nodiscard]] Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor> take();

 private:
  Device device_;
  PackedRows samples_;
  std::size_t first_row_;
  std::size_t rows_;
  cl::Kernel kernel_;
  cl::Buffer gram_;
};

/// The sampler's current samples at the first `nodes` nodes: lobes (without padding) x nodes.
[[nodiscard]] Eigen::MatrixXd read_samples(const Sampler& sampler, std::size_t nodes);

/// Waits until the device has done all it was given.
void finish(const Device& device);

/// One sparse combination of rows.
struct Combination {
  std::vector<std::pair<std::size_t, double>> terms;
};

/// Sums the squares of combinations over nodes (kernels/accumulate_differences.cl).
class DifferenceAccumulator {
 public:
  DifferenceAccumulator(const Device& device, const PackedRows& samples, const std::vector<Combination>& combinations);
  DifferenceAccumulator(const Sampler& sampler, const std::vector<Combination>& combinations);
  void add(std::size_t nodes);
  [[nodiscard]] std::vector<double> take();

 private:
  Device device_;
  PackedRows samples_;
  std::size_t count_;
  cl::Kernel kernel_;
  cl::Buffer first_term_;
  cl::Buffer term_lobe_;
  cl::Buffer term_weight_;
  cl::Buffer sums_;
};

/// Sums samples over runs of nodes: one sum per lobe and segment (kernels/sum_segments.cl).
class SegmentAccumulator {
 public:
  SegmentAccumulator(const Sampler& sampler, std::size_t segments);

  /// Adds the sampler's current samples: nodes starts[k] .. starts[k+1]-1 belong to segment first_segment + k.
  void add(const std::vector<unsigned>& starts, std::size_t first_segment);

  /// Padded lobes x segments, then zero again.
  [[nodiscard]] Eigen::MatrixXd take();

 private:
  const Sampler& sampler_;
  std::size_t segments_;
  cl::Kernel kernel_;
  cl::Buffer sums_;
};

}  // namespace lobe
