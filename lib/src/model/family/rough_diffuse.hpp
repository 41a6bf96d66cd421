#pragma once

#include <numbers>

namespace lobe {

/// A of Fujii's form of Oren and Nayar's model, whose albedo is 1 at grazing angles.
/// \param r roughness
inline double fujii_constant(double r) {
  return 1 / (1 + (0.5 - 2 / (3 * std::numbers::pi)) * r);
}

/// (1 - E)/(A r) of its mean albedo E.
inline constexpr double kFujiiRest = 6 / (5 * std::numbers::pi) - 1.0 / 6;

}  // namespace lobe
