#include <Eigen/SparseCore>
#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "core/parallel.hpp"
#include "core/text.hpp"
#include "lobe/core/error.hpp"
#include "lobe/table/table.hpp"
#include "table/cell_average.hpp"
#include "table/cell_overlap.hpp"
#include "table/evaluate.hpp"
#include "table/interpolator.hpp"
#include "table/nodes.hpp"
#include "table/norm.hpp"
#include "table/tabulate.hpp"

namespace lobe {
namespace {

constexpr double kResolved = 0.1;             // relative change of the squared norm
constexpr std::size_t kMostNodes = 4096;      // of cells, for which overlaps are taken as matrices
constexpr double kOverlapRounding = 1e-14;    // of sums over cells, relative to the largest value
constexpr std::size_t kMostPairs = 4U << 20;  // looked at to average an interpolated table, beside the least

using Shares = Eigen::SparseMatrix<double, Eigen::RowMajor>;
using Matrix = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;

/// For each two rings of the grids the largest part of a cell that cells of the other grid's ring cover.
Eigen::MatrixXd ring_shares(const Shares& shares, const HemisphereGrid& from, const HemisphereGrid& to) {
  Eigen::MatrixXd largest = Eigen::MatrixXd::Zero(static_cast<Eigen::Index>(to.rings().size()),
                                                  static_cast<Eigen::Index>(from.rings().size()));
  for (Eigen::Index i = 0; i < shares.rows(); ++i) {
    Eigen::RowVectorXd of_node = Eigen::RowVectorXd::Zero(largest.cols());
    for (Shares::InnerIterator entry(shares, i); entry; ++entry) {
      of_node(static_cast<Eigen::Index>(from.ring_of(static_cast<std::size_t>(entry.col())))) += entry.value();
    }
    auto row = largest.row(static_cast<Eigen::Index>(to.ring_of(static_cast<std::size_t>(i))));
    row = row.cwiseMax(of_node);
  }
  return largest;
}

/// Averages of a table that is constant on its cells over the cells of another grid, exact.
void average_cells(const BrdfTable& table, BrdfTable& result) {
  const BrdfTable source = to_general(table);
  const Shares shares = cell_overlaps(source.grid, result.grid);
  const Eigen::MatrixXd of_rings = ring_shares(shares, source.grid, result.grid);
  const auto n = static_cast<Eigen::Index>(source.grid.nodes());
  const auto from_rings = static_cast<Eigen::Index>(source.grid.rings().size());
  const auto rings = static_cast<Eigen::Index>(result.grid.rings().size());
  const HemisphereGrid& grid = result.grid;
  result.error.clear();
  for (std::size_t c = 0; c < result.channels; ++c) {
    const Eigen::Map<const Matrix> values(source.channel(c).data(), n, n);
    const Matrix halfway = shares * values;
    const Matrix averages = halfway * shares.transpose();
    const auto target = result.channel(c);
    if (result.form == TableForm::general) {
      std::copy_n(averages.data(), averages.size(), target.data());
    } else {
      const std::size_t half = grid.half_azimuths();
      for (std::size_t at = 0; at < target.size(); ++at) {
        const Ring& in = grid.rings()[at / half / grid.n_theta()];
        const Ring& out = grid.rings()[at / half % grid.n_theta()];
        target[at] =
            averages(static_cast<Eigen::Index>(in.first_node), static_cast<Eigen::Index>(out.first_node + at % half));
      }
    }
    const Eigen::Map<const Matrix> errors(source.error.data() + static_cast<Eigen::Index>(c) * from_rings * from_rings,
                                          from_rings, from_rings);
    const Matrix moved =
        ((of_rings * errors * of_rings.transpose()).array() + kOverlapRounding * values.cwiseAbs().maxCoeff()).matrix();
    result.error.insert(result.error.end(), moved.data(), moved.data() + rings * rings);
  }
  const auto move_part = [&](const std::vector<double>& parts, std::vector<double>& target) {
    if (parts.empty()) return;
    for (std::size_t c = 0; c < result.channels; ++c) {
      const Eigen::VectorXd moved =
          shares * Eigen::Map<const Eigen::VectorXd>(parts.data() + static_cast<Eigen::Index>(c) * n, n);
      for (std::size_t row = 0; row < result.rows(); ++row) {
        const std::size_t node = result.form == TableForm::isotropic ? grid.rings()[row].first_node : row;
        target.push_back(moved(static_cast<Eigen::Index>(node)));
      }
    }
  };
  move_part(source.mirror, result.mirror);
  move_part(source.retro, result.retro);
}

/// Averages of what a table is between its nodes over the cells of another grid.
void average_interpolation(const BrdfTable& table, const Interpolator& from, BrdfTable& result) {
  const auto values_at = [&](std::span<const Directions> pairs) {
    BrdfValues values;
    values.value.resize(static_cast<Eigen::Index>(pairs.size()), static_cast<Eigen::Index>(table.channels));
    values.error.resizeLike(values.value);
    for (std::size_t i = 0; i < pairs.size(); ++i) {
      const Directions& pair = pairs[i];
      for (std::size_t c = 0; c < table.channels; ++c) {
        const Estimate value = from.at(c, {pair.theta_in, pair.phi_in}, {pair.theta_out, pair.phi_in + pair.delta_phi});
        values.value(static_cast<Eigen::Index>(i), static_cast<Eigen::Index>(c)) = value.value;
        values.error(static_cast<Eigen::Index>(i), static_cast<Eigen::Index>(c)) = value.error;
      }
    }
    return values;
  };
  const bool is_isotropic = table.form == TableForm::isotropic;
  // An interpolation has nothing that is narrower than the distance of its rings.
  const double width = std::numbers::pi / 2 / static_cast<double>(table.grid.rings().size());
  average_over_cells({.name = table.expression,
                      .at = values_at,
                      .is_isotropic = is_isotropic,
                      .is_bilateral = is_isotropic,
                      .width = width,
                      .rounding = kOverlapRounding,
                      .effort = {.budget = kMostPairs}},
                     result, 2, {});
}

/// Values of what a table is between its nodes at the nodes of another grid.
void take_values(const Interpolator& from, BrdfTable& result) {
  const HemisphereGrid& grid = result.grid;
  const bool is_isotropic = result.form == TableForm::isotropic;
  const NodeSet rows = is_isotropic ? ring_nodes(grid, 1) : all_nodes(grid, 1);
  const NodeSet columns = is_isotropic ? half_nodes(grid, 1) : rows;
  const std::size_t count = columns.weights.size();
  const std::size_t rings = grid.rings().size();
  std::vector<double> row_errors(result.channels * result.rows() * rings);  // by row and ring of V
  for (std::size_t c = 0; c < result.channels; ++c) {
    parallel_for(result.rows(), [&](std::size_t i) {
      for (std::size_t j = 0; j < count; ++j) {
        const Estimate value = from.at(c, rows.directions.directions[i], columns.directions.directions[j]);
        result.channel(c)[i * count + j] = value.value;
        const std::size_t ring = is_isotropic ? j / grid.half_azimuths() : grid.ring_of(j);
        double& error = row_errors[(c * result.rows() + i) * rings + ring];
        if (!(value.error <= error)) error = value.error;
      }
    });
  }
  result.error.assign(result.channels * rings * rings, 0);
  for (std::size_t row = 0; row < result.channels * result.rows(); ++row) {
    const std::size_t channel = row / result.rows();
    const std::size_t i = row % result.rows();
    const std::size_t ring = is_isotropic ? i : grid.ring_of(i);
    for (std::size_t j = 0; j < rings; ++j) {
      double& error = result.error[(channel * rings + ring) * rings + j];
      if (!(row_errors[row * rings + j] <= error)) error = row_errors[row * rings + j];
    }
  }
}

/// Delta parts at the nodes of another grid, or their averages over its cells.
void take_deltas(const BrdfTable& table, const Interpolator& from, BrdfTable& result) {
  constexpr std::size_t kNodes = 8;  // of a ring
  const HemisphereGrid& grid = result.grid;
  const auto move_part = [&](const std::vector<double>& parts, std::vector<double>& target) {
    if (parts.empty()) return;
    for (std::size_t c = 0; c < result.channels; ++c) {
      for (std::size_t row = 0; row < result.rows(); ++row) {
        const std::size_t node = result.form == TableForm::isotropic ? grid.rings()[row].first_node : row;
        const RingRule rule = ring_rule(grid, node, kNodes);
        const auto share = [&](std::size_t k) {
          return from.row_part(parts, c, {rule.thetas[k], grid.directions()[node].phi}).value;
        };
        const double first = share(0);
        double change = 0;
        for (std::size_t k = 1; k < rule.thetas.size(); ++k) change += rule.weights[k] * (share(k) - first);
        target.push_back(first + change);
      }
    }
  };
  move_part(table.mirror, result.mirror);
  move_part(table.retro, result.retro);
}

}  // namespace

std::vector<std::vector<Estimate>> evaluate(const BrdfTable& table, std::span<const Directions> directions) {
  check(table);
  const Interpolator interpolator(table);
  std::vector<std::vector<Estimate>> values(table.channels);
  for (std::size_t c = 0; c < table.channels; ++c) {
    for (const auto& pair : directions) {
      if (!(pair.theta_in >= 0 && pair.theta_in <= std::numbers::pi / 2 && pair.theta_out >= 0 &&
            pair.theta_out <= std::numbers::pi / 2 && std::isfinite(pair.delta_phi) && std::isfinite(pair.phi_in))) {
        throw ArgumentError("directions (" + shortest(pair.theta_in) + ", " + shortest(pair.theta_out) + ", " +
                            shortest(pair.delta_phi) + ") rad; expected both theta in [0, pi/2]");
      }
      values[c].push_back(
          interpolator.at(c, {pair.theta_in, pair.phi_in}, {pair.theta_out, pair.phi_in + pair.delta_phi}));
    }
  }
  return values;
}

BrdfTable resample(const BrdfTable& table, const HemisphereGrid& grid) {
  check(table);
  if (table.grid == grid) return table;
  const Interpolator from(table);
  BrdfTable result;
  result.grid = grid;
  result.channels = table.channels;
  result.channel_names = table.channel_names;
  result.conventions = table.conventions;
  const bool is_isotropic = table.form == TableForm::isotropic && grid.is_product();
  result.form = is_isotropic ? TableForm::isotropic : TableForm::general;
  result.expression = "resample(" + table.expression + ", " + grid.name() + ")";
  result.source = {};
  result.resolution_error = std::numeric_limits<double>::quiet_NaN();
  result.is_unresolved = table.is_unresolved;

  result.values.resize(result.channels * result.size());
  if (table.grid.has_cells() && grid.has_cells() && table.grid.nodes() <= kMostNodes && grid.nodes() <= kMostNodes) {
    average_cells(table, result);
  } else {
    if (grid.has_cells()) {
      average_interpolation(table, from, result);
    } else {
      take_values(from, result);
    }
    take_deltas(table, from, result);
  }
  for (std::size_t c = 0; c < result.channels; ++c) {
    const double before = squared_norm(table, c);
    if (std::abs(squared_norm(result, c) - before) > kResolved * before) result.is_unresolved = true;
  }
  return result;
}

}  // namespace lobe
