// Products under point light: half-difference quadrature, samples and Gram matrix on the device.
#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "core/stopwatch.hpp"
#include "device/accumulate_differences.hpp"
#include "device/accumulate_gram.hpp"
#include "device/rounding.hpp"
#include "hemisphere/half_difference_rule.hpp"
#include "hemisphere/refinement.hpp"
#include "lobe/core/error.hpp"
#include "metric/products.hpp"

namespace lobe {
namespace {

/// The device holds at most this much of the Gram matrix; more lobes are taken in blocks of rows.
constexpr std::size_t kLargestGramBytes = std::size_t{512} << 20;

/// Coarse products of this size in all are kept from the first pass; those of other slabs are computed again.
constexpr std::size_t kKeptBytes = std::size_t{256} << 20;

/// Share of the difference of levels at which a slab is done: fewer azimuths may change no product by more.
constexpr double kAzimuthShare = 0.1;

/// How many azimuths of H products need depends on how far the lobes' azimuths reach in the slab; their aspect is a
/// bound for all of them. A rule with few nodes on the other axes tells.
constexpr int kProbeNodes = 2;

class PointIntegrator {
 public:
  PointIntegrator(const Device& device, const LobeSet& lobes, const MetricOptions& options, WorkDone& work)
      : rule_(lobes.extent(), options.tolerance),
        evaluator_(device, lobes.batches, options.precision, LobeEvaluator::suggested_capacity(lobes.lobes())),
        block_(evaluator_.node_stride(), evaluator_.needs_tangents()),
        work_(work),
        azimuth_shares_(rule_.slabs()) {}

  /// Takes fewer azimuths of H where products differ by less than a share of this, relative to the norms.
  void set_goal(double goal) { goal_ = goal; }

  [[nodiscard]] std::size_t slabs() const { return rule_.slabs(); }

  /// Products of lobes over one slab, lobes x lobes, symmetric.
  Eigen::MatrixXd products(std::size_t slab, int level) {
    const double share = azimuth_share(slab);
    return sums([&](const auto& accumulate) { visit(slab, level, share, accumulate); });
  }

  /// Squared norms of combinations of lobes over one slab.
  std::vector<double> squares(std::size_t slab, int level, const std::vector<Combination>& combinations) {
    const double share = azimuth_share(slab);
    DifferenceAccumulator sums(evaluator_, combinations);
    visit(slab, level, share, [&] { sums.add(block_.size()); });
    return sums.take();
  }

  /// Padded row of a lobe.
  [[nodiscard]] std::size_t row(Eigen::Index lobe) const { return evaluator_.rows()[static_cast<std::size_t>(lobe)]; }

 private:
  /// Sums of products over the nodes that a call visits.
  template <typename Visit>
  Eigen::MatrixXd sums(const Visit& visit_nodes) {
    const std::size_t padded = evaluator_.padded_lobes();
    const std::size_t tile = std::max<std::size_t>(evaluator_.width(), 8);
    const std::size_t block_rows = std::max(kLargestGramBytes / (padded * sizeof(double)) / tile * tile, tile);
    const auto& rows = evaluator_.rows();
    const auto n = static_cast<Eigen::Index>(rows.size());
    Eigen::MatrixXd products(n, n);
    for (std::size_t first = 0; first < padded; first += block_rows) {
      const std::size_t count = std::min(block_rows, padded - first);
      GramAccumulator gram(evaluator_, first, count);
      visit_nodes([&] { gram.add(block_.size()); });
      const auto sums = gram.take();
      for (Eigen::Index i = 0; i < n; ++i) {
        const std::size_t row = rows[static_cast<std::size_t>(i)];
        if (row < first || row >= first + count) continue;
        for (Eigen::Index j = i; j < n; ++j) {
          products(i, j) = products(j, i) = sums(static_cast<Eigen::Index>(row - first),
                                                 static_cast<Eigen::Index>(rows[static_cast<std::size_t>(j)]));
        }
      }
      work_.seconds_host += watch_.lap();
    }
    return products;
  }

  /// Products by few nodes on the other axes.
  Eigen::MatrixXd probe(std::size_t slab, double share) {
    return sums([&](const auto& accumulate) {
      rule_.place_gauss(slab, kProbeNodes, rule_.azimuths(kNodesPerPanel.front(), share), block_, [&] {
        evaluator_.evaluate(block_);
        accumulate();
        finish(evaluator_.device());
        block_.clear();
      });
    });
  }

  /// Share of the azimuths that a slab's products need: the least that changes none of them by more than the goal
  /// allows.
  double azimuth_share(std::size_t slab) {
    if (!evaluator_.needs_tangents() || !rule_.has_equal_azimuths() || rule_.has_scattered_azimuths()) return 1;
    constexpr std::array kShares{0.125, 0.25, 0.35, 0.5, 0.7};
    std::optional<double>& known = azimuth_shares_[slab];
    if (known) return *known;
    if (norms_.size() == 0) {
      for (std::size_t k = 0; k < slabs(); ++k) {
        const Eigen::VectorXd squares = probe(k, kShares.front()).diagonal();
        norms_ = k == 0 ? squares : Eigen::VectorXd(norms_ + squares);
      }
      norms_ = norms_.cwiseMax(0).cwiseSqrt().eval();
    }
    const auto azimuths_of = [&](double share) { return rule_.azimuths(kNodesPerPanel.front(), share); };
    const Eigen::MatrixXd allowed = kAzimuthShare * goal_ * norms_ * norms_.transpose();
    Eigen::MatrixXd right;
    std::size_t tried = 0;
    for (const double share : kShares) {
      const std::size_t azimuths = azimuths_of(share);
      if (azimuths == tried || azimuths == azimuths_of(1)) continue;
      tried = azimuths;
      if (right.size() == 0) right = probe(slab, 1);
      const Eigen::ArrayXXd off = (probe(slab, share) - right).cwiseAbs();
      if (!(off <= allowed.array()).all()) continue;
      known = share;
      return share;
    }
    known = 1;
    return *known;
  }

  template <typename Accumulate>
  void visit(std::size_t slab, int level, double share, const Accumulate& accumulate) {
    watch_.lap();
    const auto take = [&] {
      work_.seconds_nodes += watch_.lap();
      work_.nodes += block_.size();
      work_.evaluations += block_.size() * evaluator_.rows().size();
      evaluator_.evaluate(block_);
      finish(evaluator_.device());
      work_.seconds_values += watch_.lap();
      accumulate();
      finish(evaluator_.device());
      work_.seconds_gram += watch_.lap();
      block_.clear();
    };
    rule_.place(slab, level, block_, take, share);
  }

  HalfDifferenceRule rule_;
  LobeEvaluator evaluator_;
  NodeBlock block_;
  WorkDone& work_;
  std::vector<std::optional<double>> azimuth_shares_;  ///< by slab, once they are known
  Eigen::VectorXd norms_;                              ///< of all lobes, roughly; empty: not known yet
  double goal_ = 0;
  Stopwatch watch_;
};

/// Pairs of materials whose squared distance is lost in the cancellation of products are integrated as differences.
void refine_close_pairs(PointIntegrator& integrator, const std::vector<int>& levels, const LobeSet& lobes,
                        const MetricOptions& options, ProductSums& sums) {
  // Above this share of the squared norms the cancellation costs less than six digits of the distance (or, in single
  // precision, than the samples' own errors).
  const double share = options.precision == Precision::double_precision ? 1e-6 : 3e-2;
  const auto pairs = find_close_pairs(sums, share);
  if (pairs.empty()) return;
  const auto rows = differences(lobes, pairs);
  std::vector<Combination> combinations(pairs.size());
  for (Eigen::Index e = 0; e < rows.rows(); ++e) {
    for (Eigen::SparseMatrix<double, Eigen::RowMajor>::InnerIterator term(rows, e); term; ++term) {
      combinations[static_cast<std::size_t>(e)].terms.emplace_back(integrator.row(term.col()), term.value());
    }
  }
  Eigen::VectorXd value = Eigen::VectorXd::Zero(rows.rows());
  Eigen::VectorXd error = value;
  for (std::size_t slab = 0; slab < levels.size(); ++slab) {
    const auto fine = integrator.squares(slab, levels[slab], combinations);
    const auto coarse = integrator.squares(slab, levels[slab] - 1, combinations);
    for (std::size_t e = 0; e < pairs.size(); ++e) {
      value(static_cast<Eigen::Index>(e)) += fine[e];
      error(static_cast<Eigen::Index>(e)) += std::abs(fine[e] - coarse[e]);
    }
    report_progress(options, Lighting::point(), 1);
  }
  replace_distances(sums, pairs, rows, value, error, product_rounding(options.precision) / 4);
}

/// Name of the first anisotropic lobe with an edge about the retro direction.
std::string retro_patch_name(const LobeSet& lobes) {
  std::size_t name = 0;
  for (std::size_t b = 0; !lobes.is_retro_patch[b]; ++b) name += lobes.batches[b].coefficients.size();
  return lobes.names[name];
}

}  // namespace

std::size_t point_slabs(const LobeSet& lobes, const MetricOptions& options) {
  return HalfDifferenceRule(lobes.extent(), options.tolerance).slabs();
}

void integrate_point_products(const Device& device, const LobeSet& lobes, const MetricOptions& options,
                              ProductSums& sums, WorkDone& work) {
  if (lobes.has_opposite_patches()) {
    throw NumericError("under point light '" + retro_patch_name(lobes) +
                       "' has no products beside anisotropic patches about the mirror direction or powers of norms "
                       "with kinks; 'daylight' and 'mean-albedo' take them together");
  }
  report_progress(options, Lighting::point(), 0);
  PointIntegrator integrator(device, lobes, options, work);
  const auto slabs = integrator.slabs();
  const SlabWork share(sums.slabs(), slabs);

  const double rounding = product_rounding(options.precision);
  const double goal = std::max(options.tolerance - 2 * rounding, rounding) / (level_safety(lobes) + kCommonShare) /
                      static_cast<double>(slabs);
  integrator.set_goal(goal);

  // A first, coarse pass gives the size of every product, against which errors are measured.
  const auto n = static_cast<Eigen::Index>(lobes.lobes());
  Eigen::MatrixXd reference = Eigen::MatrixXd::Zero(n, n);
  std::vector<Eigen::MatrixXd> coarse(std::min(slabs, kKeptBytes / (lobes.lobes() * lobes.lobes() * sizeof(double))));
  std::vector<WorkDone> first(slabs);
  for (std::size_t slab = 0; slab < slabs && share.has_unknown(); ++slab) {
    const WorkDone before = work;
    Eigen::MatrixXd products = integrator.products(slab, 0);
    first[slab] = share.first_pass(slab, before, work);
    reference += products;
    if (slab < coarse.size()) coarse[slab] = std::move(products);
  }
  require_finite(reference, lobes, Lighting::point());

  const auto refined_slab = [&](std::size_t slab) {
    const WorkDone before = work;
    RefinedSlab refined;
    auto& levels = refined.levels;
    levels.push_back(slab < coarse.size() ? std::move(coarse[slab]) : integrator.products(slab, 0));
    double change = 0;
    // Where profiles end as a fractional power two levels agree by accident; the change before tells.
    const int first_level = lobes.has_fractional_edge ? 2 : 1;
    for (int level = 1; level < most_levels(lobes); ++level) {
      levels.push_back(integrator.products(slab, level));
      require_finite(levels.back(), lobes, Lighting::point());
      if (levels.size() > kLevelsKept) levels.erase(levels.begin());
      refined.level = level;
      const double earlier = change;
      change = relative_difference(levels.back(), levels[levels.size() - 2], reference);
      refined.difference = std::max(change, kEarlierShare * earlier);
      if (level >= first_level && refined.difference <= goal) break;
    }
    const WorkDone spent = difference_of(work, before);
    refined.nodes = first[slab].nodes + spent.nodes;
    refined.evaluations = first[slab].evaluations + spent.evaluations;
    return refined;
  };
  double total_difference = 0;
  std::vector<int> levels(slabs);
  for (std::size_t slab = 0; slab < slabs; ++slab) {
    if (!share.takes(slab)) continue;
    const RefinedSlab refined = take_slab(share, slab, lobes.lobes(), work, refined_slab);
    report_progress(options, Lighting::point(), static_cast<double>(slab + 1) / static_cast<double>(slabs));
    if (!share.is_complete()) continue;
    levels[slab] = refined.level;
    total_difference += refined.difference;
    sums.add_lobe_products(refined.levels, level_safety(lobes));
  }
  if (!share.is_complete()) return;
  Stopwatch watch;
  for (auto& total : sums.totals()) {
    add_common_share(total_difference, total);
    total.gram_error += rounding * total.gram.cwiseAbs();
    const Eigen::VectorXd squares = rounding * total.gram.diagonal();
    total.squared_distance_error.colwise() += squares;
    total.squared_distance_error.rowwise() += squares.transpose();
  }
  work.seconds_host += watch.lap();
  refine_close_pairs(integrator, levels, lobes, options, sums);
}

}  // namespace lobe
