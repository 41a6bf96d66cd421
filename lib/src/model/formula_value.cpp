#include "model/formula_value.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <limits>
#include <numbers>
#include <string_view>
#include <vector>

#include "model/family/fresnel.hpp"

namespace lobe {
namespace {

using std::numbers::pi;
using Kind = FormulaPart::Kind;

// Of an operation, and of a function: OpenCL allows some 16 units in the last place, of which these are a few more.
constexpr double kOperation = 2.3e-16;
constexpr double kFunction = 6e-15;

// Quantities of the geometry are known to some units in the last place of 1, or of themselves where they are larger.
constexpr double kGeometry = 2e-15;

// Beyond such a share of 1, or of itself, nothing is said about functions of a number; beyond such a share of 1 about
// periodic ones.
constexpr double kUncertain = 1e-3;

constexpr double kUnknown = std::numeric_limits<double>::quiet_NaN();

Estimate rounded(double value, double error, double rounding) {
  return {value, std::isfinite(value) ? error + rounding * std::abs(value) : kUnknown};
}

Estimate sum(const Estimate& a, const Estimate& b) {
  return rounded(a.value + b.value, a.error + b.error, kOperation);
}

Estimate negative(const Estimate& a) {
  return {-a.value, a.error};
}

Estimate product(const Estimate& a, const Estimate& b) {
  const double error = std::abs(a.value) * b.error + std::abs(b.value) * a.error + a.error * b.error;
  return rounded(a.value * b.value, error, kOperation);
}

Estimate quotient(const Estimate& a, const Estimate& b) {
  const double value = a.value / b.value;
  const double least = std::abs(b.value) - b.error;
  if (!(least > 0)) return {value, kUnknown};
  return rounded(value, (a.error + std::abs(value) * b.error) / least, kOperation);
}

double clamped(double x, double low, double high) {
  return std::fmin(std::fmax(x, low), high);
}

using Arguments = FormulaNumbers;

struct HostFunction {
  std::string_view name;
  HostFunctionOfNumbers value;
  bool is_periodic = false;
};

/// Functions that are as accurate as their arguments; others are made of operations in called().
constexpr std::array kHostFunctions{
    HostFunction{"exp", [](const Arguments& x) { return std::exp(x[0]); }},
    HostFunction{"exp2", [](const Arguments& x) { return std::exp2(x[0]); }},
    HostFunction{"exp10", [](const Arguments& x) { return std::pow(10.0, x[0]); }},
    HostFunction{"expm1", [](const Arguments& x) { return std::expm1(x[0]); }},
    HostFunction{"log", [](const Arguments& x) { return std::log(x[0]); }},
    HostFunction{"log2", [](const Arguments& x) { return std::log2(x[0]); }},
    HostFunction{"log10", [](const Arguments& x) { return std::log10(x[0]); }},
    HostFunction{"log1p", [](const Arguments& x) { return std::log1p(x[0]); }},
    HostFunction{"pow", [](const Arguments& x) { return std::pow(x[0], x[1]); }},
    HostFunction{"powr", [](const Arguments& x) { return x[0] < 0 ? kUnknown : std::pow(x[0], x[1]); }},
    HostFunction{"sqrt", [](const Arguments& x) { return std::sqrt(x[0]); }},
    HostFunction{"rsqrt", [](const Arguments& x) { return 1 / std::sqrt(x[0]); }},
    HostFunction{"cbrt", [](const Arguments& x) { return std::cbrt(x[0]); }},
    HostFunction{"hypot", [](const Arguments& x) { return std::hypot(x[0], x[1]); }},
    HostFunction{"sin", [](const Arguments& x) { return std::sin(x[0]); }, true},
    HostFunction{"cos", [](const Arguments& x) { return std::cos(x[0]); }, true},
    HostFunction{"tan", [](const Arguments& x) { return std::tan(x[0]); }, true},
    HostFunction{"asin", [](const Arguments& x) { return std::asin(x[0]); }},
    HostFunction{"acos", [](const Arguments& x) { return std::acos(x[0]); }},
    HostFunction{"atan", [](const Arguments& x) { return std::atan(x[0]); }},
    HostFunction{"atan2", [](const Arguments& x) { return std::atan2(x[0], x[1]); }},
    HostFunction{"sinh", [](const Arguments& x) { return std::sinh(x[0]); }},
    HostFunction{"cosh", [](const Arguments& x) { return std::cosh(x[0]); }},
    HostFunction{"tanh", [](const Arguments& x) { return std::tanh(x[0]); }},
    HostFunction{"asinh", [](const Arguments& x) { return std::asinh(x[0]); }},
    HostFunction{"acosh", [](const Arguments& x) { return std::acosh(x[0]); }},
    HostFunction{"atanh", [](const Arguments& x) { return std::atanh(x[0]); }},
    HostFunction{"erf", [](const Arguments& x) { return std::erf(x[0]); }},
    HostFunction{"erfc", [](const Arguments& x) { return std::erfc(x[0]); }},
    HostFunction{"fabs", [](const Arguments& x) { return std::abs(x[0]); }},
    HostFunction{"sign", [](const Arguments& x) { return x[0] > 0   ? 1.0
                                                         : x[0] < 0 ? -1.0
                                                                    : 0.0; }},
    HostFunction{"floor", [](const Arguments& x) { return std::floor(x[0]); }},
    HostFunction{"ceil", [](const Arguments& x) { return std::ceil(x[0]); }},
    HostFunction{"round", [](const Arguments& x) { return std::round(x[0]); }},
    HostFunction{"trunc", [](const Arguments& x) { return std::trunc(x[0]); }},
    HostFunction{"fmod", [](const Arguments& x) { return std::fmod(x[0], x[1]); }, true},
    HostFunction{"fmin", [](const Arguments& x) { return std::fmin(x[0], x[1]); }},
    HostFunction{"fmax", [](const Arguments& x) { return std::fmax(x[0], x[1]); }},
    HostFunction{"min", [](const Arguments& x) { return std::fmin(x[0], x[1]); }},
    HostFunction{"max", [](const Arguments& x) { return std::fmax(x[0], x[1]); }},
    HostFunction{"fdim", [](const Arguments& x) { return std::fdim(x[0], x[1]); }},
    HostFunction{"clamp", [](const Arguments& x) { return clamped(x[0], x[1], x[2]); }},
    HostFunction{"step", [](const Arguments& x) { return x[1] < x[0] ? 0.0 : 1.0; }},
    HostFunction{"radians", [](const Arguments& x) { return x[0] * (pi / 180); }},
    HostFunction{"degrees", [](const Arguments& x) { return x[0] * (180 / pi); }},
    HostFunction{"fresnel", [](const Arguments& x) { return fresnel_reflectance(x[0], x[1], x[2]); }}};

/// A function with the largest change that its arguments make within their errors, at the corners of these.
Estimate called(const HostFunction& function, std::span<const Estimate> arguments) {
  Arguments at{};
  for (std::size_t k = 0; k < arguments.size(); ++k) {
    at.at(k) = arguments[k].value;
    const double size = function.is_periodic ? 1 : std::max(1.0, std::abs(arguments[k].value));
    if (!(arguments[k].error <= kUncertain * size)) return {0, kUnknown};
  }
  const double value = function.value(at);
  double error = 0;
  for (std::size_t corner = 0; corner < std::size_t{1} << arguments.size(); ++corner) {
    Arguments moved = at;
    for (std::size_t k = 0; k < arguments.size(); ++k) {
      moved.at(k) += (corner >> k & 1U) == 0 ? arguments[k].error : -arguments[k].error;
    }
    const double change = std::abs(function.value(moved) - value);
    if (!(change <= error)) error = change;  // keeps NaN
    if (std::isnan(error)) break;
  }
  return rounded(value, error, kFunction);
}

Estimate called(std::string_view name, std::span<const Estimate> x) {
  const auto* const found = std::ranges::find(kHostFunctions, name, &HostFunction::name);
  if (found != kHostFunctions.end()) {
    Estimate value = called(*found, x);
    if (name == "fresnel") value.error += kFunction;  // numerators cancel
    return value;
  }
  if (name == "mix") return sum(x[0], product(sum(x[1], negative(x[0])), x[2]));
  if (name == "fma" || name == "mad") return sum(product(x[0], x[1]), x[2]);
  // smoothstep
  const Estimate share = quotient(sum(x[2], negative(x[0])), sum(x[1], negative(x[0])));
  const std::array limits{share, Estimate{0, 0}, Estimate{1, 0}};
  const Estimate t = called("clamp", limits);
  return product(product(t, t), sum({3, 0}, product({-2, 0}, t)));
}

/// Whether a condition holds, 1 or 0; unknown where rounding decides.
Estimate compared(Kind kind, const Estimate& a, const Estimate& b) {
  const double error = a.error + b.error;
  if (!(error == 0 || std::abs(a.value - b.value) > error)) return {0, kUnknown};
  const auto holds = [&] {
    switch (kind) {
      case Kind::less:
        return a.value < b.value;
      case Kind::less_or_equal:
        return a.value <= b.value;
      case Kind::greater:
        return a.value > b.value;
      case Kind::greater_or_equal:
        return a.value >= b.value;
      case Kind::equal:
        return a.value == b.value;
      default:
        return a.value != b.value;
    }
  };
  return {holds() ? 1.0 : 0.0, 0};
}

/// Of two conditions both or either; one that is known may decide alone.
Estimate joined(Kind kind, const Estimate& a, const Estimate& b) {
  const double deciding = kind == Kind::both ? 0 : 1;
  for (const Estimate& one : {a, b}) {
    if (one.error == 0 && one.value == deciding) return one;
  }
  return {1 - deciding, a.error + b.error};
}

/// A quantity by its definition (docs/formulas.md), from the vectors.
Estimate quantity_at(std::string_view name, const Directions& pair) {
  if (name == "pi") return {pi, 0};
  using Vector = std::array<double, 3>;
  const auto vector = [](double theta, double phi) {
    return Vector{std::sin(theta) * std::cos(phi), std::sin(theta) * std::sin(phi), std::cos(theta)};
  };
  const Vector in = vector(pair.theta_in, pair.phi_in);
  const Vector out = vector(pair.theta_out, pair.phi_in + pair.delta_phi);
  const double length = std::hypot(in[0] + out[0], in[1] + out[1], in[2] + out[2]);
  const double cos_h = (in[2] + out[2]) / length;
  const double cos_rv = in[2] * out[2] - in[0] * out[0] - in[1] * out[1];
  const double slope = std::hypot(in[0] + out[0], in[1] + out[1]) / (in[2] + out[2]);
  // Of errors of the vectors, what division by the length of their sum and by its height makes.
  const double of_half = kGeometry / std::min(length, in[2] + out[2]);
  const auto known = [](double value, double error) { return Estimate{value, error * std::max(1.0, std::abs(value))}; };
  if (name == "cos_i") return known(in[2], kGeometry);
  if (name == "cos_o") return known(out[2], kGeometry);
  if (name == "cos_h") return known(cos_h, of_half);
  if (name == "cos_d") return known(length / 2, kGeometry);
  if (name == "cos_rv") return known(cos_rv, kGeometry);
  if (name == "cos_lv") return known(in[0] * out[0] + in[1] * out[1] + in[2] * out[2], kGeometry);
  if (name == "theta_i") return known(pair.theta_in, kGeometry / std::sin(pair.theta_in));
  if (name == "theta_o") return known(pair.theta_out, kGeometry / std::sin(pair.theta_out));
  if (name == "tan2_h") return known(slope * slope, 4 * of_half * (1 + slope));
  if (name == "log_cos_h") return known(std::log(cos_h), of_half / cos_h);
  if (name == "log_rv") {
    if (std::abs(cos_rv) <= 4 * kGeometry) return {0, kUnknown};
    return cos_rv > 0 ? known(std::log(cos_rv), kGeometry / cos_rv) : Estimate{-1e30, kGeometry * 1e30};
  }
  if (name == "distance_p") return known(std::hypot(in[0] + out[0], in[1] + out[1]), 4 * of_half);
  if (name == "in_x") return known(in[0], kGeometry);
  if (name == "in_y") return known(in[1], kGeometry);
  if (name == "out_x") return known(out[0], 4 * of_half);
  if (name == "out_y") return known(out[1], 4 * of_half);
  if (name == "half_x") return known((in[0] + out[0]) / length, 4 * of_half);
  if (name == "half_y") return known((in[1] + out[1]) / length, 4 * of_half);
  return {0, kUnknown};
}

/// Functions that called() makes of operations, for numbers alone.
constexpr std::array kComposedFunctions{
    HostFunction{"mix", [](const Arguments& x) { return x[0] + (x[1] - x[0]) * x[2]; }},
    HostFunction{"fma", [](const Arguments& x) { return x[0] * x[1] + x[2]; }},
    HostFunction{"mad", [](const Arguments& x) { return x[0] * x[1] + x[2]; }},
    HostFunction{"smoothstep", [](const Arguments& x) {
                   const double t = clamped((x[2] - x[0]) / (x[1] - x[0]), 0, 1);
                   return t * t * (3 - 2 * t);
                 }}};

}  // namespace

HostFunctionOfNumbers host_function(std::string_view name) {
  const auto* const found = std::ranges::find(kHostFunctions, name, &HostFunction::name);
  if (found != kHostFunctions.end()) return found->value;
  return std::ranges::find(kComposedFunctions, name, &HostFunction::name)->value;
}

Estimate formula_value(const FormulaTree& tree, std::span<const double> parameters, const Directions& pair) {
  std::vector<Estimate> values;
  values.reserve(tree.parts.size());
  for (const FormulaPart& part : tree.parts) {
    const auto operand = [&](std::size_t k) -> const Estimate& { return values[part.operands.at(k)]; };
    const auto value = [&]() -> Estimate {
      switch (part.kind) {
        case Kind::number:
          return {part.number, 0};
        case Kind::quantity:
          return quantity_at(formula_quantities()[part.index].name, pair);
        case Kind::parameter:
          return {parameters[part.index], 0};
        case Kind::negation:
          return negative(operand(0));
        case Kind::sum:
          return sum(operand(0), operand(1));
        case Kind::difference:
          return sum(operand(0), negative(operand(1)));
        case Kind::product:
          return product(operand(0), operand(1));
        case Kind::quotient:
          return quotient(operand(0), operand(1));
        case Kind::call: {
          std::array<Estimate, 3> arguments;
          const std::size_t count = operand_count(part);
          for (std::size_t k = 0; k < count; ++k) arguments.at(k) = operand(k);
          return called(formula_functions()[part.index].name, std::span(arguments).first(count));
        }
        case Kind::choice:
          if (operand(0).error != 0) return {0, kUnknown};
          return operand(operand(0).value != 0 ? 1 : 2);
        case Kind::both:
        case Kind::either:
          return joined(part.kind, operand(0), operand(1));
        case Kind::opposite:
          return {1 - operand(0).value, operand(0).error};
        default:
          return compared(part.kind, operand(0), operand(1));
      }
    };
    values.push_back(value());
  }
  return values.back();
}

}  // namespace lobe
