#pragma once

#include <Eigen/Core>
#include <Eigen/SparseCore>
#include <cstddef>
#include <span>
#include <vector>

#include "device/evaluate_lobes.hpp"

namespace lobe {

/// Maps of scale * f at a node (kernels/products/map_materials.cl).
enum class NodeMap {
  linear,        ///< x
  log,           ///< ln(1 + x)
  cube_root,     ///< x^(1/3), negative for negative x
  cube_root_log  ///< ln(1 + x^(1/3))
};

/// Terms of the difference between two mapped values (kernels/products/accumulate_pairs.cl).
enum class PairTerm {
  square,     ///< d^2
  absolute,   ///< |d|
  two_thirds  ///< |d|^(2/3), to 2e-7
};

/// Names of the two kernels of a PairAccumulator in self-tests.
[[nodiscard]] std::string pair_kernel_name(NodeMap map, PairTerm term);

/// Sums over nodes, for pairs of rows, of weight * term(map(scale f_i) - map(scale f_j)), rows being mixtures of the
/// evaluator's lobes. Double precision but for the power 2/3.
class PairAccumulator {
 public:
  /// \param mix rows x lobes, one matrix per channel, all of one size: rows of different channels are not compared
  /// \param split 0: all rows are compared with each other; else those before this one with the others
  PairAccumulator(const LobeEvaluator& evaluator, const std::vector<Eigen::SparseMatrix<double, Eigen::RowMajor>>& mix,
                  NodeMap map, PairTerm term, std::size_t split = 0);

  /// Adds the evaluator's current values, taken with factor 1, at as many nodes as there are scales and weights, which
  /// are not negative.
  void add(std::span<const double> scale, std::span<const double> weight);

  /// The sums so far, for each channel; then zero again. Symmetric rows x rows, or rows before the split x the others.
  [[nodiscard]] std::vector<Eigen::MatrixXd> take();

 private:
  [[nodiscard]] bool is_split() const { return split_ > 0; }
  /// Packs in the rows of the sums of a channel.
  [[nodiscard]] std::size_t sum_rows() const { return is_split() ? left_packs_ : packs_; }
  /// Packs in their columns.
  [[nodiscard]] std::size_t sum_columns() const { return packs_ - left_packs_; }

  const LobeEvaluator& evaluator_;
  PairTerm term_;
  std::size_t channels_;
  std::size_t rows_;
  std::size_t split_;
  std::size_t left_packs_;  ///< packs of the rows before the split
  std::size_t packs_;       ///< packs in the rows of a channel
  cl::Kernel map_kernel_;
  cl::Kernel pair_kernel_;
  cl::Buffer first_term_;
  cl::Buffer term_place_;
  cl::Buffer term_weight_;
  cl::Buffer scale_;
  cl::Buffer factor_;
  cl::Buffer mapped_;
  cl::Buffer sums_;
};

}  // namespace lobe
