#include "lobe/reflectance/azimuthal_modes.hpp"

#include <fmt/format.h>

#include <Eigen/Core>
#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <functional>
#include <limits>
#include <numbers>
#include <utility>

#include "core/text.hpp"
#include "device/rounding.hpp"
#include "hemisphere/gauss.hpp"
#include "lobe/core/error.hpp"
#include "lobe/reflectance/as_function.hpp"

namespace lobe {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using std::numbers::pi;

constexpr std::array<std::string_view, 2> kConventions{"brdf", "disort"};
constexpr std::size_t kMostCosines = 1000;
constexpr std::size_t kMostNumbers = std::size_t{1} << 25;
constexpr double kLeastCosine = 1e-6;  // nearer to the horizon an angle has lost its cosine
constexpr double kOfFormulas = 1e-8;
constexpr double kOfSingles = 1e-4;  // of formulas in single precision
constexpr double kOfOthers = 1e-4;
constexpr std::size_t kLeastSteps = 64;
constexpr std::size_t kMostSteps = std::size_t{1} << 16;
constexpr std::size_t kMostPairs = std::size_t{1} << 19;  // of directions, evaluated at once
constexpr std::size_t kLeastModes = 8;    // that rules are compared by: where some agree by chance, not all do
constexpr std::size_t kDifferences = 3;   // of rules one after the other that are looked at, for the same reason
constexpr double kShare = 0.6;            // calibrated: true errors at kinks and jumps are up to 0.55 of what is stated
constexpr double kNothing = 1e-300;       // sr^-1
constexpr double kRoundingOfCosines = 4;  // of a cosine that comes back from its angle

void require_cosines(std::span<const double> cosines, std::string_view whose) {
  if (cosines.empty() || cosines.size() > kMostCosines) {
    throw ArgumentError(fmt::format("{} cosines of the {}; expected 1 to {}", cosines.size(), whose, kMostCosines));
  }
  for (const double cosine : cosines) {
    if (cosine >= kLeastCosine && cosine <= 1) continue;
    throw ArgumentError(fmt::format("cosine {} of the {}; expected numbers from 1e-6 to 1", shortest(cosine), whose));
  }
}

/// Integrals over the azimuth at one pair of cosines, channels across.
struct Sums {
  MatrixXd cosine;          // modes x channels
  MatrixXd sine;            // modes x channels; no rows where both sides are the same
  Eigen::RowVectorXd mean;  // of squares
  Eigen::RowVectorXd own;   // of errors that the values have themselves
};

/// Modes of one pair of cosines while rules are doubled.
struct Pair {
  Directions directions;
  std::size_t at = 0;  // [out][in]
  Sums sums;
  std::vector<Eigen::RowVectorXd> differences;  // of rules one after the other, by channel
  Eigen::RowVectorXd error;
};

/// Means over azimuths (k + offset) 2 pi / steps.
class Rule {
 public:
  Rule(std::size_t steps, double offset, std::size_t modes, bool is_bilateral) {
    // Of what is the same on both sides, half of the azimuths are enough.
    const std::size_t twice = offset == 0 ? steps / 2 + 1 : steps / 2;
    const std::size_t points = is_bilateral ? twice : steps;
    const double step = 2 * pi / static_cast<double>(steps);
    azimuths_.resize(points);
    weights_.resize(static_cast<Index>(points));
    for (std::size_t k = 0; k < points; ++k) {
      azimuths_[k] = (static_cast<double>(k) + offset) * step;
      const bool is_single = !is_bilateral || (offset == 0 && (k == 0 || 2 * k == steps));
      weights_(static_cast<Index>(k)) = (is_single ? 1.0 : 2.0) / static_cast<double>(steps);
    }
    cosine_.resize(static_cast<Index>(modes), static_cast<Index>(points));
    sine_.setZero(static_cast<Index>(modes), is_bilateral ? 0 : static_cast<Index>(points));
    for (Index k = 0; k < cosine_.cols(); ++k) {
      for (Index m = 0; m < cosine_.rows(); ++m) {
        const double angle = static_cast<double>(m) * azimuths_[static_cast<std::size_t>(k)];
        cosine_(m, k) = weights_(k) * std::cos(angle);
        if (!is_bilateral) sine_(m, k) = weights_(k) * std::sin(angle);
      }
    }
  }

  [[nodiscard]] const std::vector<double>& azimuths() const { return azimuths_; }

  /// \param errors of the values; none: 0 x 0
  [[nodiscard]] Sums sums(const Eigen::Ref<const MatrixXd>& values, const Eigen::Ref<const MatrixXd>& errors) const {
    Sums result{cosine_ * values, MatrixXd(0, values.cols()), weights_.transpose() * values.array().square().matrix(),
                Eigen::RowVectorXd::Zero(values.cols())};
    if (errors.size() > 0) {
      const auto known = errors.array().isFinite().select(errors.array().abs(), 0.0);
      result.own = weights_.transpose() * known.matrix();
    }
    if (sine_.cols() > 0) result.sine = sine_ * values;
    return result;
  }

 private:
  std::vector<double> azimuths_;
  Eigen::VectorXd weights_;
  MatrixXd cosine_;  // modes x azimuths, with the weights
  MatrixXd sine_;
};

/// Sums of a rule at all pairs, in pieces.
void for_each_sums(const BrdfFunction& function, std::span<Pair* const> pairs, const Rule& rule,
                   const std::function<void(Pair&, Sums)>& take, const std::function<void()>& tell) {
  const std::size_t points = rule.azimuths().size();
  const std::size_t piece = std::max<std::size_t>(1, kMostPairs / points);
  for (std::size_t first = 0; first < pairs.size(); first += piece) {
    tell();
    const auto part = pairs.subspan(first, std::min(piece, pairs.size() - first));
    std::vector<Directions> directions;
    directions.reserve(part.size() * points);
    for (const Pair* pair : part) {
      for (const double azimuth : rule.azimuths()) {
        directions.push_back(pair->directions);
        directions.back().delta_phi = azimuth;
      }
    }
    const BrdfValues found = function.at(directions);
    if (!found.value.allFinite() || !found.value.array().square().allFinite()) {
      throw NumericError("'" + function.name +
                         "' has values at these cosines that are not finite, or whose squares are not");
    }
    for (std::size_t k = 0; k < part.size(); ++k) {
      const auto own = [&](const MatrixXd& all) {
        return all.size() == 0 ? MatrixXd()
                               : MatrixXd(all.middleRows(static_cast<Index>(k * points), static_cast<Index>(points)));
      };
      take(*part[k], rule.sums(own(found.value), own(found.error)));
    }
  }
}

/// Root mean square by channel. Squares of what is far from a highlight vanish before the values do.
Eigen::RowVectorXd scale_of(const Pair& pair) {
  return pair.sums.mean.cwiseSqrt().cwiseMax(pair.sums.cosine.row(0).cwiseAbs());
}

/// Replaces the sums of a rule by those of half its step. Errors at jumps, and of single directions in which a file has
/// another value than next to them, are halved with the step, all others sooner: what rules differed by before bounds
/// them in spite of a last difference that is small by chance.
void halve_step(Pair& pair, const Sums& between, double rounding) {
  const Sums former = pair.sums;
  pair.sums.cosine = (former.cosine + between.cosine) / 2;
  pair.sums.sine = (former.sine + between.sine) / 2;
  pair.sums.mean = (former.mean + between.mean) / 2;
  pair.sums.own = (former.own + between.own) / 2;
  Eigen::ArrayXXd apart = (pair.sums.cosine - former.cosine).array().square();
  if (former.sine.rows() > 0) apart += (pair.sums.sine - former.sine).array().square();
  pair.differences.emplace_back(apart.sqrt().colwise().maxCoeff().matrix());
  pair.error = rounding * scale_of(pair);
  double share = kShare;
  for (std::size_t k = 0; k < std::min(kDifferences, pair.differences.size()); ++k) {
    pair.error += share * pair.differences[pair.differences.size() - 1 - k];
    share /= 2;
  }
}

/// Error relative to the root mean square, of the worst channel.
double relative_error(const Pair& pair) {
  const Eigen::RowVectorXd scale = scale_of(pair);
  double worst = 0;
  for (Index c = 0; c < pair.error.size(); ++c) {
    if (pair.error(c) <= kNothing) continue;
    worst = std::max(worst, scale(c) > 0 ? pair.error(c) / scale(c) : std::numeric_limits<double>::infinity());
  }
  return worst;
}

double factor_of(ModeConvention convention, std::size_t mode) {
  if (convention == ModeConvention::brdf) return 1;
  return pi * (mode == 0 ? 1 : 2) * (mode % 2 == 0 ? 1 : -1);  // cos(m (phi + pi)) = (-1)^m cos(m phi)
}

void take(AzimuthalModes& modes, const Pair& pair) {
  for (std::size_t c = 0; c < modes.channels.size(); ++c) {
    const auto column = static_cast<Index>(c);
    for (std::size_t m = 0; m < modes.count; ++m) {
      const std::size_t at = modes.at(c, m, 0, 0) + pair.at;
      const double factor = factor_of(modes.convention, m);
      modes.values[at] = factor * pair.sums.cosine(static_cast<Index>(m), column);
      modes.errors[at] = std::abs(factor) * (pair.error(column) + pair.sums.own(column));
    }
  }
}

/// What the modes do not show: higher ones, and those of the side.
void take_rest(AzimuthalModes& modes, const std::vector<Pair>& pairs) {
  for (std::size_t c = 0; c < modes.channels.size(); ++c) {
    const auto column = static_cast<Index>(c);
    double all = 0;
    double held = 0;
    double one_sided = 0;
    for (const Pair& pair : pairs) {
      const auto count = static_cast<Index>(modes.count);
      const auto squares = [&](const MatrixXd& parts, Index rows) {
        if (parts.rows() == 0) return 0.0;
        return 2 * parts.col(column).head(rows).squaredNorm() - parts(0, column) * parts(0, column);
      };
      // Parts of the side are not left out, but not there: the modes are those of the mean of both.
      const double sine = squares(pair.sums.sine, pair.sums.sine.rows());
      all += pair.sums.mean(column) - sine;
      held += squares(pair.sums.cosine, count);
      if (pair.sums.sine.rows() > 0) {
        one_sided = std::max(one_sided, 2 * pair.sums.sine.col(column).cwiseAbs().maxCoeff());
      }
    }
    modes.left_out.push_back(all > 0 ? std::sqrt(std::max(0.0, all - held) / all) : 0);
    modes.one_sided.push_back(one_sided);
  }
}

}  // namespace

std::vector<std::string_view> mode_convention_names() {
  return {kConventions.begin(), kConventions.end()};
}

ModeConvention parse_mode_convention(std::string_view name) {
  const auto found = std::ranges::find(kConventions, name);
  if (found == kConventions.end()) {
    throw ArgumentError(fmt::format("unknown convention '{}'; expected brdf or disort", name));
  }
  return static_cast<ModeConvention>(found - kConventions.begin());
}

CosineRule cosine_rule(std::size_t count) {
  if (count < 1 || count > kMostCosines) {
    throw ArgumentError(fmt::format("a rule of {} cosines; expected 1 to {}", count, kMostCosines));
  }
  GaussRule rule = gauss_rule(static_cast<int>(count));
  return {std::move(rule.nodes), std::move(rule.weights)};
}

AzimuthalModes azimuthal_modes(const Device& device, const Reflectance& reflectance, std::span<const double> cosines_in,
                               std::span<const double> cosines_out, std::size_t count,
                               const AzimuthalModesOptions& options) {
  require_cosines(cosines_in, "light");
  require_cosines(cosines_out, "viewer");
  if (count < 1 || count > kMostModes) {
    throw ArgumentError(fmt::format("{} modes; expected 1 to {}", count, kMostModes));
  }
  if (const std::size_t numbers = reflectance.channels() * count * cosines_in.size() * cosines_out.size();
      numbers > kMostNumbers) {
    throw ArgumentError(fmt::format("{} modes of {} x {} cosines are {} numbers; expected at most {}", count,
                                    cosines_out.size(), cosines_in.size(), numbers, kMostNumbers));
  }
  if (reflectance.has_delta()) {
    throw ArgumentError("'" + reflectance.name() + "' has delta parts, which no modes at pairs of cosines show; " +
                        "expected a reflectance without");
  }
  if (!reflectance.is_isotropic()) {
    throw ArgumentError("'" + reflectance.name() + "' depends on the azimuth of the light; " +
                        "expected an isotropic reflectance");
  }
  const BrdfFunction function = as_function(device, reflectance, options.precision);
  AzimuthalModes modes;
  modes.name = reflectance.name();
  modes.channels.assign(function.channels.begin(),
                        function.channels.begin() + static_cast<Index>(reflectance.channels()));
  modes.cosines_in.assign(cosines_in.begin(), cosines_in.end());
  modes.cosines_out.assign(cosines_out.begin(), cosines_out.end());
  modes.count = count;
  modes.convention = options.convention;
  const bool is_formula = reflectance.formula() != nullptr;
  const bool is_single = is_formula && options.precision == Precision::single_precision;
  modes.tolerance = options.tolerance > 0 ? options.tolerance
                    : is_single           ? kOfSingles
                    : is_formula          ? kOfFormulas
                                          : kOfOthers;
  std::vector<Pair> pairs;
  pairs.reserve(cosines_in.size() * cosines_out.size());
  for (const double out : cosines_out) {
    for (const double in : cosines_in) {
      pairs.push_back({{std::acos(in), std::acos(out), 0, 0}, pairs.size(), {}, {}, {}});
    }
  }
  std::vector<Pair*> open;
  for (Pair& pair : pairs) open.push_back(&pair);

  const std::size_t summed = std::max(count, kLeastModes);
  // Modes beyond half of the steps are those below it once more.
  std::size_t steps = std::max(kLeastSteps, std::bit_ceil(4 * summed));
  const auto tell = [&] {
    if (options.progress &&
        !options.progress("modes", 1 - static_cast<double>(open.size()) / static_cast<double>(pairs.size()))) {
      throw Cancelled("cancelled");
    }
  };
  const Precision precision = is_single ? Precision::single_precision : Precision::double_precision;
  const auto rounding = [&](const Pair& pair) {
    const double cosine = std::cos(std::max(pair.directions.theta_in, pair.directions.theta_out));
    return product_rounding(precision) + kRoundingOfCosines * epsilon_of(precision) / cosine;
  };
  for_each_sums(
      function, open, Rule(steps, 0, summed, function.is_bilateral),
      [](Pair& pair, Sums sums) { pair.sums = std::move(sums); }, tell);
  const std::size_t most = std::max(kMostSteps, 16 * steps);
  for (; steps < most && !open.empty(); steps *= 2) {
    for_each_sums(
        function, open, Rule(steps, 0.5, summed, function.is_bilateral),
        [&](Pair& pair, const Sums& sums) { halve_step(pair, sums, rounding(pair)); }, tell);
    std::erase_if(open, [&](const Pair* pair) {
      return pair->differences.size() >= kDifferences && relative_error(*pair) <= modes.tolerance;
    });
  }
  const std::size_t all = modes.channels.size() * count * pairs.size();
  modes.values.resize(all);
  modes.errors.resize(all);
  for (const Pair& pair : pairs) take(modes, pair);
  take_rest(modes, pairs);
  if (options.missed) {
    for (const Pair* pair : open) {
      options.missed({.quantity = fmt::format("modes at cosines {} and {} of '{}'",
                                              shortest(cosines_in[pair->at % cosines_in.size()]),
                                              shortest(cosines_out[pair->at / cosines_in.size()]), modes.name),
                      .index = pair->at,
                      .relative_error = relative_error(*pair),
                      .tolerance = modes.tolerance});
    }
  }
  return modes;
}

}  // namespace lobe
