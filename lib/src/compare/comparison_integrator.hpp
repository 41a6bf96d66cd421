#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <vector>

#include "compare/comparison_measure.hpp"
#include "core/stopwatch.hpp"
#include "device/accumulate_pairs.hpp"
#include "device/evaluate_lobes.hpp"
#include "hemisphere/angle_rule.hpp"
#include "hemisphere/half_difference_rule.hpp"
#include "lobe/compare/literature_metric.hpp"
#include "model/lobes.hpp"

namespace lobe {

/// Integrals of a comparison over pairs of materials: nodes on the host; samples, maps and differences of all pairs on
/// the device. Matrices are per channel, and those of a tile (TileIntegrals).
class ComparisonIntegrator {
 public:
  /// \param split 0: all materials are compared with each other and with black; else those before this one with the
  ///   others
  ComparisonIntegrator(const Device& device, const LobeSet& lobes, std::size_t split, LiteratureMetric comparison,
                       const LiteratureOptions& options, WorkDone& work);

  /// Whether all materials are compared with each other.
  [[nodiscard]] bool is_triangle() const { return is_triangle_; }
  [[nodiscard]] std::size_t slabs() const;

  /// A slab's share of the integrals, with so many Gauss nodes per panel and axis.
  [[nodiscard]] std::vector<Eigen::MatrixXd> gauss(std::size_t slab, int nodes_per_panel);

 private:
  [[nodiscard]] NodeBlock::Node node(std::size_t k) const;
  [[nodiscard]] double measure(const NodeBlock::Node& node) const;
  [[nodiscard]] double volume_of_half_differences();
  void add_block();

  LiteratureMetric comparison_;
  ComparisonRecipe recipe_;
  bool is_triangle_;
  HalfDifferenceRule half_difference_;
  AngleRule angles_;
  LobeEvaluator evaluator_;
  PairAccumulator pairs_;
  NodeBlock placed_;   ///< as the rule placed them, with its factors
  NodeBlock sampled_;  ///< the same with factor 1
  std::vector<double> scale_;
  std::vector<double> weight_;
  double volume_ = 1;
  WorkDone& work_;
  Stopwatch watch_;
};

}  // namespace lobe
