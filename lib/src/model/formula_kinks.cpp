#include "model/formula_kinks.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <memory>
#include <numbers>
#include <set>
#include <string>
#include <string_view>
#include <utility>

#include "model/formula_value.hpp"

namespace lobe {
namespace {

using std::numbers::pi;
using Kind = FormulaPart::Kind;

constexpr double kJump = 0;
// Corners of fmax() and its like: roots and powers of them begin as a root.
constexpr double kCorner = 0.5;
constexpr double kSmoothEnd = 2;  // of smoothstep()

using QuantityOfPair = double (*)(const KinkPair&);

double cos_d(const KinkPair& p) {
  return std::sqrt(std::max(0.0, (1 + p.cos_between) / 2));
}

double cos_h(const KinkPair& p) {
  return (p.cos_i + p.cos_o) / (2 * cos_d(p));
}

double cos_rv(const KinkPair& p) {
  return 2 * p.cos_i * p.cos_o - p.cos_between;
}

/// |V_P - L'_P|^2.
double square_distance(const KinkPair& p) {
  const double sum = p.cos_i + p.cos_o;
  return std::max(0.0, 2 * (1 + p.cos_between) - sum * sum);
}

struct PairQuantity {
  std::string_view name;
  QuantityOfPair value;
};

constexpr std::array kPairQuantities{
    PairQuantity{"cos_i", [](const KinkPair& p) { return p.cos_i; }},
    PairQuantity{"cos_o", [](const KinkPair& p) { return p.cos_o; }},
    PairQuantity{"cos_h", cos_h},
    PairQuantity{"cos_d", cos_d},
    PairQuantity{"cos_rv", cos_rv},
    PairQuantity{"cos_lv", [](const KinkPair& p) { return p.cos_between; }},
    PairQuantity{"theta_i", [](const KinkPair& p) { return std::acos(std::min(1.0, p.cos_i)); }},
    PairQuantity{"theta_o", [](const KinkPair& p) { return std::acos(std::min(1.0, p.cos_o)); }},
    PairQuantity{"tan2_h",
                 [](const KinkPair& p) { return square_distance(p) / ((p.cos_i + p.cos_o) * (p.cos_i + p.cos_o)); }},
    PairQuantity{"log_cos_h", [](const KinkPair& p) { return std::log(cos_h(p)); }},
    PairQuantity{"log_rv", [](const KinkPair& p) { return cos_rv(p) > 0 ? std::log(cos_rv(p)) : -1e30; }},
    PairQuantity{"distance_p", [](const KinkPair& p) { return std::sqrt(square_distance(p)); }},
    PairQuantity{"in_x", [](const KinkPair& p) { return p.in_x; }},
    PairQuantity{"in_y", [](const KinkPair& p) { return p.in_y; }},
    PairQuantity{"out_x", [](const KinkPair& p) { return p.out_x; }},
    PairQuantity{"out_y", [](const KinkPair& p) { return p.out_y; }},
    PairQuantity{"half_x", [](const KinkPair& p) { return (p.in_x + p.out_x) / (2 * cos_d(p)); }},
    PairQuantity{"half_y", [](const KinkPair& p) { return (p.in_y + p.out_y) / (2 * cos_d(p)); }},
    PairQuantity{"pi", [](const KinkPair&) { return pi; }}};

/// A part of a formula with what it is made of, ready to be computed at many pairs.
class Expression {
 public:
  /// Parts of a tree that are conditions are 1 or 0.
  Expression(const FormulaTree& tree, std::span<const double> parameters, std::size_t last) {
    std::vector<std::size_t> needed{last};
    for (std::size_t k = 0; k < needed.size(); ++k) {
      const FormulaPart& part = tree.parts[needed[k]];
      for (std::size_t o = 0; o < operand_count(part); ++o) needed.push_back(part.operands.at(o));
    }
    std::ranges::sort(needed);
    for (const std::size_t place : needed) {
      const FormulaPart& part = tree.parts[place];
      Step step{.kind = part.kind};
      for (std::size_t o = 0; o < operand_count(part); ++o) {
        step.operands.at(o) =
            static_cast<std::size_t>(std::ranges::lower_bound(needed, part.operands.at(o)) - needed.begin());
      }
      switch (part.kind) {
        case Kind::number:
          step.number = part.number;
          break;
        case Kind::parameter:
          step.kind = Kind::number;
          step.number = parameters[part.index];
          break;
        case Kind::quantity: {
          const FormulaQuantity& quantity = formula_quantities()[part.index];
          step.quantity = std::ranges::find(kPairQuantities, quantity.name, &PairQuantity::name)->value;
          is_anisotropic_ = is_anisotropic_ || quantity.is_anisotropic;
          is_constant_ = is_constant_ && quantity.name == "pi";
          break;
        }
        case Kind::call:
          step.function = host_function(formula_functions()[part.index].name);
          break;
        default:
          break;
      }
      steps_.push_back(step);
    }
  }

  [[nodiscard]] bool is_constant() const { return is_constant_; }
  [[nodiscard]] bool is_anisotropic() const { return is_anisotropic_; }

  [[nodiscard]] double at(const KinkPair& pair) const {
    constexpr std::size_t kFew = 32;
    std::array<double, kFew> few{};
    std::vector<double> many;
    double* values = few.data();
    if (steps_.size() > kFew) {
      many.resize(steps_.size());
      values = many.data();
    }
    for (std::size_t k = 0; k < steps_.size(); ++k) values[k] = value_of(steps_[k], values, pair);
    return values[steps_.size() - 1];
  }

 private:
  struct Step {
    Kind kind = Kind::number;
    double number = 0;
    QuantityOfPair quantity = nullptr;
    HostFunctionOfNumbers function = nullptr;
    std::array<std::size_t, 3> operands{};
  };

  static double value_of(const Step& step, const double* values, const KinkPair& pair) {
    const double a = values[step.operands[0]];
    const double b = values[step.operands[1]];
    const double c = values[step.operands[2]];
    switch (step.kind) {
      case Kind::quantity:
        return step.quantity(pair);
      case Kind::negation:
        return -a;
      case Kind::sum:
        return a + b;
      case Kind::difference:
        return a - b;
      case Kind::product:
        return a * b;
      case Kind::quotient:
        return a / b;
      case Kind::call:
        return step.function({a, b, c});
      case Kind::choice:
        return a != 0 ? b : c;
      case Kind::less:
        return a < b ? 1 : 0;
      case Kind::less_or_equal:
        return a <= b ? 1 : 0;
      case Kind::greater:
        return a > b ? 1 : 0;
      case Kind::greater_or_equal:
        return a >= b ? 1 : 0;
      case Kind::equal:
        return a == b ? 1 : 0;
      case Kind::unequal:
        return a != b ? 1 : 0;
      case Kind::both:
        return a != 0 && b != 0 ? 1 : 0;
      case Kind::either:
        return a != 0 || b != 0 ? 1 : 0;
      case Kind::opposite:
        return a == 0 ? 1 : 0;
      default:
        return step.number;
    }
  }

  std::vector<Step> steps_;
  bool is_constant_ = true;
  bool is_anisotropic_ = false;
};

/// Pairs all over the domain, for ranges of values.
std::vector<KinkPair> sampled_pairs() {
  constexpr int kPairs = 1000;
  // Steps of an additive recurrence that fills the unit cube evenly.
  constexpr std::array kSteps{0.8191725133961645, 0.6710436067037893, 0.5497004779019703, 0.4503};
  std::vector<KinkPair> pairs;
  for (int k = 0; k < kPairs; ++k) {
    const auto share = [&](std::size_t axis) {
      const double at = 0.5 + k * kSteps.at(axis);
      return at - std::floor(at);
    };
    const double theta_i = pi / 2 * share(0);
    const double theta_o = pi / 2 * share(1);
    const double phi_i = 2 * pi * share(3);
    const double phi_o = phi_i + 2 * pi * share(2);
    KinkPair pair{.cos_i = std::cos(theta_i),
                  .cos_o = std::cos(theta_o),
                  .in_x = std::sin(theta_i) * std::cos(phi_i),
                  .in_y = std::sin(theta_i) * std::sin(phi_i),
                  .out_x = std::sin(theta_o) * std::cos(phi_o),
                  .out_y = std::sin(theta_o) * std::sin(phi_o)};
    pair.cos_between = pair.cos_i * pair.cos_o + pair.in_x * pair.out_x + pair.in_y * pair.out_y;
    pairs.push_back(pair);
  }
  return pairs;
}

/// Collects the kinks of a tree.
class Collector {
 public:
  Collector(const FormulaTree& tree, std::span<const double> parameters) : tree_(tree) {
    for (FormulaPart& part : tree_.parts) {
      if (part.kind != Kind::parameter) continue;
      part = {.kind = Kind::number, .number = parameters[part.index]};
    }
  }

  FormulaKinks found() {
    const std::size_t count = tree_.parts.size();
    for (std::size_t k = 0; k < count; ++k) {
      const FormulaPart part = tree_.parts[k];
      if (part.kind == Kind::call) {
        add_call(formula_functions()[part.index].name, part.operands);
      } else if (part.kind >= Kind::less && part.kind <= Kind::unequal) {
        add_comparison(part.operands[0], part.operands[1]);
      }
    }
    found_.kinks.assign(kinks_.begin(), kinks_.end());
    return std::move(found_);
  }

 private:
  std::size_t appended(const FormulaPart& part) {
    tree_.parts.push_back(part);
    return tree_.parts.size() - 1;
  }
  std::size_t number(double value) { return appended({.kind = Kind::number, .number = value}); }
  std::size_t difference(std::size_t a, std::size_t b) {
    return appended({.kind = Kind::difference, .operands = {a, b}});
  }
  std::size_t product(std::size_t a, std::size_t b) { return appended({.kind = Kind::product, .operands = {a, b}}); }

  /// Where |x| passes a number, x passes it or the opposite: two limits instead of one function with two zeros, which
  /// may lie between the same two points that it is looked at.
  void add_comparison(std::size_t a, std::size_t b) {
    const auto is_size = [&](std::size_t place) {
      const FormulaPart& part = tree_.parts[place];
      return part.kind == Kind::call && formula_functions()[part.index].name == "fabs";
    };
    if (is_size(b)) std::swap(a, b);
    if (!is_size(a)) {
      add(difference(a, b), kJump);
      return;
    }
    const std::size_t x = tree_.parts[a].operands[0];
    add(difference(x, b), kJump);
    add(appended({.kind = Kind::sum, .operands = {x, b}}), kJump);
  }

  void add_call(std::string_view name, const std::array<std::size_t, 3>& x) {
    if (name == "fabs") add(x[0], kCorner);
    if (name == "fmin" || name == "fmax" || name == "min" || name == "max" || name == "fdim") {
      add(difference(x[0], x[1]), kCorner);
    }
    if (name == "clamp") {
      add(difference(x[0], x[1]), kCorner);
      add(difference(x[0], x[2]), kCorner);
    }
    if (name == "smoothstep") {
      add(difference(x[2], x[0]), kSmoothEnd);
      add(difference(x[2], x[1]), kSmoothEnd);
    }
    if (name == "sign" || name == "atan2") add(x[0], kJump);
    if (name == "step") add(difference(x[0], x[1]), kJump);
    if (name == "floor" || name == "ceil") add_steps(x[0], 0);
    if (name == "round") add_steps(x[0], 0.5);
    if (name == "trunc") add_steps(x[0], 0);
    if (name == "fmod") add_steps(appended({.kind = Kind::quotient, .operands = {x[0], x[1]}}), 0);
    if (name == "fresnel") {
      // The critical angle, of refractive indices below 1: sin = ior.
      const std::size_t squares = appended({.kind = Kind::sum, .operands = {product(x[0], x[0]), product(x[1], x[1])}});
      add(difference(squares, number(1)), kCorner);
    }
  }

  /// Where a number passes one of n + offset.
  void add_steps(std::size_t of, double offset) {
    constexpr double kMostSteps = 8;
    const Expression expression(tree_, {}, of);
    if (expression.is_constant()) return;
    static const std::vector<KinkPair> pairs = sampled_pairs();
    double least = std::numeric_limits<double>::infinity();
    double largest = -least;
    for (const KinkPair& pair : pairs) {
      const double value = expression.at(pair);
      if (!std::isfinite(value)) continue;
      least = std::min(least, value);
      largest = std::max(largest, value);
    }
    const double first = std::floor(least - offset);
    const double last = std::ceil(largest - offset);
    if (last - first <= kMostSteps) {
      for (double step = first; step <= last; ++step) add(difference(of, number(step + offset)), kJump);
      return;
    }
    found_.has_many_steps = true;
    const std::size_t shifted = difference(of, number(offset));
    const auto sine = static_cast<std::size_t>(std::ranges::find(formula_functions(), "sin", &FormulaFunction::name) -
                                               formula_functions().begin());
    const std::size_t turned = product(shifted, number(pi));
    add(appended({.kind = Kind::call, .index = sine, .operands = {turned}}), kJump);
  }

  void add(std::size_t of, double order) {
    auto expression = std::make_shared<const Expression>(tree_, std::span<const double>{}, of);
    if (expression->is_constant()) return;
    const auto by = [expression](const KinkPair& pair) {
      const double value = expression->at(pair);
      return std::isfinite(value) ? value : std::isinf(value) ? std::copysign(1e300, value) : 0.0;
    };
    kinks_.insert({.order = order, .is_anisotropic = expression->is_anisotropic(), .by = by, .text = text_of(of)});
  }

  [[nodiscard]] std::string text_of(std::size_t last) const {
    FormulaTree part;
    copy_part(last, part);
    return canonical_text(part, {});
  }

  std::size_t copy_part(std::size_t place, FormulaTree& to) const {
    FormulaPart part = tree_.parts[place];
    for (std::size_t o = 0; o < operand_count(part); ++o) part.operands.at(o) = copy_part(part.operands.at(o), to);
    to.parts.push_back(part);
    return to.parts.size() - 1;
  }

  FormulaTree tree_;
  std::set<Kink> kinks_;
  FormulaKinks found_;
};

}  // namespace

FormulaKinks formula_kinks(const FormulaTree& tree, std::span<const double> parameters) {
  return Collector(tree, parameters).found();
}

}  // namespace lobe
