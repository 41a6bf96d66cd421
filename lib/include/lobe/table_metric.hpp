#pragma once

#include <numbers>
#include <span>
#include <vector>

#include "lobe/estimate.hpp"
#include "lobe/lighting.hpp"
#include "lobe/metric.hpp"
#include "lobe/progress.hpp"
#include "lobe/table.hpp"

namespace lobe {

/// f . g of tables on one grid, summed over channels with equal weights that sum to 1: point the integral of
/// f(L,V) g(L,V) dmu dmu, tr(T_f T_g*), daylight that of a_f(V) a_g(V) dmu, albedos over L (Neumann 2001, eq. 5.23 with
/// W = identity and W = 1; for reciprocal reflectances, of which the text speaks, T_g* = T_g). Delta parts are exact.
/// The error has those of the values and that of the grid's quadrature, judged by an embedded rule of every second ring
/// and azimuth; of tables that are constant on cells sums are exact (lobe/cell_error.hpp). NaN where errors of values
/// are unknown. For other lightings see lobe/table_lighting.hpp.
/// \throws ArgumentError for other lightings, different grids or channels that do not fit; NumericError for the point
///   product of two tables which both have mirror parts, or both RRIM parts: it is infinite.
[[nodiscard]] Estimate scalar_product(const BrdfTable& f, const BrdfTable& g, const Lighting& lighting);

/// |f - g|, integrated as such: no cancellation. \throws as scalar_product().
[[nodiscard]] Estimate distance(const BrdfTable& f, const BrdfTable& g, const Lighting& lighting);

/// How far a repair moved a table.
struct Displacement {
  Lighting lighting;  ///< point; daylight where there are delta parts, whose point norms are infinite
  Estimate absolute;  ///< |g - f|
  Estimate relative;  ///< |g - f| / |f|; NaN where f is 0 and g is not
};
/// How far one table is from another.
/// \throws as scalar_product().
[[nodiscard]] Displacement displacement(const BrdfTable& before, const BrdfTable& after);

/// How products of tables are combined.
struct TableMetricOptions {
  /// Weight of each channel in the combined product; empty: equal weights that sum to 1.
  std::vector<double> channel_weights = {};
  /// The domain, as in MetricOptions. On grids without cells sums are over the interpolated values; on grids of cells
  /// it must be the limit of a ring.
  double theta_max = std::numbers::pi / 2;
  ProgressCallback progress = {};  ///< told of the progress; may cancel
};

/// Gram and distance matrix of tables on one grid under a lighting, entries as of the functions above. A single channel
/// serves all channels of the other tables. Nothing is refined, so that none is `unresolved`; the errors say what is
/// known. \throws as lighting_table() and scalar_product(); ArgumentError for no tables, channel weights that do
/// not fit, and a domain that the grid or the lighting does not have; Cancelled.
[[nodiscard]] MetricResult measure(const Device& device, std::span<const BrdfTable> tables, const Lighting& lighting,
                                   const TableMetricOptions& options = {});

}  // namespace lobe
