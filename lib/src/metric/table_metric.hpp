#pragma once

#include <numbers>
#include <span>
#include <vector>

#include "lobe/core/estimate.hpp"
#include "lobe/core/progress.hpp"
#include "lobe/metric/lighting.hpp"
#include "lobe/metric/metric.hpp"
#include "lobe/table/table.hpp"

namespace lobe {

/// f . g of tables on one grid, summed over channels with equal weights that sum to 1: point the integral of
/// f(L,V) g(L,V) dmu dmu, tr(T_f T_g*), daylight that of a_f(V) a_g(V) dmu, albedos over L (Neumann 2001, eq. 5.23 with
/// W = identity and W = 1; for reciprocal reflectances, of which the text speaks, T_g* = T_g). Delta parts are exact.
/// The error has those of the values and that of the grid's quadrature, judged by an embedded rule of every second ring
/// and azimuth; of tables that are constant on cells sums are exact (lobe/table/cell_error.hpp). NaN where errors of
/// values are unknown. For other lightings see metric/table_lighting.hpp.
/// \throws ArgumentError for other lightings, different grids or channels that do not fit; NumericError for the point
///   product of two tables which both have mirror parts, or both RRIM parts: it is infinite.
[[nodiscard]] Estimate scalar_product(const BrdfTable& f, const BrdfTable& g, const Lighting& lighting);

/// |f - g|, integrated as such: no cancellation.
/// \throws as scalar_product().
[[nodiscard]] Estimate distance(const BrdfTable& f, const BrdfTable& g, const Lighting& lighting);

}  // namespace lobe
