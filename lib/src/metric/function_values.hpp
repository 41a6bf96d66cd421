#pragma once

#include <Eigen/Core>
#include <array>
#include <cstddef>
#include <span>

#include "lobe/table/brdf_function.hpp"

namespace lobe {

/// Azimuths of L at which anisotropic functions are taken.
inline constexpr std::size_t kFunctionAzimuths = 16;

/// Where these begin at a node, as a share of their step: beginnings differ from node to node and from level to level,
/// so that levels differ by what azimuths miss.
[[nodiscard]] double turn_of(std::size_t number, int level);

/// Gauss nodes per panel and axis at each level of quadratures of functions.
inline constexpr std::array kFunctionLevels{4, 6, 9};

/// Error of what a slab adds to sums, from its sums at successive levels, at least two: three times the last change,
/// and no less than the change before it.
[[nodiscard]] Eigen::MatrixXd error_of_levels(std::span<const Eigen::MatrixXd> levels);

/// Values and errors at all pairs, on all cores where that helps; errors are 0 where the function states none.
/// \throws NumericError for values that are no finite numbers
[[nodiscard]] BrdfValues values_at(const BrdfFunction& function, std::span<const Directions> pairs);

/// How many channels functions that are taken together have.
/// \throws ArgumentError for no functions, delta parts, and for channel counts other than 1 that differ
[[nodiscard]] std::size_t common_channels(std::span<const BrdfFunction> functions);

}  // namespace lobe
