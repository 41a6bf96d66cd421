#include "formats/shader_program.hpp"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <limits>
#include <numbers>

namespace lobe {
namespace {

using Op = ShaderOp;

constexpr double kNotANumber = std::numeric_limits<double>::quiet_NaN();
/// Cosines of unit vectors exceed 1 by rounding.
constexpr double kCosineRounding = 4 * std::numeric_limits<double>::epsilon();

double cosine_within(double x) {
  return std::abs(x) > 1 && std::abs(x) <= 1 + kCosineRounding ? std::copysign(1.0, x) : x;
}

/// Bits of an integer, as arithmetic of 32 bits leaves them.
std::uint32_t low_bits(double x) {
  if (!std::isfinite(x)) return 0;
  constexpr double kWhole = 4294967296.0;
  const double rest = std::fmod(std::trunc(x), kWhole);
  return static_cast<std::uint32_t>(rest < 0 ? rest + kWhole : rest);
}

/// As GLSL defines them, also of what is not a number.
double smaller(double a, double b) {
  return b < a ? b : a;
}
double larger(double a, double b) {
  return a < b ? b : a;
}

/// GLSL leaves powers of negative numbers, and those of 0 to 0 and below, undefined.
double power_of(double x, double y) {
  return x < 0 || (x == 0 && y <= 0) ? kNotANumber : std::pow(x, y);
}

double dot_of(const double* a, const double* b, std::size_t n) {
  double sum = 0;
  for (std::size_t k = 0; k < n; ++k) sum += a[k] * b[k];
  return sum;
}

double apply(Op op, double a) {
  constexpr double kRightAngle = 180;
  switch (op) {
    case Op::to_integer:
    case Op::wrap_integer:
      return std::isfinite(a) ? static_cast<std::int32_t>(low_bits(a)) : kNotANumber;
    case Op::to_natural:
    case Op::wrap_natural:
      return std::isfinite(a) ? low_bits(a) : kNotANumber;
    case Op::to_truth:
      return static_cast<double>(a != 0);
    case Op::negate:
      return -a;
    case Op::opposite:
      return static_cast<double>(a == 0);
    case Op::radians:
      return a * (std::numbers::pi / kRightAngle);
    case Op::degrees:
      return a * (kRightAngle / std::numbers::pi);
    case Op::sine:
      return std::sin(a);
    case Op::cosine:
      return std::cos(a);
    case Op::tangent:
      return std::tan(a);
    case Op::arc_sine:
      return std::asin(cosine_within(a));
    case Op::arc_cosine:
      return std::acos(cosine_within(a));
    case Op::arc_tangent:
      return std::atan(a);
    case Op::hyperbolic_sine:
      return std::sinh(a);
    case Op::hyperbolic_cosine:
      return std::cosh(a);
    case Op::hyperbolic_tangent:
      return std::tanh(a);
    case Op::area_sine:
      return std::asinh(a);
    case Op::area_cosine:
      return std::acosh(a);
    case Op::area_tangent:
      return std::atanh(a);
    case Op::exponential:
      return std::exp(a);
    case Op::logarithm:
      return std::log(a);
    case Op::exponential_2:
      return std::exp2(a);
    case Op::logarithm_2:
      return std::log2(a);
    case Op::root:
      return std::sqrt(a);
    case Op::inverse_root:
      return 1 / std::sqrt(a);
    case Op::absolute:
      return std::abs(a);
    case Op::sign:
      return std::isnan(a) ? kNotANumber : static_cast<double>(a > 0) - static_cast<double>(a < 0);
    case Op::floor:
      return std::floor(a);
    case Op::truncate:
      return std::trunc(a);
    case Op::round:
      return std::round(a);
    case Op::round_even:
      return std::nearbyint(a);
    case Op::ceiling:
      return std::ceil(a);
    case Op::fraction:
      return a - std::floor(a);
    case Op::is_nan:
      return static_cast<double>(std::isnan(a));
    case Op::is_infinite:
      return static_cast<double>(std::isinf(a));
    default:
      return kNotANumber;
  }
}

double apply(Op op, double a, double b) {
  switch (op) {
    case Op::add:
      return a + b;
    case Op::subtract:
      return a - b;
    case Op::multiply:
      return a * b;
    case Op::divide:
      return a / b;
    case Op::divide_integer:
      return std::trunc(a / b);
    case Op::modulo_integer:
      return std::fmod(a, b);
    case Op::less:
      return static_cast<double>(a < b);
    case Op::less_or_equal:
      return static_cast<double>(a <= b);
    case Op::greater:
      return static_cast<double>(a > b);
    case Op::greater_or_equal:
      return static_cast<double>(a >= b);
    case Op::equal:
      return static_cast<double>(a == b);
    case Op::unequal:
      return static_cast<double>(a != b);
    case Op::arc_tangent_2:
      return std::atan2(a, b);
    case Op::power:
      return power_of(a, b);
    case Op::modulo:
      return a - b * std::floor(a / b);
    case Op::minimum:
      return smaller(a, b);
    case Op::maximum:
      return larger(a, b);
    case Op::step:
      return static_cast<double>(!(b < a));
    default:
      return kNotANumber;
  }
}

double apply(Op op, double a, double b, double c) {
  switch (op) {
    case Op::clamp:
      return smaller(larger(a, b), c);
    case Op::mix:
      return a * (1 - c) + b * c;
    case Op::choose:
      return c != 0 ? b : a;
    case Op::smoothstep: {
      const double t = smaller(larger((c - a) / (b - a), 0), 1);
      return t * t * (3 - 2 * t);
    }
    case Op::multiply_add:
      return std::fma(a, b, c);
    default:
      return kNotANumber;
  }
}

constexpr std::uint32_t kSizeBits = 4;  // of the sizes of matrices
constexpr std::uint32_t kSizeMask = 15;

void multiply_matrices(double* dst, const double* a, const double* b, std::uint32_t sizes) {
  const std::size_t rows = sizes & kSizeMask;
  const std::size_t inner = (sizes >> kSizeBits) & kSizeMask;
  const std::size_t columns = (sizes >> (2 * kSizeBits)) & kSizeMask;
  for (std::size_t j = 0; j < columns; ++j) {
    for (std::size_t i = 0; i < rows; ++i) {
      double sum = 0;
      for (std::size_t k = 0; k < inner; ++k) sum += a[k * rows + i] * b[j * inner + k];
      dst[j * rows + i] = sum;
    }
  }
}

/// Functions of whole vectors of n components; results have slots of their own.
void apply_to_vectors(const ShaderInstruction& one, double* dst, const double* a, const double* b, const double* c) {
  const std::size_t n = one.n;
  switch (one.op) {
    case Op::same:
    case Op::differs: {
      const bool are_equal = std::equal(a, a + n, b);
      *dst = static_cast<double>(are_equal == (one.op == Op::same));
      return;
    }
    case Op::matrix:
      return multiply_matrices(dst, a, b, one.c);
    case Op::dot:
      *dst = dot_of(a, b, n);
      return;
    case Op::length:
      *dst = std::sqrt(dot_of(a, a, n));
      return;
    case Op::distance: {
      double sum = 0;
      for (std::size_t k = 0; k < n; ++k) sum += (a[k] - b[k]) * (a[k] - b[k]);
      *dst = std::sqrt(sum);
      return;
    }
    case Op::cross:
      dst[0] = a[1] * b[2] - a[2] * b[1];
      dst[1] = a[2] * b[0] - a[0] * b[2];
      dst[2] = a[0] * b[1] - a[1] * b[0];
      return;
    case Op::normalise: {
      const double length = std::sqrt(dot_of(a, a, n));
      for (std::size_t k = 0; k < n; ++k) dst[k] = a[k] / length;
      return;
    }
    case Op::reflect: {
      const double twice = 2 * dot_of(b, a, n);
      for (std::size_t k = 0; k < n; ++k) dst[k] = a[k] - twice * b[k];
      return;
    }
    case Op::refract: {
      const double cosine = dot_of(b, a, n);
      const double eta = *c;
      const double rest = 1 - eta * eta * (1 - cosine * cosine);
      for (std::size_t k = 0; k < n; ++k) {
        dst[k] = rest < 0 ? 0 : eta * a[k] - (eta * cosine + std::sqrt(rest)) * b[k];
      }
      return;
    }
    case Op::face_forward: {
      const double sign = dot_of(c, b, n) < 0 ? 1 : -1;
      for (std::size_t k = 0; k < n; ++k) dst[k] = sign * a[k];
      return;
    }
    case Op::any:
    case Op::all: {
      const auto is_true = [](double x) { return x != 0; };
      *dst = static_cast<double>(one.op == Op::any ? std::any_of(a, a + n, is_true) : std::all_of(a, a + n, is_true));
      return;
    }
    case Op::transpose: {
      const std::size_t rows = one.c & kSizeMask;
      const std::size_t columns = n / rows;
      for (std::size_t j = 0; j < columns; ++j) {
        for (std::size_t i = 0; i < rows; ++i) dst[i * columns + j] = a[j * rows + i];
      }
      return;
    }
    case Op::outer: {
      const std::size_t rows = one.c & kSizeMask;
      for (std::size_t k = 0; k < n; ++k) dst[k] = a[k % rows] * b[k / rows];
      return;
    }
    default:
      return;
  }
}

bool is_unary(Op op) {
  return (op >= Op::to_integer && op <= Op::wrap_natural) || op == Op::negate || op == Op::opposite ||
         (op >= Op::radians && op <= Op::is_infinite);
}
bool is_binary(Op op) {
  return (op >= Op::add && op <= Op::modulo_integer) || (op >= Op::less && op <= Op::unequal) ||
         (op >= Op::arc_tangent_2 && op <= Op::step);
}
bool is_ternary(Op op) {
  return op >= Op::clamp && op <= Op::multiply_add;
}

/// A run, instruction by instruction.
class Run {
 public:
  Run(const ShaderProgram& program, std::span<double> slots, ShaderEnd sought)
      : code_(program.code), slots_(slots.data()), sought_(sought) {
    returns_.reserve(program.deepest + 1);
  }

  ShaderOutcome from(std::size_t at) {
    for (std::size_t steps = 1;; ++steps) {
      const ShaderInstruction& one = code_[at++];
      if (one.n > 8) steps += one.n / 8;
      if (steps > kMostShaderSteps) return {ShaderEnd::too_long, one.at, steps};
      switch (one.op) {
        case Op::halt:
          return {ShaderEnd::normal, one.at, steps};
        case Op::jump:
          at = one.dst;
          break;
        case Op::jump_if_false:
          if (slots_[one.a] == 0) at = one.dst;
          break;
        case Op::call:
          returns_.push_back(at);
          at = one.dst;
          break;
        case Op::give_back:
          at = returns_.back();
          returns_.pop_back();
          break;
        default: {
          const ShaderEnd end = step(one);
          if (end != ShaderEnd::normal) return {end, one.at, steps};
        }
      }
    }
  }

 private:
  ShaderEnd step(const ShaderInstruction& one) {
    double* const dst = slots_ + one.dst;
    const double* const a = slots_ + one.a;
    const double* const b = slots_ + one.b;
    switch (one.op) {
      case Op::copy:
        std::memmove(dst, a, one.n * sizeof(double));
        return ShaderEnd::normal;
      case Op::undefine:
        std::fill_n(dst, one.n, kNotANumber);
        return ShaderEnd::normal;
      case Op::pick:
        for (std::uint32_t k = 0; k < one.n; ++k) dst[k] = a[(one.c >> (2 * k)) & 3U];
        return ShaderEnd::normal;
      case Op::index: {
        if (!(*a >= 0 && *a < static_cast<double>(one.b))) return ShaderEnd::outside;
        *dst = std::floor(*a) * static_cast<double>(one.c);
        return ShaderEnd::normal;
      }
      case Op::load:
        std::memmove(dst, a + static_cast<std::size_t>(*b), one.n * sizeof(double));
        return ShaderEnd::normal;
      case Op::store:
        std::memmove(dst + static_cast<std::size_t>(*b), a, one.n * sizeof(double));
        return ShaderEnd::normal;
      default:
        break;
    }
    compute(one, dst, a, b, slots_ + one.c);
    if (one.op == Op::divide_integer || one.op == Op::modulo_integer) {
      for (std::uint32_t k = 0; k < one.n; ++k) {
        if (b[k * one.stride[1]] == 0) return ShaderEnd::division;
      }
    }
    return sought_ == ShaderEnd::normal ? ShaderEnd::normal : found_in(dst, width(one));
  }

  static void compute(const ShaderInstruction& one, double* dst, const double* a, const double* b, const double* c) {
    const auto [sa, sb, sc] = one.stride;
    if (one.op == Op::add) {
      for (std::uint32_t k = 0; k < one.n; ++k) dst[k] = a[k * sa] + b[k * sb];
    } else if (one.op == Op::multiply) {
      for (std::uint32_t k = 0; k < one.n; ++k) dst[k] = a[k * sa] * b[k * sb];
    } else if (is_binary(one.op)) {
      for (std::uint32_t k = 0; k < one.n; ++k) dst[k] = apply(one.op, a[k * sa], b[k * sb]);
    } else if (is_unary(one.op)) {
      for (std::uint32_t k = 0; k < one.n; ++k) dst[k] = apply(one.op, a[k * sa]);
    } else if (is_ternary(one.op)) {
      for (std::uint32_t k = 0; k < one.n; ++k) dst[k] = apply(one.op, a[k * sa], b[k * sb], c[k * sc]);
    } else {
      apply_to_vectors(one, dst, a, b, c);
    }
  }

  /// Numbers that an instruction makes.
  static std::size_t width(const ShaderInstruction& one) {
    switch (one.op) {
      case Op::same:
      case Op::differs:
      case Op::dot:
      case Op::length:
      case Op::distance:
      case Op::any:
      case Op::all:
        return 1;
      case Op::matrix:
        return (one.c & kSizeMask) * ((one.c >> (2 * kSizeBits)) & kSizeMask);
      default:
        return one.n;
    }
  }

  [[nodiscard]] ShaderEnd found_in(const double* dst, std::size_t n) const {
    const bool is_found = std::any_of(
        dst, dst + n, [&](double x) { return sought_ == ShaderEnd::not_a_number ? std::isnan(x) : !std::isfinite(x); });
    return is_found ? sought_ : ShaderEnd::normal;
  }

  const std::vector<ShaderInstruction>& code_;
  double* slots_;
  ShaderEnd sought_;
  std::vector<std::size_t> returns_;
};

}  // namespace

ShaderOutcome run_shader(const ShaderProgram& program, std::span<double> slots, std::uint32_t from, ShaderEnd sought) {
  return Run(program, slots, sought).from(from);
}

std::string_view shader_end_text(ShaderEnd end) {
  switch (end) {
    case ShaderEnd::too_long:
      return "a value takes more than 100000 steps";
    case ShaderEnd::outside:
      return "an index is outside its array";
    case ShaderEnd::division:
      return "an integer is divided by 0";
    case ShaderEnd::not_a_number:
      return "a result is not a number";
    case ShaderEnd::not_finite:
      return "a result is infinite";
    case ShaderEnd::normal:
      break;
  }
  return "it ends";
}

double shader_value(ShaderOp op, double a, double b) {
  return is_unary(op) ? apply(op, a) : apply(op, a, b);
}

}  // namespace lobe
