#pragma once

#include <cstddef>
#include <utility>
#include <vector>

#include "device/evaluate_lobes.hpp"
#include "device/packed_rows.hpp"

namespace lobe {

/// One sparse combination of rows.
struct Combination {
  std::vector<std::pair<std::size_t, double>> terms;
};

/// Sums the squares of combinations over nodes (kernels/products/accumulate_differences.cl).
class DifferenceAccumulator {
 public:
  DifferenceAccumulator(const Device& device, const PackedRows& values, const std::vector<Combination>& combinations);
  DifferenceAccumulator(const LobeEvaluator& evaluator, const std::vector<Combination>& combinations);
  void add(std::size_t nodes);
  [[nodiscard]] std::vector<double> take();

 private:
  Device device_;
  PackedRows values_;
  std::size_t count_;
  cl::Kernel kernel_;
  cl::Buffer first_term_;
  cl::Buffer term_lobe_;
  cl::Buffer term_weight_;
  cl::Buffer sums_;
};

}  // namespace lobe
