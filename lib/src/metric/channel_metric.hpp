#pragma once

#include <cstddef>
#include <vector>

#include "lobe/metric/metric.hpp"
#include "metric/products.hpp"

namespace lobe {

/// Norms and distances beside the products that they are roots of, and in their errors what underflow loses.
/// \param is_black which reflectances are 0 everywhere; none: those without a norm
[[nodiscard]] Metric make_metric(ChannelProducts products, const std::vector<bool>& is_black = {});

/// The given weights; where there are none, equal ones that sum to 1.
/// \throws ArgumentError for another number of weights than channels, and for weights that are negative or not finite.
[[nodiscard]] std::vector<double> channel_weights(const std::vector<double>& given, std::size_t channels);

/// The pairs whose product is not known to the tolerance, relative to it, worst first.
[[nodiscard]] std::vector<Unresolved> find_unresolved(const Metric& metric, double tolerance);

}  // namespace lobe
