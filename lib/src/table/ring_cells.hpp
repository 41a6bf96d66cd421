#pragma once

#include <cstddef>

#include "lobe/core/estimate.hpp"
#include "lobe/table/brdf_function.hpp"

namespace lobe {

// Integrals of reflectances that are constant on rings and cells, as sums; their errors are those of rounding.

/// Albedo (1.22) for L at theta_in.
[[nodiscard]] Estimate albedo(const RingCells& brdf, std::size_t channel, double theta_in);

/// (1.24)
[[nodiscard]] Estimate mean_albedo(const RingCells& brdf, std::size_t channel);

/// Integral of f g, or of (f - g)^2, dmu(V) dmu(L) (5.11), each of its own channel; on the common refinement of both.
/// \param g whose numbers of rings and cells are those of f times or over a power of 2
[[nodiscard]] Estimate product(const RingCells& f, std::size_t f_channel, const RingCells& g, std::size_t g_channel);
[[nodiscard]] Estimate squared_distance(const RingCells& f, std::size_t f_channel, const RingCells& g,
                                        std::size_t g_channel);

}  // namespace lobe
