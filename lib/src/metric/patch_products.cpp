// Products under patch lights: slabs of L are refined, the worst first, until their errors meet the tolerance.
#include <algorithm>
#include <cmath>
#include <optional>
#include <span>
#include <utility>
#include <vector>

#include "device/rounding.hpp"
#include "hemisphere/patch_response.hpp"
#include "metric/lighting_traits.hpp"
#include "metric/patch_modes.hpp"
#include "metric/products.hpp"

namespace lobe {
namespace {

/// A part of the integral over L. Degrees and rules are refined apart: what is cut off of W and what the quadrature
/// misses differ in size and in cost, and the latter hardly depends on the degree.
struct Slab {
  ModeLevel level = {0, 1};
  std::vector<Eigen::MatrixXd> products;  ///< at the last degrees, coarse to fine, by the rule `products_rule`
  std::size_t products_rule = 1;          ///< a former one, while it is refined
  Eigen::MatrixXd finer;                  ///< at the lowest of these degrees, where it costs a tenth, by the last rule
  Eigen::MatrixXd coarser;                ///< by the rule before
  Eigen::MatrixXd ahead;  ///< at the degree after, from the visit that gave `finer`; empty once used or out of date
  bool has_more_nodes = false;  ///< that visit took nodes for this degree, more than `finer` has by other rules
  double difference = 0;        ///< of the last two degrees, relative
  double safety = 1;            ///< error of the last degree by that difference

  [[nodiscard]] std::size_t lowest_degree() const { return level.degree + 1 - products.size(); }
  [[nodiscard]] bool is_stale() const { return products_rule != level.rule; }
};

/// How the error of a level follows from its difference to the one before: levels that fall by a factor q leave q + q^2
/// + .. = q / (1 - q). Cut off degrees fall like the first power of the degree at the slowest, the degree of levels
/// grows by 3/2.
double safety_of(double difference, double earlier) {
  constexpr double kSlowest = 2.0 / 3;
  const double q = earlier > 0 ? std::min(difference / earlier, kSlowest) : kSlowest;
  return std::max(1.0, q / (1 - q));
}

/// How the error of a rule follows from its difference to the one before, which has a node less per panel: for profiles
/// that end as a fractional power it falls slowly. Norms of power patches with n from 0.03 to 2.5 under the widest
/// patch light were off by up to 3.9 such differences.
double rule_safety(const LobeSet& lobes) {
  constexpr double kFractionalEdge = 6;
  return lobes.has_fractional_edge ? kFractionalEdge : 1;
}

/// Errors below this share of what a slab may be off need no refinement.
constexpr double kInactive = 0.1;

/// Refines the slabs of the integral over L until all products reach the tolerance.
class SlabRefinement {
 public:
  SlabRefinement(PatchModes& modes, const LobeSet& lobes, const Lighting& lighting, const MetricOptions& options)
      : modes_(modes), lobes_(lobes), lighting_(lighting), options_(options) {}

  /// \param tolerance for the relative error of every product
  /// \return the sum of the slabs' largest errors, of which every product carries kCommonShare
  double refine(double tolerance);

  [[nodiscard]] const std::vector<Slab>& slabs() const { return slabs_; }

 private:
  enum class Part { rule, degree };

  /// Relative errors of all products.
  struct Errors {
    Eigen::ArrayXXd own;      ///< summed over slabs
    Eigen::ArrayXXd stuck;    ///< of these what no finer level is there for
    double common = 0;        ///< sum of the slabs' largest
    double common_stuck = 0;  ///< of these what no finer level is there for

    [[nodiscard]] Eigen::ArrayXXd total() const { return own + kCommonShare * common; }
    /// What is small enough. Where some errors cannot become smaller, others need not be much smaller than these, nor
    /// than the share that all products carry of them.
    [[nodiscard]] Eigen::ArrayXXd enough(double tolerance) const {
      constexpr double kStuckShare = 0.1;
      return ((1 + kStuckShare) * stuck + 2 * kCommonShare * common_stuck).max(tolerance);
    }
  };

  [[nodiscard]] std::size_t number(const Slab& slab) const { return static_cast<std::size_t>(&slab - slabs_.data()); }
  [[nodiscard]] Eigen::MatrixXd products(PatchModes& modes, const LobeSet& lobes, const Slab& slab, ModeLevel level) {
    auto result = modes.products(number(slab), level);
    require_finite(result, lobes, lighting_);
    return result;
  }
  [[nodiscard]] Eigen::MatrixXd products(const Slab& slab, ModeLevel level) {
    return products(modes_, lobes_, slab, level);
  }
  [[nodiscard]] Eigen::ArrayXXd errors_of(const Slab& slab, Part part) const;
  [[nodiscard]] static bool may_grow(const Slab& slab, Part part) {
    return part == Part::rule ? slab.level.rule + 1 < PatchModes::rules()
                              : slab.level.degree + 1 < PatchModes::degrees();
  }
  [[nodiscard]] Errors look(bool rules_only) const;
  /// Of a part of a slab.
  [[nodiscard]] double inactive_error() const { return kInactive * tolerance_ / static_cast<double>(slabs_.size()); }
  /// Lobes of products with such errors above what needs no refinement, all of them if there is none; delta parts
  /// always.
  [[nodiscard]] std::vector<Eigen::Index> active_lobes(const Eigen::ArrayXXd& errors) const;

  /// Computes products of some lobes anew.
  class Partial;
  void begin();
  void refine_rule(Slab& slab, const std::vector<Eigen::Index>& active);
  void refine_degree(Slab& slab, const std::vector<Eigen::Index>& active);
  /// Brings the products at higher degrees to the last rule; small changes are taken from those at the lowest degree.
  void refresh(Slab& slab);
  /// Refines what the worst product owes most to, until all are good enough.
  void refine_worst(double tolerance, bool rules_only);

  PatchModes& modes_;
  const LobeSet& lobes_;
  const Lighting& lighting_;
  const MetricOptions& options_;
  std::vector<Slab> slabs_;
  Eigen::MatrixXd reference_;
  double tolerance_ = 0;
};

class SlabRefinement::Partial {
 public:
  Partial(SlabRefinement& refinement, const std::vector<Eigen::Index>& lobes)
      : refinement_(refinement), lobes_(lobes), some_(refinement.lobes_.selected(lobes)) {
    if (lobes.size() < refinement.lobes_.lobes()) modes_.emplace(refinement.modes_.of(some_));
  }

  /// Products of other lobes stay what they are.
  void replace(Eigen::MatrixXd& target, const Slab& slab, ModeLevel level) {
    target(lobes_, lobes_) =
        modes_ ? refinement_.products(*modes_, some_, slab, level) : refinement_.products(slab, level);
  }

 private:
  SlabRefinement& refinement_;
  const std::vector<Eigen::Index>& lobes_;
  LobeSet some_;
  std::optional<PatchModes> modes_;
};

Eigen::ArrayXXd SlabRefinement::errors_of(const Slab& slab, Part part) const {
  if (part == Part::rule) {
    return rule_safety(lobes_) * relative_differences(slab.finer, slab.coarser, reference_);
  }
  const std::size_t size = slab.products.size();
  if (size < 2) return Eigen::ArrayXXd::Zero(reference_.rows(), reference_.cols());
  Eigen::ArrayXXd change = relative_differences(slab.products[size - 1], slab.products[size - 2], reference_);
  // One difference alone may be small by accident.
  constexpr double kOfEarlierDegrees = 0.3;
  if (size > 2) {
    change = change.max(kOfEarlierDegrees *
                        relative_differences(slab.products[size - 2], slab.products[size - 3], reference_));
  }
  return slab.safety * change;
}

SlabRefinement::Errors SlabRefinement::look(bool rules_only) const {
  const Eigen::ArrayXXd zero = Eigen::ArrayXXd::Zero(reference_.rows(), reference_.cols());
  Errors errors{zero, zero};
  for (const Slab& slab : slabs_) {
    for (const Part part : {Part::rule, Part::degree}) {
      if (part == Part::degree && rules_only) continue;
      const Eigen::ArrayXXd own = errors_of(slab, part);
      const double largest = own.maxCoeff();
      errors.own += own;
      errors.common += largest;
      if (may_grow(slab, part)) continue;
      errors.stuck += own;
      errors.common_stuck += largest;
    }
  }
  return errors;
}

std::vector<Eigen::Index> SlabRefinement::active_lobes(const Eigen::ArrayXXd& errors) const {
  const auto smooth = static_cast<Eigen::Index>(lobes_.smooth_lobes());
  std::vector<Eigen::Index> active;
  for (Eigen::Index lobe = 0; lobe < smooth; ++lobe) {
    if (errors.col(lobe).maxCoeff() > inactive_error()) active.push_back(lobe);
  }
  const bool is_all = active.empty();
  for (Eigen::Index lobe = is_all ? 0 : smooth; lobe < reference_.cols(); ++lobe) active.push_back(lobe);
  return active;
}

void SlabRefinement::begin() {
  const auto n = static_cast<Eigen::Index>(lobes_.lobes());
  slabs_.resize(modes_.slabs());
  reference_ = Eigen::MatrixXd::Zero(n, n);
  for (Slab& slab : slabs_) {
    slab.coarser = products(slab, {0, 0});
    // Most slabs stay with this rule and go on to the next degree, whose nodes do for both.
    auto both = modes_.products_of_two_degrees(number(slab), {slab.level.degree + 1, slab.level.rule});
    for (const auto& one : both) require_finite(one, lobes_, lighting_);
    slab.finer = std::move(both[0]);
    slab.ahead = std::move(both[1]);
    slab.has_more_nodes = true;
    slab.products.push_back(slab.finer);
    reference_ += slab.finer;
    report_progress(options_, lighting_, 0);
  }
}

void SlabRefinement::refine_rule(Slab& slab, const std::vector<Eigen::Index>& active) {
  Partial partial(*this, active);
  // With more nodes X for a higher degree a rule may be as fine as the next one, and hide its own error.
  if (std::exchange(slab.has_more_nodes, false)) {
    partial.replace(slab.coarser, slab, {slab.lowest_degree(), slab.level.rule});
  } else {
    slab.coarser(active, active) = slab.finer(active, active);
  }
  slab.ahead.resize(0, 0);
  ++slab.level.rule;
  partial.replace(slab.finer, slab, {slab.lowest_degree(), slab.level.rule});
  if (slab.products.size() > 1) return;
  slab.products.front() = slab.finer;
  slab.products_rule = slab.level.rule;
}

void SlabRefinement::refresh(Slab& slab) {
  if (!slab.is_stale()) return;
  const Eigen::MatrixXd change = slab.finer - slab.products.front();
  const Eigen::ArrayXXd relative = relative_differences(slab.finer, slab.products.front(), reference_);
  for (Eigen::MatrixXd& one : slab.products) one += change;
  if (relative.maxCoeff() > inactive_error()) {
    const auto active = active_lobes(relative);
    Partial partial(*this, active);
    for (std::size_t k = 1; k < slab.products.size(); ++k) {
      partial.replace(slab.products[k], slab, {slab.lowest_degree() + k, slab.level.rule});
    }
  }
  slab.products_rule = slab.level.rule;
}

void SlabRefinement::refine_degree(Slab& slab, const std::vector<Eigen::Index>& active) {
  refresh(slab);
  if (slab.ahead.size() > 0) {
    slab.products.push_back(std::exchange(slab.ahead, {}));
    ++slab.level.degree;
    slab.difference = relative_difference(slab.products.back(), slab.finer, reference_);
    slab.safety = safety_of(slab.difference, 0);
    return;
  }
  Partial partial(*this, active);
  // Products of lobes that are no longer refined keep their levels.
  std::vector<Eigen::MatrixXd> refined{slab.products.front()};
  for (const auto& kept : slab.products) {
    refined.push_back(kept);
    refined[refined.size() - 2](active, active) = kept(active, active);
  }
  ++slab.level.degree;
  partial.replace(refined.back(), slab, slab.level);
  slab.products = std::move(refined);
  const double earlier = slab.difference;
  slab.difference = relative_difference(slab.products.back(), slab.products[slab.products.size() - 2], reference_);
  slab.safety = safety_of(slab.difference, earlier);
  slab.difference = std::max(slab.difference, kEarlierShare * earlier);
  if (slab.products.size() <= kLevelsKept) return;
  slab.products.erase(slab.products.begin());
  slab.finer = slab.products.front();
  slab.has_more_nodes = false;
  partial.replace(slab.coarser, slab, {slab.lowest_degree(), slab.level.rule - 1});
}

void SlabRefinement::refine_worst(double tolerance, bool rules_only) {
  // No use in refining what is not to blame.
  constexpr double kBlame = 1e-2;
  Eigen::ArrayXXd can_improve = Eigen::ArrayXXd::Ones(reference_.rows(), reference_.cols());
  for (;;) {
    const Errors errors = look(rules_only);
    const Eigen::ArrayXXd total = errors.total();
    const Eigen::ArrayXXd missing = ((total - errors.enough(tolerance)) * can_improve).max(0);
    report_progress(options_, lighting_, rules_only ? 0 : std::min(1.0, tolerance / total.maxCoeff()));
    Eigen::Index i = 0;
    Eigen::Index j = 0;
    if (missing.maxCoeff(&i, &j) <= 0) {
      const auto stale = std::ranges::find_if(slabs_, &Slab::is_stale);
      if (stale == slabs_.end()) return;
      refresh(*stale);
      continue;
    }
    Slab* worst = nullptr;
    Part part = Part::rule;
    double largest = kBlame * tolerance;
    for (Slab& slab : slabs_) {
      for (const Part one : {Part::rule, Part::degree}) {
        if ((one == Part::degree && rules_only) || !may_grow(slab, one)) continue;
        const double own = errors_of(slab, one)(i, j);
        if (own <= largest) continue;
        worst = &slab;
        part = one;
        largest = own;
      }
    }
    if (worst == nullptr) {
      can_improve(i, j) = can_improve(j, i) = 0;
      continue;
    }
    const auto active = active_lobes((missing > 0).select(errors_of(*worst, part), 0.0));
    if (part == Part::rule) {
      refine_rule(*worst, active);
    } else {
      refine_degree(*worst, active);
    }
  }
}

double SlabRefinement::refine(double tolerance) {
  // Rules are best refined before the degree is high.
  constexpr double kRuleShare = 0.25;
  tolerance_ = tolerance;
  begin();
  refine_worst(kRuleShare * tolerance, true);
  const std::vector<Eigen::Index> all = active_lobes(Eigen::ArrayXXd::Zero(reference_.rows(), reference_.cols()));
  for (Slab& slab : slabs_) refine_degree(slab, all);
  refine_worst(tolerance, false);
  return look(false).common;
}

/// Differences of near-identical materials, as for point light.
void refine_close_pairs(PatchModes& modes, const std::vector<Slab>& slabs, const LobeSet& lobes,
                        const Lighting& lighting, const MetricOptions& options, ProductSums& sums) {
  // Above this share the cancellation costs less than six digits of the distance.
  const auto pairs = find_close_pairs(sums, 1e-6);
  if (pairs.empty()) return;
  const auto rows = differences(lobes, pairs);
  Eigen::VectorXd value = Eigen::VectorXd::Zero(rows.rows());
  Eigen::VectorXd error = value;
  for (std::size_t k = 0; k < slabs.size(); ++k) {
    const auto squares = [&](std::size_t degree, std::size_t rule) { return modes.squares(k, {degree, rule}, rows); };
    const auto [degree, rule] = slabs[k].level;
    const std::size_t lowest = slabs[k].lowest_degree();
    const Eigen::VectorXd fine = squares(degree, rule);
    error += slabs[k].safety * (fine - squares(degree - 1, rule)).cwiseAbs();
    error += rule_safety(lobes) * (squares(lowest, rule) - squares(lowest, rule - 1)).cwiseAbs();
    value += fine;
    report_progress(options, lighting, 1);
  }
  replace_distances(sums, pairs, rows, value, error, product_rounding(Precision::double_precision) / 4);
}

}  // namespace

std::vector<LightDisc> light_discs(std::span<const PatchShare> shares) {
  std::vector<LightDisc> discs;
  for (const auto& [radius, weight] : shares) {
    discs.push_back({radius, weight * patch_constant(radius) * patch_constant(radius)});
  }
  return discs;
}

double light_response(std::span<const PatchShare> shares, double distance) {
  double response = 0;
  for (const auto& [radius, weight] : shares) response += weight * patch_response(distance, radius);
  return response;
}

void integrate_patch_products(const Device& device, const LobeSet& lobes, const Lighting& lighting,
                              const MetricOptions& options, ProductSums& sums, WorkDone& work) {
  report_progress(options, lighting, 0);
  const double tolerance = formula_tolerance(lighting, options);
  PatchModes modes(device, lobes, lighting, tolerance, work);
  SlabRefinement refinement(modes, lobes, lighting, options);
  const double total_difference = refinement.refine(tolerance);
  for (const Slab& slab : refinement.slabs()) {
    sums.add_lobe_products(slab.products, slab.safety);
    sums.add_lobe_change(slab.coarser, slab.finer, rule_safety(lobes));
  }
  const double rounding = product_rounding(Precision::double_precision);
  for (auto& total : sums.totals()) {
    add_common_share(total_difference, total);
    total.gram_error += rounding * total.gram.cwiseAbs();
    const Eigen::VectorXd squares = rounding * total.gram.diagonal();
    total.squared_distance_error.colwise() += squares;
    total.squared_distance_error.rowwise() += squares.transpose();
  }
  refine_close_pairs(modes, refinement.slabs(), lobes, lighting, options, sums);
}

}  // namespace lobe
