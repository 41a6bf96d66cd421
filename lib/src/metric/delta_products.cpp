// Point products of delta parts with values: finite where norms are not.
#include "metric/delta_products.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <string>

#include "hemisphere/cubature.hpp"
#include "lobe/core/error.hpp"
#include "lobe/metric/metric.hpp"
#include "lobe/reflectance/adjusted.hpp"
#include "metric/domain.hpp"
#include "model/delta.hpp"
#include "model/delta_shares.hpp"
#include "model/lobes.hpp"
#include "reflectance/prepared.hpp"

namespace lobe {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using std::numbers::pi;

constexpr double kHighestTheta = pi / 2 - 1e-12;  // functions are defined above the horizon
constexpr std::size_t kMostDeltaPoints = 400'000;

/// The integrand over directions L: delta parts of one times values of the other, channels, then errors of these.
class DeltaIntegrand {
 public:
  DeltaIntegrand(const Device& device, const Reflectance& delta, const Reflectance& other, std::size_t channels,
                 Precision precision)
      : device_(device),
        deltas_(split_delta(*delta.formula()).deltas),
        own_channels_(delta.channels()),
        values_(smooth_function(device, other, precision)),
        channels_(static_cast<Index>(channels)) {}

  /// Per dmu, points x (channels, their errors).
  [[nodiscard]] MatrixXd at(std::span<const double> elevations, std::span<const double> azimuths) const {
    const DeltaParts parts = delta_parts(device_, deltas_, own_channels_, elevations);
    MatrixXd sums = MatrixXd::Zero(static_cast<Index>(elevations.size()), 2 * channels_);
    add(parts.mirror, pi, elevations, azimuths, sums);
    add(parts.retro, 0, elevations, azimuths, sums);
    return sums;
  }

 private:
  void add(const MatrixXd& shares, double delta_phi, std::span<const double> elevations,
           std::span<const double> azimuths, MatrixXd& sums) const {
    if (shares.size() == 0 || (shares.array() == 0).all()) return;
    std::vector<Directions> pairs;
    for (std::size_t k = 0; k < elevations.size(); ++k) {
      const double theta = std::clamp(pi / 2 - elevations[k], 0.0, kHighestTheta);
      pairs.push_back({theta, theta, delta_phi, azimuths[k]});
    }
    const BrdfValues found = values_.at(pairs);
    if (!found.value.allFinite()) {
      throw NumericError("'" + values_.name + "' has values that are no finite numbers");
    }
    for (Index c = 0; c < channels_; ++c) {
      const Index column = std::min(c, found.value.cols() - 1);
      const Index row = std::min(c, shares.rows() - 1);
      for (Index k = 0; k < sums.rows(); ++k) {
        sums(k, c) += shares(row, k) * found.value(k, column);
        if (found.error.size() > 0) sums(k, channels_ + c) += std::abs(shares(row, k)) * found.error(k, column);
      }
    }
  }

  Device device_;
  Material deltas_;
  std::size_t own_channels_;
  BrdfFunction values_;
  Index channels_;
};

/// Whether decades of the elevation towards the horizon add as much as ever.
bool grows_too_fast(const DeltaIntegrand& integrand, Index channels) {
  constexpr double kDecay = 0.8 * 0.8 * 0.8;  // over three decades
  constexpr double kRounding = 1e-12;
  constexpr std::size_t kTurns = 4;
  const auto added_at = [&](double elevation) {
    const std::vector<double> elevations(kTurns, elevation);
    std::vector<double> azimuths;
    for (std::size_t k = 0; k < kTurns; ++k) azimuths.push_back(pi / 2 * (static_cast<double>(k) + 0.3));
    return integrand.at(elevations, azimuths).leftCols(channels).colwise().sum().cwiseAbs().maxCoeff() * elevation *
           elevation;
  };
  const double last = added_at(1e-10);
  return last > kDecay * added_at(1e-7) && last > kRounding * added_at(0.1);
}

bool has_any(const MatrixXd& shares) {
  return shares.size() > 0 && (shares.array() != 0).any();
}

bool has_any(const std::vector<double>& shares) {
  return std::ranges::any_of(shares, [](double share) { return share != 0; });
}

/// The table that a reflectance is, or that of its cells; null: it is none.
const BrdfTable* table_with_deltas(const Reflectance& reflectance) {
  const BrdfFunction* function = reflectance.function();
  return function != nullptr ? function->cells.get() : reflectance.table();
}

/// Which delta parts there are: mirror, retro.
std::array<bool, 2> delta_kinds(const Device& device, const Reflectance& reflectance) {
  if (const Material* formula = reflectance.formula()) {
    constexpr std::array kElevations{0.01, 0.1, 0.3, 0.6, 0.9, 1.2, 1.5};
    const DeltaParts parts = delta_parts(device, split_delta(*formula).deltas, formula->channels(), kElevations);
    return {has_any(parts.mirror), has_any(parts.retro)};
  }
  const BrdfTable* table = table_with_deltas(reflectance);
  if (table == nullptr) return {false, false};
  return {has_any(table->mirror), has_any(table->retro)};
}

}  // namespace

Reflectance without_deltas(const Reflectance& reflectance) {
  if (!reflectance.has_delta()) return reflectance;
  if (const Material* formula = reflectance.formula()) return smooth_part(*formula);
  BrdfTable table = reflectance.table() != nullptr ? *reflectance.table() : *reflectance.function()->cells;
  table.mirror.clear();
  table.retro.clear();
  return table;
}

bool have_equal_deltas(const Device& device, const Reflectance& f, const Reflectance& g) {
  if (!f.has_delta() || !g.has_delta()) return false;
  if (f.formula() != nullptr && g.formula() != nullptr) {
    const std::array both{*adjusted(device, f).formula(), *adjusted(device, g).formula()};
    const LobeSet lobes = make_lobe_set(both, {.with_deltas = true, .with_anisotropic = true});
    const auto first = static_cast<Index>(lobes.smooth_lobes());
    return std::ranges::all_of(lobes.mix, [&](const auto& mix) {
      const MatrixXd deltas = MatrixXd(mix).rightCols(mix.cols() - first);
      return deltas.row(0) == deltas.row(1);
    });
  }
  const BrdfTable* of_f = table_with_deltas(f);
  const BrdfTable* of_g = table_with_deltas(g);
  return of_f != nullptr && of_g != nullptr && of_f->grid == of_g->grid && of_f->channels == of_g->channels &&
         of_f->mirror == of_g->mirror && of_f->retro == of_g->retro;
}

bool share_delta(const Device& device, const Reflectance& f, const Reflectance& g) {
  const auto of_f = delta_kinds(device, f);
  const auto of_g = delta_kinds(device, g);
  return (of_f[0] && of_g[0]) || (of_f[1] && of_g[1]);
}

std::vector<Estimate> delta_products(const Device& device, const Reflectance& delta, const Reflectance& other,
                                     std::size_t channels, const MetricOptions& options) {
  if (!delta.has_delta()) return std::vector<Estimate>(channels);
  const auto count = static_cast<Index>(channels);
  const DeltaIntegrand integrand(device, delta, other, channels, options.precision);
  const double lowest = std::asin(std::min(1.0, cos_of_domain(options.theta_max, Lighting::point())));
  if (lowest == 0 && grows_too_fast(integrand, count)) {
    throw NumericError("the point product of '" + delta.name() + "' and '" + other.name() +
                           "' is infinite: every decade of cos(theta) towards the horizon adds as much to it; " +
                           domain_advice(Lighting::point()),
                       {.fault = Fault::infinite_norm});
  }
  std::vector<PanelEdge> edges{{lowest, lowest == 0}, {1e-5}, {1e-3}, {0.03}, {0.1}, {0.3}, {0.6}, {1}, {pi / 2}};
  std::erase_if(edges, [&](const PanelEdge& edge) { return edge.at < lowest; });
  std::vector<Rectangle> rectangles;
  for (std::size_t k = 0; k + 1 < edges.size(); ++k) {
    for (const double from : {0.0, pi}) rectangles.push_back({{edges[k], edges[k + 1]}, {{from}, {from + pi}}});
  }
  const Integrands weighted = [&](std::span<const CubaturePoint> points) {
    std::vector<double> elevations;
    std::vector<double> azimuths;
    for (const CubaturePoint& point : points) {
      elevations.push_back(point.u);
      azimuths.push_back(point.v);
    }
    MatrixXd values = integrand.at(elevations, azimuths);
    for (Index k = 0; k < values.rows(); ++k) {
      values.row(k) *=
          std::sin(elevations[static_cast<std::size_t>(k)]) * std::cos(elevations[static_cast<std::size_t>(k)]);
    }
    return values;
  };
  const double tolerance =
      other.formula() != nullptr ? options.tolerance : std::max(options.tolerance, options.function_tolerance);
  const CubatureSums sums = integrate_rectangles(
      std::move(rectangles), weighted,
      {.relative = tolerance / 2, .most_points = kMostDeltaPoints, .steering = count, .has_errors = true});
  std::vector<Estimate> products;
  for (Index c = 0; c < count; ++c) {
    products.push_back({sums.value(c), sums.error(c) + sums.value(count + c) + sums.error(count + c)});
  }
  return products;
}

}  // namespace lobe
