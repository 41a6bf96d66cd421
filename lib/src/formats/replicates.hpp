#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <vector>

namespace lobe {

/// How many replicates of samples there may be: as many as wanted, but with no more values in all than `most`.
/// \param values of the samples themselves
/// \return 0 for less than 20, which say little of a standard deviation
[[nodiscard]] std::size_t possible_replicates(std::size_t wanted, std::size_t values, std::size_t most);

/// Samples and copies of them, side by side: each value with normally distributed noise of its standard deviation. The
/// same samples have the same copies.
/// \param values samples x channels
/// \param deviations samples x channels, not below 0
/// \return samples x channels (1 + replicates)
[[nodiscard]] Eigen::MatrixXd with_replicates(const Eigen::MatrixXd& values, const Eigen::MatrixXd& deviations,
                                              std::size_t replicates);

}  // namespace lobe
