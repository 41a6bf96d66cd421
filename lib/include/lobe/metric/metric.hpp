#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <numbers>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "lobe/core/estimate.hpp"
#include "lobe/core/progress.hpp"
#include "lobe/core/work_done.hpp"
#include "lobe/device/device.hpp"
#include "lobe/hemisphere/grid.hpp"
#include "lobe/metric/lighting.hpp"
#include "lobe/model/material.hpp"
#include "lobe/table/reflectance.hpp"

namespace [[gnu::visibility("default")]] lobe {

/// Ways of computing the products of a set of reflectances.
enum class Route {
  automatic,  ///< whichever route choose_route() takes
  formulas,   ///< lobes of the formulas, each integrated once, to the tolerance
  functions,  ///< values at pairs of directions, with a quadrature that needs no grid
  tables      ///< sums over a common grid
};
/// Name of a route: "automatic", "formulas", "functions" or "tables".
[[nodiscard]] std::string_view to_string(Route route);

/// Options for scalar products.
struct MetricOptions {
  /// Relative tolerance: every scalar product of formulas is refined until its error estimate is below tolerance times
  /// the product.
  double tolerance = 1e-6;
  /// Relative tolerance for patch lights, whose cost grows with the third power of what the lobes demand; at least
  /// `tolerance`.
  double patch_tolerance = 1e-5;
  Precision precision = Precision::double_precision;  ///< arithmetic of the models
  /// Weight of each channel in the combined product; empty: equal weights that sum to 1.
  std::vector<double> channel_weights = {};
  /// Domain of the products: they are integrals over directions of light and view up to this angle from the normal,
  /// radians, in (0, pi/2]. Short of the horizon every norm exists. Only under point, daylight and mean-albedo light.
  double theta_max = std::numbers::pi / 2;
  ProgressCallback progress = {};  ///< told of the progress; may cancel

  Route route = Route::automatic;  ///< how products are computed; a route that the set does not have is refused
  /// Grid for tables, instead of the choice of choose_route(); it is not refined.
  std::optional<HemisphereGrid> grid = std::nullopt;
  /// Tolerance for the route `functions`: measured functions have kinks and jumps, and errors may stay above it.
  double function_tolerance = 5e-3;
  bool allow_unresolved = false;  ///< as in TabulateOptions, for whatever the route `tables` tabulates
  std::size_t cell_points = 4;    ///< as in TabulateOptions
  /// Whether delta parts are accepted under point light: norms and distances that are infinite are then infinity, and
  /// products are finite where no delta part meets one of its kind.
  bool allow_infinite = false;
};

/// Scalar products, norms and distances of n materials, every entry with its error estimate.
/// point: gram in sr^0, daylight: gram in sr. Norm and distance are square roots of these, NaN if squares are
/// negative beyond their errors (tables under an indefinite W).
struct Metric {
  Eigen::MatrixXd gram;            ///< n x n, f_i . f_j
  Eigen::MatrixXd gram_error;      ///< n x n
  Eigen::VectorXd norm;            ///< n
  Eigen::VectorXd norm_error;      ///< n
  Eigen::MatrixXd distance;        ///< n x n, |f_i - f_j|
  Eigen::MatrixXd distance_error;  ///< n x n
};

/// A pair of materials whose product did not reach the tolerance.
struct Unresolved {
  std::size_t first = 0;      ///< index of one material
  std::size_t second = 0;     ///< index of the other material
  double relative_error = 0;  ///< relative error that was reached
};

/// Scalar products, norms and distances of a set under one lighting.
struct MetricResult {
  Lighting lighting = Lighting::point();  ///< lighting of the products
  Metric combined;                        ///< weighted sum of the channels' products
  std::vector<Metric> channels;           ///< one per channel; empty for a single channel
  /// Relative tolerance to which the route refines products. Tables are summed on their grid, whatever it is.
  double tolerance = MetricOptions{}.tolerance;
  std::vector<Unresolved> unresolved;       ///< pairs that did not reach the tolerance
  WorkDone work;                            ///< work done
  double theta_max = std::numbers::pi / 2;  ///< the domain, as in MetricOptions

  Route route = Route::formulas;                      ///< how products were computed
  std::optional<HemisphereGrid> grid = std::nullopt;  ///< grid of the route `tables`
  std::vector<std::size_t> coarse = {};               ///< indices of the reflectances that this grid does not resolve
};

/// A route, with a grid for `tables`.
struct RouteChoice {
  Route route = Route::formulas;                      ///< never `automatic`
  std::optional<HemisphereGrid> grid = std::nullopt;  ///< grid for `tables`
  bool is_first_grid = false;                         ///< measure() goes on to finer grids, as the tolerance asks
};

/// Whether W is an operator: no products up to a largest angle, and fits of measured targets go by tables.
[[nodiscard]] bool takes_tables(const Lighting& lighting);

/// Chooses the route on which measure() computes the products of a set under a lighting. With `options.grid` it is
/// tables on that grid. Formulas alone take formulas, or under a tabulated lighting tables on its grid. Functions, and
/// formulas beside them or anisotropic under patch lights, take functions if there are no tables or delta parts.
/// Everything else takes tables, on the grid of the first table or on the natural_grid() of the first function, which
/// measure() refines until it resolves the whole set (resolving_grid()).
/// \throws ArgumentError for an `options.route` that the set does not have
[[nodiscard]] RouteChoice choose_route(const ReflectanceList& reflectances, const Lighting& lighting,
                                       const MetricOptions& options = {});

/// Whether measure() has products of these materials under a lighting. Under mean-albedo all materials have them. Under
/// other lightings, lobes that grow as 1/(N.L) at grazing angles have infinite norms; under point light so have delta
/// parts.
/// \throws ArgumentError for materials that are refused under any lighting
[[nodiscard]] bool are_measurable(std::span<const Material> materials, const Lighting& lighting);

/// Measures the Gram and distance matrices of reflectances under a lighting, by the route of choose_route(), which the
/// result names. A single channel serves all channels of the others; adjustments are applied (adjusted()) as needed.
///
/// Formulas share lobes: a lobe that occurs in several materials or channels is integrated once. Distances of
/// near-identical materials are integrated as such, not taken from the cancelling difference of products.
///
/// Functions are integrated by quadrature that is dense about the mirror direction and at grazing angles, whatever grid
/// their source has. As measurements are neither smooth nor reciprocal, both signs of delta_phi are taken, and under
/// point light both orders of the directions; anisotropic functions are evaluated at 16 azimuths, which differ from
/// node to node. Slabs are refined until the error of every f.f is below function_tolerance times f.f, or until the
/// finest level. The error of a slab is three times the difference between its last two levels, or the difference
/// between the levels before if that is larger. To the sum over slabs comes the effect of the functions' own errors on
/// norms (Cauchy-Schwarz). Nothing is listed as `unresolved`; the errors tell what was reached.
///
/// Tables are summed over the grid. Functions and formulas are tabulated on it, and tabulate() brings tables from other
/// grids to it. Nothing is refined, so nothing is `unresolved`; the errors tell what is known.
///
/// \throws ArgumentError for no reflectances, channel counts that do not fit, tolerances out of range, a domain that is
///   out of range or not supported by the lighting or the grid, and as choose_route(); NumericError if a product is not
///   finite or does not exist, and if the grid does not resolve a reflectance to be tabulated, unless
///   options.allow_unresolved; DeviceError; Cancelled
[[nodiscard]] MetricResult measure(const Device& device, const ReflectanceList& reflectances, const Lighting& lighting,
                                   const MetricOptions& options = {});
/// Measures under several lightings, one result for each, in their order; reflectances are tabulated only once.
/// \throws as measure() for one lighting
[[nodiscard]] std::vector<MetricResult> measure(const Device& device, const ReflectanceList& reflectances,
                                                std::span<const Lighting> lightings, const MetricOptions& options = {});

/// Scalar product f . g over all channels.
/// \throws as measure().
[[nodiscard]] Estimate scalar_product(const Device& device, const Reflectance& f, const Reflectance& g,
                                      const Lighting& lighting, const MetricOptions& options = {});

/// Whether the delta parts of two reflectances are the same in every channel, so that the distance of the reflectances
/// under point light is that of what they are without, although their norms are infinite. False where neither has any.
[[nodiscard]] bool have_equal_deltas(const Device& device, const Reflectance& f, const Reflectance& g);

/// Distance |f - g| over all channels, also of reflectances whose delta parts are equal.
/// \throws as measure().
[[nodiscard]] Estimate distance(const Device& device, const Reflectance& f, const Reflectance& g,
                                const Lighting& lighting, const MetricOptions& options = {});

/// Distance by which a repair moved a reflectance.
struct Displacement {
  Lighting lighting =
      Lighting::point();  ///< point; daylight where there are delta parts, whose point norms are infinite
  Estimate absolute;      ///< |g - f|
  Estimate relative;      ///< |g - f| / |f|; NaN where f is 0 and g is not
};
/// Measures how far one reflectance is from another.
/// \throws as measure().
[[nodiscard]] Displacement displacement(const Device& device, const Reflectance& before, const Reflectance& after,
                                        const MetricOptions& options = {});

/// Angle between two materials as vectors, arccos(f_i . f_j / (|f_i| |f_j|)), radians; NaN with a norm that is not
/// above its error. It is computed from the product, or from the chord between the normalised materials, which does not
/// cancel near 0, whichever the errors of norms, product and distance leave better known.
[[nodiscard]] Estimate angle(const Metric& metric, std::size_t i, std::size_t j);

}  // namespace lobe
