#include "lut/lut_fit.hpp"

#include <fmt/format.h>

#include <Eigen/Core>
#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <limits>
#include <map>
#include <numeric>
#include <optional>
#include <utility>

#include "core/text.hpp"
#include "lobe/core/error.hpp"
#include "lut/lut_measure.hpp"
#include "lut/minimax.hpp"

namespace lobe {
namespace {

constexpr std::size_t kMostNumbers = std::size_t{1} << 24;  // of the linear program
constexpr double kCentringGain = 4;    // by which centred powers must lower what single precision adds
constexpr double kSingleShare = 0.01;  // of the largest error, that single precision may add before powers are centred
constexpr unsigned kZeroSteps = 8;     // between two entries, at which a denominator is looked at
constexpr std::size_t kMostZeroPoints = std::size_t{1} << 22;

constexpr std::string_view kForms = "expected polynomial:DEGREES or rational:DEGREES/DEGREES, with DEGREES as 3 or 3,2";

std::vector<unsigned> parse_degrees(std::string_view text, std::string_view form) {
  std::vector<unsigned> degrees;
  for (const std::string_view part : split(text, ',')) {
    const std::string_view number = trim(part);
    unsigned degree = 0;
    const auto [end, code] = std::from_chars(number.data(), number.data() + number.size(), degree);
    if (number.empty() || code == std::errc::invalid_argument || end != number.data() + number.size()) {
      throw ArgumentError(fmt::format("'{}' in form '{}' is no degree; {}", excerpt(number), excerpt(form), kForms));
    }
    if (code != std::errc() || degree > kMostDegree) {
      throw ArgumentError(fmt::format("degree {} of form '{}' is out of range; expected 0 to {}", excerpt(number),
                                      excerpt(form), kMostDegree));
    }
    degrees.push_back(degree);
  }
  return degrees;
}

std::string joined(const std::vector<unsigned>& degrees) {
  return fmt::format("{}", fmt::join(degrees, ","));
}

/// Chebyshev polynomials T_0 to T_n at a place from -1 to 1.
std::vector<double> chebyshev_values(double x, unsigned most) {
  std::vector<double> values{1, x};
  for (unsigned n = 2; n <= most; ++n) values.push_back(2 * x * values[n - 1] - values[n - 2]);
  return values;
}

/// Coefficients of T_n(factor * v + offset) in powers of v.
std::vector<double> chebyshev_powers(unsigned n, double factor, double offset) {
  std::vector<double> before{1};
  if (n == 0) return before;
  std::vector<double> now{offset, factor};
  for (unsigned k = 2; k <= n; ++k) {
    std::vector<double> next(k + 1, 0.0);
    for (std::size_t i = 0; i < now.size(); ++i) {
      next[i] += 2 * offset * now[i];
      next[i + 1] += 2 * factor * now[i];
    }
    for (std::size_t i = 0; i < before.size(); ++i) next[i] -= before[i];
    before = std::exchange(now, std::move(next));
  }
  return now;
}

/// A sum of products of Chebyshev polynomials as one of powers.
std::vector<double> powers_of(const Eigen::VectorXd& sum, const std::vector<unsigned>& degrees, std::size_t arguments,
                              bool is_centred) {
  const auto exponents = exponents_of(degrees, arguments);
  std::map<std::vector<unsigned>, std::size_t> place;
  for (std::size_t i = 0; i < exponents.size(); ++i) place[exponents[i]] = i;
  std::vector<double> powers(exponents.size(), 0.0);
  for (std::size_t i = 0; i < exponents.size(); ++i) {
    std::vector<std::vector<double>> factors;
    for (const unsigned n : exponents[i])
      factors.push_back(chebyshev_powers(n, is_centred ? 1 : 2, is_centred ? 0 : -1));
    std::vector<unsigned> index(arguments, 0);
    for (bool is_left = true; is_left;) {
      double product = sum[static_cast<Eigen::Index>(i)];
      for (std::size_t a = 0; a < arguments; ++a) product *= factors[a][index[a]];
      powers[place.at(index)] += product;
      is_left = false;
      for (std::size_t a = arguments; a-- > 0;) {
        if (++index[a] < factors[a].size()) {
          is_left = true;
          break;
        }
        index[a] = 0;
      }
    }
  }
  return powers;
}

/// The Chebyshev products of a polynomial at the entries, one per column.
Eigen::MatrixXd products_at_entries(const LutRequest& request, const std::vector<unsigned>& degrees) {
  const auto& axes = request.axes;
  const auto exponents = exponents_of(degrees, axes.size());
  std::size_t entries = 1;
  for (const LutAxis& axis : axes) entries *= axis.count;
  Eigen::MatrixXd products(static_cast<Eigen::Index>(entries), static_cast<Eigen::Index>(exponents.size()));
  std::vector<std::vector<std::vector<double>>> along(axes.size());
  for (std::size_t a = 0; a < axes.size(); ++a) {
    for (std::size_t i = 0; i < axes[a].count; ++i) {
      along[a].push_back(chebyshev_values(2 * axes[a].coordinate(i) - 1, kMostDegree));
    }
  }
  for (std::size_t i = 0; i < entries; ++i) {
    for (std::size_t k = 0; k < exponents.size(); ++k) {
      double product = 1;
      std::size_t rest = i;
      for (std::size_t a = axes.size(); a-- > 0;) {
        product *= along[a][rest % axes[a].count][exponents[k][a]];
        rest /= axes[a].count;
      }
      products(static_cast<Eigen::Index>(i), static_cast<Eigen::Index>(k)) = product;
    }
  }
  return products;
}

void check_form(const LutRequest& request, const LutFitForm& form, std::size_t entries) {
  const std::size_t size = lut_fit_size(form, request.axes.size());
  if (size >= entries) {
    throw ArgumentError(
        fmt::format("form {} has {} coefficients for {} entries; expected more entries than coefficients",
                    to_string(form), size, entries));
  }
  if (size * entries > kMostNumbers) {
    throw ArgumentError(
        fmt::format("form {} has {} coefficients for {} entries, which are too many for a fit; expected "
                    "at most {} numbers",
                    to_string(form), size, entries, kMostNumbers));
  }
  for (const auto& degrees : {form.numerator, form.denominator}) {
    for (std::size_t a = 0; a < request.axes.size() && !degrees.empty(); ++a) {
      const unsigned degree = degree_at(degrees, request.axes.size(), a, 0);
      if (degree < request.axes[a].count) continue;
      throw ArgumentError(fmt::format("axis {} has {} entries for degree {} of form {}; expected at least {}",
                                      request.axes[a].name, request.axes[a].count, degree, to_string(form),
                                      degree + 1));
    }
  }
}

/// A column's functions for a fit: in double precision, and as single precision evaluates them.
class Evaluator {
 public:
  Evaluator(const LutRequest& request, const LutFitForm& form, const LutFitColumn& column, bool is_centred)
      : axes_(request.axes), form_(form), column_(column) {
    for (const LutAxis& axis : axes_) variables_.push_back(fit_variable(axis, is_centred));
  }

  template <typename Number>
  [[nodiscard]] Number at(std::span<const double> coordinates) const {
    const auto variables = variables_at<Number>(coordinates);
    const Number above = polynomial<Number>(form_.numerator, column_.numerator, variables);
    if (column_.denominator.empty()) return above;
    return above / polynomial<Number>(form_.denominator, column_.denominator, variables);
  }
  [[nodiscard]] double denominator_at(std::span<const double> coordinates) const {
    return polynomial<double>(form_.denominator, column_.denominator, variables_at<double>(coordinates));
  }

 private:
  template <typename Number>
  [[nodiscard]] std::vector<Number> variables_at(std::span<const double> coordinates) const {
    std::vector<Number> variables;
    for (std::size_t a = 0; a < axes_.size(); ++a) {
      const auto argument = static_cast<Number>(axes_[a].mapped_value(coordinates[a]));
      const FitVariable& variable = variables_[a];
      variables.push_back(variable.is_argument() ? argument
                                                 : (argument - static_cast<Number>(variable.offset)) *
                                                       static_cast<Number>(variable.factor));
    }
    return variables;
  }

  template <typename Number>
  [[nodiscard]] static Number polynomial(const std::vector<unsigned>& degrees, const std::vector<double>& coefficients,
                                         const std::vector<Number>& variables) {
    std::vector<Number> numbers;
    for (const double coefficient : coefficients) numbers.push_back(static_cast<Number>(coefficient));
    const Number* next = numbers.data();
    return horner<Number>(degrees, variables, next);
  }

  std::vector<LutAxis> axes_;
  LutFitForm form_;
  LutFitColumn column_;
  std::vector<FitVariable> variables_;
};

/// The fit of one column, in powers.
LutFitColumn in_powers(const Minimax& best, const LutRequest& request, const LutFitForm& form, bool is_centred) {
  const std::size_t axes = request.axes.size();
  LutFitColumn column{.numerator = powers_of(best.numerator, form.numerator, axes, is_centred),
                      .denominator = {},
                      .bound = best.bound,
                      .errors = {},
                      .single_errors = {}};
  if (form.denominator.empty()) return column;
  column.denominator = powers_of(best.denominator, form.denominator, axes, is_centred);
  const double first = column.denominator.front();
  for (double& coefficient : column.numerator) coefficient /= first;
  for (double& coefficient : column.denominator) coefficient /= first;
  return column;
}

/// Calls a function with the coordinates of the entries, or of a grid that has steps between them and reaches the ends.
template <typename Visit>
void at_points(const LutRequest& request, unsigned steps, const Visit& visit) {
  std::vector<std::vector<double>> points;
  std::size_t count = 1;
  for (const LutAxis& axis : request.axes) {
    auto& along = points.emplace_back();
    if (steps == 0) {
      for (std::size_t i = 0; i < axis.count; ++i) along.push_back(axis.coordinate(i));
    } else {
      const std::size_t most = steps * axis.count;
      for (std::size_t i = 0; i <= most; ++i) along.push_back(static_cast<double>(i) / static_cast<double>(most));
    }
    count *= along.size();
  }
  std::vector<double> coordinates(points.size());
  for (std::size_t i = 0; i < count; ++i) {
    std::size_t rest = i;
    for (std::size_t a = points.size(); a-- > 0;) {
      coordinates[a] = points[a][rest % points[a].size()];
      rest /= points[a].size();
    }
    visit(coordinates, i);
  }
}

/// Largest difference of single from double precision at the entries; infinite where the powers are not to be had.
double single_difference(const LutRequest& request, const Evaluator& evaluator) {
  double largest = 0;
  at_points(request, 0, [&](const std::vector<double>& coordinates, std::size_t) {
    const double difference =
        std::abs(static_cast<double>(evaluator.at<float>(coordinates)) - evaluator.at<double>(coordinates));
    largest = std::isfinite(difference) ? std::max(largest, difference) : std::numeric_limits<double>::infinity();
  });
  return largest;
}

/// Refuses a denominator that is not positive everywhere between the ends of the axes.
void check_denominator(const Lut& lut, const LutFitForm& form, const Evaluator& evaluator, std::size_t column) {
  unsigned steps = kZeroSteps;
  const auto count = [&] {
    return std::accumulate(lut.request.axes.begin(), lut.request.axes.end(), std::size_t{1},
                           [&](std::size_t all, const LutAxis& axis) { return all * (steps * axis.count + 1); });
  };
  while (steps > 1 && count() > kMostZeroPoints) steps /= 2;
  at_points(lut.request, steps, [&](const std::vector<double>& coordinates, std::size_t) {
    if (evaluator.denominator_at(coordinates) > 0) return;
    LutDeviation place;
    for (std::size_t a = 0; a < coordinates.size(); ++a) place.at.push_back(lut.request.axes[a].value(coordinates[a]));
    place.column = column;
    throw ArgumentError(
        fmt::format("the denominator of the best fit of form {} has a zero near {}; expected more entries, nodes up to "
                    "the ends of the axes, or a denominator of a smaller degree",
                    to_string(form), lut_place_text(lut, place)));
  });
}

}  // namespace

std::vector<std::vector<unsigned>> exponents_of(const std::vector<unsigned>& degrees, std::size_t arguments) {
  std::vector<std::vector<unsigned>> exponents;
  std::vector<unsigned> index(arguments, 0);
  const auto fill = [&](const auto& self, std::size_t argument, unsigned sum) -> void {
    if (argument == arguments) {
      exponents.push_back(index);
      return;
    }
    for (unsigned k = 0; k <= degree_at(degrees, arguments, argument, sum); ++k) {
      index[argument] = k;
      self(self, argument + 1, sum + k);
    }
    index[argument] = 0;
  };
  fill(fill, 0, 0);
  return exponents;
}

FitVariable fit_variable(const LutAxis& axis, bool is_centred) {
  const double low = mapped(axis.map, axis.from);
  const double high = mapped(axis.map, axis.to);
  if (is_centred) return {0.5 * (low + high), 2 / (high - low)};
  return {low, 1 / (high - low)};
}

std::string fit_argument_text(const LutAxis& axis) {
  return axis.map == AxisMap::linear ? axis.name : fmt::format("{}({})", to_string(axis.map), axis.name);
}

LutFitForm parse_lut_fit_form(std::string_view text) {
  const std::size_t colon = std::min(text.find(':'), text.size());
  const std::string_view kind = trim(text.substr(0, colon));
  const std::string_view degrees = text.substr(std::min(colon + 1, text.size()));
  if (kind == "polynomial") return {parse_degrees(degrees, text), {}};
  const std::size_t slash = degrees.find('/');
  if (kind != "rational" || slash == std::string_view::npos) {
    throw ArgumentError(fmt::format("'{}' is no form of a fit; {}", excerpt(text), kForms));
  }
  return {parse_degrees(degrees.substr(0, slash), text), parse_degrees(degrees.substr(slash + 1), text)};
}

std::string to_string(const LutFitForm& form) {
  if (form.denominator.empty()) return "polynomial:" + joined(form.numerator);
  return fmt::format("rational:{}/{}", joined(form.numerator), joined(form.denominator));
}

std::size_t lut_fit_size(const LutFitForm& form, std::size_t axes) {
  for (const auto* degrees : {&form.numerator, &form.denominator}) {
    if (degrees->empty() && degrees == &form.denominator) continue;
    if (degrees->size() != 1 && degrees->size() != axes) {
      throw ArgumentError(fmt::format("form {} has {} degrees for {} {}; expected one, or one for each axis",
                                      to_string(form), degrees->size(), axes, axes == 1 ? "axis" : "axes"));
    }
  }
  const std::size_t above = exponents_of(form.numerator, axes).size();
  return form.denominator.empty() ? above : above + exponents_of(form.denominator, axes).size() - 1;
}

std::string lut_fit_text(const LutRequest& request, const LutFitForm& form) {
  std::vector<std::string> arguments;
  for (const LutAxis& axis : request.axes) arguments.push_back(fit_argument_text(axis));
  const auto degrees_text = [&](const std::vector<unsigned>& degrees) {
    if (degrees.size() > 1) return fmt::format("degrees {}", fmt::join(degrees, ", "));
    return fmt::format("{}degree {}", arguments.size() > 1 ? "total " : "", degrees.front());
  };
  const std::string of = form.denominator.empty() ? fmt::format("of {}", degrees_text(form.numerator))
                                                  : fmt::format("of {} over {}", degrees_text(form.numerator),
                                                                degrees_text(form.denominator));
  return fmt::format("{} in {}, {}: {} coefficients", form.denominator.empty() ? "polynomial" : "rational function",
                     fmt::join(arguments, " and "), of, lut_fit_size(form, request.axes.size()));
}

double lut_fit_value(const LutFit& fit, std::span<const double> coordinates, std::size_t column) {
  return Evaluator(fit.request, fit.form, fit.functions.at(column), fit.is_centred).at<double>(coordinates);
}

LutFit fit_lut(const Device& device, const Lut& exact, const LutFitForm& form, unsigned refinement,
               const LutOptions& options) {
  const std::size_t columns = exact.columns.size();
  const std::size_t entries = exact.entries();
  if (exact.values.size() != entries * columns || exact.errors.size() != exact.values.size()) {
    throw ArgumentError("the table has no errors of its entries; expected one of make_lut()");
  }
  if (!std::ranges::all_of(exact.values, [](double value) { return std::isfinite(value); })) {
    throw ArgumentError("the table has values that are no finite numbers; expected a table without them");
  }
  check_form(exact.request, form, entries);
  const Eigen::MatrixXd above = products_at_entries(exact.request, form.numerator);
  const Eigen::MatrixXd below = form.denominator.empty() ? Eigen::MatrixXd::Ones(static_cast<Eigen::Index>(entries), 1)
                                                         : products_at_entries(exact.request, form.denominator);
  std::vector<Minimax> best;
  bool is_centred = false;
  for (std::size_t c = 0; c < columns; ++c) {
    Eigen::VectorXd values(static_cast<Eigen::Index>(entries));
    Eigen::VectorXd errors(static_cast<Eigen::Index>(entries));
    for (std::size_t i = 0; i < entries; ++i) {
      values[static_cast<Eigen::Index>(i)] = exact.values[i * columns + c];
      errors[static_cast<Eigen::Index>(i)] = exact.errors[i * columns + c];
    }
    best.push_back(minimax(above, below, values, errors));
    const Evaluator plain(exact.request, form, in_powers(best.back(), exact.request, form, false), false);
    const double plain_difference = single_difference(exact.request, plain);
    if (plain_difference > kSingleShare * best.back().largest) {
      const Evaluator centred(exact.request, form, in_powers(best.back(), exact.request, form, true), true);
      is_centred = is_centred || plain_difference > kCentringGain * single_difference(exact.request, centred);
    }
    if (options.progress && !options.progress("fit", static_cast<double>(c + 1) / static_cast<double>(columns))) {
      throw Cancelled("the fit of the lookup table was stopped");
    }
  }
  LutFit fit{
      .request = exact.request, .columns = exact.columns, .form = form, .is_centred = is_centred, .functions = {}};
  std::vector<LutPrediction> predictions;
  for (std::size_t c = 0; c < columns; ++c) {
    fit.functions.push_back(in_powers(best[c], exact.request, form, is_centred));
    const Evaluator evaluator(exact.request, form, fit.functions.back(), is_centred);
    if (!form.denominator.empty()) check_denominator(exact, form, evaluator, c);
    const auto in_double = [evaluator](std::span<const double> coordinates, std::size_t) {
      return evaluator.at<double>(coordinates);
    };
    const auto in_single = [evaluator](std::span<const double> coordinates, std::size_t) {
      return static_cast<double>(evaluator.at<float>(coordinates));
    };
    predictions.push_back({.value = in_double, .first = c, .columns = 1});
    predictions.push_back({.value = in_single, .first = c, .columns = 1});
  }
  const auto errors = measured_errors(device, exact, predictions, refinement, options);
  for (std::size_t c = 0; c < columns; ++c) {
    fit.functions[c].errors = errors[2 * c];
    fit.functions[c].single_errors = errors[2 * c + 1];
  }
  return fit;
}

}  // namespace lobe
