// Metrics of the literature, of functions: at their own values, on the host.
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <numbers>
#include <string>
#include <vector>

#include "compare/comparison_measure.hpp"
#include "compare/comparison_result.hpp"
#include "compare/comparison_routes.hpp"
#include "core/parallel.hpp"
#include "core/stopwatch.hpp"
#include "hemisphere/angle_rule.hpp"
#include "hemisphere/half_difference_rule.hpp"
#include "hemisphere/node_directions.hpp"
#include "lobe/compare/literature_metric.hpp"
#include "metric/function_values.hpp"

namespace lobe {
namespace {

using Eigen::Index;
using std::numbers::pi;

constexpr std::size_t kBlock = 2048;  // nodes

constexpr int kFunctionNodes = 8;

/// Gauss nodes per panel. Measured functions keep some slabs from converging, as those towards the horizon that a few
/// samples of a file fill.
constexpr std::array kLevels{4, 6, 9, 13, 19};
constexpr std::uint64_t kMostEvaluations = 50'000'000;  // after which no slab goes beyond the levels of products

/// Sums over nodes of a channel: of terms, (n + 1) x (n + 1) with black as the last, and of what the functions' errors
/// may add to each, n + 1.
struct Sums {
  std::vector<Eigen::MatrixXd> value;
  std::vector<Eigen::VectorXd> unsure;
};

class FunctionComparison {
 public:
  FunctionComparison(std::span<const BrdfFunction> functions, std::size_t channels, LiteratureMetric comparison,
                     const LiteratureOptions& options, WorkDone& work)
      : functions_(functions),
        channels_(channels),
        comparison_(comparison),
        recipe_(recipe_of(comparison)),
        is_isotropic_(std::ranges::all_of(functions, &BrdfFunction::is_isotropic)),
        half_difference_({.width = options.lobe_width, .patch_radii = {}, .retro_patch_radii = {}}),
        angles_({.width = options.lobe_width, .patch_radii = {}, .retro_patch_radii = {}}, options.theta_max),
        block_(kBlock),
        work_(work) {
    if (!recipe_.is_mean) return;
    volume_ = 2 * pi * options.theta_max * options.theta_max;
    if (has_angles()) return;
    volume_ = 0;
    for (std::size_t slab = 0; slab < slabs(); ++slab) {
      place(slab, kFunctionNodes, [&] {
        for (std::size_t k = 0; k < block_.size(); ++k) volume_ += measure(k);
      });
    }
  }

  [[nodiscard]] std::size_t slabs() const { return has_angles() ? angles_.slabs() : half_difference_.slabs(); }

  [[nodiscard]] Sums gauss(std::size_t slab, int nodes_per_panel) {
    const auto n = static_cast<Index>(functions_.size());
    Sums sums{std::vector<Eigen::MatrixXd>(channels_, Eigen::MatrixXd::Zero(n + 1, n + 1)),
              std::vector<Eigen::VectorXd>(channels_, Eigen::VectorXd::Zero(n + 1))};
    std::size_t placed = 0;
    place(slab, nodes_per_panel, [&] {
      add_block(sums, nodes_per_panel, placed);
      placed += block_.size();
    });
    for (std::size_t c = 0; c < channels_; ++c) {
      sums.value[c] = (sums.value[c] + sums.value[c].transpose().eval()) / volume_;
      sums.unsure[c] /= volume_;
    }
    return sums;
  }

 private:
  [[nodiscard]] bool has_angles() const { return recipe_.domain == ComparisonDomain::angles; }

  /// Calls a function with every block of nodes of a slab.
  template <typename Use>
  void place(std::size_t slab, int nodes_per_panel, const Use& use) {
    const auto flush = [&] {
      use();
      block_.clear();
    };
    if (has_angles()) {
      angles_.place(slab, nodes_per_panel, block_, flush);
    } else {
      half_difference_.place_gauss(slab, nodes_per_panel, block_, flush);
    }
  }

  [[nodiscard]] NodeBlock::Node node(std::size_t k) const {
    NodeBlock::Node node;
    for (std::size_t row = 0; row < NodeBlock::kRows; ++row) node[row] = block_.data()[row * block_.capacity() + k];
    return node;
  }

  /// Measure of the comparison's domain that a node stands for.
  [[nodiscard]] double measure(std::size_t k) const {
    const double factor = factor_at(block_, k);
    if (has_angles()) return factor;
    if (recipe_.domain == ComparisonDomain::half_difference) return factor * factor * half_difference_density(node(k));
    return factor * factor;
  }

  /// Both signs of delta_phi; by the rule of half-differences, which stands for reciprocal functions, both orders too.
  [[nodiscard]] std::size_t variants() const { return has_angles() ? 2 : 4; }
  [[nodiscard]] std::size_t azimuths() const { return is_isotropic_ ? 1 : kFunctionAzimuths; }

  [[nodiscard]] std::vector<Directions> pairs_of_block(int level, std::size_t placed, std::size_t azimuths) const {
    std::vector<Directions> pairs;
    pairs.reserve(block_.size() * variants() * azimuths);
    for (std::size_t k = 0; k < block_.size(); ++k) {
      const Directions at = directions_at(block_, k);
      const double turn = turn_of(placed + k, level);
      for (std::size_t v = 0; v < variants(); ++v) {
        const double delta_phi = v % 2 == 0 ? at.delta_phi : -at.delta_phi;
        const auto [in, out] = v / 2 == 0 ? std::pair(at.theta_in, at.theta_out) : std::pair(at.theta_out, at.theta_in);
        for (std::size_t a = 0; a < azimuths; ++a) {
          const double azimuth = 2 * pi * (static_cast<double>(a) + turn) / static_cast<double>(azimuths);
          pairs.push_back({in, out, delta_phi, azimuths == 1 ? 0 : azimuth});
        }
      }
    }
    return pairs;
  }

  void add_block(Sums& sums, int level, std::size_t placed) {
    Stopwatch watch;
    const std::size_t repeats = variants() * azimuths();
    const auto rows = static_cast<Index>(block_.size() * repeats);
    Eigen::VectorXd scale(rows);
    Eigen::VectorXd weight(rows);
    for (std::size_t k = 0; k < block_.size(); ++k) {
      const NodeBlock::Node at = node(k);
      const double cos_i = at[NodeBlock::cos_i];
      const double cos_o = at[NodeBlock::cos_o];
      const auto first = static_cast<Index>(k * repeats);
      // Where the directions change places, the scale is symmetric in both.
      scale.segment(first, static_cast<Index>(repeats)).setConstant(scale_at(comparison_, cos_i, cos_o));
      weight.segment(first, static_cast<Index>(repeats))
          .setConstant(weight_at(comparison_, cos_i, cos_o) * measure(k) / static_cast<double>(repeats));
    }
    const auto pairs = pairs_of_block(level, placed, azimuths());
    const auto pairs_of_isotropic = is_isotropic_ ? pairs : pairs_of_block(level, placed, 1);
    work_.seconds_nodes += watch.lap();
    work_.nodes += block_.size();

    const auto n = static_cast<Index>(functions_.size());
    std::vector<Eigen::MatrixXd> node_values(channels_, Eigen::MatrixXd::Zero(rows, n + 1));
    for (Index f = 0; f < n; ++f) {
      const BrdfFunction& function = functions_[static_cast<std::size_t>(f)];
      const BrdfValues values = values_at(function, function.is_isotropic ? pairs_of_isotropic : pairs);
      work_.evaluations += static_cast<std::uint64_t>(values.value.rows());
      const Index share = rows / values.value.rows();
      for (std::size_t c = 0; c < channels_; ++c) {
        const Index column = values.value.cols() == 1 ? 0 : static_cast<Index>(c);
        double unsure = 0;
        for (Index row = 0; row < rows; ++row) {
          const double x = scale(row) * values.value(row / share, column);
          const double error = scale(row) * values.error(row / share, column);
          node_values[c](row, f) = mapped(recipe_.map, x);
          if (error != 0) unsure += weight(row) * term_of(recipe_.term, mapped_error(recipe_.map, x, error));
        }
        sums.unsure[c](f) += unsure;
      }
    }
    work_.seconds_values += watch.lap();
    for (std::size_t c = 0; c < channels_; ++c) {
      const Eigen::MatrixXd& values = node_values[c];
      parallel_for(static_cast<std::size_t>(n), [&](std::size_t first) {
        const auto i = static_cast<Index>(first);
        for (Index j = i + 1; j <= n; ++j) sums.value[c](i, j) += sum_of(weight, values.col(i), values.col(j));
      });
    }
    work_.seconds_gram += watch.lap();
  }

  [[nodiscard]] double sum_of(const Eigen::VectorXd& weight, const Eigen::Ref<const Eigen::VectorXd>& f,
                              const Eigen::Ref<const Eigen::VectorXd>& g) const {
    switch (recipe_.term) {
      case PairTerm::square:
        return weight.dot((f - g).cwiseAbs2());
      case PairTerm::absolute:
        return weight.dot((f - g).cwiseAbs());
      case PairTerm::two_thirds:
        break;
    }
    return weight.dot((f - g).unaryExpr([](double d) { return term_of(PairTerm::two_thirds, d); }));
  }

  std::span<const BrdfFunction> functions_;
  std::size_t channels_;
  LiteratureMetric comparison_;
  ComparisonRecipe recipe_;
  bool is_isotropic_;
  HalfDifferenceRule half_difference_;
  AngleRule angles_;
  NodeBlock block_;
  double volume_ = 1;
  WorkDone& work_;
};

/// A slab's sums at the levels so far, at least two.
using Levels = std::vector<Sums>;

/// Error of a slab's integrals, without the functions' own errors.
Eigen::MatrixXd error_of(const Levels& levels, std::size_t channel) {
  std::vector<Eigen::MatrixXd> values;
  for (const Sums& level : levels) values.push_back(level.value[channel]);
  return error_of_levels(values);
}

std::vector<ComparisonIntegrals> integrals_of(const std::vector<Levels>& slabs, const ComparisonRecipe& recipe) {
  constexpr double kRounding = 1e-13;  // of sums of some 1e6 terms
  std::vector<ComparisonIntegrals> integrals;
  for (std::size_t c = 0; c < slabs.front().front().value.size(); ++c) {
    const Index size = slabs.front().front().value[c].rows();
    ComparisonIntegrals sum{Eigen::MatrixXd::Zero(size, size), Eigen::MatrixXd::Zero(size, size)};
    Eigen::VectorXd unsure = Eigen::VectorXd::Zero(size);
    for (const Levels& slab : slabs) {
      sum.value += slab.back().value[c];
      sum.error += error_of(slab, c);
      unsure += slab.back().unsure[c];
    }
    for (Index i = 0; i < size; ++i) {
      for (Index j = 0; j < size; ++j) {
        const double value = sum.value(i, j);
        if (i == j || (value == 0 && unsure(i) == 0 && unsure(j) == 0)) continue;
        sum.error(i, j) += value_error(recipe.term, value, unsure(i), unsure(j)) +
                           kRounding * (sum.value(i, size - 1) + sum.value(j, size - 1));
      }
    }
    integrals.push_back(std::move(sum));
  }
  return integrals;
}

/// Refines the slab that counts most in the worst of the distances, one after the other.
/// \param work that evaluate() has done
template <typename Evaluate>
std::vector<Levels> refined(std::size_t slabs, const std::vector<double>& weights, double tolerance,
                            const WorkDone& work, const Evaluate& evaluate) {
  std::vector<Levels> all(slabs);
  std::vector<Eigen::MatrixXd> errors;  // of combined integrals, by slab
  Eigen::MatrixXd total;
  const auto combined_error = [&](const Levels& slab) {
    Eigen::MatrixXd error = weights[0] * error_of(slab, 0);
    for (std::size_t c = 1; c < weights.size(); ++c) error += weights[c] * error_of(slab, c);
    return error;
  };
  for (std::size_t slab = 0; slab < slabs; ++slab) {
    for (const std::size_t level : {0U, 1U}) all[slab].push_back(evaluate(slab, level));
    errors.push_back(combined_error(all[slab]));
    for (std::size_t c = 0; c < weights.size(); ++c) {
      const Eigen::MatrixXd share = weights[c] * all[slab].back().value[c];
      total = total.size() == 0 ? share : Eigen::MatrixXd(total + share);
    }
  }
  Eigen::MatrixXd can_improve = Eigen::MatrixXd::Ones(total.rows(), total.cols());
  for (;;) {
    Eigen::MatrixXd sum = Eigen::MatrixXd::Zero(total.rows(), total.cols());
    for (const auto& error : errors) sum += error;
    Index i = 0;
    Index j = 0;
    const Eigen::ArrayXXd shares = (total.array() > 0).select(sum.array() / total.array(), 0.0) * can_improve.array();
    if (!(shares.maxCoeff(&i, &j) > tolerance)) return all;
    std::size_t next = slabs;
    const std::size_t most_levels = work.evaluations < kMostEvaluations ? kLevels.size() : kFunctionLevels.size();
    for (std::size_t slab = 0; slab < slabs; ++slab) {
      if (all[slab].size() >= most_levels) continue;
      if (next == slabs || errors[slab](i, j) > errors[next](i, j)) next = slab;
    }
    // No use in refining what is not to blame.
    constexpr double kBlame = 1e-2;
    if (next == slabs || errors[next](i, j) <= kBlame * tolerance * total(i, j)) {
      can_improve(i, j) = 0;
      continue;
    }
    all[next].push_back(evaluate(next, all[next].size()));
    errors[next] = combined_error(all[next]);
  }
}

}  // namespace

LiteratureResult compare_functions(std::span<const BrdfFunction> functions, LiteratureMetric comparison,
                                   const LiteratureOptions& options) {
  check(options);
  const std::size_t channels = common_channels(functions);
  const auto weights = comparison_weights(options, channels);
  report_progress(options, comparison, 0);
  std::vector<std::string> names;
  for (const auto& function : functions) names.push_back(function.name);
  const ComparisonRecipe recipe = recipe_of(comparison);
  WorkDone work;
  FunctionComparison integrator(functions, channels, comparison, options, work);
  const std::size_t slabs = integrator.slabs();
  const double tolerance = options.tolerance * (recipe.is_root ? 2 : 1);
  const auto levels = refined(slabs, weights, tolerance, work, [&](std::size_t slab, std::size_t level) {
    report_progress(options, comparison, static_cast<double>(slab) / static_cast<double>(slabs));
    return integrator.gauss(slab, kLevels.at(level));
  });
  LiteratureResult result = make_comparison_result(comparison, integrals_of(levels, recipe), names, options);
  result.work = work;
  report_progress(options, comparison, 1);
  return result;
}

}  // namespace lobe
