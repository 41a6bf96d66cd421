#pragma once

#include <Eigen/SparseCore>

#include "lobe/hemisphere/grid.hpp"

namespace lobe {

/// Shares of cells in cells, exact: rows for the nodes of `to`, columns for those of `from`, each the part of the
/// row's cell (projected solid angle) that the column's cell covers. Rows sum to 1.
[[nodiscard]] Eigen::SparseMatrix<double, Eigen::RowMajor> cell_overlaps(const HemisphereGrid& from,
                                                                         const HemisphereGrid& to);

}  // namespace lobe
