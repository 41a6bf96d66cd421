#include "fit/fit_starts.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>
#include <utility>

#include "core/text.hpp"
#include "fit/nearest_point.hpp"
#include "lobe/core/error.hpp"

namespace lobe {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

constexpr std::size_t kMostCombinations = 20'000;

/// The i-th point of Halton's sequence in one coordinate.
double halton(std::size_t i, std::size_t dimension) {
  constexpr std::array<std::size_t, 8> kPrimes{2, 3, 5, 7, 11, 13, 17, 19};
  const std::size_t base = kPrimes.at(dimension % kPrimes.size());
  double fraction = 1;
  double sum = 0;
  for (std::size_t rest = i + 1; rest > 0; rest /= base) {
    fraction /= static_cast<double>(base);
    sum += fraction * static_cast<double>(rest % base);
  }
  return sum;
}

/// Values of all parameters, of which one term's own vary.
using Shape = std::vector<double>;

/// \param numbers of the term's parameters
std::vector<Shape> filling_shapes(const FitSpace& space, const std::vector<std::size_t>& numbers, std::size_t count) {
  std::vector<Shape> shapes;
  if (numbers.empty()) count = 1;
  for (std::size_t s = 0; s < count; ++s) {
    Shape shape(space.parameters());
    for (std::size_t d = 0; d < numbers.size(); ++d) {
      const std::size_t j = space.scales() + numbers[d];
      const double share =
          numbers.size() == 1 ? (static_cast<double>(s) + 0.5) / static_cast<double>(count) : halton(s, d);
      const double coordinate = space.lower(j) + share * (space.upper(j) - space.lower(j));
      shape[numbers[d]] = std::clamp(space.value(j, coordinate), space.axis(j).minimum, space.axis(j).maximum);
    }
    shapes.push_back(std::move(shape));
  }
  return shapes;
}

/// A given starting point as values of all parameters.
Shape given_shape(const FitSpace& space, const std::vector<NamedValue>& given) {
  Shape shape(space.parameters());
  std::vector<bool> has_value(space.parameters(), false);
  for (const auto& [label, value] : given) {
    const FitSpace::Axis& axis = space.axis(space.find_parameter(label));
    if (has_value[axis.index]) throw ArgumentError("start gives '" + label + "' twice; expected it once");
    if (!(value >= axis.minimum && value <= axis.maximum)) {
      throw ArgumentError("start '" + label + "' is " + shortest(value) + "; expected a value in [" +
                          shortest(axis.minimum) + ", " + shortest(axis.maximum) + "]");
    }
    shape[axis.index] = value;
    has_value[axis.index] = true;
  }
  for (std::size_t i = 0; i < shape.size(); ++i) {
    if (has_value[i]) continue;
    throw ArgumentError("start has no value of '" + space.parameter(i).label +
                        "'; expected one for every free parameter");
  }
  return shape;
}

/// Terms in shapes, measured against the target.
struct MeasuredShapes {
  std::vector<std::vector<Shape>> shapes;  ///< [term][number]
  std::vector<std::vector<Index>> row;     ///< [term][number], of the Gram matrices; the target is row 0
  std::vector<MatrixXd> gram;              ///< by channel
  std::vector<double> weights;             ///< of channels
};

/// Drops shapes that cannot be measured (a table's grid does not resolve them) and measures the others at once.
MeasuredShapes measure_shapes(const FitTarget& target, const FitSpace& space, std::vector<std::vector<Shape>> shapes,
                              std::span<const double> weights, double tolerance) {
  MeasuredShapes measured;
  measured.weights.assign(weights.begin(), weights.end());
  const auto result_of = [&](const std::vector<std::vector<Shape>>& wanted) {
    std::vector<Material> members;
    for (std::size_t k = 0; k < wanted.size(); ++k) {
      for (const Shape& shape : wanted[k]) members.push_back(space.member(k, shape));
    }
    return target.rough_products(members, tolerance);
  };
  MetricResult result;
  try {
    result = result_of(shapes);
  } catch (const NumericError&) {
    for (std::size_t k = 0; k < shapes.size(); ++k) {
      std::string why;
      std::erase_if(shapes[k], [&](const Shape& shape) {
        const Material member = space.member(k, shape);
        try {
          (void)target.rough_products({&member, 1}, tolerance);
          return false;
        } catch (const UnresolvedError& error) {
          // Which grid would do is found for the message alone.
          const bool is_last = &shape == &shapes[k].back();
          const auto more = is_last && target.refusal ? target.refusal(member) : std::nullopt;
          why = more.value_or(error.what());
          return true;
        } catch (const NumericError& error) {
          why = error.what();
          return true;
        }
      });
      if (shapes[k].empty()) throw NumericError(why);
    }
    result = result_of(shapes);
  }
  const std::size_t channels = space.channels();
  for (std::size_t c = 0; c < channels; ++c) {
    measured.gram.push_back(result.channels.empty() ? result.combined.gram : result.channels[c].gram);
  }
  Index row = 1;
  for (const auto& of_term : shapes) {
    measured.row.emplace_back();
    for (std::size_t s = 0; s < of_term.size(); ++s) measured.row.back().push_back(row++);
  }
  measured.shapes = std::move(shapes);
  return measured;
}

/// A combination of one shape per term with its best scales.
struct StartCombination {
  std::vector<std::size_t> shape;  ///< by term
  MatrixXd scales;                 ///< terms x channels
  double square = 0;               ///< |f - g|^2 over all channels
};

StartCombination best_scales(const MeasuredShapes& measured, const FitSpace& space, std::vector<std::size_t> shape) {
  const Family& family = space.family();
  const auto terms = static_cast<Index>(shape.size());
  StartCombination combination{std::move(shape), MatrixXd::Zero(terms, static_cast<Index>(measured.gram.size())), 0};
  for (std::size_t c = 0; c < measured.gram.size(); ++c) {
    const MatrixXd& gram = measured.gram[c];
    std::vector<Index> rows;
    for (std::size_t k = 0; k < combination.shape.size(); ++k) rows.push_back(measured.row[k][combination.shape[k]]);
    const MatrixXd own = gram(rows, rows);
    VectorXd scales = VectorXd::Zero(terms);
    std::vector<Index> free;
    for (Index k = 0; k < terms; ++k) {
      const auto at = static_cast<std::size_t>(k);
      const std::vector<double>& weight = family.terms[at].weight;
      if (!family.has_free_scale[at]) {
        scales(k) = weight[weight.size() == 1 ? 0 : c];
      } else if (own(k, k) > 0) {
        free.push_back(k);
      }
    }
    const VectorXd products = gram.col(0)(rows);
    const VectorXd rest = products - own * scales;  // of what fixed terms leave of the target
    if (!free.empty()) {
      const VectorXd norm = own.diagonal()(free).cwiseSqrt();
      const MatrixXd scaled = norm.cwiseInverse().asDiagonal() * own(free, free) * norm.cwiseInverse().asDiagonal();
      const double size = std::sqrt(std::max(gram(0, 0), 0.0));
      if (size > 0) {
        const VectorXd found = nearest_in_cone(scaled, rest(free).cwiseQuotient(norm) / size);
        scales(free) = size * found.cwiseQuotient(norm);
      }
    }
    combination.scales.col(static_cast<Index>(c)) = scales;
    combination.square +=
        measured.weights[c] * std::max(0.0, gram(0, 0) - 2 * products.dot(scales) + scales.dot(own * scales));
  }
  return combination;
}

/// All choices of one shape per term.
std::vector<std::vector<std::size_t>> all_choices(const std::vector<std::vector<Shape>>& shapes) {
  std::vector<std::vector<std::size_t>> list{{}};
  for (const auto& of_term : shapes) {
    std::vector<std::vector<std::size_t>> longer;
    for (const auto& choice : list) {
      for (std::size_t s = 0; s < of_term.size(); ++s) {
        longer.push_back(choice);
        longer.back().push_back(s);
      }
    }
    list = std::move(longer);
  }
  return list;
}

Shape parameters_of(const MeasuredShapes& measured, const FitSpace& space, const StartCombination& combination) {
  Shape all(space.parameters());
  for (std::size_t k = 0; k < combination.shape.size(); ++k) {
    for (const std::size_t i : space.parameters_of(k)) all[i] = measured.shapes[k][combination.shape[k]][i];
  }
  return all;
}

/// Whether two points lie so near that their searches would end in the same place as a rule: no parameter differs by
/// more than this share of its range.
bool are_near(const FitSpace& space, const VectorXd& a, const VectorXd& b) {
  constexpr double kShare = 0.15;
  for (std::size_t j = space.scales(); j < space.size(); ++j) {
    const auto at = static_cast<Index>(j);
    if (std::abs(a(at) - b(at)) > kShare * (space.upper(j) - space.lower(j))) return false;
  }
  return true;
}

/// As many shapes per term as the number of combinations admits.
std::size_t shapes_per_term(const FitTarget& target, const FitSpace& space) {
  std::size_t varying = 0;
  for (std::size_t k = 0; k < space.family().terms.size(); ++k) varying += space.parameters_of(k).empty() ? 0U : 1U;
  std::size_t count = std::max<std::size_t>(2, target.most_shapes / std::max<std::size_t>(1, varying));
  const auto combinations = [&] { return std::pow(static_cast<double>(count), static_cast<double>(varying)); };
  while (count > 2 && combinations() > static_cast<double>(kMostCombinations)) --count;
  return count;
}

}  // namespace

FitStarts find_starts(const FitTarget& target, const FitSpace& space, std::span<const std::vector<NamedValue>> given,
                      std::span<const double> weights, std::size_t count, double tolerance) {
  const std::size_t terms = space.family().terms.size();
  std::vector<std::vector<Shape>> shapes(terms);
  std::vector<std::vector<std::size_t>> choices;
  for (std::size_t g = 0; g < given.size(); ++g) {
    const Shape shape = given_shape(space, given[g]);
    for (auto& of_term : shapes) of_term.push_back(shape);
    choices.emplace_back(terms, g);
  }
  if (given.empty()) {
    const std::size_t per_term = shapes_per_term(target, space);
    for (std::size_t k = 0; k < terms; ++k) shapes[k] = filling_shapes(space, space.parameters_of(k), per_term);
  }
  const MeasuredShapes measured = measure_shapes(target, space, std::move(shapes), weights, tolerance);
  if (given.empty()) {
    choices = all_choices(measured.shapes);
  } else if (std::ranges::any_of(measured.shapes, [&](const auto& list) { return list.size() < given.size(); })) {
    throw NumericError("a starting point cannot be measured against '" + target.name +
                       "'; expected shapes that its grid resolves");
  }

  double size = 0;
  for (std::size_t c = 0; c < measured.gram.size(); ++c) size += weights[c] * measured.gram[c](0, 0);
  if (!(size > 0)) throw NumericError("'" + target.name + "' has norm 0; expected a target that is not black");

  std::vector<StartCombination> combinations;
  for (auto& choice : choices) combinations.push_back(best_scales(measured, space, std::move(choice)));
  std::ranges::stable_sort(combinations, {}, &StartCombination::square);

  FitStarts starts;
  starts.compared = combinations.size();
  starts.evaluations = static_cast<std::size_t>(measured.gram.front().rows()) - 1;
  for (const StartCombination& combination : combinations) {
    const Shape parameters = parameters_of(measured, space, combination);
    FitStart start{space.point(combination.scales, parameters), std::sqrt(combination.square / size)};
    const auto is_near = [&](const FitStart& other) { return are_near(space, other.x, start.x); };
    if (given.empty() && std::ranges::any_of(starts.best, is_near)) continue;
    starts.best.push_back(std::move(start));
    if (starts.best.size() == count) break;
  }

  starts.unit = VectorXd::Zero(static_cast<Index>(space.scales()));
  const StartCombination& best = combinations.front();
  for (std::size_t j = 0; j < space.scales(); ++j) {
    const FitSpace::Axis& axis = space.axis(j);
    const MatrixXd& gram = measured.gram[axis.index];
    const Index row = measured.row[axis.term][best.shape[axis.term]];
    const double scale = std::sqrt(gram(0, 0) / gram(row, row));
    starts.unit(static_cast<Index>(j)) = std::isfinite(scale) && scale > 0 ? scale : 1;
  }
  return starts;
}

}  // namespace lobe
