#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <filesystem>
#include <span>
#include <vector>

#include "lobe/device/device.hpp"
#include "lobe/io/measured.hpp"
#include "lobe/metric/fit.hpp"
#include "lobe/metric/metric.hpp"
#include "lobe/table/brdf_function.hpp"

namespace lobe {

/// Replicates from which a standard deviation is known to 7 %.
inline constexpr std::size_t kReplicates = 100;

/// The standard deviations of numbers that were computed channel by channel from a measured reflectance, as those of
/// its samples cause them (parametric bootstrap: Efron and Tibshirani 1993, section 6.5): the scatter of a number over
/// the replicates. It says nothing of numerical errors, nor of errors that all samples have in common.
/// \param numbers one for each of the function's channels, in their order, replicates included
/// \return one for each of the reflectance's own channels; empty for functions without replicates
/// \throws ArgumentError for another count of numbers
[[nodiscard]] std::vector<double> measurement_deviations(const BrdfFunction& brdf, std::span<const double> numbers);

/// The same of many numbers at once.
/// \param numbers as rows, a column for each of the function's channels
/// \return [own channel][row]; empty for functions without replicates
[[nodiscard]] std::vector<std::vector<double>> measurement_deviations(const BrdfFunction& brdf,
                                                                      const Eigen::MatrixXd& numbers);

/// The number of a function's own channels, without replicates.
[[nodiscard]] std::size_t own_channels(const BrdfFunction& brdf);

/// A table with its standard deviations (load_table_deviations()) as a function with replicates, delta parts left out.
/// As many as are wanted, or less, 20 at least, where values are many; none beyond, and without deviations.
/// \param options the channels wanted, and how many replicates
/// \throws IoError; ArgumentError as with_channels()
[[nodiscard]] BrdfFunction load_replicated_table(const std::filesystem::path& path, const ReadOptions& options = {});

/// Functions whose channels belong together, for numbers that are computed channel by channel from several of them: as
/// many own channels each as the one with most, and as many replicates each as the one with fewest of those that have
/// any. One without replicates stays the same in all. Files are read with the same noise, so that replicates of
/// different sources are brought together in another order: what one measurement has by chance the other has not.
/// \param source of each function: those of one source keep their noise in common; empty: all are different
/// \throws ArgumentError for own channels that are neither one nor as many as most, and another count of sources
[[nodiscard]] std::vector<BrdfFunction> aligned_replicates(std::span<const BrdfFunction> functions,
                                                           std::span<const std::size_t> source = {});

/// Standard deviations of products and what follows from them.
struct ProductDeviations {
  Eigen::MatrixXd gram;      ///< n x n
  Eigen::VectorXd norm;      ///< n
  Eigen::MatrixXd distance;  ///< n x n
  Eigen::MatrixXd angle;     ///< n x n, radians; NaN beside a norm of 0
};

/// Those of all channels together and of each own one.
struct MetricDeviations {
  ProductDeviations combined;               ///< of all channels, weighted
  std::vector<ProductDeviations> channels;  ///< empty for a single channel
};

/// What the standard deviations of samples make of products.
/// \param replicated products of aligned_replicates()
/// \param own channels of each function without replicates
/// \param weights of these; empty: equal weights that sum to 1
/// \throws ArgumentError for products that have no replicates, and weights that do not fit
[[nodiscard]] MetricDeviations metric_deviations(const MetricResult& replicated, std::size_t own,
                                                 std::span<const double> weights = {});

/// What the standard deviations of samples make of a fit under point, daylight or mean-albedo light (FitObjective::l2):
/// how far each value moves where the target moves by its noise, to first order: dx = H^-1 J^T df in the metric of the
/// fit, H = J^T J, J by differences about the fit. Values at bounds stay; those that the target does not determine are
/// infinitely uncertain. Beside FitResult::covariance, which says what the family leaves open.
/// \param target with replicates
/// \param options those of the fit
/// \return one for each of result.values
/// \throws ArgumentError for targets without replicates, other objectives and lightings; as measure()
[[nodiscard]] std::vector<double> fit_deviations(const Device& device, const BrdfFunction& target, const Family& family,
                                                 const FitResult& result, const FitOptions& options = {});

}  // namespace lobe
