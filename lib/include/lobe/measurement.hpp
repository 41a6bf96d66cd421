#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "lobe/brdf_function.hpp"

namespace lobe {

/// Replicates from which a standard deviation is known to 7 %.
inline constexpr std::size_t kReplicates = 100;

/// The standard deviations of numbers that were computed channel by channel from a measured reflectance, as those of
/// its samples cause them (parametric bootstrap: Efron and Tibshirani 1993, section 6.5): the scatter of a number over
/// the replicates. It says nothing of numerical errors, nor of errors that all samples have in common. \param numbers
/// one for each of the function's channels, in their order, replicates included \return one for each of the
/// reflectance's own channels; empty for functions without replicates \throws ArgumentError for another count of
/// numbers
[[nodiscard]] std::vector<double> measurement_deviations(const BrdfFunction& brdf, std::span<const double> numbers);

/// The number of a function's own channels, without replicates.
[[nodiscard]] std::size_t own_channels(const BrdfFunction& brdf);

}  // namespace lobe
