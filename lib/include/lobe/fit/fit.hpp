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

/// A parameter of a family that is to be found.
struct FreeParameter {
  std::string label;  ///< "m"; where several terms have an m "2.m", of the second term; "2.fresnel.k" among its factors
  std::size_t term = 0;               ///< number of the term that it belongs to
  std::optional<std::size_t> factor;  ///< of that term; none: a parameter of its model
  std::size_t index = 0;              ///< among the values of model or factor
  Parameter range;                    ///< as the catalogue has it
};

/// Materials sum_k c_k g_k(p): terms with free scales c_k >= 0 and free parameters p of their models and factors.
struct Family {
  std::string name;                       ///< the specification
  std::vector<Term> terms;                ///< with the values that are fixed; the weight of a fixed scale, else 1
  std::vector<bool> has_free_scale;       ///< one per term: its scale is to be found
  std::vector<FreeParameter> parameters;  ///< those of models and factors that are to be found
};

/// Reads a family: a material specification (parse_material()) that leaves values open. A parameter without a default
/// that is not given, and one given as `free`, is to be found; so is the scale of each term unless it is given:
/// "lambert+ward", "lambert:scale=0.1+ward", "cook_torrance:f0=free", "phong*fresnel:k=3".
/// \throws ArgumentError as parse_material(), and for adjustments, parameters by channel, delta parts, and when nothing
///   is left to find.
[[nodiscard]] Family parse_family(std::string_view specification);

/// What a fit makes least.
enum class FitObjective {
  l2,         ///< |f - g| under a lighting
  log,        ///< a distance of the literature that compares logarithms, or another of lobe/metric/comparison.hpp
  perceptual  ///< the largest relative error of radiances and albedos, Neumann 2001, section 2.1.1
};
/// "l2", "log", "perceptual".
[[nodiscard]] std::string_view to_string(FitObjective objective);
/// Reads such a name.
/// \throws ArgumentError for another name, with the nearest known one.
[[nodiscard]] FitObjective parse_fit_objective(std::string_view name);

/// Bounds of a parameter, within those of the catalogue.
struct FitRange {
  std::string label;   ///< of the parameter, as FreeParameter has it
  double minimum = 0;  ///< smallest value that is tried
  double maximum = 0;  ///< largest one
};

/// What is fitted, and how well.
struct FitOptions {
  FitObjective objective = FitObjective::l2;  ///< what is made least
  Lighting lighting = Lighting::point();      ///< of l2; other objectives start from its best fits
  LiteratureMetric comparison =
      LiteratureMetric::bieron_log;  ///< of log; not cube_root, cube_root_log or albedo_of_difference
  /// Of scalar products (1e-6 where none is given) or of distances of the literature (1e-3), for the result; the search
  /// before is content with less.
  std::optional<double> tolerance;
  double theta_max = MetricOptions{}.theta_max;       ///< domain of scalar products, as in MetricOptions
  Precision precision = Precision::double_precision;  ///< of the models
  /// Relative errors are taken of what is darker than this as of this: f cos(theta_in), sr^-1, and albedos.
  double radiance_floor = 1e-3;
  double albedo_floor = 1e-3;  ///< the same of albedos
  /// Best starting points that are followed to their minima. Starting points fill the ranges of the parameters.
  std::size_t searches = 3;
  /// Starting points instead: values of all parameters by label.
  std::vector<std::vector<NamedValue>> starts;
  std::vector<FitRange> ranges;  ///< bounds narrower than the catalogue's
  /// Weight of each channel; empty: equal weights that sum to 1. `perceptual` takes the worst channel.
  std::vector<double> channel_weights;
  ProgressCallback progress;  ///< told of the progress; may cancel
};

/// A number that was found.
struct FittedValue {
  std::string label;                   ///< of a scale "scale", "2.scale"; the channel is apart
  std::optional<std::size_t> channel;  ///< of scales of targets with several channels
  bool is_scale = false;               ///< a scale of a term, else a parameter
  double value = 0;                    ///< what was found
  /// Root of its variance (FitResult::covariance); infinite where the target does not determine it, NaN for perceptual.
  double standard_error = 0;
  double minimum = 0;     ///< bounds of the search; of scales 0 and infinity
  double maximum = 0;     ///< largest value of the search
  bool at_bound = false;  ///< the search ended at one of its bounds
};

/// The largest relative error of a kind, |g - f| / max(f, floor), and where it is taken.
struct LargestError {
  Estimate value;           ///< the error is that of target and fit there
  Directions directions;    ///< of albedos theta_in and phi_in
  std::size_t channel = 0;  ///< number of the channel, from 0 on
};

/// What the perceptual objective makes least, apart.
struct PerceptualErrors {
  LargestError radiance;  ///< of f cos(theta_in), over perceptual_directions()
  LargestError albedo;    ///< over perceptual_incidence()
};

/// The best member of a family, and how near it is.
struct FitResult {
  FitObjective objective = FitObjective::l2;  ///< what was made least
  Material material;                          ///< what was found, of family "fit"
  /// Scales by term and channel, then parameters in the family's order.
  std::vector<FittedValue> values;
  /// Of the values, in their order: r^2 H^-1, r the residual with its error, H = J^T J in the metric of the objective.
  /// So along an axis of H one standard error doubles the squared residual. Rows of values at bounds are zero; empty
  /// for perceptual, whose optimum is a corner and not the bottom of a bowl.
  Eigen::MatrixXd covariance;
  /// Distance between target and fit in the metric of the objective (perceptual: under the lighting), the target's
  /// distance from black, and their quotient.
  Estimate residual;
  Estimate target_norm;                    ///< distance of the target from black
  Estimate relative_residual;              ///< residual / target_norm
  std::optional<PerceptualErrors> errors;  ///< of perceptual
  std::size_t evaluations = 0;             ///< materials held against the target
  std::size_t starting_points = 0;         ///< members of the family that the search for starting points compared
  std::vector<double> minima;  ///< what each search led to, best first: relative residuals, or largest relative errors
  bool converged = false;      ///< the last step of the best search was below what changes anything

  Route route = Route::formulas;                      ///< how the target was taken
  std::optional<HemisphereGrid> grid = std::nullopt;  ///< of the route `tables`
  bool is_coarse = false;                             ///< this grid does not resolve the target
};

/// The correlation matrix of a covariance; zero beside variances that are zero or not finite.
[[nodiscard]] Eigen::MatrixXd correlation(const Eigen::MatrixXd& covariance);

/// The member of a family nearest to a target. All channels share the parameters; scales are found per channel.
///
/// l2, log: starting points are compared by scalar products alone, with the best scales of each (non-negative least
/// squares); the best few are followed by Gauss-Newton steps with Levenberg and Marquardt's damping, of which residual
/// and Hessian come from distances between neighbouring members of the family. perceptual: from there on, min t with
/// -t <= e_i <= t for the relative errors e_i of all radiances and albedos, by Powell's COBYLA.
///
/// Targets are taken by the route of choose_route(). Measured ones in the metric of functions, which follows narrow
/// lobes; where they need tables (patch light, the objective log) on the grid of natural_grid(), and `is_coarse` says
/// whether that resolves them. Of tables members of the family are tabulated on their grid, as far as that resolves
/// them; perceptual interpolates the table.
/// \throws ArgumentError for options that do not fit the family; NumericError for a target that is black, has delta
///   parts where they are infinitely far, or cannot be measured; DeviceError; Cancelled.
[[nodiscard]] FitResult fit(const Device& device, const Reflectance& target, const Family& family,
                            const FitOptions& options = {});

/// Where radiances are compared: theta_h = 90 deg (k/30)^2 with k = 0 .. 29, theta_d = 0, 15, ..., 75 deg, phi_d = 0,
/// 45, 90, 135 deg in half-difference coordinates, as far as both directions are within 80 deg of the normal; for
/// anisotropic reflectances with the light at the azimuths 0, 45, 90 and 135 deg.
[[nodiscard]] std::vector<Directions> perceptual_directions(bool is_isotropic);
/// Where albedos are compared: 0, 15, ..., 75 and 80 deg of incidence, at the same azimuths.
[[nodiscard]] std::vector<Direction> perceptual_incidence(bool is_isotropic);

}  // namespace lobe
