#include "formats/replicates.hpp"

#include <algorithm>
#include <random>

namespace lobe {

std::size_t possible_replicates(std::size_t wanted, std::size_t values, std::size_t most) {
  constexpr std::size_t kFewest = 20;
  const std::size_t sets = most / std::max<std::size_t>(values, 1);
  const std::size_t possible = std::min(wanted, std::max<std::size_t>(sets, 1) - 1);
  return possible < std::min(kFewest, wanted) ? 0 : possible;
}

Eigen::MatrixXd with_replicates(const Eigen::MatrixXd& values, const Eigen::MatrixXd& deviations,
                                std::size_t replicates) {
  std::mt19937_64 engine(1);
  std::normal_distribution<double> noise;
  const Eigen::Index channels = values.cols();
  Eigen::MatrixXd all(values.rows(), channels * static_cast<Eigen::Index>(1 + replicates));
  all.leftCols(channels) = values;
  for (Eigen::Index column = channels; column < all.cols(); ++column) {
    for (Eigen::Index row = 0; row < all.rows(); ++row) {
      all(row, column) = values(row, column % channels) + deviations(row, column % channels) * noise(engine);
    }
  }
  return all;
}

}  // namespace lobe
