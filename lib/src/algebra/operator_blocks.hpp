#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <vector>

#include "lobe/table/table.hpp"

namespace lobe {

/// A position as Eigen takes it.
[[nodiscard]] inline Eigen::Index index(std::size_t i) {
  return static_cast<Eigen::Index>(i);
}

/// The symmetrised operator D^1/2 T D^1/2, D = diag(weights), of a channel, as matrices that do not mix: for an
/// isotropic table one of n_theta x n_theta per azimuthal order m = 0 .. n_phi/2 (F^m = integral of f cos(m dphi)), for
/// a general one the dense matrix. Delta parts are on diagonals. Operators multiply, add and transpose block by block.
struct OperatorBlocks {
  std::vector<Eigen::MatrixXd> blocks;
  std::vector<std::size_t> multiplicities;  ///< multiplicity of each block's eigenvalues

  [[nodiscard]] std::size_t size() const { return blocks.size(); }
};

[[nodiscard]] OperatorBlocks smooth_blocks(const BrdfTable& table, std::size_t channel);

/// Adds sign times the delta parts of a table.
void add_delta(const BrdfTable& table, std::size_t channel, double sign, OperatorBlocks& blocks);

/// The smooth part that has these blocks, written into the values of a channel.
void store_smooth(const OperatorBlocks& blocks, std::size_t channel, BrdfTable& table);

/// Effect of delta parts on the values at a row's direction and at its mirror image:
/// [[retro, mirror], [mirror', retro']].
[[nodiscard]] Eigen::Matrix2d delta_matrix(const BrdfTable& table, std::size_t channel, std::size_t row);
/// Takes the first line of such a matrix as the delta parts of a row. Both parts must have been given their sizes.
void set_delta(const Eigen::Matrix2d& matrix, std::size_t channel, std::size_t row, BrdfTable& table);

/// Square of the Hilbert-Schmidt norm.
[[nodiscard]] double squared_norm(const OperatorBlocks& blocks);

/// Norms of the operator whose kernel is the table's bound on the error of a channel: no operator within that bound has
/// larger ones. NaN where unknown.
struct ErrorNorms {
  double largest = 0;          ///< as an operator in L^2
  double hilbert_schmidt = 0;  ///< root of the integral of its square
};
[[nodiscard]] ErrorNorms error_norms(const BrdfTable& table, std::size_t channel);

/// Delta parts that are zero in all channels are none.
void drop_zeros(std::vector<double>& parts);

}  // namespace lobe
