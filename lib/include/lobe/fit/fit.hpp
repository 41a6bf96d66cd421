#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <functional>
#include <numbers>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "lobe/compare/literature_metric.hpp"
#include "lobe/core/directions.hpp"
#include "lobe/core/estimate.hpp"
#include "lobe/core/progress.hpp"
#include "lobe/device/device.hpp"
#include "lobe/metric/lighting.hpp"
#include "lobe/model/material.hpp"
#include "lobe/model/model.hpp"
#include "lobe/table/reflectance.hpp"

namespace [[gnu::visibility("default")]] lobe {

/// A free parameter of a family.
struct FreeParameter {
  std::string label;     ///< "m"; or "2.m" for the second of several terms with an m; "2.fresnel.k" for its factor
  std::size_t term = 0;  ///< index of its term
  std::optional<std::size_t> factor;  ///< factor of that term; none: a parameter of its model
  std::size_t index = 0;              ///< index among the values of model or factor
  Parameter range;                    ///< range as in the catalogue
};

/// A family of materials sum_k c_k g_k(p): terms with free scales c_k >= 0 and free parameters p of their models and
/// factors.
struct Family {
  std::string name;                       ///< the specification
  std::vector<Term> terms;                ///< terms with the fixed values; the weight is a fixed scale, else 1
  std::vector<bool> has_free_scale;       ///< one per term: whether its scale is free
  std::vector<FreeParameter> parameters;  ///< free parameters of models and factors
};

/// Reads a family: a material specification (parse_material()) that leaves values open. Parameters without a default
/// that are not given, and parameters given as `free`, are free; so is the scale of each term unless it is given:
/// "lambert+ward", "lambert:scale=0.1+ward", "cook_torrance:f0=free", "phong*fresnel:k=3".
/// \throws ArgumentError as parse_material(), and for adjustments, parameters by channel, delta parts, and
///   specifications that leave nothing open
[[nodiscard]] Family parse_family(std::string_view specification);

/// Quantities that a fit minimises.
enum class FitObjective {
  l2,   ///< |f - g| under a lighting
  log,  ///< a distance from the literature that compares logarithms, or another in lobe/compare/literature_metric.hpp
  perceptual  ///< the largest relative error of radiances and albedos, Neumann 2001, section 2.1.1
};
/// Name of an objective: "l2", "log" or "perceptual".
[[nodiscard]] std::string_view to_string(FitObjective objective);
/// Reads the name of an objective.
/// \throws ArgumentError for another name, with the nearest known one
[[nodiscard]] FitObjective parse_fit_objective(std::string_view name);

/// Bounds on a parameter, within those of the catalogue.
struct FitRange {
  std::string label;   ///< label of the parameter, as in FreeParameter
  double minimum = 0;  ///< smallest value to try
  double maximum = 0;  ///< largest value to try
};

/// Options for fits.
struct FitOptions {
  FitObjective objective = FitObjective::l2;  ///< quantity to minimise
  Lighting lighting = Lighting::point();      ///< lighting for l2; other objectives start from its best fits
  LiteratureMetric metric = LiteratureMetric::bieron_log;  ///< for log: no cube roots, no albedo_of_difference
  /// Tolerance of the result: of scalar products (1e-6 by default) or of distances from the literature (1e-3). The
  /// search before is content with less.
  std::optional<double> tolerance;
  double theta_max = MetricOptions{}.theta_max;       ///< domain of scalar products, as in MetricOptions
  Precision precision = Precision::double_precision;  ///< arithmetic of the models
  /// Floor for relative errors of f cos(theta_in), sr^-1: darker values count as this.
  double radiance_floor = 1e-3;
  double albedo_floor = 1e-3;  ///< floor for relative errors of albedos
  /// Number of best starting points to follow to their minima. Starting points fill the ranges of the parameters.
  std::size_t searches = 3;
  /// Starting points to use instead: values of all parameters by label.
  std::vector<std::vector<NamedValue>> starts;
  std::vector<FitRange> ranges;  ///< bounds narrower than the catalogue's
  /// Weight of each channel; empty: equal weights that sum to 1. `perceptual` takes the worst channel.
  std::vector<double> channel_weights;
  ProgressCallback progress;  ///< told of the progress; may cancel
  /// Told of every better member that descents come to, with its distance from the target, in the unit of the norm and
  /// as accurate as the descent needs it. For `perceptual` these are the descents before the search for the smallest
  /// largest error. Called in the thread of fit().
  std::function<void(const Material& member, double residual)> watch = {};
};

/// A fitted number.
struct FittedValue {
  std::string label;                   ///< label; scales are "scale", "2.scale", without the channel
  std::optional<std::size_t> channel;  ///< channel of a scale, for targets with several channels
  bool is_scale = false;               ///< whether it is the scale of a term rather than a parameter
  double value = 0;                    ///< fitted value
  /// Standard error, the root of its variance (FitResult::covariance); infinite if the target does not determine the
  /// value, NaN for perceptual.
  double standard_error = 0;
  double minimum = 0;     ///< lower bound of the search; 0 for scales
  double maximum = 0;     ///< upper bound of the search; infinite for scales
  bool at_bound = false;  ///< whether the search ended at one of its bounds
};

/// The largest relative error of one kind, |g - f| / max(f, floor), and its place.
struct LargestError {
  Estimate value;           ///< its error is that of target and fit there
  Directions directions;    ///< place; for albedos theta_in and phi_in
  std::size_t channel = 0;  ///< index of the channel
};

/// Largest errors that the perceptual objective minimises, one for each kind.
struct PerceptualErrors {
  LargestError radiance;  ///< largest error of f cos(theta_in), over perceptual_directions()
  LargestError albedo;    ///< largest error of albedos, over perceptual_incidence()
};

/// The best member of a family, and its distance from the target.
struct FitResult {
  FitObjective objective = FitObjective::l2;  ///< quantity that was minimised
  Material material;                          ///< best member, of family "fit"
  /// Scales by term and channel, then parameters in the family's order.
  std::vector<FittedValue> values;
  /// Covariance of the values, in their order: r^2 H^-1, with the residual r including its error and H = J^T J in the
  /// metric of the objective. Along an axis of H one standard error doubles the squared residual. Rows of values at
  /// bounds are zero. Empty for perceptual, whose optimum is a corner and not the bottom of a bowl.
  Eigen::MatrixXd covariance;
  /// Distance between target and fit in the metric of the objective (perceptual: under the lighting).
  Estimate residual;
  Estimate target_norm;                    ///< distance of the target from black
  Estimate relative_residual;              ///< residual / target_norm
  std::optional<PerceptualErrors> errors;  ///< largest errors, for perceptual
  std::size_t evaluations = 0;             ///< number of materials compared with the target
  std::size_t starting_points = 0;         ///< members of the family compared in the search for starting points
  std::vector<double> minima;  ///< result of each search, best first: relative residuals, or largest relative errors
  bool converged = false;      ///< whether the last step of the best search was too small to change anything

  Route route = Route::formulas;                      ///< route on which the target was taken
  std::optional<HemisphereGrid> grid = std::nullopt;  ///< grid of the route `tables`
  bool is_coarse = false;                             ///< whether this grid does not resolve the target
};

/// Correlation matrix of a covariance; zero beside variances that are zero or not finite.
[[nodiscard]] Eigen::MatrixXd correlation(const Eigen::MatrixXd& covariance);

/// Fits a family: finds its member nearest to a target. All channels share the parameters; each has its own scales.
///
/// l2, log: starting points are compared by scalar products alone, each with its best scales (non-negative least
/// squares). The best few are followed by Gauss-Newton steps with Levenberg and Marquardt's damping, with residual and
/// Hessian from distances between neighbouring members of the family. perceptual: from there on, Powell's COBYLA
/// minimises t subject to -t <= e_i <= t for the relative errors e_i of all radiances and albedos.
///
/// Targets are taken on the route of choose_route(). Measured targets use the metric of functions, which follows narrow
/// lobes; if they need tables (patch light, the objective log) they use the natural_grid(), and formulas beside which
/// anisotropic ones are fitted by the objective log gauss:16x32 or gauss:24x48; `is_coarse` says whether the grid does
/// not resolve the target. If the target is a table, members of the family are tabulated on its grid, as
/// far as that resolves them; perceptual interpolates the table.
/// \throws ArgumentError for options that do not fit the family; NumericError for a target that is black, has delta
///   parts where they are infinitely far, or has no norm; DeviceError; Cancelled
[[nodiscard]] FitResult fit(const Device& device, const Reflectance& target, const Family& family,
                            const FitOptions& options = {});

/// Directions in which radiances are compared: theta_h = 90 deg (k/30)^2 with k = 0 .. 29, theta_d = 0, 15, ..., 75
/// deg, phi_d = 0, 45, 90, 135 deg in half-difference coordinates, as far as both directions are within 80 deg of the
/// normal; for anisotropic reflectances with the light at the azimuths 0, 45, 90 and 135 deg.
[[nodiscard]] std::vector<Directions> perceptual_directions(bool is_isotropic);
/// Directions of incidence at which albedos are compared: 0, 15, ..., 75 and 80 deg, at the same azimuths.
[[nodiscard]] std::vector<Direction> perceptual_incidence(bool is_isotropic);

}  // namespace lobe
