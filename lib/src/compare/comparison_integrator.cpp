#include "compare/comparison_integrator.hpp"

#include <algorithm>
#include <numbers>

#include "device/evaluate_lobes.hpp"

namespace lobe {
namespace {

using Mix = std::vector<Eigen::SparseMatrix<double, Eigen::RowMajor>>;

/// With black, f = 0, as one more material.
Mix with_black(Mix mix) {
  for (auto& channel : mix) channel.conservativeResize(channel.rows() + 1, channel.cols());
  return mix;
}

}  // namespace

ComparisonIntegrator::ComparisonIntegrator(const Device& device, const LobeSet& lobes, std::size_t split,
                                           LiteratureMetric comparison, const LiteratureOptions& options,
                                           WorkDone& work)
    : comparison_(comparison),
      recipe_(recipe_of(comparison)),
      is_triangle_(split == 0),
      half_difference_(lobes.extent()),
      angles_(lobes.extent(), options.theta_max),
      evaluator_(device, lobes.batches, options.precision,
                 LobeEvaluator::suggested_capacity(std::max(
                     lobes.lobes(), lobes.channels() * static_cast<std::size_t>(lobes.mix.front().rows() + 1)))),
      pairs_(evaluator_, is_triangle_ ? with_black(lobes.mix) : lobes.mix, recipe_.map, recipe_.term, split),
      placed_(evaluator_.node_stride()),
      sampled_(evaluator_.node_stride()),
      work_(work) {
  if (!recipe_.is_mean) return;
  volume_ = recipe_.domain == ComparisonDomain::angles ? 2 * std::numbers::pi * options.theta_max * options.theta_max
                                                       : volume_of_half_differences();
}

std::size_t ComparisonIntegrator::slabs() const {
  return recipe_.domain == ComparisonDomain::angles ? angles_.slabs() : half_difference_.slabs();
}

std::vector<Eigen::MatrixXd> ComparisonIntegrator::gauss(std::size_t slab, int nodes_per_panel) {
  watch_.lap();
  const auto flush = [this] { add_block(); };
  if (recipe_.domain == ComparisonDomain::angles) {
    angles_.place(slab, nodes_per_panel, placed_, flush);
  } else {
    half_difference_.place_gauss(slab, nodes_per_panel, placed_, flush);
  }
  auto sums = pairs_.take();
  for (auto& sum : sums) sum /= volume_;
  work_.seconds_gram += watch_.lap();
  return sums;
}

NodeBlock::Node ComparisonIntegrator::node(std::size_t k) const {
  NodeBlock::Node node;
  for (std::size_t row = 0; row < NodeBlock::kRows; ++row) node[row] = placed_.data()[row * placed_.capacity() + k];
  return node;
}

/// Measure of the comparison's domain that a placed node stands for.
double ComparisonIntegrator::measure(const NodeBlock::Node& node) const {
  const double factor = node[NodeBlock::factor];
  switch (recipe_.domain) {
    case ComparisonDomain::angles:
      return factor;
    case ComparisonDomain::half_difference:
      return factor * factor * half_difference_density(node);
    case ComparisonDomain::projected:
      break;
  }
  return factor * factor;
}

double ComparisonIntegrator::volume_of_half_differences() {
  constexpr int kNodesOfVolume = 8;
  double volume = 0;
  for (std::size_t slab = 0; slab < slabs(); ++slab) {
    half_difference_.place_gauss(slab, kNodesOfVolume, placed_, [&] {
      for (std::size_t k = 0; k < placed_.size(); ++k) volume += measure(node(k));
      placed_.clear();
    });
  }
  return volume;
}

void ComparisonIntegrator::add_block() {
  scale_.clear();
  weight_.clear();
  for (std::size_t k = 0; k < placed_.size(); ++k) {
    NodeBlock::Node at = node(k);
    const double cos_i = at[NodeBlock::cos_i];
    const double cos_o = at[NodeBlock::cos_o];
    scale_.push_back(scale_at(comparison_, cos_i, cos_o));
    weight_.push_back(weight_at(comparison_, cos_i, cos_o) * measure(at));
    at[NodeBlock::factor] = 1;
    sampled_.push(at);
  }
  placed_.clear();
  work_.seconds_nodes += watch_.lap();
  work_.nodes += sampled_.size();
  work_.evaluations += sampled_.size() * evaluator_.rows().size();
  evaluator_.evaluate(sampled_);
  finish(evaluator_.device());
  work_.seconds_values += watch_.lap();
  pairs_.add(scale_, weight_);
  finish(evaluator_.device());
  work_.seconds_gram += watch_.lap();
  sampled_.clear();
}

}  // namespace lobe
