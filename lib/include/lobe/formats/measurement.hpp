#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <filesystem>
#include <span>
#include <vector>

#include "lobe/device/device.hpp"
#include "lobe/fit/fit.hpp"
#include "lobe/formats/measured.hpp"
#include "lobe/metric/metric.hpp"
#include "lobe/table/brdf_function.hpp"

namespace [[gnu::visibility("default")]] lobe {

/// Number of replicates that gives a standard deviation to 7 %.
inline constexpr std::size_t kReplicates = 100;

/// Standard deviations of numbers computed channel by channel from a measured reflectance, as caused by those of its
/// samples (parametric bootstrap: Efron and Tibshirani 1993, section 6.5): the scatter of a number over the replicates.
/// They include neither numerical errors nor errors that all samples have in common.
/// \param numbers one for each of the function's channels, in their order, replicates included
/// \return one for each of the reflectance's own channels; empty for functions without replicates
/// \throws ArgumentError if the count of numbers differs
[[nodiscard]] std::vector<double> measurement_deviations(const BrdfFunction& brdf, std::span<const double> numbers);

/// Standard deviations of many numbers at once.
/// \param numbers one row per number, one column for each of the function's channels
/// \return [own channel][row]; empty for functions without replicates
/// \throws ArgumentError if the number of columns differs
[[nodiscard]] std::vector<std::vector<double>> measurement_deviations(const BrdfFunction& brdf,
                                                                      const Eigen::MatrixXd& numbers);

/// Number of a function's own channels, without replicates.
[[nodiscard]] std::size_t own_channels(const BrdfFunction& brdf);

/// Loads a table with its standard deviations (load_table_deviations()) as a function with replicates, without delta
/// parts. It has as many replicates as wanted, or fewer, but at least 20, if there are many values; none if there are
/// too many, or without deviations.
/// \param options the channels wanted, and how many replicates
/// \throws IoError; ArgumentError as with_channels()
[[nodiscard]] BrdfFunction load_replicated_table(const std::filesystem::path& path, const ReadOptions& options = {});

/// Aligns functions so that their channels correspond, for numbers computed channel by channel from several of them:
/// each gets as many own channels as the function with the most, and as many replicates as the function with the fewest
/// of those that have any. A function without replicates is the same in all. Files are read with the same noise, so
/// replicates from different sources are paired in another order: their errors are independent.
/// \param source source of each function; functions from one source share their noise; empty: all are different
/// \throws ArgumentError if the numbers of own channels are neither one nor the largest, or if the count of sources
///   differs
[[nodiscard]] std::vector<BrdfFunction> aligned_replicates(std::span<const BrdfFunction> functions,
                                                           std::span<const std::size_t> source = {});

/// Standard deviations of products and quantities derived from them.
struct ProductDeviations {
  Eigen::MatrixXd gram;      ///< n x n
  Eigen::VectorXd norm;      ///< n
  Eigen::MatrixXd distance;  ///< n x n
  Eigen::MatrixXd angle;     ///< n x n, radians; NaN beside a norm of 0
};

/// Standard deviations for all channels together and for each own channel.
struct MetricDeviations {
  ProductDeviations combined;               ///< for all channels, weighted
  std::vector<ProductDeviations> channels;  ///< empty for a single channel
};

/// Standard deviations of products, as caused by those of the samples.
/// \param replicated products of aligned_replicates()
/// \param own number of channels of each function without replicates
/// \param weights weights of these channels; empty: equal weights that sum to 1
/// \throws ArgumentError for products without replicates, and weights that do not fit
[[nodiscard]] MetricDeviations metric_deviations(const MetricResult& replicated, std::size_t own,
                                                 std::span<const double> weights = {});

/// Standard deviations of a fit under point, daylight or mean-albedo light (FitObjective::l2), as caused by those of
/// the samples: how far each value moves if the target moves by its noise, to first order. dx = H^-1 J^T df in the
/// metric of the fit, H = J^T J, with J from differences about the fit. Values at bounds stay; values that the target
/// does not determine are infinitely uncertain. By contrast, FitResult::covariance tells what the family leaves open.
/// \param target function with replicates
/// \param options options of the fit
/// \return one for each of result.values
/// \throws ArgumentError for targets without replicates, other objectives and lightings; as measure()
[[nodiscard]] std::vector<double> fit_deviations(const Device& device, const BrdfFunction& target, const Family& family,
                                                 const FitResult& result, const FitOptions& options = {});

}  // namespace lobe
