#include "lobe/fit/fit.hpp"

#include <Eigen/Cholesky>
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <utility>

#include "compare/comparison_measure.hpp"
#include "core/decompositions.hpp"
#include "core/numbers.hpp"
#include "core/text.hpp"
#include "energy/prepare.hpp"
#include "fit/fit_descent.hpp"
#include "fit/fit_perceptual.hpp"
#include "fit/fit_space.hpp"
#include "fit/fit_starts.hpp"
#include "fit/fit_target.hpp"
#include "lobe/core/error.hpp"
#include "lobe/core/estimate.hpp"
#include "lobe/reflectance/tabulate.hpp"
#include "metric/channel_metric.hpp"
#include "metric/lighting_traits.hpp"
#include "model/traits.hpp"
#include "table/tabulate.hpp"

namespace lobe {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

// The search is content with these; the result is refined to FitOptions::tolerance.
constexpr double kSearchTolerance = 1e-3;
constexpr double kLogSearchTolerance = 1e-2;
const DescentOptions kSearch{.step = 1e-2, .precision = 1e-3, .most_steps = 40};
const DescentOptions kRefinement{.step = 1e-3, .precision = 1e-7, .most_steps = 60};

/// Turns the progress of parts into that of the whole.
class FitProgress {
 public:
  explicit FitProgress(ProgressCallback callback) : callback_(std::move(callback)) {}

  void begin(std::string stage, double from, double to) {
    stage_ = std::move(stage);
    from_ = from;
    to_ = to;
    report(0);
  }
  /// \throws Cancelled
  void report(double share) {
    share_ = share;
    if (!proceed()) throw Cancelled("cancelled");
  }
  [[nodiscard]] bool proceed() const { return !callback_ || callback_(stage_, from_ + share_ * (to_ - from_)); }

 private:
  ProgressCallback callback_;
  std::string stage_;
  double from_ = 0;
  double to_ = 0;
  double share_ = 0;
};

void require_valid(const FitOptions& options) {
  if (options.searches == 0) throw ArgumentError("a fit without searches; expected at least one");
  if (options.tolerance && !(*options.tolerance > 0 && *options.tolerance < 1)) {
    throw ArgumentError("tolerance out of range; expected a value in (0, 1)");
  }
  const bool has_product = recipe_of(options.metric).term == PairTerm::square;
  if (options.objective == FitObjective::log && !has_product) {
    throw ArgumentError(
        "'" + std::string(to_string(options.metric)) +
        "' is no distance of a space with a scalar product, which the search needs; expected another, " +
        "such as bieron-log");
  }
  for (const double floor : {options.radiance_floor, options.albedo_floor}) {
    if (!(floor > 0) || std::isinf(floor)) {
      throw ArgumentError("floor of relative errors is " + shortest(floor) + "; expected a number above 0");
    }
  }
}

std::string scales_text(const std::vector<double>& scales) {
  std::string text;
  for (const double scale : scales) text += (text.empty() ? "" : "/") + shortest(scale);
  return text;
}

std::string call_text(std::string_view name, std::span<const Parameter> parameters, const std::vector<double>& values,
                      const std::string& scale) {
  std::string text(name);
  for (std::size_t i = 0; i < parameters.size(); ++i) {
    text += (i == 0 ? ":" : ",") + std::string(parameters[i].name) + "=" + shortest(values[i]);
  }
  return scale.empty() ? text : text + (parameters.empty() ? ":" : ",") + "scale=" + scale;
}

/// The text that parse_material() reads as these terms.
std::string specification(const std::vector<Term>& terms) {
  std::string text;
  for (const Term& term : terms) {
    text += (text.empty() ? "" : "+") +
            call_text(term.model, find_model(term.model).parameters, term.values, scales_text(term.weight));
    for (const Factor& factor : term.factors) {
      text += "*" + call_text(factor.name, find_factor(factor.name).parameters, factor.values, {});
    }
  }
  return text;
}

/// The member at a point as a result: without terms of scale 0, named by its specification.
Material result_material(const FitSpace& space, const VectorXd& x) {
  Material material = space.material(x);
  const auto is_zero = [](const Term& term) {
    return std::ranges::all_of(term.weight, [](double weight) { return weight == 0; });
  };
  std::vector<Term> visible;
  for (const Term& term : material.terms) {
    if (!is_zero(term)) visible.push_back(term);
  }
  if (!visible.empty()) material.terms = std::move(visible);
  material.name = specification(material.terms);
  return material;
}

/// Rows and columns of bounded values stay zero; of values that change nothing the variance is infinite.
MatrixXd covariance_of(const FitSpace& space, const Descent& descent, const std::vector<bool>& is_bounded,
                       const Estimate& residual) {
  const Index n = descent.x.size();
  VectorXd slope(n);
  std::vector<Index> free;
  for (Index j = 0; j < n; ++j) {
    const auto at = static_cast<std::size_t>(j);
    slope(j) = space.axis(at).scale.slope(descent.x(j));
    if (!is_bounded[at]) free.push_back(j);
  }
  MatrixXd covariance = MatrixXd::Zero(n, n);
  if (free.empty()) return covariance;
  const MatrixXd hessian = descent.hessian(free, free);
  VectorXd norm = hessian.diagonal().cwiseMax(0).cwiseSqrt();
  const VectorXd inverse_norm = norm.unaryExpr([](double x) { return x > 0 ? 1 / x : 0.0; });
  const MatrixXd scaled = inverse_norm.asDiagonal() * hessian * inverse_norm.asDiagonal();
  const Eigenpairs pairs = symmetric_eigenpairs(scaled);
  constexpr double kFlat = 1e-10;  // quotients of distances are good to about that
  VectorXd inverse = VectorXd::Zero(pairs.values.size());
  for (Index i = 0; i < inverse.size(); ++i) inverse(i) = pairs.values(i) > kFlat ? 1 / pairs.values(i) : 0;
  const double size = residual.value + residual.error;
  const MatrixXd found = size * size * inverse_norm.asDiagonal() * pairs.vectors * inverse.asDiagonal() *
                         pairs.vectors.transpose() * inverse_norm.asDiagonal();
  covariance(free, free) = slope(free).asDiagonal() * found * slope(free).asDiagonal();
  for (Index i = 0; i < inverse.size(); ++i) {
    if (inverse(i) != 0) continue;
    for (Index j = 0; j < static_cast<Index>(free.size()); ++j) {
      constexpr double kTakesPart = 1e-4;
      if (std::abs(pairs.vectors(j, i)) < kTakesPart) continue;
      const Index at = free[static_cast<std::size_t>(j)];
      covariance.row(at).setZero();
      covariance.col(at).setZero();
      covariance(at, at) = kInfinity;
    }
  }
  return covariance;
}

std::vector<bool> bounded_axes(const FitSpace& space, const VectorXd& x) {
  constexpr double kNear = 1e-6;
  std::vector<bool> is_bounded;
  for (std::size_t j = 0; j < space.size(); ++j) {
    const double at = x(static_cast<Index>(j));
    const double room = kNear * space.axis(j).unit;
    is_bounded.push_back(at - space.lower(j) <= room || space.upper(j) - at <= room);
  }
  return is_bounded;
}

/// A fit under way: what all objectives share.
class Fit {
 public:
  /// \param make_target FitTarget from a progress callback
  Fit(const Device& device, const Family& family, const FitOptions& options,
      const std::function<FitTarget(const ProgressCallback&)>& make_target)
      : device_(device),
        options_(options),
        progress_(options.progress),
        target_(make_target([this](std::string_view, double) { return progress_.proceed(); })),
        space_(family, target_.channels, options.ranges),
        weights_(channel_weights(options.channel_weights, target_.channels)) {}

  FitResult run() {
    find_starting_points();
    return options_.objective == FitObjective::perceptual ? least_error() : least_distance();
  }

 private:
  struct Search {
    double measure = 0;  ///< relative residual or largest relative error
    VectorXd x;
    bool converged = false;
  };

  [[nodiscard]] bool is_log() const { return options_.objective == FitObjective::log; }
  [[nodiscard]] double tolerance() const { return options_.tolerance.value_or(is_log() ? 1e-3 : 1e-6); }

  [[nodiscard]] TargetDistances measured(std::span<const Material> members, double tolerance) const {
    return is_log() ? target_.compared(members, tolerance) : distances_of(target_.products(members, tolerance));
  }

  void find_starting_points() {
    progress_.begin("starting points", 0, 0.1);
    starts_ = find_starts(target_, space_, options_.starts, weights_, options_.searches, kSearchTolerance);
    evaluations_ += starts_.evaluations;
    constexpr double kSmallest = 0.01;
    const VectorXd& x = starts_.best.front().x;
    for (std::size_t j = 0; j < space_.scales(); ++j) {
      const auto at = static_cast<Index>(j);
      space_.set_unit(j, std::max(x(at), kSmallest * starts_.unit(at)));
    }
  }

  Descent descent_from(const VectorXd& x, double tolerance, DescentOptions options) {
    options.progress = [this](double share) { progress_.report(share); };
    if (options_.watch) options.moved = [this](const VectorXd& at, double distance) { tell_better(at, distance); };
    try {
      Descent descent = descend(
          space_, [&](std::span<const Material> members) { return measured(members, tolerance).distance; }, x, options);
      evaluations_ += descent.evaluations;
      return descent;
    } catch (const UnresolvedError& error) {
      const auto more = target_.refusal ? target_.refusal(space_.material(x)) : std::nullopt;
      throw UnresolvedError(more.value_or(error.what()));
    }
  }

  void tell_better(const VectorXd& x, double distance) {
    if (!(distance < told_)) return;
    told_ = distance;
    options_.watch(result_material(space_, x), distance);
  }

  /// Descents from the best starting points, best first.
  /// \param from where the share of the whole begins that they take
  /// \param to where it ends
  std::vector<Search> searched(double from, double to) {
    const double tolerance = std::max(this->tolerance(), is_log() ? kLogSearchTolerance : kSearchTolerance);
    std::vector<Search> searches;
    const std::size_t count = starts_.best.size();
    for (std::size_t i = 0; i < count; ++i) {
      const double length = (to - from) / static_cast<double>(count);
      progress_.begin("search " + std::to_string(i + 1) + " of " + std::to_string(count),
                      from + length * static_cast<double>(i), from + length * static_cast<double>(i + 1));
      const Descent descent = descent_from(starts_.best[i].x, tolerance, kSearch);
      searches.push_back({descent.distance, descent.x, descent.converged});
    }
    std::ranges::stable_sort(searches, {}, &Search::measure);
    return searches;
  }

  /// Without those that ended where a better one did.
  [[nodiscard]] std::vector<Search> distinct(const std::vector<Search>& searches) const {
    constexpr double kSame = 0.02;  // in units of the axes
    VectorXd unit(static_cast<Index>(space_.size()));
    for (std::size_t j = 0; j < space_.size(); ++j) unit(static_cast<Index>(j)) = space_.axis(j).unit;
    std::vector<Search> list;
    for (const Search& search : searches) {
      const auto is_same = [&](const Search& other) {
        return (search.x - other.x).cwiseQuotient(unit).cwiseAbs().maxCoeff() < kSame;
      };
      if (std::ranges::none_of(list, is_same)) list.push_back(search);
    }
    return list;
  }

  /// \param x is moved onto the bounds that it all but touches
  [[nodiscard]] FitResult begin_result(VectorXd& x) {
    const std::vector<bool> is_bounded = bounded_axes(space_, x);
    for (std::size_t j = 0; j < space_.size(); ++j) {
      if (!is_bounded[j]) continue;
      double& at = x(static_cast<Index>(j));
      at = at - space_.lower(j) <= space_.upper(j) - at ? space_.lower(j) : space_.upper(j);
    }
    FitResult result;
    result.objective = options_.objective;
    result.material = result_material(space_, x);
    const std::vector<Material> member{result.material};
    const TargetDistances distances = measured(member, tolerance());
    ++evaluations_;
    result.residual = {distances.distance(0, 1), distances.distance_error(0, 1)};
    result.target_norm = distances.target_norm;
    result.relative_residual = result.residual / result.target_norm;
    for (std::size_t j = 0; j < space_.size(); ++j) {
      const FitSpace::Axis& axis = space_.axis(j);
      const double value = std::clamp(space_.value(j, x(static_cast<Index>(j))), axis.minimum, axis.maximum);
      result.values.push_back({.label = axis.label,
                               .channel = axis.channel,
                               .is_scale = axis.is_scale,
                               .value = value,
                               .standard_error = std::numeric_limits<double>::quiet_NaN(),
                               .minimum = axis.minimum,
                               .maximum = axis.maximum,
                               .at_bound = is_bounded[j]});
    }
    return result;
  }

  void end_result(FitResult& result, const std::vector<Search>& searches, double unit) const {
    result.evaluations = evaluations_;
    result.starting_points = starts_.compared;
    for (const Search& search : searches) result.minima.push_back(search.measure / unit);
  }

  FitResult least_distance() {
    const std::vector<Search> searches = searched(0.1, 0.7);
    progress_.begin("refinement", 0.7, 1);
    Descent best = descent_from(searches.front().x, tolerance(), kRefinement);
    FitResult result = begin_result(best.x);
    result.converged = best.converged;
    result.covariance = covariance_of(space_, best, bounded_axes(space_, best.x), result.residual);
    for (std::size_t j = 0; j < result.values.size(); ++j) {
      const auto at = static_cast<Index>(j);
      result.values[j].standard_error = std::sqrt(result.covariance(at, at));
    }
    end_result(result, searches, result.target_norm.value);
    return result;
  }

  FitResult least_error() {
    progress_.begin("target", 0.1, 0.1);
    const bool is_isotropic = target_.is_isotropic && std::ranges::all_of(space_.family().terms, [](const Term& term) {
                                return traits_of(term).isotropic;
                              });
    const PerceptualErrorsOf errors(device_, target_, is_isotropic, options_);
    std::vector<Search> searches = distinct(searched(0.1, 0.4));
    const std::size_t count = searches.size();
    for (std::size_t i = 0; i < count; ++i) {
      const double length = 0.6 / static_cast<double>(count);
      progress_.begin("largest error, search " + std::to_string(i + 1) + " of " + std::to_string(count),
                      0.4 + length * static_cast<double>(i), 0.4 + length * static_cast<double>(i + 1));
      double left = 1;
      const MinimaxFit found = least_largest_error(space_, errors, searches[i].x, [&] {
        constexpr double kSlower = 0.995;  // nobody knows how long it will be
        left *= kSlower;
        progress_.report(1 - left);
      });
      evaluations_ += found.evaluations;
      searches[i] = {found.largest, found.x, found.converged};
    }
    std::ranges::stable_sort(searches, {}, &Search::measure);
    FitResult result = begin_result(searches.front().x);
    result.errors = errors.largest(result.material);
    result.converged = searches.front().converged;
    end_result(result, searches, 1);
    return result;
  }

  const Device& device_;
  const FitOptions& options_;
  FitProgress progress_;
  FitTarget target_;
  FitSpace space_;
  std::vector<double> weights_;
  FitStarts starts_;
  std::size_t evaluations_ = 0;
  double told_ = std::numeric_limits<double>::infinity();  ///< least distance that was told of
};

/// Residuals of logarithms and products under patch lights are integrated for isotropic formulas alone, and summed on
/// grids for others; under some lightings there are products of tables alone.
bool needs_table(const Reflectance& target, const Family& family, const FitOptions& options) {
  const LightingTraits& traits = traits_of(options.lighting);
  if (options.objective != FitObjective::log && traits.is_by_tables) return true;
  const bool is_isotropic = target.is_isotropic() && std::ranges::all_of(family.terms, [](const Term& term) {
                              return traits_of(term).isotropic;
                            });
  return !is_isotropic && (options.objective == FitObjective::log ||
                           (options.objective == FitObjective::l2 && !traits.takes_anisotropic));
}

}  // namespace

MatrixXd correlation(const MatrixXd& covariance) {
  MatrixXd result = MatrixXd::Zero(covariance.rows(), covariance.cols());
  for (Index j = 0; j < covariance.cols(); ++j) {
    for (Index i = 0; i < covariance.rows(); ++i) {
      const double size = std::sqrt(covariance(i, i)) * std::sqrt(covariance(j, j));
      if (size > 0 && std::isfinite(size)) result(i, j) = i == j ? 1 : covariance(i, j) / size;
    }
  }
  return result;
}

FitResult fit(const Device& device, const Reflectance& target, const Family& family, const FitOptions& options) {
  require_valid(options);
  const auto fitted = [&](const auto& own) {
    return Fit(device, family, options,
               [&](const ProgressCallback& progress) { return fit_target(device, own, options, progress); })
        .run();
  };
  const auto fitted_table = [&](const BrdfTable& table) {
    FitResult result = fitted(table);
    result.route = Route::tables;
    result.grid = table.grid;
    result.is_coarse = table.is_unresolved;
    return result;
  };
  if (const Material* formula = target.formula()) {
    if (!needs_table(target, family, options)) return fitted(prepare(device, *formula));
    const auto grid = resolving_grid(device, {target}, HemisphereGrid::gauss(16, 32), TableUse::decomposition);
    return fitted_table(tabulate(device, target, grid, {.precision = options.precision, .allow_unresolved = true}));
  }
  const RouteChoice choice = choose_route({target}, options.lighting, {.theta_max = options.theta_max});
  const bool takes_function = target.function() != nullptr && !takes_tables(options.lighting);
  if (choice.route == Route::functions && takes_function && options.objective != FitObjective::log) {
    FitResult result = fitted(*target.function());
    result.route = Route::functions;
    return result;
  }
  if (const BrdfTable* table = target.table()) return fitted_table(*table);
  const BrdfFunction& function = *target.function();
  return fitted_table(
      tabulate(function, natural_grid(function), {.precision = options.precision, .allow_unresolved = true}));
}

}  // namespace lobe
