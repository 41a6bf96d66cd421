// Metrics of the literature, of tables: every value stands for its node's cell.
#include <algorithm>
#include <cmath>
#include <numbers>

#include "algebra/operands.hpp"
#include "compare/comparison_measure.hpp"
#include "compare/comparison_result.hpp"
#include "compare/comparison_routes.hpp"
#include "core/parallel.hpp"
#include "core/stopwatch.hpp"
#include "hemisphere/half_difference_rule.hpp"
#include "lobe/compare/literature_metric.hpp"
#include "lobe/core/error.hpp"
#include "table/evaluate.hpp"

namespace lobe {
namespace {

using std::numbers::pi;

// Factor on the change to cells three times as large. Where the integrand is smooth these err nine times as much, where
// it has kinks (powers of |f - g|) less regularly.
constexpr double kSmoothSafety = 0.5;
constexpr double kKinkedSafety = 1;
constexpr std::size_t kMerged = 3;

constexpr std::size_t kSamples = 6;  // of a cell per coordinate, for the mean of the weight

// Gauss nodes per panel and axis where tables are interpolated, and of the coarser rule beside it.
constexpr int kFineNodes = 6;
constexpr int kCoarseNodes = 4;

void require_values(std::span<const BrdfTable* const> tables) {
  for (const BrdfTable* const one : tables) {
    const BrdfTable& table = *one;
    check(table);
    const auto is_present = [](double x) { return x != 0; };
    if (std::ranges::any_of(table.mirror, is_present) || std::ranges::any_of(table.retro, is_present)) {
      throw NumericError("'" + table.expression +
                         "' has a delta part, which has no values in sr^-1; comparison metrics need such");
    }
  }
}

/// Weights of the values of a channel: of the full rule and of the coarse one it is judged by.
struct CellWeights {
  std::vector<double> full;
  std::vector<double> coarse;
  std::vector<std::size_t> ends;  ///< behind the values of each three rings of theta_in that the coarse rule merges
};

/// For each ring, the middle one of three into which the coarse rule merges it.
std::vector<std::size_t> merged_rings(std::size_t rings) {
  std::vector<std::size_t> into(rings);
  for (std::size_t ring = 0; ring < rings; ++ring) {
    const std::size_t begin = ring / kMerged * kMerged;
    const std::size_t end = std::min(begin + kMerged, rings);
    into[ring] = (begin + end - 1) / 2;
  }
  return into;
}

class CellMeasure {
 public:
  CellMeasure(const HemisphereGrid& grid, LiteratureMetric comparison, const LiteratureOptions& options)
      : grid_(grid), comparison_(comparison), recipe_(recipe_of(comparison)), theta_max_(options.theta_max) {}

  /// Measure of the comparison's domain in a pair of cells times its weight, per radian of delta_phi.
  [[nodiscard]] double operator()(std::size_t ring_in, std::size_t ring_out) const {
    const Ring& in = grid_.rings()[ring_in];
    const Ring& out = grid_.rings()[ring_out];
    if (recipe_.domain == ComparisonDomain::projected) return projected(in) * projected(out) / (2 * pi);
    const double range_in = std::min(in.theta_high, theta_max_) - in.theta_low;
    const double range_out = std::min(out.theta_high, theta_max_) - out.theta_low;
    if (range_in <= 0 || range_out <= 0) return 0;
    double sum = 0;
    for (std::size_t a = 0; a < kSamples; ++a) {
      const double cos_i = std::cos(in.theta_low + range_in * middle(a));
      for (std::size_t b = 0; b < kSamples; ++b)
        sum += weight_at(comparison_, cos_i, std::cos(out.theta_low + range_out * middle(b)));
    }
    return range_in * range_out * sum / static_cast<double>(kSamples * kSamples);
  }

 private:
  /// Middle of the k-th of so many parts of [0, 1].
  static double middle(std::size_t k) { return (static_cast<double>(k) + 0.5) / static_cast<double>(kSamples); }

  /// Projected solid angle of a ring.
  static double projected(const Ring& ring) { return ring.weight * static_cast<double>(ring.count); }

  const HemisphereGrid& grid_;
  LiteratureMetric comparison_;
  ComparisonRecipe recipe_;
  double theta_max_;
};

/// Weights of an isotropic table's values, [theta_in][theta_out][k].
CellWeights isotropic_weights(const HemisphereGrid& grid, const CellMeasure& measure) {
  const std::size_t rings = grid.n_theta();
  const std::size_t half = grid.half_azimuths();
  const auto into = merged_rings(rings);
  const double step = 2 * pi / static_cast<double>(grid.n_phi());
  const bool halves = grid.n_phi() % 4 == 0;
  CellWeights weights{std::vector<double>(rings * rings * half), std::vector<double>(rings * rings * half), {}};
  for (std::size_t end = kMerged; end < rings + kMerged; end += kMerged) {
    weights.ends.push_back(std::min(end, rings) * rings * half);
  }
  for (std::size_t i = 0; i < rings; ++i) {
    for (std::size_t o = 0; o < rings; ++o) {
      for (std::size_t k = 0; k < half; ++k) {
        const double share = k == 0 || k + 1 == half ? 1 : 2;  // both signs of delta_phi
        const double weight = share * step * measure(i, o);
        weights.full[(i * rings + o) * half + k] = weight;
        const std::size_t at = (into[i] * rings + into[o]) * half;
        if (!halves || k % 2 == 0) {
          weights.coarse[at + k] += weight;
        } else {
          weights.coarse[at + k - 1] += weight / 2;
          weights.coarse[at + k + 1] += weight / 2;
        }
      }
    }
  }
  return weights;
}

/// Weights of a general table's values, [node_in][node_out]: the pairs of nodes of two rings have equal shares.
CellWeights general_weights(const HemisphereGrid& grid, const CellMeasure& measure) {
  const std::size_t nodes = grid.nodes();
  const auto into = merged_rings(grid.rings().size());
  const auto coarse_node = [&](std::size_t ring, std::size_t place) {
    const Ring& target = grid.rings()[into[ring]];
    const Ring& source = grid.rings()[ring];
    // The nearest azimuth of the ring in the middle.
    return target.first_node + place * target.count / source.count;
  };
  CellWeights weights{std::vector<double>(nodes * nodes), std::vector<double>(nodes * nodes), {}};
  for (std::size_t end = kMerged; end < grid.rings().size() + kMerged; end += kMerged) {
    const Ring& last = grid.rings()[std::min(end, grid.rings().size()) - 1];
    weights.ends.push_back((last.first_node + last.count) * nodes);
  }
  for (std::size_t i = 0; i < grid.rings().size(); ++i) {
    for (std::size_t o = 0; o < grid.rings().size(); ++o) {
      const Ring& in = grid.rings()[i];
      const Ring& out = grid.rings()[o];
      const double weight = 2 * pi / static_cast<double>(in.count * out.count) * measure(i, o);
      for (std::size_t l = 0; l < in.count; ++l) {
        for (std::size_t v = 0; v < out.count; ++v) {
          weights.full[(in.first_node + l) * nodes + out.first_node + v] = weight;
          weights.coarse[coarse_node(i, l) * nodes + coarse_node(o, v)] += weight;
        }
      }
    }
  }
  return weights;
}

/// Factor on f, and the place where the bound of its error stands in a channel's errors.
struct Cell {
  double scale = 0;
  std::size_t error_at = 0;
};

std::vector<Cell> cells_of(const BrdfTable& table, LiteratureMetric comparison) {
  const auto& rings = table.grid.rings();
  const bool is_isotropic = table.form == TableForm::isotropic;
  std::vector<Cell> cells;
  cells.reserve(table.size());
  const std::size_t azimuths = is_isotropic ? table.grid.half_azimuths() : 1;
  for (std::size_t row = 0; row < table.rows(); ++row) {
    const std::size_t in = is_isotropic ? row : table.grid.ring_of(row);
    for (std::size_t column = 0; column < table.rows(); ++column) {
      const std::size_t out = is_isotropic ? column : table.grid.ring_of(column);
      const double scale = scale_at(comparison, std::cos(rings[in].theta), std::cos(rings[out].theta));
      cells.insert(cells.end(), azimuths, {scale, in * rings.size() + out});
    }
  }
  return cells;
}

/// Integral of the differences of two series of mapped values by the full rule. The error is its difference to the
/// coarse rule, without regard to the sign at each theta_in: the whole of it is small by accident where parts cancel.
Estimate integral_of(PairTerm term, double safety, const CellWeights& weights, const double* f, const double* g) {
  double integral = 0;
  double error = 0;
  std::size_t k = 0;
  for (const std::size_t end : weights.ends) {
    double full = 0;
    double coarse = 0;
    for (; k < end; ++k) {
      const double value = term_of(term, f[k] - g[k]);
      full += weights.full[k] * value;
      coarse += weights.coarse[k] * value;
    }
    integral += full;
    error += safety * std::abs(full - coarse);
  }
  return {integral, error};
}

/// Nodes of the half-difference rule as directions, and their measure.
struct InterpolationNodes {
  std::vector<Directions> directions;
  std::vector<double> scale;
  std::vector<double> weight;  ///< sum 1
};

InterpolationNodes place_half_difference(const HemisphereGrid& grid, LiteratureMetric comparison, int nodes_per_panel) {
  // Panels as fine as the grid: no lobe of a table is narrower than the half of a step.
  const double width = pi / 4 / static_cast<double>(grid.rings().size());
  const HalfDifferenceRule rule({width, {}, 1, {}});
  NodeBlock block(4096);
  InterpolationNodes nodes;
  double volume = 0;
  for (std::size_t slab = 0; slab < rule.slabs(); ++slab) {
    rule.place_gauss(slab, nodes_per_panel, block, [&] {
      for (std::size_t k = 0; k < block.size(); ++k) {
        NodeBlock::Node node;
        for (std::size_t row = 0; row < NodeBlock::kRows; ++row) node[row] = block.data()[row * block.capacity() + k];
        const double cos_i = node[NodeBlock::cos_i];
        const double cos_o = node[NodeBlock::cos_o];
        const double sines = std::sqrt((1 - cos_i * cos_i) * (1 - cos_o * cos_o));
        const double along = 2 * node[NodeBlock::cos_d] * node[NodeBlock::cos_d] - 1 - cos_i * cos_o;
        const double delta_phi = sines > 0 ? std::acos(std::clamp(along / sines, -1.0, 1.0)) : 0;
        nodes.directions.push_back({std::acos(cos_i), std::acos(cos_o), delta_phi});
        nodes.scale.push_back(scale_at(comparison, cos_i, cos_o));
        const double factor = node[NodeBlock::factor];
        nodes.weight.push_back(factor * factor * half_difference_density(node));
        volume += nodes.weight.back();
      }
      block.clear();
    });
  }
  for (double& weight : nodes.weight) weight /= volume;
  return nodes;
}

/// Integrals of all pairs of isotropic tables over the half-difference domain at interpolated values, per channel.
std::vector<ComparisonIntegrals> interpolated_integrals(std::span<const BrdfTable* const> tables,
                                                        LiteratureMetric comparison, int nodes_per_panel) {
  const ComparisonRecipe recipe = recipe_of(comparison);
  const auto nodes = place_half_difference(tables.front()->grid, comparison, nodes_per_panel);
  const auto n = static_cast<Eigen::Index>(tables.size());
  const auto size = static_cast<Eigen::Index>(nodes.weight.size());
  const std::size_t channels = tables.front()->channels;
  std::vector<Eigen::MatrixXd> node_values(channels, Eigen::MatrixXd::Zero(size, n + 1));
  std::vector<Eigen::VectorXd> unsure(channels, Eigen::VectorXd::Zero(n + 1));
  for (Eigen::Index t = 0; t < n; ++t) {
    const auto values = evaluate(*tables[static_cast<std::size_t>(t)], nodes.directions);
    for (std::size_t c = 0; c < channels; ++c) {
      for (Eigen::Index k = 0; k < size; ++k) {
        const auto at = static_cast<std::size_t>(k);
        // Interpolation overshoots where values fall to zero.
        const double x = nodes.scale[at] * std::max(values[c][at].value, 0.0);
        node_values[c](k, t) = mapped(recipe.map, x);
        unsure[c](t) +=
            nodes.weight[at] * term_of(recipe.term, mapped_error(recipe.map, x, nodes.scale[at] * values[c][at].error));
      }
    }
  }
  std::vector<ComparisonIntegrals> integrals(
      channels, {Eigen::MatrixXd::Zero(n + 1, n + 1), Eigen::MatrixXd::Zero(n + 1, n + 1)});
  for (std::size_t c = 0; c < channels; ++c) {
    for (Eigen::Index i = 0; i <= n; ++i) {
      for (Eigen::Index j = 0; j < i; ++j) {
        double sum = 0;
        for (Eigen::Index k = 0; k < size; ++k)
          sum += nodes.weight[static_cast<std::size_t>(k)] *
                 term_of(recipe.term, node_values[c](k, i) - node_values[c](k, j));
        integrals[c].value(i, j) = integrals[c].value(j, i) = sum;
        integrals[c].error(i, j) = integrals[c].error(j, i) = value_error(recipe.term, sum, unsure[c](i), unsure[c](j));
      }
    }
  }
  return integrals;
}

ComparisonIntegrals channel_integrals(std::span<const BrdfTable* const> tables, std::size_t channel,
                                      LiteratureMetric comparison, const CellWeights& weights, double volume) {
  const ComparisonRecipe recipe = recipe_of(comparison);
  const auto cells = cells_of(*tables.front(), comparison);
  const std::size_t rings = tables.front()->grid.rings().size();
  const auto n = static_cast<Eigen::Index>(tables.size());
  const auto size = static_cast<Eigen::Index>(cells.size());
  Eigen::MatrixXd node_values = Eigen::MatrixXd::Zero(size, n + 1);  // the last column is black
  Eigen::VectorXd unsure = Eigen::VectorXd::Zero(n + 1);             // integral of the values' errors
  parallel_for(tables.size(), [&](std::size_t t) {
    const auto values = tables[t]->channel(channel);
    const double* const errors = tables[t]->error.data() + channel * rings * rings;
    const auto column = static_cast<Eigen::Index>(t);
    double sum = 0;
    for (std::size_t k = 0; k < cells.size(); ++k) {
      const double x = cells[k].scale * values[k];
      node_values(static_cast<Eigen::Index>(k), column) = mapped(recipe.map, x);
      const double error = cells[k].scale * errors[cells[k].error_at];
      sum += weights.full[k] * term_of(recipe.term, mapped_error(recipe.map, x, error));
    }
    unsure(column) = sum;
  });
  ComparisonIntegrals integrals{Eigen::MatrixXd::Zero(n + 1, n + 1), Eigen::MatrixXd::Zero(n + 1, n + 1)};
  parallel_for(static_cast<std::size_t>(n), [&](std::size_t t) {
    const auto i = static_cast<Eigen::Index>(t);
    for (Eigen::Index j = i + 1; j <= n; ++j) {
      const Estimate sum = integral_of(recipe.term, has_kinks(recipe) ? kKinkedSafety : kSmoothSafety, weights,
                                       node_values.col(i).data(), node_values.col(j).data());
      integrals.value(i, j) = integrals.value(j, i) = sum.value / volume;
      integrals.error(i, j) = integrals.error(j, i) =
          (sum.error + value_error(recipe.term, sum.value, unsure(i), unsure(j))) / volume;
    }
  });
  return integrals;
}

}  // namespace

LiteratureResult compare_tables(std::span<const BrdfTable* const> given, LiteratureMetric comparison,
                                const LiteratureOptions& options) {
  check(options);
  require_values(given);
  const Operands operands(given, common_shape(given, true),
                          [](const BrdfTable& table, const HemisphereGrid&) { return table; });
  const std::span<const BrdfTable* const> tables = operands.all();
  report_progress(options, comparison, 0);
  Stopwatch watch;
  const BrdfTable& first = *tables.front();
  (void)comparison_weights(options, first.channels);  // wrong ones are told before the work
  std::vector<std::string> names;
  for (const auto* table : given) names.push_back(table->expression);
  if (recipe_of(comparison).domain == ComparisonDomain::half_difference) {
    if (first.form != TableForm::isotropic) {
      throw ArgumentError("'" + std::string(to_string(comparison)) + "' of general tables such as '" +
                          first.expression +
                          "' is not to be had; expected isotropic tables, which can be interpolated "
                          "at half-vector angles");
    }
    auto integrals = interpolated_integrals(tables, comparison, kFineNodes);
    const auto coarse = interpolated_integrals(tables, comparison, kCoarseNodes);
    for (std::size_t c = 0; c < integrals.size(); ++c)
      integrals[c].error += (integrals[c].value - coarse[c].value).cwiseAbs();
    LiteratureResult result = make_comparison_result(comparison, integrals, names, options);
    result.work.seconds_host = watch.lap();
    report_progress(options, comparison, 1);
    return result;
  }
  const CellMeasure measure(first.grid, comparison, options);
  const CellWeights weights = first.form == TableForm::isotropic ? isotropic_weights(first.grid, measure)
                                                                 : general_weights(first.grid, measure);
  double volume = 1;
  if (recipe_of(comparison).is_mean) {
    volume = 0;
    for (const double weight : weights.full) volume += weight;
  }
  std::vector<ComparisonIntegrals> channels;
  for (std::size_t c = 0; c < first.channels; ++c) {
    channels.push_back(channel_integrals(tables, c, comparison, weights, volume));
    report_progress(options, comparison, static_cast<double>(c + 1) / static_cast<double>(first.channels));
  }
  LiteratureResult result = make_comparison_result(comparison, channels, names, options);
  result.work.nodes = weights.full.size();
  result.work.seconds_host = watch.lap();
  return result;
}

}  // namespace lobe
