#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "lobe/core/estimate.hpp"
#include "lobe/device/device.hpp"
#include "lobe/energy/albedo.hpp"
#include "lobe/metric/lighting.hpp"
#include "lobe/metric/metric.hpp"
#include "lobe/model/label.hpp"
#include "lobe/model/material.hpp"
#include "lobe/table/reflectance.hpp"

namespace [[gnu::visibility("default")]] lobe {

/// Constraints on the combinations sum x_i a_i of basis materials a_i.
struct ApproximationForm {
  bool non_negative = false;  ///< x_i >= 0
  /// sum |x_i| max a_i <= 1, with the largest albedo of every basis material, so that |a(L)| <= 1: the energy balance
  /// of mixtures (Neumann 2001, eqs. 5.3-5.4, where all x_i >= 0 and max a_i = 1).
  bool energy = false;
  /// Whether to answer if the basis is linearly dependent, so that several combinations are equally good: without
  /// constraints by the one with least norm, sum (x_i |a_i|)^2, with constraints by one of independent materials.
  bool allow_dependent = false;
};

/// Scalar products behind an approximation of a target f by k basis materials. Errors are bounds on the products.
struct ApproximationProblem {
  Eigen::MatrixXd gram;            ///< k x k, a_i . a_j
  Eigen::MatrixXd gram_error;      ///< k x k; empty: exact
  Eigen::VectorXd products;        ///< k, a_i . f
  Eigen::VectorXd products_error;  ///< k; empty: exact
  Estimate target_square;          ///< f . f
  /// k, bounds on the basis materials' albedos, positive; infinity excludes a material. Only for the form `energy`.
  Eigen::VectorXd largest_albedo = {};
  std::vector<std::string> names = {};  ///< k, for messages; empty: numbers from 1 on
  /// k, by how much the bounds may exceed the largest albedos, >= 0; empty: not at all.
  Eigen::VectorXd largest_albedo_error = {};
};

/// The admissible combination nearest to the target.
struct LinearFit {
  Eigen::VectorXd coefficients;  ///< k, x_i
  /// k, first-order bounds from the errors of the products and, at the energy bound, of the largest albedos, assuming
  /// that the same coefficients stay at bounds and, for a dependent basis, that the rank stays; infinite if products
  /// are too uncertain to tell. A coefficient at zero has the error that it would have if it were free and is not
  /// surely zero.
  Eigen::VectorXd coefficients_error;
  std::vector<bool> at_zero;     ///< k, whether x_i >= 0 or the energy holds x_i at zero
  bool at_energy_bound = false;  ///< whether the energy bound is reached
  double energy = 0;             ///< sum |x_i| max a_i; 0 if no albedos are given

  Estimate residual;           ///< |f - sum x_i a_i|
  Estimate relative_residual;  ///< residual / |f|; 0 if f is zero, as a channel may be
  /// How much smaller the square of the best combination's residual may be, to first order, as largest albedos may be
  /// smaller than their bounds. The residual's error contains it. 0 unless the energy bound is reached.
  double energy_slack = 0;

  Eigen::Index rank = 0;  ///< rank of the Gram matrix; eigenvalues below their error count as zero
  /// Ratio of the largest to the smallest eigenvalue of the Gram matrix, with basis materials scaled to norm 1;
  /// infinite for a dependent basis.
  double condition = 0;
  std::vector<std::size_t> dependent;  ///< materials that depend on the others, k - rank of them

  /// Largest violation of the optimality conditions (Karush, Kuhn, Tucker), with materials and target scaled to norm 1.
  /// With y_i the scaled coefficients, g_i = a_i . (f - sum y_j a_j), lambda >= 0 the multiplier of the energy bound
  /// and e_i the scaled largest albedos: |g_i - lambda e_i sign(y_i)| where y_i is free, max(0, |g_i| - lambda e_i)
  /// where it is held at zero (with g_i instead of |g_i| if all y_i >= 0), max(0, -y_i) if all y_i >= 0, max(0, sum e_i
  /// |y_i| - 1). For a dependent basis without constraints, eigenvalues that do not count leave up to the root of their
  /// size.
  double kkt_residual = 0;
};

/// Finds the best approximation from scalar products alone (Neumann 2001, section 5.3.1: G x = b), with constraints by
/// an active set (Lawson and Hanson 1974 for cones, Wolfe 1976 for the energy). The residual is computed from products
/// and cancels: below about 1e-7 of the target's norm its error says that it is unknown.
/// \throws ArgumentError for sizes that do not fit and products that are not finite; NumericError for a target that is
///   zero, and for a dependent basis, naming the dependent materials, unless the form allows it
[[nodiscard]] LinearFit best_combination(const ApproximationProblem& problem, const ApproximationForm& form = {});

/// Ways of approximating materials with several channels.
enum class ChannelCoefficients {
  separate,  ///< each channel by itself: a coefficient per basis material and channel
  common     ///< one coefficient per basis material, for the weighted sum of the channels' products
};

/// Options for approximations.
struct ApproximationOptions {
  ApproximationForm form;                                        ///< constraints on the combinations
  ChannelCoefficients channels = ChannelCoefficients::separate;  ///< whether channels share their coefficients
  MetricOptions metric;                                          ///< options for the scalar products
  /// Largest albedos are searched up to this angle of incidence, radians. Towards 90 degrees Ward's albedo grows
  /// without bound, which would exclude it.
  double energy_theta_max = kAlbedoPeakThetaMax;
};

/// The approximation of a target under a lighting.
struct Approximation {
  Lighting lighting = Lighting::point();  ///< lighting of the distances
  /// sum x_i a_i as a material of its own, without those of x_i = 0; without terms if the basis has others than
  /// formulas
  Material material;
  Reflectance combination = Material{};  ///< sum x_i a_i: the material, else a function or a table
  /// One fit per channel, or a single one (common coefficients, or a single channel). Their residuals are distances
  /// integrated as such, without cancellation.
  std::vector<LinearFit> fits;
  Estimate target_norm;                          ///< |f| over all channels
  Estimate residual;                             ///< |f - sum x_i a_i| over all channels, its error with energy_slack
  Estimate relative_residual;                    ///< residual / |f|
  double tolerance = MetricOptions{}.tolerance;  ///< as in MetricResult
  std::vector<Unresolved> unresolved;            ///< pairs among the basis materials, followed by the target

  Route route = Route::formulas;                      ///< how products with the target were computed
  std::optional<HemisphereGrid> grid = std::nullopt;  ///< grid of the route `tables`
  bool is_coarse = false;                             ///< whether this grid does not resolve the target
};

/// Makes the material sum x_i a_i with a given name and the family "approximation"; one vector of coefficients per
/// channel, or one for all. Materials with x_i = 0 are left out, unless all are.
/// \throws ArgumentError for numbers that do not fit
[[nodiscard]] Material linear_combination(std::span<const Material> basis,
                                          std::span<const Eigen::VectorXd> coefficients, std::string name);

/// Approximates each target best by a basis, on the route that choose_route() takes for target and basis.
/// By formulas, all products come from one measure(). By functions (measured targets), the target's norm, its products
/// and the residual are integrated as functions; their errors contain those of the measurement's interpolation, and
/// they reach no tolerance. Products within a basis of formulas are still those of formulas. By tables, all are put on
/// options.metric.grid, else on the grid of the target or of the first of the basis that has one; a target that the
/// grid does not resolve is accepted, and `is_coarse` is set.
/// \throws as measure() and best_combination(); ArgumentError for an empty basis
[[nodiscard]] std::vector<Approximation> approximate(const Device& device, const ReflectanceList& targets,
                                                     const ReflectanceList& basis, const Lighting& lighting,
                                                     const ApproximationOptions& options = {});
/// Approximates a single target best.
/// \throws as for several targets
[[nodiscard]] Approximation approximate(const Device& device, const Reflectance& target, const ReflectanceList& basis,
                                        const Lighting& lighting, const ApproximationOptions& options = {});

/// A step in a greedy selection.
struct GreedyStep {
  std::size_t chosen = 0;      ///< index of the material taken in this step
  Estimate residual;           ///< residual after it, over all channels
  Estimate relative_residual;  ///< residual / norm of the target
};

/// Materials chosen one after the other.
struct GreedyBasis {
  std::vector<GreedyStep> steps;  ///< one per material, in order of choice
  std::vector<LinearFit> fits;    ///< fits by the materials chosen, in order of choice; one per problem
};

/// Selects materials by orthogonal matching pursuit (Pati, Rezaiifar, Krishnaprasad 1993) on scalar products: every
/// step adds the material that correlates most with the residual, sum_c w_c (a_i . r)_c^2 / |a_i|_c^2 (if x_i >= 0,
/// only positive correlations count), and approximates again. Materials that depend on those already chosen are
/// skipped. It stops early if nothing correlates beyond the errors of the products.
/// \param channels one problem per channel, over the same materials
/// \param weights w_c, one per problem
/// \throws ArgumentError for count 0, and as best_combination()
[[nodiscard]] GreedyBasis greedy_combination(std::span<const ApproximationProblem> channels,
                                             std::span<const double> weights, std::size_t count,
                                             const ApproximationForm& form = {});

/// A target approximated by few out of many materials.
struct GreedyApproximation {
  std::vector<GreedyStep> steps;  ///< indices into the candidates
  Approximation approximation;    ///< by the materials chosen, in order of choice
};

/// Chooses at most `count` basis materials among candidates for each target, with products as in approximate().
/// \throws as approximate() and greedy_combination()
[[nodiscard]] std::vector<GreedyApproximation> greedy_basis(const Device& device, const ReflectanceList& targets,
                                                            const ReflectanceList& candidates, std::size_t count,
                                                            const Lighting& lighting,
                                                            const ApproximationOptions& options = {});
/// Chooses basis materials for a single target.
/// \throws as for several targets
[[nodiscard]] GreedyApproximation greedy_basis(const Device& device, const Reflectance& target,
                                               const ReflectanceList& candidates, std::size_t count,
                                               const Lighting& lighting, const ApproximationOptions& options = {});

/// Residuals that tell how well each family in a set represents each material: every material against the span of every
/// family's materials, leaving itself out.
struct FamilyResiduals {
  Lighting lighting = Lighting::point();  ///< lighting of the distances
  bool non_negative = false;              ///< whether coefficients below 0 were excluded
  std::vector<std::string> targets;       ///< names of materials, n
  std::vector<std::string> families;      ///< in order of their first material, m
  /// n x m, |f - nearest combination| / |f|, over all channels, each approximated by itself; NaN if the family has no
  /// other material, or if the target's norm is zero.
  Eigen::MatrixXd relative_residual;
  Eigen::MatrixXd relative_residual_error;  ///< n x m, bounds
  Eigen::MatrixXi rank;  ///< n x m, largest rank of the channels' Gram matrices: how many materials really count
};

/// Computes family residuals from a set's scalar products alone. Dependent families count by their span. Residuals
/// below about 1e-4 of the target have errors as large as they are, since products are known to about the square of
/// that.
/// \param materials names and families of the materials of the result, in its order
/// \param channel_weights as in MetricOptions
/// \throws ArgumentError if result and materials do not fit
[[nodiscard]] FamilyResiduals family_residuals(const MetricResult& result, std::span<const MaterialLabel> materials,
                                               bool non_negative = false, std::span<const double> channel_weights = {});

/// Writes the relative residuals as comma-separated text: a row per target, a column per family, then the best family.
[[nodiscard]] std::string csv_text(const FamilyResiduals& residuals);

}  // namespace lobe
