#include "compare/comparison_refinement.hpp"

#include <algorithm>
#include <array>
#include <functional>
#include <span>
#include <utility>

namespace lobe {
namespace {

// Gauss nodes per panel and axis at each level. |f - g| and its powers have kinks where f = g, which no panel follows:
// there a rule of n nodes errs as n^-2 or n^-5/3, and the steps must be wide for the difference of two levels to bound
// the error of the finer one. Squares are smooth and converge fast.
constexpr std::array kSmoothNodes{3, 4, 6, 8, 10, 12, 15, 18, 22};
constexpr std::array kKinkedNodes{3, 5, 8, 12, 18};

std::span<const int> ladder(const ComparisonRecipe& recipe) {
  if (has_kinks(recipe)) return kKinkedNodes;
  return kSmoothNodes;
}

// No theory: 1 was too little by a factor of 2.3 for kinked terms on the eight materials by which
// tests/property/comparison_test.cpp guards it, and 2.5 was chosen on these same ones. Logarithms down to what panels
// do not follow converge less evenly than other smooth terms: with 1, 1 of 11 175 distances was off by 2.1 errors.
double safety_of(const ComparisonRecipe& recipe) {
  if (has_kinks(recipe)) return 2.5;
  return recipe.domain == ComparisonDomain::half_difference ? 1.5 : 1;
}

// Without this share of what is usual among the pairs, 2 of 177 000 distances of the published fits were off by up to
// 2.2 of their errors: across kinks two levels agree by accident more often.
constexpr double kTypical = 0.5;

/// Visits the pairs of a tile, those with black among them.
template <typename Use>
void for_each_pair(const Eigen::MatrixXd& matrix, bool is_triangle, const Use& use) {
  for (Eigen::Index j = 0; j < matrix.cols(); ++j) {
    const Eigen::Index end = is_triangle ? j : matrix.rows();
    for (Eigen::Index i = 0; i < end; ++i) use(i, j);
  }
}

/// Goal of a run.
class Goal {
 public:
  Goal(LiteratureMetric comparison, bool is_triangle, const std::vector<double>& weights,
       const LiteratureOptions& options)
      : is_triangle_(is_triangle),
        weights_(weights),
        relative_(options.tolerance * (recipe_of(comparison).is_root ? 2 : 1)),
        share_of_outliers_(options.outliers) {}

  /// Largest errors that combined integrals may have.
  [[nodiscard]] Eigen::MatrixXd allowed(const Eigen::MatrixXd& value) const { return relative_ * value; }

  /// Largest error relative to what is allowed, off the zeros and but for the outliers.
  [[nodiscard]] double worst_share(const Eigen::MatrixXd& error, const Eigen::MatrixXd& allowed) const {
    std::vector<double> shares;
    for_each_pair(allowed, is_triangle_, [&](Eigen::Index i, Eigen::Index j) {
      shares.push_back(allowed(i, j) > 0 ? error(i, j) / allowed(i, j) : 0);
    });
    const auto rows = static_cast<double>(allowed.rows());
    const double pairs = is_triangle_ ? (rows - 1) * (rows - 2) / 2 : rows * static_cast<double>(allowed.cols());
    const auto outliers = static_cast<std::ptrdiff_t>(share_of_outliers_ * pairs);
    const auto place = shares.begin() + outliers;
    std::nth_element(shares.begin(), place, shares.end(), std::greater<>());
    return *place;
  }

  [[nodiscard]] const std::vector<double>& weights() const { return weights_; }

 private:
  bool is_triangle_;
  const std::vector<double>& weights_;
  double relative_;
  double share_of_outliers_;
};

/// A quantile over pairs of error / value, off the zeros of the latter.
double usual_share(double quantile, const Eigen::MatrixXd& error, const Eigen::MatrixXd& value, bool is_triangle) {
  std::vector<double> shares;
  for_each_pair(value, is_triangle, [&](Eigen::Index i, Eigen::Index j) {
    const double share = error(i, j) / value(i, j);
    if (value(i, j) > 0 && share >= 0) shares.push_back(share);  // what is not finite is told later
  });
  if (shares.empty()) return 0;
  const auto place = shares.begin() + static_cast<std::ptrdiff_t>(quantile * static_cast<double>(shares.size()));
  std::nth_element(shares.begin(), place, shares.end());
  return *place;
}

/// Share of an error of smooth terms that is left from level to level at least: as much as for three quarters of the
/// pairs. Where errors were small by accident before they seem to grow, hence kMost.
double slowest_fall(const Eigen::MatrixXd& difference, const Eigen::MatrixXd& earlier, bool is_triangle) {
  constexpr double kMost = 0.5;
  return std::min(kMost, usual_share(0.75, difference, earlier, is_triangle));
}

/// The coarsest level that a sum may end at. Of smooth terms, a difference of the first two alone is no estimate: 309
/// of 7140 distances of mixtures were off by up to 13 of it.
std::size_t least_level(const ComparisonRecipe& recipe) {
  return has_kinks(recipe) ? 1 : 2;
}

/// A slab as far as it is refined.
struct Slab {
  std::size_t level = 0;
  std::vector<Eigen::MatrixXd> value;
  std::vector<Eigen::MatrixXd> error;

  void refine(std::vector<Eigen::MatrixXd> finer, const ComparisonRecipe& recipe, bool is_triangle) {
    ++level;
    error.resize(finer.size());
    for (std::size_t c = 0; c < finer.size(); ++c) {
      Eigen::MatrixXd difference = safety_of(recipe) * (finer[c] - value[c]).cwiseAbs();
      // Two levels agree by accident in single pairs.
      if (has_kinks(recipe)) {
        difference = difference.cwiseMax(kTypical * usual_share(0.5, difference, finer[c], is_triangle) * finer[c]);
      } else if (level > 1) {
        difference = difference.cwiseMax(slowest_fall(difference, error[c], is_triangle) * error[c]);
      }
      error[c] = std::move(difference);
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

/// Which slabs are to be refined next; none when no slab can be.
std::vector<std::size_t> slabs_to_refine(const std::vector<Slab>& slabs, const Goal& goal,
                                         const Eigen::MatrixXd& allowed, std::size_t levels) {
  // Equal shares would do; a slab that takes much less than the worst one has time.
  std::vector<double> shares;
  for (const auto& slab : slabs) {
    Eigen::MatrixXd error = Eigen::MatrixXd::Zero(allowed.rows(), allowed.cols());
    for (std::size_t c = 0; c < slab.error.size(); ++c) error += goal.weights()[c] * slab.error[c];
    shares.push_back(slab.level + 1 < levels ? goal.worst_share(error, allowed) : 0);
  }
  const double worst = *std::max_element(shares.begin(), shares.end());
  std::vector<std::size_t> chosen;
  if (worst == 0) return chosen;
  constexpr double kHasTime = 0.3;
  const double threshold = std::max(kHasTime * worst, std::min(worst, 1 / static_cast<double>(slabs.size())));
  for (std::size_t s = 0; s < slabs.size(); ++s) {
    if (shares[s] >= threshold) chosen.push_back(s);
  }
  return chosen;
}

}  // namespace

std::vector<ComparisonIntegrals> refined_integrals(ComparisonIntegrator& integrator, LiteratureMetric comparison,
                                                   const std::vector<double>& weights,
                                                   const LiteratureOptions& options) {
  const ComparisonRecipe recipe = recipe_of(comparison);
  const auto nodes = ladder(recipe);
  const bool is_triangle = integrator.is_triangle();
  const Goal goal(comparison, is_triangle, weights, options);
  std::vector<Slab> slabs(integrator.slabs());
  for (std::size_t s = 0; s < slabs.size(); ++s) {
    slabs[s].value = integrator.gauss(s, nodes[0]);
    while (slabs[s].level < least_level(recipe)) {
      slabs[s].refine(integrator.gauss(s, nodes[slabs[s].level + 1]), recipe, is_triangle);
    }
    report_progress(options, comparison, 0.5 * static_cast<double>(s + 1) / static_cast<double>(slabs.size()));
  }
  while (true) {
    std::vector<ComparisonIntegrals> total = sum_of(slabs);
    const ComparisonIntegrals combined = combine(total, weights);
    const Eigen::MatrixXd allowed = goal.allowed(combined.value);
    if (!combined.value.allFinite() || goal.worst_share(combined.error, allowed) <= 1) return total;
    const auto chosen = slabs_to_refine(slabs, goal, allowed, nodes.size());
    if (chosen.empty()) return total;
    for (const std::size_t s : chosen) {
      slabs[s].refine(integrator.gauss(s, nodes[slabs[s].level + 1]), recipe, is_triangle);
      report_progress(options, comparison, 0.5);
    }
  }
}

}  // namespace lobe
