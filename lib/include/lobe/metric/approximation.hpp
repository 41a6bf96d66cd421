#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "lobe/core/estimate.hpp"
#include "lobe/device/device.hpp"
#include "lobe/energy/energy.hpp"
#include "lobe/metric/lighting.hpp"
#include "lobe/metric/metric.hpp"
#include "lobe/model/material.hpp"
#include "lobe/table/reflectance.hpp"

namespace lobe {

/// Which combinations sum x_i a_i of basis materials a_i are admitted.
struct ApproximationForm {
  bool non_negative = false;  ///< x_i >= 0
  /// sum |x_i| max a_i <= 1 with the largest albedo of every basis material: then |a(L)| <= 1, the energy balance of
  /// mixtures (Neumann 2001, eqs. 5.3-5.4, where all x_i >= 0 and max a_i = 1).
  bool energy = false;
  /// Answer also where the basis is linearly dependent, so that several combinations are equally good: without
  /// constraints by the one of least norm, sum (x_i |a_i|)^2, with constraints by one of independent materials.
  bool allow_dependent = false;
};

/// Scalar products behind an approximation of a target f by k basis materials. Errors bound those of the products.
struct ApproximationProblem {
  Eigen::MatrixXd gram;            ///< k x k, a_i . a_j
  Eigen::MatrixXd gram_error;      ///< k x k; empty: exact
  Eigen::VectorXd products;        ///< k, a_i . f
  Eigen::VectorXd products_error;  ///< k; empty: exact
  Estimate target_square;          ///< f . f
  /// k, bounds of the basis materials' albedos, positive; infinity takes a material out. Only for the form `energy`.
  Eigen::VectorXd largest_albedo = {};
  std::vector<std::string> names = {};  ///< k, for messages; empty: numbers from 1 on
};

/// The admitted combination nearest to the target.
struct LinearFit {
  Eigen::VectorXd coefficients;  ///< k, x_i
  /// k. First-order bounds from the errors of the products, with the same coefficients at bounds and, of a dependent
  /// basis, the same rank; infinite where products are too uncertain to tell. A coefficient at zero has the error that
  /// it would have if it were free and is not surely zero.
  Eigen::VectorXd coefficients_error;
  std::vector<bool> at_zero;     ///< k, whether x_i >= 0 or the energy holds x_i at zero
  bool at_energy_bound = false;  ///< the energy bound is reached
  double energy = 0;             ///< sum |x_i| max a_i; 0 where no albedos are given

  Estimate residual;           ///< |f - sum x_i a_i|
  Estimate relative_residual;  ///< residual / |f|; 0 where f is zero, as a channel may be

  Eigen::Index rank = 0;  ///< of the Gram matrix, eigenvalues below their error counting as zero
  /// Largest over smallest eigenvalue of the Gram matrix of the basis materials scaled to norm 1; infinite for a
  /// dependent basis.
  double condition = 0;
  std::vector<std::size_t> dependent;  ///< materials that depend on the others, k - rank of them

  /// Largest violation of the optimality conditions (Karush, Kuhn, Tucker), with materials and target scaled to norm 1.
  /// With y_i the scaled coefficients, g_i = a_i . (f - sum y_j a_j), lambda >= 0 the multiplier of the energy bound
  /// and e_i the scaled largest albedos: |g_i - lambda e_i sign(y_i)| where y_i is free, max(0, |g_i| - lambda e_i)
  /// where it is held at zero (g_i for |g_i| where all y_i >= 0), max(0, -y_i) where all y_i >= 0, max(0, sum e_i |y_i|
  /// - 1). Of a dependent basis without constraints, eigenvalues that do not count leave up to the root of their size.
  double kkt_residual = 0;
};

/// Best approximation by scalar products alone (Neumann 2001, section 5.3.1: G x = b), with constraints by an active
/// set (Lawson and Hanson 1974 for cones, Wolfe 1976 for the energy). The residual is taken from products and cancels:
/// below about 1e-7 of the target's norm its error says that it is unknown.
/// \throws ArgumentError for sizes that do not fit and products that are no finite numbers; NumericError for a target
///   that is zero, and for a dependent basis, naming the dependent materials, unless the form allows it.
[[nodiscard]] LinearFit best_combination(const ApproximationProblem& problem, const ApproximationForm& form = {});

/// How materials with several channels are approximated.
enum class ChannelCoefficients {
  separate,  ///< every channel by itself: a coefficient per basis material and channel
  common     ///< one coefficient per basis material, for the weighted sum of the channels' products
};

/// How materials are approximated.
struct ApproximationOptions {
  ApproximationForm form;                                        ///< which combinations are admitted
  ChannelCoefficients channels = ChannelCoefficients::separate;  ///< whether channels share their coefficients
  MetricOptions metric;                                          ///< of the scalar products
  /// Largest albedos are taken up to this angle of incidence, radians. Towards 90 degrees Ward's albedo grows without
  /// bound, which would rule it out.
  double energy_theta_max = kAlbedoPeakThetaMax;
};

/// A target approximated under a lighting.
struct Approximation {
  Lighting lighting = Lighting::point();  ///< what distances are taken under
  Material material;  ///< sum x_i a_i as a material of its own; basis materials with x_i = 0 are left out
  /// One per channel, or a single one (common coefficients, or a single channel). Their residuals are distances
  /// integrated as such, without cancellation.
  std::vector<LinearFit> fits;
  Estimate target_norm;                ///< |f| over all channels
  Estimate residual;                   ///< |f - sum x_i a_i| over all channels
  Estimate relative_residual;          ///< residual / |f|
  std::vector<Unresolved> unresolved;  ///< among the basis materials, then the target

  Route route = Route::formulas;                      ///< how products with the target were computed
  std::optional<HemisphereGrid> grid = std::nullopt;  ///< of the route `tables`
  bool is_coarse = false;                             ///< this grid does not resolve the target
};

/// sum x_i a_i, named as given, of family "approximation"; one vector of coefficients per channel, or one for all.
/// Materials with x_i = 0 are left out, unless all are.
/// \throws ArgumentError for numbers that do not fit
[[nodiscard]] Material linear_combination(std::span<const Material> basis,
                                          std::span<const Eigen::VectorXd> coefficients, std::string name);

/// Best approximation of each target by a basis of formulas, by the route that choose_route() takes for target and
/// basis. By formulas all products come from one measure(). By functions (measured targets) products with the target,
/// its norm and the residual are those of functions, whose errors contain those of the measurement's interpolation and
/// which reach no tolerance; products within the basis are those of formulas. By tables the basis is tabulated on the
/// target's grid, or on options.metric.grid; a target that this does not resolve is taken as it is, and `is_coarse`
/// says so.
/// \throws as measure() and best_combination(); the basis must not be empty.
[[nodiscard]] std::vector<Approximation> approximate(const Device& device, const ReflectanceList& targets,
                                                     std::span<const Material> basis, const Lighting& lighting,
                                                     const ApproximationOptions& options = {});
/// Best approximation of a single target.
/// \throws as above.
[[nodiscard]] Approximation approximate(const Device& device, const Reflectance& target,
                                        std::span<const Material> basis, const Lighting& lighting,
                                        const ApproximationOptions& options = {});

/// A step of greedy selection.
struct GreedyStep {
  std::size_t chosen = 0;      ///< index of the material taken in this step
  Estimate residual;           ///< after it, over all channels
  Estimate relative_residual;  ///< residual / norm of the target
};

/// Materials chosen one after the other.
struct GreedyBasis {
  std::vector<GreedyStep> steps;  ///< one per material, in order of choice
  std::vector<LinearFit> fits;    ///< of the materials chosen, in order of choice; one per problem
};

/// Orthogonal matching pursuit (Pati, Rezaiifar, Krishnaprasad 1993) on scalar products: every step takes the material
/// that correlates most with what is left, sum_c w_c (a_i . r)_c^2 / |a_i|_c^2 (with x_i >= 0 only positive
/// correlations count), and approximates anew. Materials that depend on those taken are passed over. Ends early where
/// nothing correlates beyond the errors of the products.
/// \param channels one problem per channel, over the same materials
/// \param weights w_c, one per problem
/// \throws ArgumentError for count 0, and as best_combination().
[[nodiscard]] GreedyBasis greedy_combination(std::span<const ApproximationProblem> channels,
                                             std::span<const double> weights, std::size_t count,
                                             const ApproximationForm& form = {});

/// A target approximated by few of many materials.
struct GreedyApproximation {
  std::vector<GreedyStep> steps;  ///< indices into the candidates
  Approximation approximation;    ///< by the materials chosen, in order of choice
};

/// Chooses at most `count` basis materials among candidates for each target, by products as those of approximate().
/// \throws as approximate() and greedy_combination().
[[nodiscard]] std::vector<GreedyApproximation> greedy_basis(const Device& device, const ReflectanceList& targets,
                                                            std::span<const Material> candidates, std::size_t count,
                                                            const Lighting& lighting,
                                                            const ApproximationOptions& options = {});
/// The choice for a single target.
/// \throws as above.
[[nodiscard]] GreedyApproximation greedy_basis(const Device& device, const Reflectance& target,
                                               std::span<const Material> candidates, std::size_t count,
                                               const Lighting& lighting, const ApproximationOptions& options = {});

/// How well each family of a set of materials represents each material: every material against the span of every
/// family's materials, itself left out.
struct FamilyResiduals {
  Lighting lighting = Lighting::point();  ///< what distances were taken under
  bool non_negative = false;              ///< whether coefficients below 0 were excluded
  std::vector<std::string> targets;       ///< names of materials, n
  std::vector<std::string> families;      ///< in order of their first material, m
  /// n x m, |f - nearest combination| / |f|, over all channels, each approximated by itself; NaN where the family has
  /// no other material, or the target's norm is zero.
  Eigen::MatrixXd relative_residual;
  Eigen::MatrixXd relative_residual_error;  ///< n x m, bounds
  Eigen::MatrixXi rank;  ///< n x m, of the channels' Gram matrices the largest: how many materials really count
};

/// From a set's scalar products alone. Dependent families count by what they span. Residuals below about 1e-4 of the
/// target have errors as large as they are, since products are known to about the square of that.
/// \param materials those that were measured
/// \param channel_weights as in MetricOptions
/// \throws ArgumentError when result and materials do not fit.
[[nodiscard]] FamilyResiduals family_residuals(const MetricResult& result, std::span<const Material> materials,
                                               bool non_negative = false, std::span<const double> channel_weights = {});

/// The relative residuals as a comma-separated table: a row per target, a column per family, then the best family.
[[nodiscard]] std::string csv_text(const FamilyResiduals& residuals);

}  // namespace lobe
