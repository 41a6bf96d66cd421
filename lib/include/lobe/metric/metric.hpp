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
#include "lobe/core/work.hpp"
#include "lobe/device/device.hpp"
#include "lobe/hemisphere/grid.hpp"
#include "lobe/metric/lighting.hpp"
#include "lobe/model/material.hpp"
#include "lobe/table/reflectance.hpp"

namespace lobe {

/// How the products of a set of reflectances are computed.
enum class Route {
  automatic,  ///< by whichever of the others choose_route() takes
  formulas,   ///< by the lobes of the formulas, each integrated once, to the tolerance
  functions,  ///< by values at pairs of directions, with a quadrature that needs no grid
  tables      ///< as sums over a common grid
};
/// "automatic", "formulas", "functions", "tables".
[[nodiscard]] std::string_view to_string(Route route);

/// How scalar products are computed.
struct MetricOptions {
  /// Every scalar product of formulas is refined until its error estimate is below tolerance times the product.
  double tolerance = 1e-6;
  /// The same for patch lights, whose cost grows with the third power of what the lobes ask for; at least `tolerance`.
  double patch_tolerance = 1e-5;
  Precision precision = Precision::double_precision;  ///< of the models
  /// Weight of each channel in the combined product; empty: equal weights that sum to 1.
  std::vector<double> channel_weights = {};
  /// The domain: products are integrals over directions up to this angle from the normal, of light and of view,
  /// radians, in (0, pi/2]. Short of the horizon every norm exists. Under point, daylight and mean-albedo light only.
  double theta_max = std::numbers::pi / 2;
  ProgressCallback progress = {};  ///< told of the progress; may cancel

  Route route = Route::automatic;  ///< how products are computed; one that the set does not have is refused
  /// Tables on this grid instead of what choose_route() takes by itself.
  std::optional<HemisphereGrid> grid = std::nullopt;
  /// The `tolerance` of the route `functions`: measured functions have kinks and jumps, and errors may stay above it.
  double function_tolerance = 5e-3;
  bool allow_unresolved = false;  ///< as in TabulateOptions, of what the route `tables` tabulates
  std::size_t samples = 4;        ///< as in TabulateOptions
};

/// Scalar products of n materials and what follows from them, every entry with its error estimate.
/// point: gram in sr^0, daylight: gram in sr; norm and distance are square roots of these, NaN where squares are
/// negative beyond their errors (tables under an indefinite W).
struct Metric {
  Eigen::MatrixXd gram;            ///< n x n, f_i . f_j
  Eigen::MatrixXd gram_error;      ///< n x n
  Eigen::VectorXd norm;            ///< n
  Eigen::VectorXd norm_error;      ///< n
  Eigen::MatrixXd distance;        ///< n x n, |f_i - f_j|
  Eigen::MatrixXd distance_error;  ///< n x n
};

/// A pair of materials whose product did not reach the tolerance, and what it reached (relative).
struct Unresolved {
  std::size_t first = 0;      ///< its number
  std::size_t second = 0;     ///< that of the other one
  double relative_error = 0;  ///< what was reached
};

/// Scalar products, norms and distances of a set under one lighting.
struct MetricResult {
  Lighting lighting = Lighting::point();    ///< what products were taken under
  Metric combined;                          ///< weighted sum of the channels' products
  std::vector<Metric> channels;             ///< per channel; empty for a single channel
  std::vector<Unresolved> unresolved;       ///< pairs that did not reach the tolerance
  Work work;                                ///< what it took
  double theta_max = std::numbers::pi / 2;  ///< the domain, as in MetricOptions

  Route route = Route::formulas;                      ///< how products were computed
  std::optional<HemisphereGrid> grid = std::nullopt;  ///< of the route `tables`
  std::vector<std::size_t> coarse = {};               ///< numbers of those that this grid does not resolve
};

/// A route, and the grid of the route `tables`.
struct RouteChoice {
  Route route = Route::formulas;                      ///< never `automatic`
  std::optional<HemisphereGrid> grid = std::nullopt;  ///< of `tables`
};

/// Whether a lighting needs tables of what has no formulas, as that of patches and tabulated ones do.
[[nodiscard]] bool takes_tables(const Lighting& lighting);

/// How measure() computes the products of a set under a lighting. With `options.grid` by tables on that grid. Formulas
/// alone by formulas, under a tabulated lighting by tables on its grid. With functions among them and neither tables
/// nor delta parts by functions, under a lighting that these have. Everything else by tables: on the grid of the first
/// table, or that on which the first function is tabulated (natural_grid()). Values are not looked at.
/// \throws ArgumentError for an `options.route` that the set does not have
[[nodiscard]] RouteChoice choose_route(const ReflectanceList& reflectances, const Lighting& lighting,
                                       const MetricOptions& options = {});

/// Whether measure() has products of these materials under a lighting. Under mean-albedo it has them of all; elsewhere
/// lobes that grow as 1/(N.L) at grazing angles have infinite norms, under point light also delta parts, and there
/// anisotropic patches about the mirror direction have no products with those about the retro direction.
/// \throws ArgumentError for materials that are refused under any lighting.
[[nodiscard]] bool are_measurable(std::span<const Material> materials, const Lighting& lighting);

/// Gram and distance matrix of reflectances under a lighting, by the route of choose_route(), which the result names.
/// A single channel serves all channels of the others; what needs preparation (prepare()) is prepared.
///
/// Formulas share lobes: a lobe that occurs in several of them or in several channels is integrated once. Distances of
/// near-identical ones are integrated as such, not taken from the cancelling difference of products.
///
/// Functions are integrated by quadrature that is dense about the mirror direction and at grazing angles, whatever grid
/// their source has. As measurements are neither smooth nor reciprocal, both orders of the directions and both signs of
/// delta_phi are taken; anisotropic functions are taken at 16 azimuths, which differ from node to node. Slabs are
/// refined until the error of every f.f is below function_tolerance times f.f, or until the finest level. Errors are
/// three times the differences of the last two levels and as much as a third of those before, summed by slabs, and what
/// the functions' own errors may do to norms (Cauchy-Schwarz); none is `unresolved`, the errors say what was reached.
///
/// Tables are summed over the grid, functions and formulas tabulated on it, tables of other grids brought to it by
/// resample(); entries are as those of lobe/metric/table_metric.hpp. Nothing is refined, so that none is `unresolved`;
/// the errors say what is known.
///
/// \throws ArgumentError for no reflectances, channel counts that do not fit, tolerances out of range, a domain that
///   is out of range or that the lighting or the grid does not have, and as choose_route(); NumericError where a
///   product is no finite number or does not exist, and where the grid does not resolve what is tabulated, unless
///   options.allow_unresolved; DeviceError; Cancelled.
[[nodiscard]] MetricResult measure(const Device& device, const ReflectanceList& reflectances, const Lighting& lighting,
                                   const MetricOptions& options = {});
/// One result per lighting, in their order; what is tabulated is tabulated once.
/// \throws as above.
[[nodiscard]] std::vector<MetricResult> measure(const Device& device, const ReflectanceList& reflectances,
                                                std::span<const Lighting> lightings, const MetricOptions& options = {});

/// f . g over all channels.
/// \throws as measure().
[[nodiscard]] Estimate scalar_product(const Device& device, const Reflectance& f, const Reflectance& g,
                                      const Lighting& lighting, const MetricOptions& options = {});

/// |f - g| over all channels.
/// \throws as measure().
[[nodiscard]] Estimate distance(const Device& device, const Reflectance& f, const Reflectance& g,
                                const Lighting& lighting, const MetricOptions& options = {});

/// How far a repair moved a reflectance.
struct Displacement {
  Lighting lighting =
      Lighting::point();  ///< point; daylight where there are delta parts, whose point norms are infinite
  Estimate absolute;      ///< |g - f|
  Estimate relative;      ///< |g - f| / |f|; NaN where f is 0 and g is not
};
/// How far one reflectance is from another.
/// \throws as measure().
[[nodiscard]] Displacement displacement(const Device& device, const Reflectance& before, const Reflectance& after,
                                        const MetricOptions& options = {});

/// Angle between two of the materials as vectors, arccos(f_i . f_j / (|f_i| |f_j|)), radians; NaN with a norm that is
/// not above its error. By the product, or by the chord between the normalised materials, which does not cancel near 0:
/// whichever the errors of norms, product and distance leave better known.
[[nodiscard]] Estimate angle(const Metric& metric, std::size_t i, std::size_t j);

}  // namespace lobe
