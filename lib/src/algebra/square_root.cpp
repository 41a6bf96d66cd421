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
#include "lobe/algebra/algebra.hpp"
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
constexpr double kRootSafety = 4;    // of changes against a coarser grid; chosen by cases that need 2.7

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

/// Two thirds of the rings and azimuths.
HemisphereGrid coarser_grid(const HemisphereGrid& grid) {
  const std::size_t rings = std::max<std::size_t>(2, 2 * grid.n_theta() / 3);
  return HemisphereGrid::gauss(rings, std::max<std::size_t>(4, grid.n_phi() / 3 * 2));
}

/// Bounds on the errors of a root's values where no formulas are known: its change against the root on a coarser grid,
/// which has the larger error, and what the errors of the values do.
void measure_errors_below(const BrdfTable& table, BrdfTable& root) {
  const BrdfTable coarser = resample(table, coarser_grid(table.grid));
  BrdfTable coarse = root_frame(coarser);
  for (std::size_t c = 0; c < root.channels; ++c) store_root(smooth_blocks(coarser, c), coarser, c, coarse);
  const std::size_t coarse_rings = coarse.grid.rings().size();
  coarse.error.assign(coarse.channels * coarse_rings * coarse_rings, 0);
  const BrdfTable moved = resample(coarse, root.grid);
  bound_errors(table, root);
  const std::size_t rings = root.grid.rings().size();
  std::vector<double> changes(root.error.size(), 0.0);
  for (std::size_t c = 0; c < root.channels; ++c) {
    for (std::size_t at = 0; at < root.size(); ++at) {
      const std::size_t pair = root.form == TableForm::isotropic
                                   ? at / root.grid.half_azimuths()
                                   : root.grid.ring_of(at / root.rows()) * rings + root.grid.ring_of(at % root.rows());
      double& change = changes[c * rings * rings + pair];
      change = std::max(change, std::abs(root.channel(c)[at] - moved.channel(c)[at]));
    }
  }
  // Between two rings both roots may agree by chance, so that the neighbours count, too.
  const auto largest_about = [&](std::size_t c, std::size_t i, std::size_t j) {
    double largest = 0;
    for (std::size_t k = i - std::min<std::size_t>(i, 1); k < std::min(i + 2, rings); ++k) {
      for (std::size_t l = j - std::min<std::size_t>(j, 1); l < std::min(j + 2, rings); ++l) {
        largest = std::max(largest, changes[(c * rings + k) * rings + l]);
      }
    }
    return largest;
  };
  for (std::size_t c = 0; c < root.channels; ++c) {
    for (std::size_t i = 0; i < rings; ++i) {
      for (std::size_t j = 0; j < rings; ++j) {
        root.error[(c * rings + i) * rings + j] += kRootSafety * largest_about(c, i, j);
      }
    }
  }
}

Definiteness judge(const ChannelSpectrum& spectrum, double tolerance) {
  const Estimate& smallest = spectrum.smallest;
  if (smallest.value >= -tolerance * spectrum.norm.value) return Definiteness::semi_definite;
  return smallest.value < -smallest.error ? Definiteness::indefinite : Definiteness::undecided;
}

/// Half of T and of its adjoint, the nearest reciprocal operator.
BrdfTable reciprocal_part(const BrdfTable& table) {
  return mix(std::vector<double>{0.5, 0.5}, std::vector<BrdfTable>{table, transpose(table)}, true);
}

/// The norm of what is left of T beside its reciprocal part.
Estimate skew_part(const ChannelSpectrum& spectrum) {
  const Estimate& square = spectrum.hilbert_schmidt.integral;
  const double norm = std::sqrt(std::max(square.value, 0.0));
  const double error = norm > 0 ? square.error / (2 * norm) : 0;
  return {spectrum.reciprocity_defect * norm, spectrum.reciprocity_defect * error};
}

/// \param skew norm of the part of T that was left out before, orthogonal to the rest
ChannelRoot describe(const BrdfTable& table, const BrdfTable& root, const ChannelSpectrum& spectrum,
                     const Estimate& skew, const TableAlbedo& albedos, std::size_t channel, double tolerance) {
  ChannelRoot result;
  result.skew = skew;
  result.definiteness = judge(spectrum, tolerance);
  result.norm = spectrum.norm;
  result.smallest = spectrum.smallest;
  result.distance = spectrum.negative_norm;
  if (skew.value > 0) {
    const double both = std::hypot(result.distance.value, skew.value);
    result.distance.error = (result.distance.value * result.distance.error + skew.value * skew.error) / both;
    result.distance.value = both;
  }
  const Estimate square = spectrum.hilbert_schmidt.integral;
  const double norm = std::hypot(std::sqrt(square.value), skew.value);
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

SquareRoot square_root(const Device& device, const BrdfTable& given, const SquareRootOptions& options) {
  if (!(options.tolerance >= 0 && options.tolerance < 1)) {
    throw ArgumentError("tolerance " + shortest(options.tolerance) +
                        " of negative eigenvalues; expected one in [0, 1)");
  }
  SpectrumOptions spectrum_options;
  spectrum_options.progress = options.progress;
  Spectrum values = spectrum(device, given, spectrum_options);
  const bool is_reciprocal = std::ranges::all_of(values.channels, &ChannelSpectrum::is_self_adjoint);
  std::vector<Estimate> skew;
  for (const auto& channel : values.channels) skew.push_back(is_reciprocal ? Estimate{0, 0} : skew_part(channel));
  const BrdfTable table = is_reciprocal ? given : reciprocal_part(given);
  if (!is_reciprocal) values = spectrum(device, table, spectrum_options);
  SquareRoot result{root_frame(table), {}};
  result.table.expression = "square-root(" + given.expression + ")";
  BrdfTable& root = result.table;
  for (std::size_t c = 0; c < table.channels; ++c) store_root(smooth_blocks(table, c), table, c, root);
  drop_zeros(root.mirror);
  drop_zeros(root.retro);
  if (table.form == TableForm::isotropic) {
    const auto formula = FormulaTable::make(device, table);
    if (formula && formula->is_finer()) measure_errors(*formula, root);
  }
  if (is_constant_on_cells(table)) {
    bound_errors(table, root);
  } else if (std::ranges::any_of(root.error, [](double error) { return std::isnan(error); })) {
    measure_errors_below(table, root);
  }
  const TableAlbedo albedos = row_albedos(root);
  for (std::size_t c = 0; c < table.channels; ++c) {
    result.channels.push_back(describe(table, root, values.channels[c], skew[c], albedos, c, options.tolerance));
  }
  return result;
}

}  // namespace lobe
