#pragma once

#include <Eigen/Core>
#include <numbers>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "lobe/core/progress.hpp"
#include "lobe/core/work_done.hpp"
#include "lobe/device/device.hpp"
#include "lobe/hemisphere/grid.hpp"
#include "lobe/metric/metric.hpp"
#include "lobe/table/reflectance.hpp"

namespace [[gnu::visibility("default")]] lobe {

/// Distances between reflectances f, g as other publications define them, to be compared with those of a Lighting. f
/// and g are in sr^-1; ci, co are the cosines and si, so the sines of theta_in and theta_out.
///
/// A publication sums over its own grid of samples. Here the sum is an integral over the coordinates that the grid
/// divides into equal steps, so that no value depends on a resolution. A plain sum becomes the integral itself, S =
/// integral of dtheta_in dtheta_out ddelta_phi; a mean over N samples becomes the integral divided by that of 1. The
/// root of squared sums is taken, so that all have the dimension of a distance.
///
/// The grids in theta_in, theta_out, delta_phi extend up to LiteratureOptions::theta_max for both directions.
enum class LiteratureMetric {
  ngan_l2,       ///< sqrt(S ((f - g) ci)^2 si so). Ngan, Durand, Matusik 2005
  low_l2,        ///< sqrt(S ((f - g) ci)^2 si); phi_out is not sampled, so no so. Low, Kronander, Ynnerman, Unger 2012
  bieron_l2,     ///< sqrt(S ((f - g) ci)^2 co si so). Bieron, Peers 2020
  low_log,       ///< sqrt(S (ln(1 + f ci) - ln(1 + g ci))^2 si). Low et al. 2012
  bieron_log,    ///< sqrt(S (ln(1 + f ci) - ln(1 + g ci))^2 co si so). Bieron, Peers 2020
  standard_log,  ///< sqrt(S (ln(1 + f ci) - ln(1 + g ci))^2 si so)
  cube_root,     ///< sqrt(mean |(f - g) ci|^(2/3)). Fores, Ferwerda, Gu 2012. No metric: triangles may fail
  /// sqrt(mean (ln(f w + e) - ln(g w + e))^2), w = max(ci co, e), e = 1e-3. Nielsen, Jensen, Ramamoorthi 2015. They map
  /// f to ln((f w + e) / (r w + e)) with r the median of the set; r cancels in the difference of two, so none is needed
  /// and distances do not depend on the set. The mean is over the cells of the MERL data: equal steps of sqrt(theta_h),
  /// theta_d and phi_d, as far as both directions are above the horizon.
  log_relative,
  /// Integral of |f - g| dmu dmu over both hemispheres, dmu = cos(theta) domega; sr. libbsdf.
  albedo_of_difference,
  cube_root_l2,  ///< sqrt(mean (f^(1/3) - g^(1/3))^2). Lavoue, Bonneel, Farrugia, Soler 2021
  /// mean |ln(f^(1/3) w + e) - ln(g^(1/3) w + e)|, w = max(ci co, e), e = 1e-3. Lavoue et al. 2021
  cube_root_log
};

/// Lists all metrics from the literature, in the order of the enumeration.
[[nodiscard]] std::span<const LiteratureMetric> literature_metrics();
/// Name of a metric from the literature: "ngan-l2", "low-l2", "bieron-l2", "low-log", "bieron-log", "standard-log",
/// "cube-root", "log-relative", "albedo-of-difference", "cube-root-l2", "cube-root-log".
[[nodiscard]] std::string_view to_string(LiteratureMetric metric);
/// Reads the name of a metric from the literature.
/// \throws ArgumentError for an unknown name, with the nearest known one
[[nodiscard]] LiteratureMetric parse_literature_metric(std::string_view name);
/// Unit of a distance, "" for none.
[[nodiscard]] std::string_view unit_of(LiteratureMetric metric);

/// Options for distances from the literature.
struct LiteratureOptions {
  /// Relative tolerance: distances are refined until their error estimates are below tolerance times the distance,
  /// except for a share `outliers` of the pairs, since a few hard pairs among many would cost more than all others.
  /// These are listed as unresolved, with the error they reached.
  double tolerance = 1e-3;
  double outliers = 0.01;                             ///< share of the pairs that may miss the tolerance
  Precision precision = Precision::double_precision;  ///< arithmetic of the models
  /// Weight of each channel in the combined distance; empty: equal weights that sum to 1.
  std::vector<double> channel_weights = {};
  /// Largest theta_in and theta_out, radians, in (0, 89 deg], for the grids in these angles; log_relative and
  /// albedo_of_difference always take whole hemispheres. Ngan et al. leave out samples beyond 80 degrees. Towards the
  /// horizon ngan_l2 and low_l2 have no finite limit for reflectances that grow as (co)^-1/2, such as Ward's.
  double theta_max = 80 * std::numbers::pi / 180;
  double lobe_width = 0.005;       ///< for functions: half-vector width of the narrowest lobes followed, radians
  ProgressCallback progress = {};  ///< told of the progress; may cancel

  Route route = Route::automatic;                     ///< as in MetricOptions
  std::optional<HemisphereGrid> grid = std::nullopt;  ///< as in MetricOptions
  bool allow_unresolved = false;                      ///< as in MetricOptions
};

/// Distances between n materials, with their errors; symmetric, zero on the diagonal.
struct LiteratureMatrix {
  Eigen::MatrixXd distance;        ///< n x n
  Eigen::MatrixXd distance_error;  ///< n x n
  Eigen::VectorXd size;            ///< n, distance from the black reflectance f = 0
  Eigen::VectorXd size_error;      ///< n
};

/// Distances between the materials of a set by one metric from the literature.
struct LiteratureResult {
  LiteratureMetric metric = LiteratureMetric::ngan_l2;  ///< metric of the distances
  /// Combined distances: the channels' weighted sum of whatever stands under the root (of the distances for
  /// albedo_of_difference and cube_root_log). Squared distances add up, as in MetricResult.
  LiteratureMatrix combined;
  std::vector<LiteratureMatrix> channels;  ///< one per channel; empty for a single channel
  std::vector<Unresolved> unresolved;      ///< pairs whose distance did not reach the tolerance, worst first
  WorkDone work;                           ///< work done

  Route route = Route::formulas;                      ///< how distances were computed
  std::optional<HemisphereGrid> grid = std::nullopt;  ///< grid of the route `tables`
};

/// Chooses the route of compare(), as the overload for products does: formulas alone take formulas; functions, with
/// formulas without delta parts, take functions; everything else, and everything with `options.grid`, takes tables.
/// \throws ArgumentError for an `options.route` that the set does not have
[[nodiscard]] RouteChoice choose_route(const ReflectanceList& reflectances, const LiteratureOptions& options = {});

/// Compares all pairs of reflectances by a metric, on the route of choose_route(), which the result names. A single
/// channel serves all channels of the others; adjustments are applied (adjusted()) as needed.
///
/// More than 128 formulas are compared in tiles of at most 128 by 128, each refined by itself, `options.outliers` being
/// a share of its pairs. Which materials share a tile depends on their order, and distances with it, within their
/// errors.
///
/// Functions are taken at their own values, by quadrature that is dense about the mirror direction and at grazing
/// angles, down to options.lobe_width. As measurements need not be reciprocal, log_relative and albedo_of_difference
/// take the mean over both orders of the directions; anisotropic functions are evaluated at 16 azimuths, which differ
/// from node to node. Errors are three times the difference between the last two levels of quadrature, or the
/// difference between the levels before if that is larger, plus the effect of the functions' own errors; NaN if these
/// are unknown. Slabs of the quadrature are refined until every distance reaches the tolerance, or until the finest
/// level.
///
/// Tables share one grid; isotropic ones become general beside general ones. Each value represents its node's cell. The
/// error contains that of the values and that of the quadrature, estimated from cells three times as large; there is no
/// tolerance to reach. It is NaN if errors of values are unknown. In general tables every pair of nodes counts.
/// log_relative, whose domain is not a product of cells, takes interpolated values (evaluate()) with their errors. On
/// the routes of functions and tables, options.precision and options.outliers have no effect, and `unresolved` names
/// the pairs that exceed options.tolerance.
///
/// \throws ArgumentError for no reflectances, channel counts that do not fit, options out of range, and log_relative
///   with general tables; NumericError for delta parts, if a distance is not finite, and if a grid does not resolve a
///   reflectance to be tabulated, unless options.allow_unresolved; DeviceError; Cancelled
[[nodiscard]] LiteratureResult compare(const Device& device, const ReflectanceList& reflectances,
                                       LiteratureMetric metric, const LiteratureOptions& options = {});

/// Compares by several metrics, one result per name, in their order. All names are checked before anything is computed.
/// \throws as parse_literature_metric() and compare()
[[nodiscard]] std::vector<LiteratureResult> compare(const Device& device, const ReflectanceList& reflectances,
                                                    std::span<const std::string> names,
                                                    const LiteratureOptions& options = {});

}  // namespace lobe
