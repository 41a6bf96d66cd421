#pragma once

#include <span>
#include <vector>

#include "hemisphere/kink.hpp"
#include "model/formula_tree.hpp"

namespace lobe {

/// Where a formula jumps or has kinks, as far as its text tells.
struct FormulaKinks {
  /// The zeros of what its comparisons, choices and functions with steps or corners depend on, each once: jumps have
  /// the order 0. A function such as floor() that steps often has one kink for all of its steps, or one for each step.
  std::vector<Kink> kinks;
  bool has_many_steps = false;  ///< steps lie closer than limits of panels could
};

/// \param parameters their values
[[nodiscard]] FormulaKinks formula_kinks(const FormulaTree& tree, std::span<const double> parameters);

}  // namespace lobe
