#pragma once

/// How far an evaluated reflectance may be from the reference: factor * eps * condition(L, V), relative to the value.
///
/// The condition is the factor by which an ulp in the geometry reaches the result; it is written beside the cases of
/// each model (tests/kernel/<model>_test.cpp) and in the model's file (kernels/models/<model>.clh). A factor is four
/// times what was measured, as the nearest power of two. The measured values are the worst error / (eps * condition)
/// over all cases of a model, structured and random directions; the tests print and record them again on every run.

#include <limits>
#include <stdexcept>
#include <string_view>

namespace lobe::test {

struct ErrorBudget {
  std::string_view model;
  double double_factor;
  double double_measured;
  double single_factor;
  double single_measured;
};

inline constexpr double kDoubleEps = std::numeric_limits<double>::epsilon();
inline constexpr double kSingleEps = static_cast<double>(std::numeric_limits<float>::epsilon());

/// Below these values the comparison is absolute: the next decades hold denormal numbers and flushed zeros.
inline constexpr double kDoubleFloor = 1e-290;
inline constexpr double kSingleFloor = 1e-30;

inline constexpr ErrorBudget kErrorBudgets[] = {
    // model, double: factor, measured; single: factor, measured
    {"basic_patch", 1, 0.3, 1, 0.4},
    {"blinn", 16, 3.5, 4, 1.1},
    {"blinn_phong", 16, 4.2, 4, 0.9},
    {"cook_torrance", 16, 4.2, 8, 2},
    {"exponential_patch", 8, 1.8, 4, 1.4},
    {"lafortune", 8, 2.1, 4, 1.3},
    {"lafortune_ngan", 8, 2.1, 4, 1.2},
    {"lambert", 1, 0.3, 1, 0.4},
    {"metal_phong", 8, 1.8, 1, 0.3},
    {"minnaert", 4, 1, 4, 1},
    {"oren_nayar", 4, 1.4, 4, 0.9},
    {"phong", 8, 1.8, 1, 0.3},
    {"ward", 16, 4, 8, 1.5},
};

inline const ErrorBudget& error_budget(std::string_view model) {
  for (const auto& budget : kErrorBudgets) {
    if (budget.model == model) return budget;
  }
  throw std::out_of_range("model without an error budget");
}

}  // namespace lobe::test
