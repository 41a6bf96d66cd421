#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <span>
#include <vector>

#include "hemisphere/mirror_panels.hpp"
#include "lobe/core/directions.hpp"
#include "lobe/core/progress.hpp"
#include "lobe/hemisphere/grid.hpp"
#include "lobe/table/table.hpp"

namespace lobe {

/// A factor of a composition that has values anywhere: a formula, or a function. Isotropic.
struct InnerFactor {
  LobeExtent extent;           ///< extent of its lobes
  std::size_t channels = 1;    ///< number of its channels; a single one serves all of the other factor
  bool is_even = true;         ///< in delta_phi
  bool has_ring_kinks = true;  ///< where N.X passes N.L or N.V
  /// Values [channel][ring][X] between directions of some of the grid's rings at azimuth 0, of L for the first factor
  /// and of V for the second, and directions X.
  std::function<void(std::span<const std::size_t> rings, std::span<const Direction> inner, std::span<double> values)>
      values;
};

/// How a resolved product is computed.
struct ResolvedOptions {
  bool is_square = false;          ///< both factors are the same and reciprocal: the product is symmetric
  double tolerance = 1e-5;         ///< relative tolerance of the root mean square error
  std::size_t levels = 4;          ///< refinement levels at most
  double most_values = 1e300;      ///< of both factors that a level may take, beyond the first two
  ProgressCallback progress = {};  ///< told of the progress; may cancel
};

/// Values of a composition at the nodes of a product grid, and bounds on their errors.
struct ResolvedProduct {
  TableValues values;  ///< [channel][theta_in][theta_out][k], k = 0 .. n_phi/2: the mean of both signs of delta_phi
  std::vector<double> error;       ///< largest over azimuth, [channel][ring_in][ring_out]
  std::vector<double> mean_error;  ///< the same, root mean square over azimuth
  /// Half the difference of both signs of delta_phi, the largest and the root mean square over azimuth; empty where
  /// both factors are even.
  std::vector<double> largest_odd, odd;
};

/// The integral of f(L,X) g(X,V) dmu(X) for all nodes L, V of a product grid, over directions X of their own that
/// resolve both factors (hemisphere/inner_rule.hpp), refined until the tolerance is met or the work grows too large.
/// If factors are not even, their odd parts are composed, too: the even part of the composition is that of both
/// even parts less that of both odd ones. The error is that of the quadrature alone: the difference of the last two
/// levels, times what that of a further level shows at some of the rings.
/// \throws Cancelled
[[nodiscard]] ResolvedProduct resolved_product(const InnerFactor& f, const InnerFactor& g, const HemisphereGrid& grid,
                                               const ResolvedOptions& options);

/// Bytes that it takes at its peak.
[[nodiscard]] std::uint64_t resolved_product_bytes(const HemisphereGrid& grid, std::size_t channels);

}  // namespace lobe
