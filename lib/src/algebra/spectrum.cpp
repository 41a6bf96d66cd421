#include "lobe/algebra/spectrum.hpp"

#include <algorithm>
#include <array>
#include <atomic>
#include <cmath>
#include <limits>
#include <numbers>
#include <numeric>

#include "algebra/formula_blocks.hpp"
#include "algebra/operator_blocks.hpp"
#include "core/decompositions.hpp"
#include "core/numbers.hpp"
#include "core/parallel.hpp"
#include "core/text.hpp"
#include "hemisphere/embedded_rule.hpp"
#include "lobe/core/error.hpp"
#include "table/norm.hpp"

namespace lobe {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

constexpr double kReciprocal = 1e-10;  // defects that count as rounding
constexpr double kFinerSafety = 2;     // of changes against a finer grid, which leave out its own error
constexpr double kCoarserSafety = 1;   // of those against a coarser one, which are far larger than the error
constexpr double kEmbeddedSafety = 4;  // of those in an embedded rule, to first order
constexpr int kDecades = 6;

/// Eigenvalues or singular values, falling.
using BlockValues = SingularValues;

BlockValues decompose(const MatrixXd& block, bool is_self_adjoint, bool with_vectors) {
  if (is_self_adjoint) {
    const Eigenpairs eigen = symmetric_eigenpairs((block + block.transpose()) / 2, with_vectors);
    BlockValues result{eigen.values.reverse(), {}, {}};
    if (with_vectors) result.left = result.right = eigen.vectors.rowwise().reverse();
    return result;
  }
  return singular_values(block, with_vectors);
}

std::vector<BlockValues> decompose(const OperatorBlocks& blocks, bool is_self_adjoint, bool with_vectors,
                                   const ProgressCallback& progress) {
  std::vector<BlockValues> values(blocks.size());
  constexpr std::size_t kTogether = 16;  // progress is called from this thread only
  for (std::size_t first = 0; first < blocks.size(); first += kTogether) {
    if (progress && !progress("spectrum", static_cast<double>(first) / static_cast<double>(blocks.size()))) {
      throw Cancelled("spectrum interrupted");
    }
    parallel_for(std::min(kTogether, blocks.size() - first), [&](std::size_t b) {
      values[first + b] = decompose(blocks.blocks[first + b], is_self_adjoint, with_vectors);
    });
  }
  return values;
}

/// Falling values as their multiplicities repeat them.
VectorXd merged(const std::vector<BlockValues>& values, const std::vector<std::size_t>& multiplicities) {
  std::vector<double> all;
  for (std::size_t b = 0; b < values.size(); ++b) {
    for (const double value : values[b].values) all.insert(all.end(), multiplicities[b], value);
  }
  std::ranges::sort(all, std::greater());
  return Eigen::Map<const VectorXd>(all.data(), index(all.size()));
}

/// Change of falling values against those on another grid. They accumulate at a pivot, the factor of the delta parts:
/// those above are paired from the top, those below from the bottom; where the other grid has none left, its value is
/// the pivot.
VectorXd changes(const VectorXd& values, const VectorXd& others, double pivot) {
  VectorXd change(values.size());
  for (Index k = 0; k < values.size(); ++k) {
    const bool is_above = values(k) >= pivot;
    const Index partner = is_above ? k : others.size() - (values.size() - k);
    const bool is_there = partner >= 0 && partner < others.size() && (others(partner) >= pivot) == is_above;
    change(k) = std::abs(values(k) - (is_there ? others(partner) : pivot));
  }
  return change;
}

/// The largest change of each value, its two neighbours in rank and theirs in the next orders, because two grids may
/// agree on one value by accident.
std::vector<VectorXd> spread(const std::vector<VectorXd>& changes) {
  std::vector<VectorXd> largest = changes;
  for (std::size_t m = 0; m < changes.size(); ++m) {
    for (std::size_t other = m - std::min<std::size_t>(m, 1); other <= std::min(m + 1, changes.size() - 1); ++other) {
      const Index count = changes[m].size();
      for (const Index shift : {-2, -1, 0, 1, 2}) {
        if (std::abs(shift) >= count) continue;
        const Index first = std::max<Index>(0, -shift);
        const Index length = count - std::abs(shift);
        largest[m].segment(first, length) =
            largest[m].segment(first, length).cwiseMax(changes[other].segment(first + shift, length));
      }
    }
  }
  return largest;
}

/// Relative change of each row's weight in an embedded rule.
VectorXd embedded_changes(const BrdfTable& table) {
  const auto rings = table.grid.rings();
  const auto embedded = embedded_ring_weights(table.grid);
  VectorXd changes(table.rows());
  for (std::size_t row = 0; row < table.rows(); ++row) {
    const std::size_t ring = table.form == TableForm::isotropic ? row : table.grid.ring_of(row);
    const double own = rings[ring].weight * static_cast<double>(rings[ring].count) / (2 * std::numbers::pi);
    changes(index(row)) = embedded[ring] / own - 1;
  }
  return changes;
}

/// Changes by falling size of the values: each at least as large as those of larger values, but no larger than that of
/// the largest value and its own size. Functions of small values oscillate with the nodes, of which the embedded rule
/// sees every second one only.
VectorXd believable(const VectorXd& changes, const VectorXd& sizes) {
  std::vector<Index> order(static_cast<std::size_t>(sizes.size()));
  std::iota(order.begin(), order.end(), Index{0});
  std::ranges::sort(order, std::greater(), [&](Index k) { return sizes(k); });
  VectorXd errors(sizes.size());
  double most = 0;
  for (const Index k : order) {
    most = std::max(most, std::min(changes(k), sizes(k) + changes(order.front())));
    errors(k) = most;
  }
  return errors;
}

/// Errors of the grid judged by the table alone: how far a function that belongs to a value is from doing so in the
/// embedded rule. Orders beyond the last one of the grid fold back onto the others.
std::vector<VectorXd> own_grid_errors(const BrdfTable& table, const std::vector<BlockValues>& values,
                                      const OperatorBlocks& smooth) {
  const VectorXd embedded = embedded_changes(table);
  std::vector<VectorXd> errors;
  for (std::size_t b = 0; b < values.size(); ++b) {
    const MatrixXd& block = smooth.blocks[b];
    const VectorXd right = (block * embedded.asDiagonal() * values[b].right).colwise().norm();
    const VectorXd left = (block.transpose() * embedded.asDiagonal() * values[b].left).colwise().norm();
    const VectorXd sizes = values[b].values.cwiseAbs();
    const VectorXd change = kEmbeddedSafety * (right + left) / 2;
    errors.push_back(believable(change, sizes));
  }
  if (table.form == TableForm::general) return errors;
  double folded = 0;
  for (std::size_t m = values.size() - (values.size() + 7) / 8; m < values.size(); ++m) {
    folded = std::max(folded, smooth.blocks[m].norm());
  }
  for (auto& error : errors) error.array() += folded;
  return errors;
}

/// A factor of the delta parts on one ring, and how far from it others are that no ring has.
struct DeltaFactor {
  double value = 0;
  double spacing = 0;
};

/// Factors retro + sign mirror of the rings. Where they depend on the angle they are the continuous spectrum, of which
/// a grid has a value here and there: others lie half way to the next ring. Normal and horizon are nearer than that.
std::vector<DeltaFactor> delta_factors(const BrdfTable& table, std::size_t channel, double sign) {
  const auto rings = table.grid.rings();
  std::vector<DeltaFactor> factors(rings.size());
  for (std::size_t ring = 0; ring < rings.size(); ++ring) {
    const std::size_t row = table.form == TableForm::isotropic ? ring : rings[ring].first_node;
    const Eigen::Matrix2d delta = delta_matrix(table, channel, row);
    factors[ring].value = (delta(0, 0) + delta(1, 1) + sign * (delta(0, 1) + delta(1, 0))) / 2;
  }
  for (std::size_t ring = 0; ring + 1 < factors.size(); ++ring) {
    DeltaFactor& one = factors[ring];
    DeltaFactor& next = factors[ring + 1];
    const double half = std::abs(next.value - one.value) / 2;
    one.spacing = std::max(one.spacing, half);
    next.spacing = half;
  }
  return factors;
}

/// Root of the sum of squares of the negative values.
double negative_norm(const std::vector<BlockValues>& values, const std::vector<std::size_t>& multiplicities) {
  double sum = 0;
  for (std::size_t b = 0; b < values.size(); ++b) {
    sum += static_cast<double>(multiplicities[b]) * values[b].values.cwiseMin(0).squaredNorm();
  }
  return std::sqrt(sum);
}

double trace(const OperatorBlocks& blocks) {
  double sum = 0;
  for (std::size_t b = 0; b < blocks.size(); ++b) {
    sum += static_cast<double>(blocks.multiplicities[b]) * blocks.blocks[b].trace();
  }
  return sum;
}

/// The integral of f(L,L) dmu by the table's values, with what their errors add, and by the embedded rule.
struct TraceIntegral {
  double full = 0;
  double embedded = 0;
  double value_error = 0;
};

TraceIntegral integrate_trace(const BrdfTable& table, std::size_t channel) {
  const VectorXd embedded = embedded_changes(table);
  const std::size_t rows = table.rows();
  const std::size_t rings = table.grid.rings().size();
  TraceIntegral result;
  for (std::size_t row = 0; row < rows; ++row) {
    const bool is_isotropic = table.form == TableForm::isotropic;
    const std::size_t ring = is_isotropic ? row : table.grid.ring_of(row);
    const double weight =
        table.grid.rings()[ring].weight * (is_isotropic ? static_cast<double>(table.grid.rings()[ring].count) : 1);
    const double value =
        table.channel(channel)[is_isotropic ? (row * rows + row) * table.grid.half_azimuths() : row * rows + row];
    result.full += weight * value;
    result.embedded += weight * (1 + embedded(index(row))) * value;
    result.value_error += weight * table.error[(channel * rings + ring) * rings + ring];
  }
  return result;
}

/// The square of the Hilbert-Schmidt norm by the embedded rule.
double embedded_squared_norm(const BrdfTable& table, const OperatorBlocks& smooth) {
  const VectorXd weights = embedded_changes(table).array() + 1;
  double sum = 0;
  for (std::size_t b = 0; b < smooth.size(); ++b) {
    sum += static_cast<double>(smooth.multiplicities[b]) * weights.dot(smooth.blocks[b].cwiseAbs2() * weights);
  }
  return sum;
}

/// Spectra of one channel on another grid.
struct Comparison {
  std::vector<BlockValues> values;
  OperatorBlocks smooth;
  double safety = 1;
};

class ChannelAnalysis {
 public:
  ChannelAnalysis(const BrdfTable& table, std::size_t channel, const SpectrumOptions& options)
      : table_(table),
        channel_(channel),
        options_(options),
        smooth_(smooth_blocks(table, channel)),
        norms_(error_norms(table, channel)),
        delta_factors_{delta_factors(table, channel, 1), delta_factors(table, channel, -1)} {
    blocks_ = smooth_;
    add_delta(table, channel, 1, blocks_);
    judge_reciprocity();
  }

  [[nodiscard]] bool is_self_adjoint() const { return result_.is_self_adjoint; }

  [[nodiscard]] ChannelSpectrum analyse(const std::optional<Comparison>& comparison) {
    values_ = decompose(blocks_, is_self_adjoint(), !comparison, options_.progress);
    const auto grid_errors = comparison ? compared_errors(*comparison) : own_grid_errors(table_, values_, smooth_);
    // Values of the comparison are computed from formulas: its change contains the errors of the table's values.
    if (comparison) norms_ = {};
    double largest = 0;
    for (const auto& block : values_) largest = std::max(largest, block.values.cwiseAbs().maxCoeff());
    const double rounding =
        std::numeric_limits<double>::epsilon() * static_cast<double>(blocks_.blocks.front().rows()) * largest;
    const double common = norms_.largest + defect_ + rounding;
    for (std::size_t b = 0; b < values_.size(); ++b) add_order(b, grid_errors[b], common);
    find_negative(comparison, grid_errors, rounding);
    add_sums(comparison);
    add_ranks(largest);
    return result_;
  }

 private:
  void judge_reciprocity() {
    double sum = 0;
    for (std::size_t b = 0; b < blocks_.size(); ++b) {
      sum += static_cast<double>(blocks_.multiplicities[b]) *
             (blocks_.blocks[b] - blocks_.blocks[b].transpose()).squaredNorm() / 4;
    }
    const double norm = std::sqrt(squared_norm(smooth_));
    const double defect = std::sqrt(sum);
    result_.reciprocity_defect = norm > 0 ? defect / norm : 0;
    // A product that is not reciprocal is not wrong, however large the errors are.
    const bool is_product = table_.source.size() > 1;
    result_.is_self_adjoint =
        defect <= kReciprocal * std::sqrt(squared_norm(blocks_)) || (!is_product && defect <= norms_.hilbert_schmidt);
    if (result_.is_self_adjoint) defect_ = defect;
  }

  /// Effect of constant delta parts on functions of an order (for general tables: without the mirror, which shifts some
  /// of them up and some down, so that errors of those between are stated too large).
  [[nodiscard]] double pivot(std::size_t order) const {
    const Eigen::Matrix2d delta = delta_matrix(table_, channel_, 0);
    if (table_.form == TableForm::general) return delta(0, 0);
    const double factor = delta(0, 0) + (order % 2 == 0 ? delta(0, 1) : -delta(0, 1));
    return is_self_adjoint() ? factor : std::abs(factor);
  }

  [[nodiscard]] std::vector<VectorXd> compared_errors(const Comparison& comparison) const {
    std::vector<VectorXd> found;
    if (table_.form == TableForm::general) {
      found.push_back(
          changes(values_.front().values, merged(comparison.values, comparison.smooth.multiplicities), pivot(0)));
    }
    for (std::size_t m = 0; table_.form == TableForm::isotropic && m < values_.size(); ++m) {
      found.push_back(changes(values_[m].values,
                              m < comparison.values.size() ? comparison.values[m].values : VectorXd(), pivot(m)));
    }
    std::vector<VectorXd> errors = spread(found);
    for (auto& error : errors) error *= comparison.safety;
    return errors;
  }

  void add_order(std::size_t order, const VectorXd& grid_errors, double common) {
    const VectorXd& values = values_[order].values;
    OrderSpectrum spectrum{order, blocks_.multiplicities[order], {}};
    for (Index k = 0; k < values.size(); ++k) {
      spectrum.values.push_back({values(k), grid_errors(k) + common + delta_spacing(order, values(k))});
    }
    const auto magnitude = [](const Estimate& value) { return std::abs(value.value); };
    std::ranges::stable_sort(spectrum.values, std::greater(), magnitude);
    if (magnitude(spectrum.values.front()) > std::abs(result_.norm.value)) result_.norm = spectrum.values.front();
    const auto least = std::ranges::min_element(spectrum.values, {}, &Estimate::value);
    if (order == 0 || least->value < result_.smallest.value) result_.smallest = *least;
    result_.orders.push_back(std::move(spectrum));
    result_.norm.value = std::abs(result_.norm.value);
  }

  /// How far from a value others are that belong to the same function but on no ring: those of the nearest factor.
  [[nodiscard]] double delta_spacing(std::size_t order, double value) const {
    const bool has_both = table_.form == TableForm::general;
    double nearest = kInfinity;
    double spacing = 0;
    for (const bool is_even : {true, false}) {
      if (!has_both && is_even != (order % 2 == 0)) continue;
      for (const DeltaFactor& factor : delta_factors_[is_even ? 0 : 1]) {
        const double distance =
            is_self_adjoint() ? std::abs(value - factor.value) : std::abs(std::abs(value) - std::abs(factor.value));
        if (distance > nearest || (distance == nearest && factor.spacing <= spacing)) continue;
        nearest = distance;
        spacing = factor.spacing;
      }
    }
    return spacing;
  }

  void find_negative(const std::optional<Comparison>& comparison, const std::vector<VectorXd>& grid_errors,
                     double rounding) {
    if (!is_self_adjoint()) return;
    Estimate& norm = result_.negative_norm;
    if (has_negative_delta()) {
      norm = {kInfinity, 0};
      return;
    }
    norm.value = negative_norm(values_, blocks_.multiplicities);
    if (comparison) {
      norm.error = comparison->safety *
                   std::abs(norm.value - negative_norm(comparison->values, comparison->smooth.multiplicities));
    } else {
      double sum = 0;
      for (std::size_t b = 0; b < values_.size(); ++b) {
        sum += static_cast<double>(blocks_.multiplicities[b]) *
               (values_[b].values.array() < 0).select(grid_errors[b], 0.0).matrix().squaredNorm();
      }
      norm.error = std::sqrt(sum);
    }
    norm.error += norms_.hilbert_schmidt + defect_ + rounding * std::sqrt(static_cast<double>(table_.grid.nodes()));
  }

  void add_sums(const std::optional<Comparison>& comparison) {
    double sum = 0;
    double squares = 0;
    for (std::size_t b = 0; b < values_.size(); ++b) {
      const auto multiplicity = static_cast<double>(blocks_.multiplicities[b]);
      sum += multiplicity * values_[b].values.sum();
      squares += multiplicity * values_[b].values.squaredNorm();
    }
    SumRule& square = result_.hilbert_schmidt;
    square.sum = squares - (squared_norm(blocks_) - squared_norm(smooth_));
    square.integral.value = squared_norm(table_, channel_);
    const double e = norms_.hilbert_schmidt;
    square.integral.error = e * (2 * std::sqrt(square.integral.value) + e);
    square.integral.error +=
        comparison ? comparison->safety * std::abs(square.integral.value - squared_norm(comparison->smooth))
                   : kEmbeddedSafety * std::abs(square.integral.value - embedded_squared_norm(table_, smooth_));
    square.deviation = std::abs(square.sum - square.integral.value);

    const TraceIntegral diagonal = integrate_trace(table_, channel_);
    SumRule& trace_rule = result_.trace;
    trace_rule.sum = is_self_adjoint() ? sum - (trace(blocks_) - trace(smooth_)) : kUnknown;
    trace_rule.integral.value = diagonal.full;
    trace_rule.integral.error =
        comparison ? comparison->safety * std::abs(diagonal.full - trace(comparison->smooth))
                   : kEmbeddedSafety * std::abs(diagonal.full - diagonal.embedded) + diagonal.value_error;
    trace_rule.deviation = std::abs(trace_rule.sum - trace_rule.integral.value);
  }

  /// Whether delta parts have negative values, retro - |mirror|, which belong to functions without end.
  [[nodiscard]] bool has_negative_delta() const {
    constexpr double kRounding = 1e-12;
    for (std::size_t row = 0; row < table_.rows(); ++row) {
      const Eigen::Matrix2d delta = delta_matrix(table_, channel_, row);
      const double mirror = std::abs(delta(0, 1) + delta(1, 0)) / 2;
      if ((delta(0, 0) + delta(1, 1)) / 2 < mirror * (1 - kRounding)) return true;
    }
    return false;
  }

  /// Largest magnitude of the delta parts on any order.
  [[nodiscard]] double largest_delta() const {
    double largest = 0;
    for (std::size_t row = 0; row < table_.rows(); ++row) {
      largest = std::max(largest, singular_values(delta_matrix(table_, channel_, row), false).values(0));
    }
    return largest;
  }

  void add_ranks(double largest) {
    const double delta = largest_delta();
    const auto for_all = [&](const auto& use) {
      for (std::size_t b = 0; b < values_.size(); ++b) {
        for (const double value : values_[b].values) use(static_cast<double>(blocks_.multiplicities[b]), value, b);
      }
    };
    double squares = 0;
    double fourths = 0;
    for_all([&](double multiplicity, double value, std::size_t) {
      squares += multiplicity * value * value;
      fourths += multiplicity * value * value * value * value;
    });
    double entropy = 0;
    double rank = 0;
    for_all([&](double multiplicity, double value, std::size_t) {
      const double share = value * value / squares;
      if (share > 0) entropy -= multiplicity * share * std::log(share);
      if (std::abs(value) >= options_.threshold * largest && value != 0) rank += multiplicity;
    });
    result_.effective_rank = delta > 0 ? kInfinity : squares > 0 ? std::exp(entropy) : 0;
    result_.participation_ratio = delta > 0 ? kInfinity : squares > 0 ? squares * squares / fourths : 0;
    result_.numerical_rank = delta > 0 && delta >= options_.threshold * largest ? kInfinity : rank;
    result_.white_share = squares / static_cast<double>(table_.grid.nodes());
    for (int decade = 1; decade <= kDecades; ++decade) {
      DecayPoint point{.level = std::pow(10.0, -decade)};
      const double noise = point.level * largest;
      for_all([&](double multiplicity, double value, std::size_t order) {
        if (noise > 0)
          point.bits += multiplicity * std::log1p(value * value / (noise * noise)) / (2 * std::numbers::ln2);
        if (!(std::abs(value) > noise)) return;
        point.components += multiplicity;
        point.last_order = std::max(point.last_order, order);
      });
      if (delta > 0) point.bits = kInfinity;
      if (delta > noise) point.components = kInfinity;
      result_.decay.push_back(point);
    }
  }

  const BrdfTable& table_;
  std::size_t channel_;
  const SpectrumOptions& options_;
  OperatorBlocks smooth_;
  OperatorBlocks blocks_;
  ErrorNorms norms_;
  std::array<std::vector<DeltaFactor>, 2> delta_factors_;  ///< of even and of odd orders, where they tell these apart
  double defect_ = 0;
  std::vector<BlockValues> values_;
  ChannelSpectrum result_;
};

Comparison compare(const FormulaTable& formula, std::size_t channel, bool is_self_adjoint,
                   const ProgressCallback& progress) {
  Comparison comparison;
  comparison.smooth = formula.smooth_blocks(channel);
  comparison.safety = formula.is_finer() ? kFinerSafety : kCoarserSafety;
  OperatorBlocks blocks = comparison.smooth;
  add_delta(formula.frame(), channel, 1, blocks);
  comparison.values = decompose(blocks, is_self_adjoint, false, progress);
  return comparison;
}

}  // namespace

Spectrum spectrum(const Device& device, const BrdfTable& table, const SpectrumOptions& options) {
  check(table);
  if (!(options.threshold > 0 && options.threshold < 1)) {
    throw ArgumentError("threshold " + shortest(options.threshold) + " of the numerical rank; expected one in (0, 1)");
  }
  std::optional<FormulaTable> formula;
  if (options.refine) formula = FormulaTable::make(device, table);
  Spectrum result;
  result.threshold = options.threshold;
  for (std::size_t c = 0; c < table.channels; ++c) {
    ChannelAnalysis analysis(table, c, options);
    std::optional<Comparison> comparison;
    if (formula) comparison = compare(*formula, c, analysis.is_self_adjoint(), options.progress);
    result.channels.push_back(analysis.analyse(comparison));
  }
  return result;
}

std::uint64_t spectrum_bytes(const BrdfTable& table) {
  // Blocks with and without delta parts, and vectors while they are needed; those of the comparison beside two factors.
  constexpr std::uint64_t kCopies = 4;
  const std::uint64_t own = kCopies * sizeof(double) * table.size();
  return own + (table.source.empty() ? 0 : (kCopies + table.source.size()) * compared_bytes(table));
}

}  // namespace lobe
