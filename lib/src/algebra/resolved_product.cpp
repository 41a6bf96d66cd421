#include "algebra/resolved_product.hpp"

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <complex>
#include <numbers>
#include <numeric>
#include <unsupported/Eigen/FFT>

#include "algebra/operator_blocks.hpp"
#include "core/parallel.hpp"
#include "hemisphere/gauss.hpp"
#include "hemisphere/inner_rule.hpp"
#include "lobe/core/error.hpp"

namespace lobe {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using std::numbers::pi;
using Complex = std::complex<double>;

constexpr std::size_t kChunkBytes = std::size_t{96} << 20;  // of values of a factor between the rings and some X
constexpr std::size_t kFirstLevels = 3;                     // that are always done, where there is a choice
constexpr double kMostWork = 2e11;                          // multiplications of a level beyond the first two
constexpr std::size_t kSampledRings = 9;                    // at which a further level is looked at

// What a further level shows is the error of the last one but for its own, which is a third of it and more where kinks
// make errors fall by 1.5 to 3 from level to level, and misses the worst of the rings.
constexpr double kSafety = 3;
constexpr double kLeastShare = 0.3;         // of what smooth integrands lead to expect, however small samples are
constexpr double kFarShare = 0.2;           // of the largest ratio, away from where it was found
constexpr double kLeastDecay = 1e-3;        // of differences from level to level that is believed
constexpr double kLeastMeanShare = 0.1;     // of the largest error over azimuth, for the root mean square
constexpr double kProductRounding = 1e-14;  // of sums, relative to the largest value of a pair of rings

// What the elevations of a band do not tell of a kink in it, once the higher Legendre coefficients of the integrand do
// not fall: a share of these, which kSafety multiplies as well.
constexpr double kUntold = 1.1;
constexpr double kFall = 0.5;          // of coefficients two degrees on, above which it is that of kinks
constexpr std::size_t kTellTales = 6;  // of a band: four coefficients, and both ends

/// Directions X at all azimuths of the grid, shifted by an offset; of even factors also those shifted by its opposite.
struct InnerPoint {
  double theta;
  double offset;
  double root_weight;
  bool is_half;    ///< half a step off: the transform of an even factor is real but for a phase
  bool has_sines;  ///< it is not real
};

/// Adds those of an elevation.
/// \param is_even both factors are
void add_points(std::vector<InnerPoint>& points, const WeightedPoint& elevation, const InnerBand& band, double step,
                bool is_even) {
  for (const WeightedPoint& offset : band.offsets) {
    const bool is_half = offset.at == step / 2;
    if (!is_even) {
      const bool has_opposite = offset.at != 0 && !is_half;
      const double weight = std::sqrt(elevation.weight * offset.weight / (has_opposite ? 2 : 1));
      points.push_back({pi / 2 - elevation.at, offset.at, weight, false, true});
      if (has_opposite) points.push_back({pi / 2 - elevation.at, -offset.at, weight, false, true});
      continue;
    }
    points.push_back({pi / 2 - elevation.at, offset.at, std::sqrt(elevation.weight * offset.weight), is_half,
                      offset.at != 0 && !is_half});
  }
}

std::vector<InnerPoint> points_of(const InnerRule& rule, double step, bool is_even) {
  std::vector<InnerPoint> points;
  for (const InnerBand& band : rule.bands()) {
    for (const WeightedPoint& elevation : band.elevations) add_points(points, elevation, band, step, is_even);
  }
  return points;
}

/// Coefficients of what a band's elevations contribute, and its ends last, that tell of a kink: [tell-tale][elevation].
/// The first ones make Legendre coefficients of the degrees n - 1 to n - 4 for n nodes, normalised; the last ones the
/// difference between the integrand at an end and the polynomial through the nodes, times the width that no node sees.
MatrixXd tell_tales(std::size_t elevations) {
  const GaussRule gauss = gauss_rule(static_cast<int>(elevations));
  MatrixXd found = MatrixXd::Zero(index(kTellTales), index(elevations + 2));
  for (std::size_t e = 0; e < elevations; ++e) {
    const double x = 2 * gauss.nodes[e] - 1;
    for (std::size_t t = 0; t < 4; ++t) {
      const auto degree = static_cast<unsigned>(elevations - 1 - t);
      found(index(t), index(e)) = std::sqrt(2.0 * degree + 1) * std::legendre(degree, x);
    }
    for (const std::size_t end : {0U, 1U}) {
      double weight = 1;
      for (std::size_t other = 0; other < elevations; ++other) {
        if (other == e) continue;
        weight *= (static_cast<double>(end) - gauss.nodes[other]) / (gauss.nodes[e] - gauss.nodes[other]);
      }
      found(index(4 + end), index(e)) = -gauss.nodes[0] * weight / gauss.weights[e];
    }
  }
  for (const std::size_t end : {0U, 1U}) found(index(4 + end), index(elevations + end)) = gauss.nodes[0];
  return found;
}

/// The product between some rings by azimuthal orders, summed over chunks of X.
///
/// With f_a = f(L, X at the azimuth a of the grid and an offset) and g likewise about V, the sum over a is a
/// correlation, whose transform is F conj(G): its real part is the even part of the product, its imaginary part the odd
/// one. Of even factors the sum over both signs of the offset has 2 Re(F conj(G)).
class OrderSum {
 public:
  /// \param has_odd sum the odd part, too
  OrderSum(const HemisphereGrid& grid, std::vector<std::size_t> rings, std::size_t channels, bool has_odd)
      : turn_(grid.n_phi()),
        orders_(grid.half_azimuths()),
        rings_(std::move(rings)),
        sums_(channels * orders_, MatrixXd::Zero(index(rings_.size()), index(rings_.size()))) {
    if (has_odd) odd_sums_ = sums_;
    for (std::size_t m = 0; m < orders_; ++m) {
      phases_.push_back(std::polar(1.0, -pi * static_cast<double>(m) / static_cast<double>(turn_)));
    }
  }

  /// Adds what some of X contribute.
  void add(const InnerFactor& f, const InnerFactor& g, bool is_square, std::span<const InnerPoint> points) {
    transform_all(f, g, is_square, points);
    const std::vector<double>& right = is_square ? left_ : right_;
    parallel_for(sums_.size(), [&](std::size_t at) {
      sums_[at].noalias() += block(left_, f.channels, at).transpose() * block(right, g.channels, at);
    });
    if (odd_sums_.empty()) return;
    // Im(F conj(G)): cosines of the one with sines of the other.
    for (std::size_t at = 0; at + 1 < right_.size(); at += 2) {
      const double cosine = right_[at];
      right_[at] = -right_[at + 1];
      right_[at + 1] = cosine;
    }
    parallel_for(odd_sums_.size(), [&](std::size_t at) {
      odd_sums_[at].noalias() += block(left_, f.channels, at).transpose() * block(right_, g.channels, at);
    });
  }

  /// Adds what the elevations of some bands contribute, and looks at what these tell of kinks.
  /// \return by band, what the integral may be off by, the largest over azimuth [channel][a][b]
  [[nodiscard]] std::vector<std::vector<double>> add_bands(const InnerFactor& f, const InnerFactor& g, bool is_square,
                                                           std::span<const InnerBand> bands) {
    const double step = 2 * pi / static_cast<double>(turn_);
    const std::size_t elevations = bands.front().elevations.size();
    std::vector<InnerPoint> points;
    std::vector<std::size_t> first{0};  // point of each elevation, those of a band and its ends
    for (const InnerBand& band : bands) {
      for (std::size_t e = 0; e < elevations + 2; ++e) {
        const WeightedPoint& elevation = e < elevations ? band.elevations[e] : band.ends.at(e - elevations);
        add_points(points, elevation, band, step, f.is_even && g.is_even);
        first.push_back(points.size());
      }
    }
    transform_all(f, g, is_square, points);
    const std::vector<double>& right = is_square ? left_ : right_;
    const MatrixXd weights = tell_tales(elevations);
    std::vector<std::vector<MatrixXd>> told(bands.size() * kTellTales);
    for (auto& one : told) one.assign(sums_.size(), MatrixXd::Zero(index(rings_.size()), index(rings_.size())));
    parallel_for(sums_.size(), [&](std::size_t at) {
      const auto of_f = block(left_, f.channels, at);
      const auto of_g = block(right, g.channels, at);
      for (std::size_t k = 0; k + 1 < first.size(); ++k) {
        const std::size_t e = k % (elevations + 2);
        const Index from = index(columns_[first[k]]);
        const Index count = index(columns_[first[k + 1]]) - from;
        const MatrixXd part = of_f.middleRows(from, count).transpose() * of_g.middleRows(from, count);
        if (e < elevations) sums_[at] += part;
        for (std::size_t t = 0; t < kTellTales; ++t) {
          const double weight = weights(index(t), index(e));
          if (weight != 0) told[k / (elevations + 2) * kTellTales + t][at] += weight * part;
        }
      }
    });
    std::vector<std::vector<double>> untold;
    for (std::size_t band = 0; band < bands.size(); ++band) {
      std::vector<TableValues> values;
      for (std::size_t t = 0; t < kTellTales; ++t) {
        values.push_back(inverse(told[band * kTellTales + t], is_square, 1));
      }
      std::vector<double> largest(values[0].size() / orders_);
      for (std::size_t run = 0; run < largest.size(); ++run) {
        const auto sum_of = [&](std::size_t one, std::size_t other) {
          double most = 0;
          for (std::size_t k = run * orders_; k < (run + 1) * orders_; ++k) {
            most = std::max(most, std::hypot(values[one][k], values[other][k]));
          }
          return most;
        };
        const double last = sum_of(0, 1);
        const double before = sum_of(2, 3);
        const double fall = last >= kFall * before ? 1 : last / (kFall * before);
        largest[run] = last * fall * fall + sum_of(4, 5);
      }
      untold.push_back(std::move(largest));
    }
    return untold;
  }

  /// The odd part, as values() has the even one.
  [[nodiscard]] TableValues odd_values() const {
    return odd_sums_.empty() ? TableValues() : inverse(odd_sums_, false, Complex(0, 1));
  }

  /// The product, [channel][ring_in][ring_out][k].
  /// \param is_square takes the mean with the transpose
  [[nodiscard]] TableValues values(bool is_square) const { return inverse(sums_, is_square, 1); }

 private:
  void transform_all(const InnerFactor& f, const InnerFactor& g, bool is_square, std::span<const InnerPoint> points) {
    const double step = 2 * pi / static_cast<double>(turn_);
    std::vector<Direction> inner;
    inner.reserve(points.size() * turn_);
    columns_.assign(1, 0);
    for (const InnerPoint& point : points) {
      for (std::size_t k = 0; k < turn_; ++k) {
        inner.push_back({point.theta, step * static_cast<double>(k) + point.offset});
      }
      columns_.push_back(columns_.back() + (point.has_sines ? 2 : 1));
    }
    transform(f, inner, points, left_);
    if (!is_square) transform(g, inner, points, right_);
  }

  /// \param unit of the transform: 1 of even series, i of odd ones
  [[nodiscard]] TableValues inverse(const std::vector<MatrixXd>& sums, bool is_square, Complex unit) const {
    const std::size_t count = rings_.size();
    const std::size_t half = orders_ - 1;
    TableValues values(sums.size() * count * count);
    parallel_for(sums.size() / orders_ * count, [&](std::size_t row) {
      const std::size_t first = row / count * orders_;
      const Index i = index(row % count);
      Eigen::FFT<double> fft;
      std::vector<Complex> series(2 * half);
      std::vector<Complex> orders(2 * half);
      for (Index j = 0; j < index(count); ++j) {
        for (std::size_t m = 0; m < orders_; ++m) {
          const MatrixXd& sum = sums[first + m];
          orders[m] = unit * (is_square ? (sum(i, j) + sum(j, i)) / 2 : sum(i, j));
          if (m > 0) orders[2 * half - m] = std::conj(orders[m]);
        }
        fft.inv(series, orders);
        double* const out = values.data() + (row * count + static_cast<std::size_t>(j)) * orders_;
        for (std::size_t k = 0; k < orders_; ++k) out[k] = series[k].real();
      }
    });
    return values;
  }

  [[nodiscard]] Eigen::Map<const MatrixXd> block(const std::vector<double>& side, std::size_t own_channels,
                                                 std::size_t at) const {
    const std::size_t channel = own_channels == 1 ? 0 : at / orders_;
    const std::size_t size = columns_.back() * rings_.size();
    return {side.data() + (channel * orders_ + at % orders_) * size, index(columns_.back()), index(rings_.size())};
  }

  /// Fourier transforms over the azimuth times the root of the weights, [channel][order][ring][column].
  void transform(const InnerFactor& factor, std::span<const Direction> inner, std::span<const InnerPoint> points,
                 std::vector<double>& side) {
    const std::size_t count = rings_.size();
    const std::size_t depth = columns_.back();
    values_.resize(factor.channels * count * inner.size());
    factor.values(rings_, inner, values_);
    side.resize(factor.channels * orders_ * count * depth);
    parallel_for(factor.channels * count, [&](std::size_t row) {
      Eigen::FFT<double> fft;
      fft.SetFlag(Eigen::FFT<double>::HalfSpectrum);
      std::vector<Complex> orders(turn_);
      double* const out = side.data() + (row / count * orders_ * count + row % count) * depth;
      for (std::size_t p = 0; p < points.size(); ++p) {
        fft.fwd(orders.data(), values_.data() + row * inner.size() + p * turn_, static_cast<Index>(turn_));
        for (std::size_t m = 0; m < orders_; ++m) {
          const Complex order = points[p].is_half ? orders[m] * phases_[m] : orders[m];
          double* const to = out + m * count * depth + columns_[p];
          to[0] = points[p].root_weight * order.real();
          if (points[p].has_sines) to[1] = points[p].root_weight * order.imag();
        }
      }
    });
  }

  std::size_t turn_;
  std::size_t orders_;
  std::vector<std::size_t> rings_;
  std::vector<MatrixXd> sums_;        ///< [channel][order]
  std::vector<MatrixXd> odd_sums_;    ///< the same; empty where they are not wanted
  std::vector<Complex> phases_;       ///< of half a step, by order
  std::vector<std::size_t> columns_;  ///< where the transforms of each point begin; the number of all
  std::vector<double> values_, left_, right_;
};

/// Values of a product between some rings, [channel][a][b][k].
struct Level {
  TableValues even;
  TableValues odd;  ///< empty where it is not wanted, or there is none
};

/// Both factors, and the grid.
class Product {
 public:
  Product(const InnerFactor& f, const InnerFactor& g, const HemisphereGrid& grid, const ResolvedOptions& options)
      : f_(f), g_(g), grid_(grid), options_(options) {}

  [[nodiscard]] std::size_t channels() const { return std::max(f_.channels, g_.channels); }

  [[nodiscard]] bool is_even() const { return f_.is_even && g_.is_even; }

  [[nodiscard]] InnerRule rule(std::size_t level) const {
    const bool has_kinks = f_.has_ring_kinks || g_.has_ring_kinks;
    return {grid_, f_.extent, g_.extent, level, has_kinks ? InnerPanels::on_all_rings : InnerPanels::by_width};
  }

  /// Whether the work that a level takes is bearable.
  [[nodiscard]] bool is_bearable(std::size_t level) const {
    if (work(level) > kMostWork) return false;
    const auto points = points_of(rule(level), 2 * pi / static_cast<double>(grid_.n_phi()), is_even()).size();
    return 2 * static_cast<double>(points * grid_.n_phi() * grid_.n_theta()) <= options_.most_values;
  }

  /// Multiplications of a level, about.
  [[nodiscard]] double work(std::size_t level) const {
    const auto rings = static_cast<double>(grid_.n_theta());
    return static_cast<double>(channels() * grid_.half_azimuths() * rule(level).size()) * rings * rings;
  }

  /// Between some rings.
  [[nodiscard]] Level at_level(std::size_t level, const std::vector<std::size_t>& rings, bool with_odd) const {
    const auto points = points_of(rule(level), 2 * pi / static_cast<double>(grid_.n_phi()), is_even());
    OrderSum sum(grid_, rings, channels(), with_odd && !is_even());
    const std::size_t bytes = sizeof(double) * channels() * rings.size() * grid_.n_phi();
    const std::size_t chunk = std::max<std::size_t>(1, kChunkBytes / bytes);
    for (std::size_t first = 0; first < points.size(); first += chunk) {
      const double share = static_cast<double>(first) / static_cast<double>(points.size());
      if (options_.progress && !options_.progress("product", share)) throw Cancelled("the composition was cancelled");
      sum.add(f_, g_, options_.is_square, std::span(points).subspan(first, std::min(chunk, points.size() - first)));
    }
    return {sum.values(options_.is_square), sum.odd_values()};
  }

  /// Between some rings, with what the elevations of X tell of kinks: what values may be off by, the largest over
  /// azimuth [channel][a][b].
  [[nodiscard]] std::pair<TableValues, std::vector<double>> with_tell_tales(
      std::size_t level, const std::vector<std::size_t>& rings) const {
    const InnerRule inner = rule(level);
    const std::span<const InnerBand> bands = inner.bands();
    OrderSum sum(grid_, rings, channels(), false);
    const std::size_t pairs = channels() * rings.size() * rings.size();
    const std::size_t told = sizeof(double) * kTellTales * pairs * grid_.half_azimuths();
    const std::size_t point = sizeof(double) * channels() * rings.size() * grid_.n_phi();
    std::vector<double> untold(pairs);
    std::vector<double> squares(pairs);
    for (std::size_t first = 0; first < bands.size();) {
      std::size_t bytes = 0;
      std::size_t end = first;
      for (; end < bands.size() && (end == first || bytes < kChunkBytes); ++end) {
        bytes += told + 2 * point * bands[end].offsets.size() * (bands[end].elevations.size() + 2);
      }
      const double share = static_cast<double>(first) / static_cast<double>(bands.size());
      if (options_.progress && !options_.progress("product", share)) throw Cancelled("the composition was cancelled");
      for (const auto& band : sum.add_bands(f_, g_, options_.is_square, bands.subspan(first, end - first))) {
        for (std::size_t at = 0; at < pairs; ++at) {
          untold[at] += band[at];
          squares[at] += band[at] * band[at];
        }
      }
      first = end;
    }
    for (std::size_t at = 0; at < pairs; ++at) untold[at] = std::min(untold[at], kDeviations * std::sqrt(squares[at]));
    return {sum.values(options_.is_square), std::move(untold)};
  }

 private:
  static constexpr double kDeviations = 2;
  const InnerFactor& f_;
  const InnerFactor& g_;
  const HemisphereGrid& grid_;
  const ResolvedOptions& options_;
};

/// Largest absolute value of each run of values, of one table or of the difference of two.
std::vector<double> largest(std::span<const double> a, std::span<const double> b, std::size_t run) {
  std::vector<double> found(a.size() / run);
  for (std::size_t at = 0; at < a.size(); ++at) {
    found[at / run] = std::max(found[at / run], std::abs(b.empty() ? a[at] : a[at] - b[at]));
  }
  return found;
}

/// Root mean squares of runs over half a turn of one table, or of the difference of two.
std::vector<double> root_mean_squares(std::span<const double> a, std::span<const double> b, std::size_t run) {
  std::vector<double> found(a.size() / run);
  for (std::size_t at = 0; at < a.size(); ++at) {
    const double value = b.empty() ? a[at] : a[at] - b[at];
    const bool is_end = at % run == 0 || at % run + 1 == run;
    found[at / run] += (is_end ? 0.5 : 1) * value * value / static_cast<double>(run - 1);
  }
  for (double& value : found) value = std::sqrt(value);
  return found;
}

/// Relative errors at pairs of rings, [channel][ring][ring]: the largest of each and of its neighbours.
std::vector<double> with_neighbours(const std::vector<double>& errors, std::size_t rings) {
  std::vector<double> widened(errors.size());
  for (std::size_t at = 0; at < errors.size(); ++at) {
    const std::size_t j = at % rings;
    const std::size_t i = at / rings % rings;
    const double* const channel = errors.data() + at / (rings * rings) * rings * rings;
    for (std::size_t a = i - std::min<std::size_t>(i, 1); a < std::min(i + 2, rings); ++a) {
      for (std::size_t b = j - std::min<std::size_t>(j, 1); b < std::min(j + 2, rings); ++b) {
        widened[at] = std::max(widened[at], channel[a * rings + b]);
      }
    }
  }
  return widened;
}

std::vector<double> over(std::vector<double> errors, const std::vector<double>& sizes) {
  for (std::size_t at = 0; at < errors.size(); ++at) errors[at] = sizes[at] > 0 ? errors[at] / sizes[at] : 0;
  return errors;
}

/// Some rings, evenly spread, with the first and the last.
std::vector<std::size_t> sampled_rings(std::size_t rings) {
  const std::size_t count = std::min(rings, kSampledRings);
  std::vector<std::size_t> chosen;
  for (std::size_t k = 0; k < count; ++k) chosen.push_back(count == 1 ? 0 : k * (rings - 1) / (count - 1));
  return chosen;
}

/// Bounds on the errors of a level from two things: what a further level changes at pairs of some rings, and the
/// differences of this level and the one before at all pairs, all relative. Errors of smooth integrands are less than
/// the difference by as much as that is less than the one before, or more; those of kinks are a share of it. So the
/// sampled errors are taken relative to three sizes, difference x decay^power, each gives a bound, and the least
/// counts: the largest ratio at the samples around a pair, or a share of the largest of all.
class ErrorModel {
 public:
  /// \param rings of the table
  /// \param chosen the sampled ones
  ErrorModel(std::size_t rings, std::vector<std::size_t> chosen, std::vector<double> differences,
             const std::vector<double>& before)
      : rings_(rings),
        chosen_(std::move(chosen)),
        differences_(std::move(differences)),
        decay_(differences_.size(), 1) {
    for (std::size_t at = 0; at < before.size(); ++at) {
      if (before[at] > 0) decay_[at] = std::clamp(differences_[at] / before[at], kLeastDecay, 1.0);
    }
  }

  /// \param sampled [channel][a][b]
  [[nodiscard]] std::vector<double> bounds(const std::vector<double>& sampled) const {
    std::vector<double> least;
    for (const double power : {0.0, 0.5, 1.0}) {
      const auto of_power = bounds(sampled, power);
      if (least.empty()) least = of_power;
      for (std::size_t at = 0; at < least.size(); ++at) least[at] = std::min(least[at], of_power[at]);
    }
    for (std::size_t at = 0; at < least.size(); ++at) least[at] = std::max(least[at], kLeastShare * size(at, 1));
    return least;
  }

  /// Pair of rings of the table that a sampled one is, with its channel.
  [[nodiscard]] std::size_t pair_of(std::size_t sample) const {
    const std::size_t count = chosen_.size();
    const std::size_t channel = sample / (count * count);
    return (channel * rings_ + chosen_[sample / count % count]) * rings_ + chosen_[sample % count];
  }

 private:
  [[nodiscard]] double size(std::size_t at, double power) const {
    return differences_[at] * std::pow(decay_[at], power);
  }

  [[nodiscard]] std::vector<double> bounds(const std::vector<double>& sampled, double power) const {
    const std::size_t count = chosen_.size();
    std::vector<double> ratios;
    double largest = 0;
    for (std::size_t sample = 0; sample < sampled.size(); ++sample) {
      ratios.push_back(sampled[sample] / (size(pair_of(sample), power) + kProductRounding));
      largest = std::max(largest, ratios.back());
    }
    std::vector<double> bounds(differences_.size());
    for (std::size_t at = 0; at < bounds.size(); ++at) {
      const double* const channel = ratios.data() + at / (rings_ * rings_) * count * count;
      const auto [a_low, a_high] = around(at / rings_ % rings_);
      const auto [b_low, b_high] = around(at % rings_);
      double ratio = kFarShare * largest;
      for (std::size_t a = a_low; a <= a_high; ++a) {
        for (std::size_t b = b_low; b <= b_high; ++b) ratio = std::max(ratio, channel[a * count + b]);
      }
      bounds[at] = kSafety * ratio * (size(at, power) + kProductRounding);
    }
    return bounds;
  }

  /// Numbers of the sampled rings on both sides of a ring, and the next ones.
  [[nodiscard]] std::pair<std::size_t, std::size_t> around(std::size_t ring) const {
    const auto above = static_cast<std::size_t>(std::ranges::lower_bound(chosen_, ring) - chosen_.begin());
    return {above - std::min<std::size_t>(above, 2), std::min(above + 1, chosen_.size() - 1)};
  }

  std::size_t rings_;
  std::vector<std::size_t> chosen_;
  std::vector<double> differences_;
  std::vector<double> decay_;
};

/// Root mean square of errors relative to that of sizes, weighted by dmu dmu, of the worst channel.
double mean_square(const std::vector<double>& errors, const std::vector<double>& sizes, const HemisphereGrid& grid) {
  const auto rings = grid.rings();
  const std::size_t blocks = rings.size() * rings.size();
  double worst = 0;
  for (std::size_t first = 0; first < errors.size(); first += blocks) {
    double error = 0;
    double size = 0;
    for (std::size_t at = 0; at < blocks; ++at) {
      const double weight = rings[at / rings.size()].weight * rings[at % rings.size()].weight;
      error += weight * errors[first + at] * errors[first + at];
      size += weight * sizes[first + at] * sizes[first + at];
    }
    if (size > 0) worst = std::max(worst, std::sqrt(error / size));
  }
  return worst;
}

}  // namespace

ResolvedProduct resolved_product(const InnerFactor& f, const InnerFactor& g, const HemisphereGrid& grid,
                                 const ResolvedOptions& options) {
  const Product product(f, g, grid, options);
  const std::size_t rings = grid.n_theta();
  const std::size_t half = grid.half_azimuths();
  std::vector<std::size_t> all(rings);
  std::iota(all.begin(), all.end(), std::size_t{0});
  const auto chosen = sampled_rings(rings);
  ResolvedProduct result;
  std::vector<double> before;  // relative differences of the level before, with their neighbours
  const std::size_t last = std::min(options.levels, InnerRule::kLevels - 1);
  for (std::size_t level = 0; level < last; ++level) {
    if (level > 1 && !product.is_bearable(level)) break;
    auto [values, odd] = product.at_level(level, all, level > 0);
    if (level == 0) {
      result.values = std::move(values);
      continue;
    }
    result.largest_odd = largest(odd, {}, half);
    result.odd = root_mean_squares(odd, {}, half);
    const auto sizes = largest(values, {}, half);
    const auto changes = largest(values, result.values, half);
    const auto shares = with_neighbours(over(root_mean_squares(values, result.values, half), changes), rings);
    const auto differences = with_neighbours(over(changes, sizes), rings);
    result.values = std::move(values);
    const bool can_go_on = level + 1 < last && product.is_bearable(level + 1);
    if (can_go_on && level + 1 < std::min(kFirstLevels, last)) {
      before = differences;
      continue;
    }
    // Changes by a further level at some rings.
    const auto [finer, untold] = product.with_tell_tales(level + 1, chosen);
    const ErrorModel model(rings, chosen, differences, before);
    std::vector<double> sampled(finer.size() / half);
    for (std::size_t at = 0; at < finer.size(); ++at) {
      const std::size_t pair = model.pair_of(at / half);
      if (sizes[pair] == 0) continue;
      const double change = std::abs(finer[at] - result.values[pair * half + at % half]) / sizes[pair];
      sampled[at / half] = std::max(sampled[at / half], change);
    }
    for (std::size_t at = 0; at < sampled.size(); ++at) {
      const double size = sizes[model.pair_of(at)];
      if (size > 0) sampled[at] = std::max(sampled[at], kUntold * untold[at] / size);
    }
    result.error = model.bounds(sampled);
    result.mean_error.resize(sizes.size());
    for (std::size_t at = 0; at < sizes.size(); ++at) {
      result.error[at] = sizes[at] * (result.error[at] + kProductRounding);
      result.mean_error[at] = result.error[at] * std::max(shares[at], kLeastMeanShare);
    }
    if (!can_go_on || mean_square(result.error, sizes, grid) <= options.tolerance) break;
    before = differences;
  }
  return result;
}

std::uint64_t resolved_product_bytes(const HemisphereGrid& grid, std::size_t channels) {
  const std::uint64_t table = sizeof(double) * channels * grid.n_theta() * grid.n_theta() * grid.half_azimuths();
  const std::uint64_t row = sizeof(double) * channels * grid.n_theta() * grid.n_phi();
  // Two levels and the sums of one; values of a chunk and the transforms of both factors.
  return 3 * table + 3 * std::max<std::uint64_t>(kChunkBytes, row);
}

}  // namespace lobe
