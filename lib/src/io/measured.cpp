#include "lobe/measured.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "core/parallel.hpp"
#include "core/text.hpp"
#include "io/measured_formats.hpp"
#include "lobe/error.hpp"
#include "table/nodes.hpp"

namespace lobe {
namespace {

/// Samples of cells per coordinate where there are cells.
std::span<const Direction> samples_of(const NodeSet& set, std::size_t node) {
  return std::span(set.directions.directions).subspan(node * set.directions.samples, set.directions.samples);
}

Directions pair_of(const Direction& in, const Direction& out) {
  return {in.theta, out.theta, out.phi - in.phi, in.phi};
}

Directions mirrored(const Directions& pair) {
  return {pair.theta_in, pair.theta_out, -pair.delta_phi, -pair.phi_in};
}

/// Values of a row of L: mean over samples of cells, columns x channels.
Eigen::MatrixXd row_values(const MeasuredBrdf& brdf, std::span<const Direction> in, const NodeSet& columns,
                           bool is_mirrored) {
  std::vector<Directions> pairs;
  const std::size_t samples = columns.directions.samples;
  for (const Direction& from : in) {
    for (const Direction& to : columns.directions.directions) {
      const Directions pair = pair_of(from, to);
      pairs.push_back(is_mirrored ? mirrored(pair) : pair);
    }
  }
  const Eigen::MatrixXd values = brdf.evaluate(pairs);
  const auto count = static_cast<Eigen::Index>(columns.directions.count);
  Eigen::MatrixXd means = Eigen::MatrixXd::Zero(count, values.cols());
  for (Eigen::Index i = 0; i < values.rows(); ++i) {
    means.row(i / static_cast<Eigen::Index>(samples) % count) += values.row(i);
  }
  return means / static_cast<double>(samples * in.size());
}

/// Integral of f^2 dmu(V) for one row of L, by channel.
Eigen::VectorXd square_of(const Eigen::MatrixXd& row, const NodeSet& columns) {
  const Eigen::Map<const Eigen::VectorXd> weights(columns.weights.data(),
                                                  static_cast<Eigen::Index>(columns.weights.size()));
  return row.cwiseAbs2().transpose() * weights;
}

/// Relative difference of the integrals of f^2 to those on the refined grid, mean over L; the worst channel.
double resolution_of(const MeasuredBrdf& brdf, const HemisphereGrid& grid, std::size_t samples) {
  const NodeSet rows = ring_nodes(grid, 1);
  const NodeSet coarse = row_nodes(grid, samples);
  const NodeSet fine = row_nodes(grid.refined(), samples);
  std::vector<Eigen::VectorXd> differences(rows.weights.size());
  parallel_for(rows.weights.size(), [&](std::size_t row) {
    const auto in = samples_of(rows, row);
    const Eigen::VectorXd exact = square_of(row_values(brdf, in, fine, false), fine);
    const Eigen::VectorXd found = square_of(row_values(brdf, in, coarse, false), coarse);
    differences[row] = (exact.array() > 0).select((found - exact).array().abs() / exact.array(), 0.0);
  });
  Eigen::VectorXd sum = Eigen::VectorXd::Zero(differences.front().size());
  double total = 0;
  for (std::size_t row = 0; row < differences.size(); ++row) {
    sum += rows.weights[row] * differences[row];
    total += rows.weights[row];
  }
  return sum.maxCoeff() / total;
}

/// The same reflectance, of which only angles up to a limit count.
class Limited : public MeasuredBrdf {
 public:
  Limited(std::unique_ptr<MeasuredBrdf> brdf, double theta_max)
      : MeasuredBrdf(with_limit(brdf->info(), theta_max)), brdf_(std::move(brdf)), theta_max_(theta_max) {}

  [[nodiscard]] Eigen::MatrixXd evaluate(std::span<const Directions> pairs) const override {
    std::vector<Directions> limited(pairs.begin(), pairs.end());
    for (Directions& pair : limited) {
      pair.theta_in = std::min(pair.theta_in, theta_max_);
      pair.theta_out = std::min(pair.theta_out, theta_max_);
    }
    return brdf_->evaluate(limited);
  }

 private:
  static MeasuredInfo with_limit(MeasuredInfo info, double theta_max) {
    info.conventions += fmt::format("; beyond {} degrees the values there",
                                    shortest(std::round(theta_max * 180 / std::numbers::pi * 1e6) / 1e6));
    return info;
  }

  std::unique_ptr<MeasuredBrdf> brdf_;
  double theta_max_;
};

std::unique_ptr<MeasuredBrdf> load_format(const std::filesystem::path& path, const MeasuredOptions& options) {
  std::error_code ignored;
  if (!std::filesystem::is_regular_file(path, ignored)) {
    throw IoError("cannot read " + path.string() + ": there is no such file");
  }
  if (is_zernike_expansion(path)) return load_zernike_expansion(path, options);
  if (!options.wavelengths.empty()) {
    throw ArgumentError(path.string() + " does not depend on the wavelength; expected no wavelengths");
  }
  if (is_neural_encoding(path)) return load_neural_encoding(path);
  throw IoError("cannot read " + path.string() +
                ": it is of no known format; expected an NBRDF neural encoding (.h5) or Zernike coefficients of NIST");
}

}  // namespace

std::unique_ptr<MeasuredBrdf> load_measured(const std::filesystem::path& path, const MeasuredOptions& options) {
  if (!(options.theta_max > 0 && options.theta_max <= std::numbers::pi / 2)) {
    throw ArgumentError("the largest angle of a measurement is out of range; expected a value in (0, 90] degrees");
  }
  auto brdf = load_format(path, options);
  if (options.theta_max == std::numbers::pi / 2) return brdf;
  return std::make_unique<Limited>(std::move(brdf), options.theta_max);
}

BrdfTable tabulate(const MeasuredBrdf& brdf, const HemisphereGrid& grid, const TabulateOptions& options) {
  constexpr double kRounding = 1e-12;  // of sums that cancel, as Zernike polynomials do, relative to the largest value
  constexpr std::size_t kBlock = 16;   // rows between reports of progress
  BrdfTable table;
  table.grid = grid;
  table.form = grid.is_product() ? TableForm::isotropic : TableForm::general;
  table.channels = brdf.info().channels.size();
  table.expression = brdf.info().name + " (" + brdf.info().format + ")";
  table.resolution_error = resolution_of(brdf, grid, options.samples);
  if (!std::isfinite(table.resolution_error)) {
    throw NumericError("'" + brdf.info().name + "' has values that are no finite numbers");
  }
  if (table.resolution_error > options.tolerance) {
    if (!options.allow_unresolved) {
      throw NumericError(
          fmt::format("grid {} does not resolve '{}' (integrals of its square are off by {} %, expected at "
                      "most {} %); take a finer one",
                      grid.name(), brdf.info().name, shortest(std::round(table.resolution_error * 1000) / 10),
                      shortest(options.tolerance * 100)));
    }
    table.is_unresolved = true;
  }
  const bool is_isotropic = table.form == TableForm::isotropic;
  const NodeSet rows = is_isotropic ? ring_nodes(grid, options.samples) : all_nodes(grid, options.samples);
  const NodeSet columns = is_isotropic ? half_nodes(grid, options.samples) : rows;
  const std::size_t rings = grid.rings().size();
  const std::size_t width = columns.weights.size();
  table.values.resize(table.channels * table.size());
  table.error.assign(table.channels * rings * rings, 0.0);
  std::vector<std::vector<double>> errors(rows.weights.size(), std::vector<double>(table.channels * rings, 0.0));
  const auto fill_row = [&](std::size_t row) {
    const auto in = samples_of(rows, row);
    const Eigen::MatrixXd forward = row_values(brdf, in, columns, false);
    const Eigen::MatrixXd backward = is_isotropic ? row_values(brdf, in, columns, true) : forward;
    for (std::size_t c = 0; c < table.channels; ++c) {
      const double largest = forward.col(static_cast<Eigen::Index>(c)).cwiseAbs().maxCoeff();
      for (std::size_t k = 0; k < width; ++k) {
        const auto at = std::pair(static_cast<Eigen::Index>(k), static_cast<Eigen::Index>(c));
        const double value = (forward(at.first, at.second) + backward(at.first, at.second)) / 2;
        const double asymmetry = std::abs(forward(at.first, at.second) - backward(at.first, at.second)) / 2;
        table.values[c * table.size() + row * width + k] = value;
        double& error = errors[row][c * rings + (is_isotropic ? k / grid.half_azimuths() : grid.ring_of(k))];
        error = std::max(error, asymmetry + kRounding * largest);
      }
    }
  };
  for (std::size_t first = 0; first < rows.weights.size(); first += kBlock) {
    const double done = static_cast<double>(first) / static_cast<double>(rows.weights.size());
    if (options.progress && !options.progress("tabulating", done)) throw Cancelled("cancelled");
    parallel_for(std::min(kBlock, rows.weights.size() - first), [&](std::size_t k) { fill_row(first + k); });
  }
  if (!std::ranges::all_of(table.values, [](double value) { return std::isfinite(value); })) {
    throw NumericError("'" + brdf.info().name + "' has values that are no finite numbers");
  }
  for (std::size_t row = 0; row < errors.size(); ++row) {
    const std::size_t ring = is_isotropic ? row : grid.ring_of(row);
    for (std::size_t c = 0; c < table.channels; ++c) {
      for (std::size_t k = 0; k < rings; ++k) {
        double& error = table.error[(c * rings + ring) * rings + k];
        error = std::max(error, errors[row][c * rings + k]);
      }
    }
  }
  return table;
}

}  // namespace lobe
