// Products under point light: half-difference quadrature, samples and Gram matrix on the device.
#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <set>
#include <utility>
#include <variant>
#include <vector>

#include "core/stopwatch.hpp"
#include "device/accumulate_differences.hpp"
#include "device/accumulate_gram.hpp"
#include "device/rounding.hpp"
#include "hemisphere/half_difference_rule.hpp"
#include "hemisphere/opposite_patch_rule.hpp"
#include "hemisphere/refinement.hpp"
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

using PairRule = std::variant<HalfDifferenceRule, OppositePatchRule>;

std::size_t slabs_of(const PairRule& rule) {
  return std::visit([](const auto& known) { return known.slabs(); }, rule);
}

class PointIntegrator {
 public:
  PointIntegrator(const Device& device, const LobeSet& lobes, PairRule rule, const MetricOptions& options,
                  WorkDone& work)
      : rule_(std::move(rule)),
        evaluator_(device, lobes.batches, options.precision, LobeEvaluator::suggested_capacity(lobes.lobes())),
        block_(evaluator_.node_stride(), evaluator_.needs_tangents()),
        work_(work),
        azimuth_shares_(slabs_of(rule_)) {}

  /// Takes fewer azimuths of H where products differ by less than a share of this, relative to the norms.
  void set_goal(double goal) { goal_ = goal; }

  [[nodiscard]] std::size_t slabs() const { return slabs_of(rule_); }

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
  Eigen::MatrixXd probe(const HalfDifferenceRule& rule, std::size_t slab, double share) {
    return sums([&](const auto& accumulate) {
      rule.place_gauss(slab, kProbeNodes, rule.azimuths(kNodesPerPanel.front(), share), block_, [&] {
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
    const auto* rule = std::get_if<HalfDifferenceRule>(&rule_);
    if (rule == nullptr || !evaluator_.needs_tangents()) return 1;
    if (!rule->has_equal_azimuths() || rule->has_scattered_azimuths()) return 1;
    constexpr std::array kShares{0.125, 0.25, 0.35, 0.5, 0.7};
    std::optional<double>& known = azimuth_shares_[slab];
    if (known) return *known;
    if (norms_.size() == 0) {
      for (std::size_t k = 0; k < slabs(); ++k) {
        const Eigen::VectorXd squares = probe(*rule, k, kShares.front()).diagonal();
        norms_ = k == 0 ? squares : Eigen::VectorXd(norms_ + squares);
      }
      norms_ = norms_.cwiseMax(0).cwiseSqrt().eval();
    }
    const auto azimuths_of = [&](double share) { return rule->azimuths(kNodesPerPanel.front(), share); };
    const Eigen::MatrixXd allowed = kAzimuthShare * goal_ * norms_ * norms_.transpose();
    Eigen::MatrixXd right;
    std::size_t tried = 0;
    for (const double share : kShares) {
      const std::size_t azimuths = azimuths_of(share);
      if (azimuths == tried || azimuths == azimuths_of(1)) continue;
      tried = azimuths;
      if (right.size() == 0) right = probe(*rule, slab, 1);
      const Eigen::ArrayXXd off = (probe(*rule, slab, share) - right).cwiseAbs();
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
    if (const auto* rule = std::get_if<HalfDifferenceRule>(&rule_)) {
      rule->place(slab, level, block_, take, share);
    } else {
      std::get<OppositePatchRule>(rule_).place(slab, level, block_, take);
    }
  }

  PairRule rule_;
  LobeEvaluator evaluator_;
  NodeBlock block_;
  WorkDone& work_;
  std::vector<std::optional<double>> azimuth_shares_;  ///< by slab, once they are known
  Eigen::VectorXd norms_;                              ///< of all lobes, roughly; empty: not known yet
  double goal_ = 0;
  Stopwatch watch_;
};

/// Lobes that one rule takes together, and the products that are its own.
struct Part {
  enum class Pairs { all, with_retro_edge, across };

  std::vector<Eigen::Index> numbers;  ///< of the lobes, rising; none where they are all of the set
  LobeSet lobes;                      ///< these
  PairRule rule;
  Pairs pairs = Pairs::all;
};

/// The rules for a set of lobes: one knows anisotropic edges about one direction only. With edges about both, a second
/// one takes those about the retro direction and all lobes without any, and a third one the products across.
std::vector<Part> parts_of(const LobeSet& lobes, double tolerance) {
  std::vector<Part> parts;
  if (!lobes.has_opposite_patches()) {
    parts.push_back({{}, lobes, HalfDifferenceRule(lobes.extent(), tolerance)});
    return parts;
  }
  const auto select = [&](const auto& is_wanted) {
    std::vector<Eigen::Index> numbers;
    for (std::size_t k = 0; k < lobes.lobes(); ++k) {
      if (is_wanted(k)) numbers.push_back(static_cast<Eigen::Index>(k));
    }
    return numbers;
  };
  const auto part_of = [&](const std::vector<Eigen::Index>& numbers) {
    LobeSet part = lobes.selected(numbers);
    part.narrowest = part.narrowest_retro = 1;
    for (const std::size_t group : part.group_of_batch) {
      part.narrowest = std::min(part.narrowest, lobes.group_limits[group].narrowest);
      part.narrowest_retro = std::min(part.narrowest_retro, lobes.group_limits[group].narrowest_retro);
    }
    return part;
  };
  const auto add = [&](std::vector<Eigen::Index> numbers, LobeSet part, PairRule rule, Part::Pairs pairs) {
    parts.push_back({std::move(numbers), std::move(part), std::move(rule), pairs});
  };
  const auto about_mirror = select([&](std::size_t k) { return !lobes.has_retro_edge[k]; });
  LobeSet mirror = part_of(about_mirror);
  mirror.retro_patch_edges.clear();
  add(about_mirror, mirror, HalfDifferenceRule(mirror.extent(), tolerance), Part::Pairs::all);
  const auto about_retro = select([&](std::size_t k) { return !lobes.has_mirror_edge[k]; });
  LobeSet retro = part_of(about_retro);
  retro.patch_edges.clear();
  add(about_retro, retro, HalfDifferenceRule(retro.extent(), tolerance), Part::Pairs::with_retro_edge);
  const auto with_edges = select([&](std::size_t k) { return lobes.has_retro_edge[k] || lobes.has_mirror_edge[k]; });
  LobeSet across = part_of(with_edges);
  std::set<Kink> kinks;
  for (const std::size_t group : across.group_of_batch) {
    kinks.insert(lobes.group_limits[group].kinks.begin(), lobes.group_limits[group].kinks.end());
  }
  across.kinks.assign(kinks.begin(), kinks.end());
  add(with_edges, across, OppositePatchRule(across.extent()), Part::Pairs::across);
  return parts;
}

/// The integrators of all parts of a set, whose slabs come one after the other.
class JointIntegrator {
 public:
  JointIntegrator(const Device& device, const LobeSet& lobes, const MetricOptions& options, WorkDone& work)
      : has_retro_edge_(lobes.has_retro_edge), lobes_(static_cast<Eigen::Index>(lobes.lobes())) {
    for (Part& part : parts_of(lobes, options.tolerance)) {
      PointIntegrator integrator(device, part.lobes, std::move(part.rule), options, work);
      parts_.push_back({std::move(part.numbers), part.pairs, std::move(integrator)});
    }
  }

  void set_goal(double goal) {
    for (Share& part : parts_) part.integrator.set_goal(goal);
  }

  [[nodiscard]] std::size_t slabs() const {
    std::size_t sum = 0;
    for (const Share& part : parts_) sum += part.integrator.slabs();
    return sum;
  }

  /// Products of all lobes over one slab: 0 where they are those of another part.
  Eigen::MatrixXd products(std::size_t slab, int level) {
    Share& part = part_of(slab);
    Eigen::MatrixXd some = part.integrator.products(slab, level);
    if (part.numbers.empty()) return some;
    Eigen::MatrixXd all = Eigen::MatrixXd::Zero(lobes_, lobes_);
    for (std::size_t i = 0; i < part.numbers.size(); ++i) {
      for (std::size_t j = 0; j < part.numbers.size(); ++j) {
        const bool is_retro = has_retro_edge_[static_cast<std::size_t>(part.numbers[i])];
        const bool is_other_retro = has_retro_edge_[static_cast<std::size_t>(part.numbers[j])];
        if (part.pairs == Part::Pairs::with_retro_edge && !is_retro && !is_other_retro) continue;
        if (part.pairs == Part::Pairs::across && is_retro == is_other_retro) continue;
        all(part.numbers[i], part.numbers[j]) = some(static_cast<Eigen::Index>(i), static_cast<Eigen::Index>(j));
      }
    }
    return all;
  }

  /// A slab's squared norms of combinations of lobes that one part has; none if it is another part's slab.
  std::vector<double> squares(std::size_t part, std::size_t slab, int level,
                              const std::vector<Combination>& combinations) {
    if (&part_of(slab) != &parts_[part]) return {};
    return parts_[part].integrator.squares(slab, level, combinations);
  }

  [[nodiscard]] std::size_t parts() const { return parts_.size(); }
  /// Padded row of a lobe in a part that has all its products; none if it does not.
  [[nodiscard]] std::optional<std::size_t> row(std::size_t part, Eigen::Index lobe) const {
    const Share& share = parts_[part];
    if (share.numbers.empty()) return share.integrator.row(lobe);
    const auto place = std::ranges::lower_bound(share.numbers, lobe);
    if (share.pairs == Part::Pairs::across || place == share.numbers.end() || *place != lobe) return std::nullopt;
    return share.integrator.row(place - share.numbers.begin());
  }

 private:
  struct Share {
    std::vector<Eigen::Index> numbers;
    Part::Pairs pairs;
    PointIntegrator integrator;
  };

  /// The part of a slab of all, whose own number it becomes.
  Share& part_of(std::size_t& slab) {
    std::size_t part = 0;
    for (; slab >= parts_[part].integrator.slabs(); ++part) slab -= parts_[part].integrator.slabs();
    return parts_[part];
  }

  std::vector<bool> has_retro_edge_;
  Eigen::Index lobes_;
  std::vector<Share> parts_;
};

/// Pairs of materials whose squared distance is lost in the cancellation of products are integrated as differences,
/// where one part has all their lobes.
void refine_close_pairs(JointIntegrator& integrator, const std::vector<int>& levels, const LobeSet& lobes,
                        const MetricOptions& options, ProductSums& sums) {
  // Above this share of the squared norms the cancellation costs less than six digits of the distance (or, in single
  // precision, than the samples' own errors).
  const double share = options.precision == Precision::double_precision ? 1e-6 : 3e-2;
  std::vector<ClosePair> left = find_close_pairs(sums, share);
  for (std::size_t part = 0; part < integrator.parts() && !left.empty(); ++part) {
    std::vector<ClosePair> pairs;
    std::vector<ClosePair> others;
    std::vector<Combination> combinations;
    const auto all = differences(lobes, left);
    for (Eigen::Index e = 0; e < all.rows(); ++e) {
      const ClosePair& pair = left[static_cast<std::size_t>(e)];
      Combination combination;
      bool has_all = true;
      for (Eigen::SparseMatrix<double, Eigen::RowMajor>::InnerIterator term(all, e); term; ++term) {
        const auto row = integrator.row(part, term.col());
        has_all = has_all && row.has_value();
        if (has_all) combination.terms.emplace_back(*row, term.value());
      }
      (has_all ? pairs : others).push_back(pair);
      if (has_all) combinations.push_back(std::move(combination));
    }
    left = std::move(others);
    if (pairs.empty()) continue;
    const auto count = static_cast<Eigen::Index>(pairs.size());
    Eigen::VectorXd value = Eigen::VectorXd::Zero(count);
    Eigen::VectorXd error = value;
    for (std::size_t slab = 0; slab < levels.size(); ++slab) {
      const auto fine = integrator.squares(part, slab, levels[slab], combinations);
      if (fine.empty()) continue;
      const auto coarse = integrator.squares(part, slab, levels[slab] - 1, combinations);
      for (std::size_t e = 0; e < pairs.size(); ++e) {
        value(static_cast<Eigen::Index>(e)) += fine[e];
        error(static_cast<Eigen::Index>(e)) += std::abs(fine[e] - coarse[e]);
      }
      report_progress(options, Lighting::point(), 1);
    }
    replace_distances(sums, pairs, differences(lobes, pairs), value, error, product_rounding(options.precision) / 4);
  }
}

}  // namespace

std::size_t point_slabs(const LobeSet& lobes, const MetricOptions& options) {
  std::size_t sum = 0;
  for (const Part& part : parts_of(lobes, options.tolerance)) sum += slabs_of(part.rule);
  return sum;
}

void integrate_point_products(const Device& device, const LobeSet& lobes, const MetricOptions& options,
                              ProductSums& sums, WorkDone& work) {
  report_progress(options, Lighting::point(), 0);
  JointIntegrator integrator(device, lobes, options, work);
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
