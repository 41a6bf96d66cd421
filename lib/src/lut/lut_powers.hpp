#pragma once

#include <array>
#include <cstddef>
#include <span>
#include <vector>

namespace lobe {

constexpr unsigned kMostDegree = 20;  // a Chebyshev polynomial of degree 20 in u still has exact coefficients

/// Exponents of the powers that a polynomial of several arguments has, in lexicographic order.
/// \param degrees a single one for the largest sum, or one per argument
[[nodiscard]] std::vector<std::vector<unsigned>> exponents_of(const std::vector<unsigned>& degrees,
                                                              std::size_t arguments);

/// Largest exponent of an argument where those of the arguments before it add up to a sum.
[[nodiscard]] inline unsigned degree_at(const std::vector<unsigned>& degrees, std::size_t arguments,
                                        std::size_t argument, unsigned sum) {
  return degrees.size() == 1 && arguments > 1 ? degrees.front() - sum : degrees[argument];
}

/// Value of a polynomial by nested Horner schemes, in the order of operations of the written functions.
/// \param coefficients as exponents_of() orders them, from the first one of these powers on; moved behind the last one
template <typename Number>
Number horner(const std::vector<unsigned>& degrees, std::span<const Number> arguments, const Number*& coefficients,
              std::size_t argument = 0, unsigned sum = 0) {
  const unsigned degree = degree_at(degrees, arguments.size(), argument, sum);
  std::array<Number, kMostDegree + 1> values;
  for (unsigned k = 0; k <= degree; ++k) {
    values[k] = argument + 1 == arguments.size()
                    ? *coefficients++
                    : horner<Number>(degrees, arguments, coefficients, argument + 1, sum + k);
  }
  Number value = values[degree];
  for (unsigned k = degree; k-- > 0;) value = values[k] + arguments[argument] * value;
  return value;
}

/// How the argument of a function becomes the variable of its powers: (argument - offset) * factor.
struct FitVariable {
  double offset = 0;
  double factor = 1;

  [[nodiscard]] bool is_argument() const { return offset == 0 && factor == 1; }
};

}  // namespace lobe
