#include "algebra/operator_blocks.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "algebra/smooth_product.hpp"
#include "core/decompositions.hpp"
#include "core/parallel.hpp"
#include "device/cosine_plan.hpp"
#include "table/delta_parts.hpp"

namespace lobe {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using RowMajor = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;

Eigen::VectorXd root_weights(const BrdfTable& table) {
  const auto scale = inner_scale(table.grid, table.form);
  return Eigen::Map<const Eigen::VectorXd>(scale.data(), index(scale.size()));
}

/// Coefficients of the sum over dphi_k = 2 pi k / n_phi, k = 0 .. n_phi/2, for each order, [k][m]. Ends count once.
MatrixXd transform(const HemisphereGrid& grid) {
  const std::size_t half = grid.n_phi() / 2;
  const double step = 2 * std::numbers::pi / static_cast<double>(grid.n_phi());
  MatrixXd matrix(half + 1, half + 1);
  for (std::size_t k = 0; k <= half; ++k) {
    for (std::size_t m = 0; m <= half; ++m) {
      matrix(index(k), index(m)) = (k == 0 || k == half ? 1 : 2) * step * cosine_of(m, k, half);
    }
  }
  return matrix;
}

/// The Fourier series at each dphi_k, [m][k].
MatrixXd inverse_transform(const HemisphereGrid& grid) {
  const std::size_t half = grid.n_phi() / 2;
  MatrixXd matrix(half + 1, half + 1);
  for (std::size_t m = 0; m <= half; ++m) {
    for (std::size_t k = 0; k <= half; ++k) {
      matrix(index(m), index(k)) = (m == 0 || m == half ? 1 : 2) / (2 * std::numbers::pi) * cosine_of(m, k, half);
    }
  }
  return matrix;
}

}  // namespace

OperatorBlocks smooth_blocks(const BrdfTable& table, std::size_t channel) {
  const std::size_t rows = table.rows();
  const Eigen::VectorXd scale = root_weights(table);
  OperatorBlocks result;
  if (table.form == TableForm::general) {
    const Eigen::Map<const RowMajor> values(table.channel(channel).data(), index(rows), index(rows));
    result.blocks = {scale.asDiagonal() * values * scale.asDiagonal()};
    result.multiplicities = {1};
    return result;
  }
  const std::size_t orders = table.grid.half_azimuths();
  const MatrixXd cosines = transform(table.grid);
  result.blocks.assign(orders, MatrixXd(rows, rows));
  result.multiplicities.assign(orders, 2);
  result.multiplicities.front() = result.multiplicities.back() = 1;
  parallel_for(rows, [&](std::size_t i) {
    const Eigen::Map<const RowMajor> values(table.channel(channel).data() + i * rows * orders, index(rows),
                                            index(orders));
    const MatrixXd by_order = values * cosines;
    for (std::size_t m = 0; m < orders; ++m) {
      result.blocks[m].row(index(i)) = scale(index(i)) * by_order.col(index(m)).cwiseProduct(scale).transpose();
    }
  });
  return result;
}

void add_delta(const BrdfTable& table, std::size_t channel, double sign, OperatorBlocks& blocks) {
  if (!table.has_delta()) return;
  const std::size_t rows = table.rows();
  for (std::size_t row = 0; row < rows; ++row) {
    const double retro = sign * delta_part(table.retro, channel * rows + row);
    const double mirror = sign * delta_part(table.mirror, channel * rows + row);
    const Index i = index(row);
    if (table.form == TableForm::general) {
      blocks.blocks.front()(i, i) += retro;
      blocks.blocks.front()(i, index(table.grid.opposite(row))) += mirror;
      continue;
    }
    // R multiplies cos(m phi) and sin(m phi) by (-1)^m.
    for (std::size_t m = 0; m < blocks.size(); ++m) blocks.blocks[m](i, i) += retro + (m % 2 == 0 ? mirror : -mirror);
  }
}

void store_smooth(const OperatorBlocks& blocks, std::size_t channel, BrdfTable& table) {
  const std::size_t rows = table.rows();
  const Eigen::VectorXd inverse_scale = root_weights(table).cwiseInverse();
  if (table.form == TableForm::general) {
    Eigen::Map<RowMajor> values(table.channel(channel).data(), index(rows), index(rows));
    values = inverse_scale.asDiagonal() * blocks.blocks.front() * inverse_scale.asDiagonal();
    return;
  }
  const std::size_t orders = blocks.size();
  const MatrixXd series = inverse_transform(table.grid);
  parallel_for(rows, [&](std::size_t i) {
    MatrixXd by_order(rows, orders);
    for (std::size_t m = 0; m < orders; ++m) {
      by_order.col(index(m)) =
          inverse_scale(index(i)) * blocks.blocks[m].row(index(i)).transpose().cwiseProduct(inverse_scale);
    }
    Eigen::Map<RowMajor>(table.channel(channel).data() + i * rows * orders, index(rows), index(orders)) =
        by_order * series;
  });
}

Eigen::Matrix2d delta_matrix(const BrdfTable& table, std::size_t channel, std::size_t row) {
  const std::size_t first = channel * table.rows();
  const std::size_t at = first + row;
  const std::size_t opposite = table.form == TableForm::isotropic ? at : first + table.grid.opposite(row);
  Eigen::Matrix2d matrix;
  matrix << delta_part(table.retro, at), delta_part(table.mirror, at), delta_part(table.mirror, opposite),
      delta_part(table.retro, opposite);
  return matrix;
}

void set_delta(const Eigen::Matrix2d& matrix, std::size_t channel, std::size_t row, BrdfTable& table) {
  const std::size_t at = channel * table.rows() + row;
  table.retro[at] = matrix(0, 0);
  table.mirror[at] = matrix(0, 1);
}

double squared_norm(const OperatorBlocks& blocks) {
  double sum = 0;
  for (std::size_t b = 0; b < blocks.size(); ++b) {
    sum += static_cast<double>(blocks.multiplicities[b]) * blocks.blocks[b].squaredNorm();
  }
  return sum;
}

ErrorNorms error_norms(const BrdfTable& table, std::size_t channel) {
  const auto rings = table.grid.rings();
  // Its order 0, which has the largest norm of all: the bounds do not depend on azimuth and are not negative.
  MatrixXd bound(rings.size(), rings.size());
  for (std::size_t i = 0; i < rings.size(); ++i) {
    for (std::size_t j = 0; j < rings.size(); ++j) {
      bound(index(i), index(j)) = table.error[(channel * rings.size() + i) * rings.size() + j] *
                                  std::sqrt(rings[i].weight * static_cast<double>(rings[i].count) * rings[j].weight *
                                            static_cast<double>(rings[j].count));
    }
  }
  if (!bound.allFinite()) {
    const double unknown = std::numeric_limits<double>::quiet_NaN();
    return {unknown, unknown};
  }
  const Eigenpairs squares = symmetric_eigenpairs(bound.transpose() * bound, false);
  return {std::sqrt(std::max(squares.values.maxCoeff(), 0.0)), bound.norm()};
}

void drop_zeros(std::vector<double>& parts) {
  if (std::ranges::all_of(parts, [](double part) { return part == 0; })) parts.clear();
}

}  // namespace lobe
