#pragma once

/// How far an evaluated reflectance may be from the reference: factor * eps * condition(L, V), relative to the value.
///
/// The condition is the factor by which an ulp in the geometry reaches the result; it is written beside the cases of
/// each model (tests/models/<model>.cpp) and in the model's file (kernels/models/<model>.clh). A factor is four
/// times what was measured, as the nearest power of two. The measured values are the worst error / (eps * condition)
/// over all cases of a model, structured and random directions; the tests print and record them again on every run.

#include <limits>

namespace lobe::test {

struct ErrorBudget {
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

}  // namespace lobe::test
