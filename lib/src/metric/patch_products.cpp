// Products under patch lights: slabs of L are refined, the worst first, until their errors meet the tolerance.
#include <algorithm>
#include <cmath>
#include <optional>
#include <span>
#include <utility>
#include <vector>

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
  std::vector<Eigen::MatrixXd> products;  ///< of this rule at the last degrees, coarse to fine
  Eigen::MatrixXd of_coarser_rule;        ///< of the rule before at the lowest of these degrees, where it costs a tenth
  double difference = 0;                  ///< of the last two degrees, relative
  double safety = 1;                      ///< error of the last degree by that difference
  double rule_error = 0;                  ///< by the difference of the last two rules, relative

  [[nodiscard]] std::size_t lowest_degree() const { return level.degree + 1 - products.size(); }
  [[nodiscard]] double degree_error() const { return safety * difference; }
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

/// A lobe is active while its products in a slab change by more than this share of what a slab may be off: twice that,
/// the largest factor, is no more than the change and the common share that every estimate carries.
constexpr double kInactive = kCommonShare;

/// The lobes of these numbers, rising, and all delta parts; without materials.
LobeSet select(const LobeSet& lobes, std::span<const Eigen::Index> wanted) {
  LobeSet some = lobes;
  some.mix.clear();
  some.names.clear();
  for (const Eigen::Index lobe : wanted) some.names.push_back(lobes.names[static_cast<std::size_t>(lobe)]);
  auto next = wanted.begin();
  Eigen::Index first = 0;
  for (LobeBatch& batch : some.batches) {
    const auto all = std::exchange(batch.coefficients, {});
    const auto curves = std::exchange(batch.curves, {});
    const auto end = first + static_cast<Eigen::Index>(all.size());
    for (; next != wanted.end() && *next < end; ++next) {
      const auto place = static_cast<std::size_t>(*next - first);
      batch.coefficients.push_back(all[place]);
      if (!curves.empty()) batch.curves.push_back(curves[place]);
    }
    first = end;
  }
  std::erase_if(some.batches, [](const LobeBatch& batch) { return batch.coefficients.empty(); });
  return some;
}

/// Refines the slabs of the integral over L.
class SlabRefinement {
 public:
  SlabRefinement(PatchModes& modes, const LobeSet& lobes, const Lighting& lighting, const MetricOptions& options)
      : modes_(modes), lobes_(lobes), lighting_(lighting), options_(options) {}

  /// \param goal for the sum of all relative errors
  /// \return that sum
  double refine(double goal);

  [[nodiscard]] const std::vector<Slab>& slabs() const { return slabs_; }

 private:
  [[nodiscard]] Eigen::MatrixXd products(PatchModes& modes, const LobeSet& lobes, const Slab& slab, ModeLevel level) {
    auto result = modes.products(static_cast<std::size_t>(&slab - slabs_.data()), level);
    require_finite(result, lobes, lighting_);
    return result;
  }
  [[nodiscard]] Eigen::MatrixXd products(const Slab& slab, ModeLevel level) {
    return products(modes_, lobes_, slab, level);
  }
  /// Lobes with a product that a higher degree may still change; delta parts always.
  [[nodiscard]] std::vector<Eigen::Index> active_lobes(const Slab& slab) const;
  /// Relative errors of the slabs.
  struct Errors {
    double sum = 0;
    double stuck = 0;       ///< of those that have no finer level
    Slab* worst = nullptr;  ///< of the others
    bool is_rule = false;   ///< of the worst: not the degree
    double largest = 0;     ///< of the worst
  };
  [[nodiscard]] double rule_error(const Slab& slab) const {
    return rule_safety(lobes_) * relative_difference(slab.products.front(), slab.of_coarser_rule, reference_);
  }
  [[nodiscard]] Errors look(bool rules_only);
  void begin();
  void refine_rule(Slab& slab);
  void refine_degree(Slab& slab);

  PatchModes& modes_;
  const LobeSet& lobes_;
  const Lighting& lighting_;
  const MetricOptions& options_;
  std::vector<Slab> slabs_;
  Eigen::MatrixXd reference_;
  double goal_ = 0;
};

void SlabRefinement::begin() {
  const auto n = static_cast<Eigen::Index>(lobes_.lobes());
  slabs_.resize(modes_.slabs());
  reference_ = Eigen::MatrixXd::Zero(n, n);
  for (Slab& slab : slabs_) {
    slab.of_coarser_rule = products(slab, {0, 0});
    slab.products.push_back(products(slab, slab.level));
    reference_ += slab.products.back();
    report_progress(options_, lighting_, 0);
  }
  for (Slab& slab : slabs_) {
    slab.rule_error = rule_error(slab);
  }
}

void SlabRefinement::refine_rule(Slab& slab) {
  slab.of_coarser_rule = slab.products.front();
  ++slab.level.rule;
  for (std::size_t k = 0; k < slab.products.size(); ++k) {
    slab.products[k] = products(slab, {slab.lowest_degree() + k, slab.level.rule});
  }
  slab.rule_error = rule_error(slab);
}

std::vector<Eigen::Index> SlabRefinement::active_lobes(const Slab& slab) const {
  std::vector<Eigen::Index> active;
  const auto smooth = static_cast<Eigen::Index>(lobes_.smooth_lobes());
  // One difference alone may be small by accident.
  if (slab.products.size() == kLevelsKept) {
    const double limit = kInactive * goal_ / static_cast<double>(slabs_.size());
    const auto& fine = slab.products.back();
    const Eigen::ArrayXXd differences = relative_differences(fine, slab.products[kLevelsKept - 2], reference_);
    for (Eigen::Index lobe = 0; lobe < smooth; ++lobe) {
      if (differences.col(lobe).maxCoeff() > limit) active.push_back(lobe);
    }
  }
  const bool is_all = active.empty();
  for (Eigen::Index lobe = is_all ? 0 : smooth; lobe < reference_.cols(); ++lobe) active.push_back(lobe);
  return active;
}

void SlabRefinement::refine_degree(Slab& slab) {
  const auto active = active_lobes(slab);
  const LobeSet some = select(lobes_, active);
  std::optional<PatchModes> modes_of_some;
  if (active.size() < lobes_.lobes()) modes_of_some.emplace(modes_.of(some));
  const auto replace_active = [&](Eigen::MatrixXd& target, ModeLevel level) {
    target(active, active) = modes_of_some ? products(*modes_of_some, some, slab, level) : products(slab, level);
  };

  // Products of lobes that are no longer refined keep their levels.
  std::vector<Eigen::MatrixXd> refined{slab.products.front()};
  for (const auto& kept : slab.products) {
    refined.push_back(kept);
    refined[refined.size() - 2](active, active) = kept(active, active);
  }
  ++slab.level.degree;
  replace_active(refined.back(), slab.level);
  slab.products = std::move(refined);
  const double earlier = slab.difference;
  slab.difference = relative_difference(slab.products.back(), slab.products[slab.products.size() - 2], reference_);
  slab.safety = safety_of(slab.difference, earlier);
  slab.difference = std::max(slab.difference, kEarlierShare * earlier);
  if (slab.products.size() <= kLevelsKept) return;
  slab.products.erase(slab.products.begin());
  replace_active(slab.of_coarser_rule, {slab.lowest_degree(), slab.level.rule - 1});
  slab.rule_error = rule_error(slab);
}

SlabRefinement::Errors SlabRefinement::look(bool rules_only) {
  Errors errors;
  const auto consider = [&](Slab& slab, double error, bool is_rule) {
    const bool may_grow =
        is_rule ? slab.level.rule + 1 < PatchModes::rules() : slab.level.degree + 1 < PatchModes::degrees();
    errors.sum += error;
    if (!may_grow) errors.stuck += error;
    if (may_grow && error > errors.largest) {
      errors.worst = &slab;
      errors.is_rule = is_rule;
      errors.largest = error;
    }
  };
  for (Slab& slab : slabs_) {
    consider(slab, slab.rule_error, true);
    if (!rules_only) consider(slab, slab.degree_error(), false);
  }
  return errors;
}

double SlabRefinement::refine(double goal) {
  // Where some errors cannot become smaller, others need not be much smaller than these.
  constexpr double kStuckShare = 0.1;
  // Rules are best refined before the degree is high.
  constexpr double kRuleShare = 0.25;
  goal_ = goal;
  begin();
  const auto is_done = [](const Errors& errors, double limit) {
    return errors.worst == nullptr || errors.sum <= std::max(limit, (1 + kStuckShare) * errors.stuck);
  };
  for (Errors errors = look(true); !is_done(errors, kRuleShare * goal); errors = look(true)) {
    refine_rule(*errors.worst);
    report_progress(options_, lighting_, 0);
  }
  for (Slab& slab : slabs_) refine_degree(slab);
  Errors errors = look(false);
  for (; !is_done(errors, goal); errors = look(false)) {
    report_progress(options_, lighting_, std::min(1.0, goal / errors.sum));
    if (errors.is_rule) {
      refine_rule(*errors.worst);
    } else {
      refine_degree(*errors.worst);
    }
  }
  report_progress(options_, lighting_, std::min(1.0, goal / errors.sum));
  return errors.sum;
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
  PatchModes modes(device, lobes, lighting, work);
  SlabRefinement refinement(modes, lobes, lighting, options);
  // Few slabs make most of the error: the worst one is refined until their sum is below the tolerance.
  const double goal = formula_tolerance(lighting, options) / (1 + kCommonShare);
  const double total_difference = refinement.refine(goal);
  for (const Slab& slab : refinement.slabs()) {
    sums.add_lobe_products(slab.products, slab.safety);
    sums.add_lobe_change(slab.of_coarser_rule, slab.products.front(), rule_safety(lobes));
  }
  const double rounding = product_rounding(Precision::double_precision);
  for (auto& total : sums.totals()) {
    total.gram_error += (rounding + kCommonShare * total_difference) * total.gram.cwiseAbs();
    const Eigen::VectorXd squares = rounding * total.gram.diagonal();
    total.squared_distance_error.colwise() += squares;
    total.squared_distance_error.rowwise() += squares.transpose();
  }
  refine_close_pairs(modes, refinement.slabs(), lobes, lighting, options, sums);
}

}  // namespace lobe
