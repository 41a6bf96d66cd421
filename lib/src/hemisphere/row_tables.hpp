#pragma once

#include <Eigen/Core>
#include <cstddef>

namespace lobe {

using RowMajorMatrix = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;

/// Rows of tables have a multiple of so many numbers.
constexpr std::size_t kTableLanes = 8;

/// Writes scale cos(m psi) for m = 0 .. stride - 1.
/// \param psi radians
/// \param stride a multiple of kTableLanes
void write_cosines(double psi, double scale, std::size_t stride, double* values);

/// Writes weights times `fine` row by row.
/// \param fine as many rows as weights have columns; columns a multiple of kTableLanes
/// \param rows as many as weights have, of the columns of `fine`
void combine_rows(const Eigen::MatrixXd& weights, const RowMajorMatrix& fine, double* rows);

}  // namespace lobe
