#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <vector>

#include "device/evaluate_lobes.hpp"

namespace lobe {

/// Sums values over runs of nodes: one sum per lobe and segment (kernels/products/sum_segments.cl).
class SegmentAccumulator {
 public:
  SegmentAccumulator(const LobeEvaluator& evaluator, std::size_t segments);

  /// Adds the evaluator's current values: nodes starts[k] .. starts[k+1]-1 belong to segment first_segment + k.
  void add(const std::vector<unsigned>& starts, std::size_t first_segment);

  /// Padded lobes x segments, then zero again.
  [[nodiscard]] Eigen::MatrixXd take();

 private:
  const LobeEvaluator& evaluator_;
  std::size_t segments_;
  cl::Kernel kernel_;
  cl::Buffer sums_;
};

}  // namespace lobe
