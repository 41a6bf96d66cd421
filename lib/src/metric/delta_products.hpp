#pragma once

#include <span>
#include <vector>

#include "lobe/core/estimate.hpp"
#include "lobe/metric/metric.hpp"
#include "lobe/table/reflectance.hpp"

namespace lobe {

/// A reflectance without its delta parts; a table keeps its grid.
[[nodiscard]] Reflectance without_deltas(const Reflectance& reflectance);

/// Whether two reflectances have a delta part of the same kind, so that their point product is infinite.
[[nodiscard]] bool share_delta(const Device& device, const Reflectance& f, const Reflectance& g);

/// What the delta parts of one formula see of the values of another reflectance: the integral of mirror(L) g(L, L') +
/// retro(L) g(L, L) over dmu(L), which is their point product, by channel.
/// \param delta prepared, as `other`, which is no table
/// \throws NumericError where it is infinite: where decades of the cosine towards the horizon add as much as ever
[[nodiscard]] std::vector<Estimate> delta_products(const Device& device, const Reflectance& delta,
                                                   const Reflectance& other, std::size_t channels,
                                                   const MetricOptions& options);

}  // namespace lobe
