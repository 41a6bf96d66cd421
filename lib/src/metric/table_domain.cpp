#include "metric/table_domain.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <string>

#include "core/text.hpp"
#include "hemisphere/gauss.hpp"
#include "lobe/core/error.hpp"
#include "metric/domain.hpp"
#include "table/delta_parts.hpp"
#include "table/even_error.hpp"
#include "table/ring_bounds.hpp"

namespace lobe {
namespace {

using std::numbers::pi;

constexpr double kSameAngle = 1e-9;  // radians
constexpr std::size_t kStencil = 4;  // nodes of a cubic

std::string degrees_of(double angle) {
  return shortest(degrees_of_domain(angle));
}

double solid_angle(const Ring& ring) {
  return ring.weight * static_cast<double>(ring.count);
}

/// Weights w so that the sum of w h(x) is the integral of h(x) x dx over [lowest, 1], for cubics between falling nodes.
std::vector<double> cubic_weights(const std::vector<double>& nodes, double lowest) {
  const std::size_t count = nodes.size();
  const std::size_t stencil = std::min(kStencil, count);
  const GaussRule gauss = gauss_rule(3);  // exact for x times a cubic
  std::vector<double> weights(count);
  for (std::size_t panel = 0; panel <= count; ++panel) {
    const double high = panel == 0 ? 1 : nodes[panel - 1];
    const double low = panel == count ? lowest : std::max(nodes[panel], lowest);
    if (high <= lowest) break;
    const std::size_t before = std::min(panel, stencil / 2);
    const std::size_t first = std::min(panel - before, count - stencil);
    for (std::size_t k = 0; k < gauss.nodes.size(); ++k) {
      const double x = low + (high - low) * gauss.nodes[k];
      for (std::size_t i = first; i < first + stencil; ++i) {
        double basis = 1;
        for (std::size_t j = first; j < first + stencil; ++j) {
          if (j != i) basis *= (x - nodes[j]) / (nodes[i] - nodes[j]);
        }
        weights[i] += (high - low) * gauss.weights[k] * x * basis;
      }
    }
  }
  return weights;
}

RingWeights interpolated(const HemisphereGrid& grid, double theta_max) {
  const auto rings = grid.rings();
  const double lowest = std::max(0.0, std::cos(theta_max));
  std::vector<double> nodes;
  for (const Ring& ring : rings) nodes.push_back(std::cos(ring.theta));
  RingWeights weights{cubic_weights(nodes, lowest), {}, {}};
  for (double& weight : weights.full) weight *= 2 * pi;
  const auto every_second = [&](std::size_t first) {
    std::vector<double> kept;
    for (std::size_t r = first; r < rings.size(); r += 2) kept.push_back(nodes[r]);
    const auto own = cubic_weights(kept, lowest);
    std::vector<double> found(rings.size());
    for (std::size_t k = 0; k < kept.size(); ++k) found[first + 2 * k] = 2 * pi * own[k];
    return found;
  };
  weights.embedded = every_second(rings.size() == 1 ? 0 : 1);
  weights.other = rings.size() < 4 ? weights.embedded : every_second(0);
  return weights;
}

RingWeights whole_rings(const HemisphereGrid& grid, double theta_max) {
  const auto rings = grid.rings();
  const std::vector<double> none(rings.size());
  RingWeights weights{none, none, none};
  std::size_t count = 0;
  while (count < rings.size() && rings[count].theta_high <= theta_max + kSameAngle) ++count;
  const bool ends_on_limit = count == rings.size() || rings[count].theta_low >= theta_max - kSameAngle;
  if (!ends_on_limit || count == 0) {
    const std::string nearest = count == 0 ? "" : degrees_of(rings[count].theta_low) + " or ";
    throw ArgumentError("the domain ends at " + degrees_of(theta_max) +
                        " degrees, within a ring of cells of the grid " + grid.name() +
                        "; expected the limit of a ring, such as " + nearest + degrees_of(rings[count].theta_high));
  }
  for (std::size_t r = 0; r < count; ++r) {
    weights.full[r] = solid_angle(rings[r]);
    weights.embedded[std::min(r | 1U, count - 1)] += weights.full[r];
    weights.other[r & ~std::size_t{1}] += weights.full[r];
  }
  return weights;
}

/// Means over azimuths of a row's values on the rings of L, of all and of every second one: isotropic rows are rings
/// of V, general ones nodes.
struct RingMeans {
  double full = 0;
  double embedded = 0;
};

RingMeans mean_on_ring(const BrdfTable& table, std::size_t channel, std::size_t ring_in, std::size_t row) {
  const double* const values = table.channel(channel).data();
  RingMeans mean;
  if (table.form == TableForm::isotropic) {
    const std::size_t half = table.grid.half_azimuths();
    const double* const row_values = values + (ring_in * table.rows() + row) * half;
    const std::size_t step = table.grid.n_phi() % 4 == 0 ? 2 : 1;
    for (std::size_t k = 0; k < half; ++k) {
      const double term = (k == 0 || k + 1 == half ? 1 : 2) * row_values[k];
      mean.full += term;
      if (k % step == 0) mean.embedded += static_cast<double>(step) * term;
    }
    const auto count = static_cast<double>(table.grid.n_phi());
    return {mean.full / count, mean.embedded / count};
  }
  const Ring& in = table.grid.rings()[ring_in];
  const std::size_t step = in.count % 2 == 0 ? 2 : 1;
  for (std::size_t k = 0; k < in.count; ++k) {
    const double term = values[(in.first_node + k) * table.rows() + row];
    mean.full += term;
    if (k % step == 0) mean.embedded += static_cast<double>(step) * term;
  }
  const auto count = static_cast<double>(in.count);
  return {mean.full / count, mean.embedded / count};
}

}  // namespace

RingWeights ring_weights_up_to(const HemisphereGrid& grid, double theta_max) {
  return grid.has_cells() ? whole_rings(grid, theta_max) : interpolated(grid, theta_max);
}

std::vector<Estimate> albedos_up_to(const BrdfTable& table, std::size_t channel, const RingWeights& weights) {
  const auto rings = table.grid.rings();
  const bool is_isotropic = table.form == TableForm::isotropic;
  std::vector<double> values(table.rows());
  std::vector<double> changes(rings.size());
  for (std::size_t row = 0; row < table.rows(); ++row) {
    double embedded = 0;
    double other = 0;
    for (std::size_t i = 0; i < rings.size(); ++i) {
      const RingMeans mean = mean_on_ring(table, channel, i, row);
      values[row] += weights.full[i] * mean.full;
      embedded += weights.embedded[i] * mean.embedded;
      other += weights.other[i] * mean.embedded;
    }
    // Averages over cells sum up exactly.
    if (table.grid.has_cells()) continue;
    double& change = changes[is_isotropic ? row : table.grid.ring_of(row)];
    change = std::max(change, kEmbeddedSafety * std::hypot(values[row] - embedded, values[row] - other));
  }
  const auto quadrature = spread_over_rings(changes);
  std::vector<Estimate> albedos;
  for (std::size_t row = 0; row < table.rows(); ++row) {
    const std::size_t ring = is_isotropic ? row : table.grid.ring_of(row);
    double error = quadrature[ring];
    for (std::size_t i = 0; i < rings.size(); ++i) {
      error += std::abs(weights.full[i]) * even_errors(table, channel)[i * rings.size() + ring];
    }
    const std::size_t mirrored = is_isotropic ? row : table.grid.opposite(row);
    const double delta = delta_part(table.mirror, channel * table.rows() + mirrored) +
                         delta_part(table.retro, channel * table.rows() + row);
    albedos.push_back({values[row] + delta, error});
  }
  return albedos;
}

}  // namespace lobe
