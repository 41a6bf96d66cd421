#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "core/parallel.hpp"
#include "core/text.hpp"
#include "lobe/core/error.hpp"
#include "lobe/table/brdf_function.hpp"
#include "model/evaluate.hpp"
#include "table/cell_average.hpp"
#include "table/nodes.hpp"
#include "table/tabulate.hpp"

namespace lobe {
namespace {

constexpr double kRounding = 1e-12;  // of sums that cancel, as Zernike polynomials do, relative to the largest value

std::span<const Direction> points_of(const NodeSet& set, std::size_t node) {
  return std::span(set.directions.directions).subspan(node * set.directions.points, set.directions.points);
}

Directions pair_of(const Direction& in, const Direction& out) {
  return {in.theta, out.theta, out.phi - in.phi, in.phi};
}

Directions mirrored(const Directions& pair) {
  return {pair.theta_in, pair.theta_out, -pair.delta_phi, -pair.phi_in};
}

/// Sums of consecutive groups of rows, taken in turn: row i goes to i / points % count.
Eigen::MatrixXd group_means(const Eigen::MatrixXd& all, std::size_t count, std::size_t points) {
  const auto groups = static_cast<Eigen::Index>(count);
  Eigen::MatrixXd means = Eigen::MatrixXd::Zero(groups, all.cols());
  for (Eigen::Index i = 0; i < all.rows(); ++i) means.row(i / static_cast<Eigen::Index>(points) % groups) += all.row(i);
  return means / (static_cast<double>(all.rows()) / static_cast<double>(count));
}

/// A row of L: means over points of cells, columns x channels; errors are 0 where the function states none.
BrdfValues row_values(const BrdfFunction& brdf, std::span<const Direction> in, const NodeSet& columns,
                      bool is_mirrored = false) {
  std::vector<Directions> pairs;
  pairs.reserve(in.size() * columns.directions.directions.size());
  for (const Direction& from : in) {
    for (const Direction& to : columns.directions.directions) {
      const Directions pair = pair_of(from, to);
      pairs.push_back(is_mirrored ? mirrored(pair) : pair);
    }
  }
  const std::size_t points = columns.directions.points;
  const std::size_t count = columns.directions.count;
  BrdfValues values = brdf.at(pairs);
  if (in.size() * points > 1) values.value = group_means(values.value, count, points);
  if (values.error.size() == 0) {
    values.error = Eigen::MatrixXd::Zero(values.value.rows(), values.value.cols());
  } else if (in.size() * points > 1) {
    values.error = group_means(values.error, count, points);
  }
  return values;
}

/// The mean of both signs of delta_phi, columns x channels.
struct BothSigns {
  BrdfValues mean;
  Eigen::MatrixXd odd;  ///< half their difference
};

BothSigns both_signs(const BrdfFunction& brdf, std::span<const Direction> in, const NodeSet& columns) {
  BothSigns row{row_values(brdf, in, columns), {}};
  row.odd = Eigen::MatrixXd::Zero(row.mean.value.rows(), row.mean.value.cols());
  if (brdf.is_bilateral || !brdf.is_isotropic) return row;
  const BrdfValues other = row_values(brdf, in, columns, true);
  row.odd = (row.mean.value - other.value) / 2;
  row.mean.value = (row.mean.value + other.value) / 2;
  row.mean.error = (row.mean.error + other.error) / 2;
  return row;
}

/// Integral of f^2 dmu(V) for one row of L, by channel.
Eigen::VectorXd square_of(const Eigen::MatrixXd& row, const NodeSet& columns) {
  const Eigen::Map<const Eigen::VectorXd> weights(columns.weights.data(),
                                                  static_cast<Eigen::Index>(columns.weights.size()));
  return row.cwiseAbs2().transpose() * weights;
}

}  // namespace

/// Relative difference of the integrals of f^2 to those on the refined grid, mean over some rings of L; the worst
/// channel.
double resolution_of(const BrdfFunction& brdf, const HemisphereGrid& grid, std::size_t points) {
  constexpr std::size_t kRings = 16;  // that are looked at
  const NodeSet rows = ring_nodes(grid, 1);
  const bool is_even = brdf.is_isotropic && brdf.is_bilateral;
  const HemisphereGrid refined = grid.refined();
  const NodeSet coarse = is_even ? row_nodes(grid, points) : all_nodes(grid, points);
  const NodeSet fine = is_even ? row_nodes(refined, points) : all_nodes(refined, points);
  const std::size_t stride = (rows.weights.size() + kRings - 1) / kRings;
  const std::size_t count = (rows.weights.size() + stride - 1) / stride;
  std::vector<Eigen::VectorXd> differences(count);
  parallel_for(count, [&](std::size_t i) {
    const auto in = points_of(rows, i * stride);
    const Eigen::VectorXd exact = square_of(row_values(brdf, in, fine).value, fine);
    const Eigen::VectorXd found = square_of(row_values(brdf, in, coarse).value, coarse);
    differences[i] = (exact.array() > 0).select((found - exact).array().abs() / exact.array(), 0.0);
  });
  Eigen::VectorXd sum = Eigen::VectorXd::Zero(differences.front().size());
  double total = 0;
  for (std::size_t i = 0; i < count; ++i) {
    sum += rows.weights[i * stride] * differences[i];
    total += rows.weights[i * stride];
  }
  return sum.maxCoeff() / total;
}

namespace {

[[noreturn]] void refuse_values(const BrdfFunction& brdf) {
  throw NumericError("'" + brdf.name + "' has values that are no finite numbers");
}

/// A gauss grid that resolves a function, for messages.
std::string resolution_needed(const BrdfFunction& brdf, const HemisphereGrid& grid, double tolerance) {
  constexpr std::size_t kMostRings = 256;  // that are tried
  const std::size_t rings = grid.is_product() ? grid.n_theta() : 16;
  const std::size_t azimuths = grid.is_product() ? grid.n_phi() : 32;
  std::size_t factor = 2;
  for (; factor * rings <= kMostRings; factor *= 2) {
    const auto finer = HemisphereGrid::gauss(factor * rings, factor * azimuths);
    if (resolution_of(brdf, finer, 1) <= tolerance) return finer.name();
  }
  return "more than " + HemisphereGrid::gauss(factor / 2 * rings, factor / 2 * azimuths).name();
}

void check_resolution(BrdfTable& table, const BrdfFunction& brdf, const TabulateOptions& options) {
  table.resolution_error = resolution_of(brdf, table.grid, options.cell_points);
  if (!std::isfinite(table.resolution_error)) refuse_values(brdf);
  if (table.resolution_error <= options.tolerance) return;
  if (!options.allow_unresolved) {
    throw UnresolvedError(
        fmt::format("grid {} does not resolve '{}' (integrals of its square are off by {} %, expected at "
                    "most {} %); it needs {}",
                    table.grid.name(), brdf.name, shortest(std::round(table.resolution_error * 1000) / 10),
                    shortest(options.tolerance * 100), resolution_needed(brdf, table.grid, options.tolerance)));
  }
  table.is_unresolved = true;
}

/// A maximum that keeps NaN: unknown.
double larger_or_unknown(double a, double b) {
  return std::isnan(b) || b > a ? b : a;
}

/// Errors of one row of L, channels x rings of V.
struct RowErrors {
  std::vector<double> largest;
  std::vector<double> even, odd;  ///< mean squares over azimuth
};

/// Fills a table of values at nodes row by row.
class FunctionTabulator {
 public:
  FunctionTabulator(const BrdfFunction& brdf, BrdfTable& table)
      : brdf_(brdf),
        table_(table),
        rows_(is_isotropic() ? ring_nodes(table.grid, 1) : all_nodes(table.grid, 1)),
        columns_(is_isotropic() ? half_nodes(table.grid, 1) : rows_),
        rings_(table.grid.rings().size()),
        keeps_odd_part_(is_isotropic() && !brdf.is_bilateral) {
    const std::vector<double> none(table.channels * rings_, 0.0);
    errors_.assign(rows_.weights.size(), {none, none, none});
    table_.values.resize(table_.channels * table_.size());
    table_.error.assign(table_.channels * rings_ * rings_, 0.0);
    if (!keeps_odd_part_) return;
    table_.even_error = table_.error;
    table_.odd_part = table_.error;
  }

  [[nodiscard]] std::size_t rows() const { return rows_.weights.size(); }

  void fill(std::size_t row) {
    const auto in = points_of(rows_, row);
    const BothSigns found =
        is_isotropic() ? both_signs(brdf_, in, columns_) : BothSigns{row_values(brdf_, in, columns_), {}};
    const std::size_t half = is_isotropic() ? table_.grid.half_azimuths() : 1;
    RowErrors& errors = errors_[row];
    const std::size_t width = columns_.weights.size();
    for (std::size_t c = 0; c < table_.channels; ++c) {
      const auto channel = static_cast<Eigen::Index>(c);
      const double rounding = kRounding * found.mean.value.col(channel).cwiseAbs().maxCoeff();
      for (std::size_t k = 0; k < width; ++k) {
        const auto column = static_cast<Eigen::Index>(k);
        table_.values[c * table_.size() + row * width + k] = found.mean.value(column, channel);
        const std::size_t at = c * rings_ + (is_isotropic() ? k / half : table_.grid.ring_of(k));
        const double even = found.mean.error(column, channel) + rounding;
        const double odd = is_isotropic() ? std::abs(found.odd(column, channel)) : 0;
        errors.largest[at] = larger_or_unknown(errors.largest[at], even + odd);
        if (!keeps_odd_part_) continue;
        const bool is_end = k % half == 0 || k % half + 1 == half;
        const double share = (is_end ? 1 : 2) / static_cast<double>(table_.grid.n_phi());
        errors.even[at] += share * even * even;
        errors.odd[at] += share * odd * odd;
      }
    }
  }

  /// Once all rows are filled.
  void merge_errors() {
    for (std::size_t row = 0; row < errors_.size(); ++row) {
      const std::size_t ring = is_isotropic() ? row : table_.grid.ring_of(row);
      for (std::size_t c = 0; c < table_.channels; ++c) {
        for (std::size_t k = 0; k < rings_; ++k) {
          const std::size_t pair = (c * rings_ + ring) * rings_ + k;
          table_.error[pair] = larger_or_unknown(table_.error[pair], errors_[row].largest[c * rings_ + k]);
          if (!keeps_odd_part_) continue;
          table_.even_error[pair] = std::sqrt(errors_[row].even[c * rings_ + k]);
          table_.odd_part[pair] = std::sqrt(errors_[row].odd[c * rings_ + k]);
        }
      }
    }
  }

 private:
  [[nodiscard]] bool is_isotropic() const { return table_.form == TableForm::isotropic; }

  const BrdfFunction& brdf_;
  BrdfTable& table_;
  NodeSet rows_;
  NodeSet columns_;
  std::size_t rings_;
  bool keeps_odd_part_;
  std::vector<RowErrors> errors_;
};

}  // namespace

std::string resolution_needed(const BrdfFunction& brdf, const HemisphereGrid& grid, const TabulateOptions& options) {
  return brdf.cells ? brdf.cells->grid.name() : resolution_needed(brdf, grid, options.tolerance);
}

HemisphereGrid natural_grid(const BrdfFunction& brdf) {
  if (brdf.cells) return brdf.cells->grid;
  return HemisphereGrid::default_grid(brdf.is_isotropic);
}

BrdfTable natural_table(const BrdfFunction& brdf, const ProgressCallback& progress) {
  return tabulate(brdf, natural_grid(brdf), {.allow_unresolved = true, .progress = progress});
}

BrdfTable tabulate(const BrdfFunction& brdf, const HemisphereGrid& grid, const TabulateOptions& options) {
  if (brdf.cells) return resample(*brdf.cells, grid);
  constexpr std::size_t kBlock = 16;  // rows between reports of progress
  BrdfTable table;
  table.grid = grid;
  table.form = grid.is_product() && brdf.is_isotropic ? TableForm::isotropic : TableForm::general;
  table.channels = brdf.channels.size();
  table.channel_names = brdf.channels;
  table.conventions = brdf.format.empty() ? "" : brdf.format + ": " + brdf.conventions;
  table.expression = brdf.format.empty() ? brdf.name : brdf.name + " (" + brdf.format + ")";
  check_resolution(table, brdf, options);
  if (grid.has_cells()) {
    average_over_cells({.name = brdf.name,
                        .at = brdf.at,
                        .is_isotropic = brdf.is_isotropic,
                        .is_bilateral = brdf.is_isotropic && brdf.is_bilateral,
                        .is_concurrent = brdf.is_concurrent},
                       table, options.cell_points, options.progress);
    return table;
  }
  FunctionTabulator tabulator(brdf, table);
  for (std::size_t first = 0; first < tabulator.rows(); first += kBlock) {
    const double done = static_cast<double>(first) / static_cast<double>(tabulator.rows());
    if (options.progress && !options.progress("tabulating", done)) throw Cancelled("cancelled");
    parallel_for(std::min(kBlock, tabulator.rows() - first), [&](std::size_t k) { tabulator.fill(first + k); });
  }
  if (!std::ranges::all_of(table.values, [](double value) { return std::isfinite(value); })) refuse_values(brdf);
  tabulator.merge_errors();
  return table;
}

}  // namespace lobe
