#include "lobe/algebra/square_root.hpp"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <limits>

#include "algebra/formula_blocks.hpp"
#include "algebra/operator_blocks.hpp"
#include "core/decompositions.hpp"
#include "core/numbers.hpp"
#include "core/parallel.hpp"
#include "core/text.hpp"
#include "lobe/algebra/spectrum.hpp"
#include "lobe/core/error.hpp"
#include "lobe/table/cell_error.hpp"
#include "table/tabulate.hpp"

namespace lobe {
namespace {

using Eigen::Matrix2d;
using Eigen::MatrixXd;
using Eigen::VectorXd;

// Rounding of eigenvalues: by the decomposition, relative to the norm of the order, and by the table's own values,
// relative to that of the largest one.
constexpr double kDecomposition = 0.5 * std::numeric_limits<double>::epsilon();
constexpr double kTable = 0.1 * std::numeric_limits<double>::epsilon();
constexpr double kGridSafety = 1.5;  // of changes against a finer grid, which leave out its own error

/// The root of a symmetric 2x2 matrix >= 0, by its Cayley-Hamilton equation.
Matrix2d root_of_delta(const Matrix2d& matrix, const std::string& expression) {
  constexpr double kRounding = 1e-14;
  const double size = matrix.cwiseAbs().maxCoeff();
  if (size == 0) return Matrix2d::Zero();
  const double determinant = matrix.determinant();
  if (matrix.trace() < 0 || determinant < -kRounding * size * size ||
      std::abs(matrix(0, 1) - matrix(1, 0)) > kRounding * size) {
    throw NumericError("the delta parts of '" + expression + "' have no self-adjoint root: mirror " +
                       shortest(matrix(0, 1)) + " with rrim " + shortest(matrix(0, 0)) +
                       " is negative on half of all azimuthal orders; expected |mirror| <= rrim");
  }
  const double root = std::sqrt(std::max(determinant, 0.0));
  return (matrix + root * Matrix2d::Identity()) / std::sqrt(matrix.trace() + 2 * root);
}

/// \param floor eigenvalues below it are rounding of the table
MatrixXd root_of(const MatrixXd& block, double floor) {
  const Eigenpairs eigen = symmetric_eigenpairs((block + block.transpose()) / 2);
  const VectorXd roots = eigen.values.unaryExpr([&](double value) { return value > floor ? std::sqrt(value) : 0; });
  const MatrixXd root = eigen.vectors * roots.asDiagonal() * eigen.vectors.transpose();
  return (root + root.transpose()) / 2;  // to the bit
}

/// The root of the operator of smooth blocks and the delta parts of `table`, written as a channel of `root`, whose
/// delta parts have their sizes where there are any.
void store_root(OperatorBlocks blocks, const BrdfTable& table, std::size_t channel, BrdfTable& root) {
  add_delta(table, channel, 1, blocks);
  for (std::size_t row = 0; table.has_delta() && row < table.rows(); ++row) {
    set_delta(root_of_delta(delta_matrix(table, channel, row), table.expression), channel, row, root);
  }
  double largest = 0;
  for (const auto& block : blocks.blocks) largest = std::max(largest, block.norm());
  parallel_for(blocks.size(), [&](std::size_t b) {
    const double floor = kDecomposition * blocks.blocks[b].norm() + kTable * largest;
    blocks.blocks[b] = root_of(blocks.blocks[b], floor);
  });
  add_delta(root, channel, -1, blocks);
  store_smooth(blocks, channel, root);
}

/// A table for the root of another one.
BrdfTable root_frame(const BrdfTable& table) {
  BrdfTable root;
  root.grid = table.grid;
  root.form = table.form;
  root.channels = table.channels;
  root.channel_names = table.channel_names;
  root.values.resize(table.channels * table.size());
  if (table.has_delta()) {
    root.mirror.resize(table.channels * table.rows());
    root.retro.resize(table.channels * table.rows());
  }
  const std::size_t rings = table.grid.rings().size();
  root.error.assign(table.channels * rings * rings, kUnknown);
  root.expression = "square-root(" + table.expression + ")";
  root.resolution_error = kUnknown;
  root.is_unresolved = table.is_unresolved;
  return root;
}

/// Bounds on the errors of a root's values, from the root of its formulas on a finer grid, interpolated.
void measure_errors(const FormulaTable& formula, BrdfTable& root) {
  BrdfTable finer = root_frame(formula.frame());
  for (std::size_t c = 0; c < root.channels; ++c) store_root(formula.smooth_blocks(c), formula.frame(), c, finer);
  const std::size_t finer_rings = finer.grid.rings().size();
  finer.error.assign(finer.channels * finer_rings * finer_rings, 0);  // that of interpolation comes to it
  const BrdfTable moved = resample(finer, root.grid);
  const std::size_t half = root.grid.half_azimuths();
  for (std::size_t pair = 0; pair < root.error.size(); ++pair) {
    double change = 0;
    for (std::size_t at = pair * half; at < (pair + 1) * half; ++at) {
      change = std::max(change, std::abs(root.values[at] - moved.values[at]));
    }
    root.error[pair] = kGridSafety * change + moved.error[pair];
  }
}

/// Bounds on the errors of a root's values where operators are constant on cells, so that the values' errors are all:
/// |A^1/2 - B^1/2| <= |A - B|^1/2 for operators A, B >= 0, and no entry of a matrix exceeds its norm. What is negative
/// is cut off, which changes no Hilbert-Schmidt distance for the worse.
void bound_errors(const BrdfTable& table, BrdfTable& root) {
  const auto rings = root.grid.rings();
  for (std::size_t c = 0; c < root.channels; ++c) {
    const double change = std::sqrt(error_norms(table, c).hilbert_schmidt);
    for (std::size_t i = 0; i < rings.size(); ++i) {
      for (std::size_t j = 0; j < rings.size(); ++j) {
        root.error[(c * rings.size() + i) * rings.size() + j] = change / std::sqrt(rings[i].weight * rings[j].weight);
      }
    }
  }
}

Definiteness judge(const ChannelSpectrum& spectrum, double tolerance) {
  const Estimate& smallest = spectrum.smallest;
  if (smallest.value >= -tolerance * spectrum.norm.value) return Definiteness::semi_definite;
  return smallest.value < -smallest.error ? Definiteness::indefinite : Definiteness::undecided;
}

ChannelRoot describe(const BrdfTable& table, const BrdfTable& root, const ChannelSpectrum& spectrum,
                     const TableAlbedo& albedos, std::size_t channel, double tolerance) {
  ChannelRoot result;
  result.definiteness = judge(spectrum, tolerance);
  result.norm = spectrum.norm;
  result.smallest = spectrum.smallest;
  result.distance = spectrum.negative_norm;
  const Estimate square = spectrum.hilbert_schmidt.integral;
  const double norm = std::sqrt(square.value);
  result.relative_distance = {kUnknown, kUnknown};
  if (!table.has_delta() && norm > 0) {
    const double norm_error = square.error / (2 * norm);
    result.relative_distance = {result.distance.value / norm,
                                (result.distance.error + result.distance.value * norm_error / norm) / norm};
  }
  result.least_value = least_value(root, channel);
  const auto largest = std::ranges::max_element(albedos.in[channel], {}, &Estimate::value);
  result.largest_albedo = *largest;
  const auto row = static_cast<std::size_t>(largest - albedos.in[channel].begin());
  result.largest_albedo_theta =
      root.grid.rings()[root.form == TableForm::isotropic ? row : root.grid.ring_of(row)].theta;
  return result;
}

}  // namespace

SquareRoot square_root(const Device& device, const BrdfTable& table, const SquareRootOptions& options) {
  if (!(options.tolerance >= 0 && options.tolerance < 1)) {
    throw ArgumentError("tolerance " + shortest(options.tolerance) +
                        " of negative eigenvalues; expected one in [0, 1)");
  }
  SpectrumOptions spectrum_options;
  spectrum_options.progress = options.progress;
  const Spectrum values = spectrum(device, table, spectrum_options);
  for (const auto& channel : values.channels) {
    if (channel.is_self_adjoint) continue;
    throw NumericError("'" + table.expression + "' is not reciprocal (relative defect " +
                       shortest(channel.reciprocity_defect) +
                       "), which a self-composition is; expected its reciprocal part, half of it and of its transpose");
  }
  SquareRoot result{root_frame(table), {}};
  BrdfTable& root = result.table;
  for (std::size_t c = 0; c < table.channels; ++c) store_root(smooth_blocks(table, c), table, c, root);
  drop_zeros(root.mirror);
  drop_zeros(root.retro);
  if (table.form == TableForm::isotropic) {
    const auto formula = FormulaTable::make(device, table);
    if (formula && formula->is_finer()) measure_errors(*formula, root);
  }
  if (is_constant_on_cells(table)) bound_errors(table, root);
  const TableAlbedo albedos = row_albedos(root);
  for (std::size_t c = 0; c < table.channels; ++c) {
    result.channels.push_back(describe(table, root, values.channels[c], albedos, c, options.tolerance));
  }
  return result;
}

}  // namespace lobe
