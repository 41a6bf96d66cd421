#include "table/interpolator.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <span>

namespace lobe {
namespace {

/// Coefficients of the Lagrange polynomial through `nodes` at x.
void lagrange(std::span<const double> nodes, double x, double* coefficients) {
  for (std::size_t i = 0; i < nodes.size(); ++i) {
    double product = 1;
    for (std::size_t j = 0; j < nodes.size(); ++j) {
      if (j != i) product *= (x - nodes[j]) / (nodes[i] - nodes[j]);
    }
    coefficients[i] = product;
  }
}

constexpr std::size_t kMostLocalNodes = 6;  // of a local polynomial

/// Change that a kink among six values may cause between the middle ones, where polynomials of any degree may agree by
/// accident: a share of the fourth differences. Those of a kink are no smaller than the second and third ones; of
/// smooth values they fall, and count by the eighth power of how far.
double kink_of(std::span<const double> values) {
  constexpr double kShare = 0.2;
  if (values.size() < kMostLocalNodes) return 0;
  std::array<double, kMostLocalNodes> differences{};
  std::ranges::copy(values, differences.begin());
  std::array<double, 5> largest{};  // by order
  for (std::size_t order = 1; order < largest.size(); ++order) {
    for (std::size_t k = 0; k + order < kMostLocalNodes; ++k) {
      differences[k] = differences[k + 1] - differences[k];
      largest[order] = std::max(largest[order], std::abs(differences[k]));
    }
  }
  const double fourth = largest[4];
  const double lower = std::max(largest[2], largest[3]);
  if (fourth >= lower) return kShare * fourth;
  const double fall = (fourth / lower) * (fourth / lower);
  return kShare * fourth * fall * fall * fall * fall;
}

/// The mean of theta over a ring, by projected solid angle.
double mean_theta(const Ring& ring) {
  const auto moment = [](double theta) { return std::sin(2 * theta) / 4 - theta * std::cos(2 * theta) / 2; };
  // cos 2a - cos 2b = 2 sin(b + a) sin(b - a)
  const double measure = std::sin(ring.theta_high + ring.theta_low) * std::sin(ring.theta_high - ring.theta_low);
  return (moment(ring.theta_high) - moment(ring.theta_low)) / measure;
}

/// Values on the nodes of theta_in and on those of theta_out, interpolated in all other coordinates.
struct AlongThetas {
  std::array<double, kMostLocalNodes> in{};
  std::array<double, kMostLocalNodes> out{};
};

/// A value of degree 5 in all coordinates, and those of lower degree in one of them.
template <std::size_t Coordinates>
struct Changes {
  static constexpr std::size_t kRules = 4;

  double value = 0;
  std::array<std::array<double, kRules>, Coordinates> lower{};
  std::array<double, Coordinates> kinks{};  ///< kink_of() the values along a coordinate

  /// The value, and the sum over coordinates of the largest change.
  [[nodiscard]] Estimate estimate() const {
    double sum = 0;
    for (std::size_t c = 0; c < Coordinates; ++c) {
      double largest = kinks[c];
      for (std::size_t r = 1; r < kRules; ++r) largest = std::max(largest, std::abs(value - lower[c][r]));
      sum += largest;
    }
    return {value, sum};
  }
};

}  // namespace

Interpolator::Interpolator(const BrdfTable& table) : table_(table) {
  const auto rings = table.grid.rings();
  for (std::size_t r = rings.size(); r-- > 0;) thetas_.push_back(-rings[r].theta);
  for (const Ring& ring : rings) thetas_.push_back(ring.theta);
}

void Interpolator::fill_rules(Stencil& stencil, std::span<const double> nodes, double x) {
  const std::size_t size = nodes.size();
  lagrange(nodes, x, stencil.rules[0].data());
  const std::size_t inner = std::min<std::size_t>(4, size > 2 ? size - 2 : 1);
  const std::size_t outer = std::min<std::size_t>(5, size > 1 ? size - 1 : 1);
  const auto above = static_cast<std::size_t>(std::ranges::upper_bound(nodes, x) - nodes.begin());
  const std::size_t middle = std::min(above > inner / 2 ? above - inner / 2 : 0, size - inner);
  lagrange(nodes.subspan(middle, inner), x, stencil.rules[1].data() + middle);
  lagrange(nodes.first(outer), x, stencil.rules[2].data());
  lagrange(nodes.last(outer), x, stencil.rules[3].data() + (size - outer));
}

Interpolator::Stencil Interpolator::theta_stencil(double theta) const {
  Stencil stencil;
  stencil.size = std::min(kNodes, thetas_.size());
  const auto above = static_cast<std::size_t>(std::ranges::upper_bound(thetas_, theta) - thetas_.begin());
  const std::size_t half = stencil.size / 2;
  const std::size_t first = std::min(above > half ? above - half : 0, thetas_.size() - stencil.size);
  for (std::size_t s = 0; s < stencil.size; ++s) {
    stencil.index[s] = static_cast<long>(first + s) - static_cast<long>(thetas_.size() / 2);
  }
  fill_rules(stencil, std::span(thetas_).subspan(first, stencil.size), theta);
  stencil.spans_normal = stencil.index[0] < 0;
  return stencil;
}

Interpolator::Stencil Interpolator::one_sided_stencil(double theta) const {
  Stencil stencil;
  const std::size_t rings = thetas_.size() / 2;
  stencil.size = std::min<std::size_t>(4, rings);
  for (std::size_t s = 0; s < stencil.size; ++s) stencil.index[s] = static_cast<long>(s);
  fill_rules(stencil, std::span(thetas_).subspan(rings, stencil.size), theta);
  return stencil;
}

Interpolator::Stencil Interpolator::azimuth_stencil(double phi) const {
  const double position = phi / (2 * std::numbers::pi) * static_cast<double>(table_.grid.n_phi());
  const auto below = static_cast<long>(std::floor(position));
  Stencil stencil;
  stencil.size = kNodes;
  std::array<double, kNodes> nodes{};
  for (std::size_t s = 0; s < kNodes; ++s) {
    stencil.index[s] = below - 2 + static_cast<long>(s);
    nodes[s] = static_cast<double>(stencil.index[s]);
  }
  fill_rules(stencil, nodes, position);
  return stencil;
}

double Interpolator::node_error(std::size_t channel, const Stencil& in, const Stencil& out) const {
  const std::size_t rings = table_.grid.rings().size();
  const auto ring = [](long index) { return static_cast<std::size_t>(index < 0 ? -1 - index : index); };
  double worst = 0;
  for (std::size_t i = 0; i < in.size; ++i) {
    for (std::size_t j = 0; j < out.size; ++j) {
      const double error = table_.error[(channel * rings + ring(in.index[i])) * rings + ring(out.index[j])];
      // Maximum that keeps NaN, which stands for an unknown error.
      if (!(error <= worst)) worst = error;
    }
  }
  return worst;
}

Estimate Interpolator::isotropic_sum(std::size_t channel, const Stencil& theta_in, const Stencil& theta_out,
                                     double delta_phi) const {
  const Stencil azimuth = azimuth_stencil(delta_phi);
  const auto rings = static_cast<long>(table_.grid.n_theta());
  const auto count = static_cast<long>(table_.grid.n_phi());
  const auto half = static_cast<long>(table_.grid.half_azimuths());
  const double* const values = table_.channel(channel).data();
  Changes<3> changes;
  AlongThetas along;
  for (std::size_t a = 0; a < theta_in.size; ++a) {
    for (std::size_t b = 0; b < theta_out.size; ++b) {
      const long i = theta_in.index[a];
      const long j = theta_out.index[b];
      const long turn = (i < 0) != (j < 0) ? count / 2 : 0;
      const long block = (i < 0 ? -1 - i : i) * rings + (j < 0 ? -1 - j : j);
      std::array<double, kRules> sums{};
      for (std::size_t c = 0; c < azimuth.size; ++c) {
        const long k = (((azimuth.index[c] + turn) % count) + count) % count;
        const double value = values[block * half + (k < half ? k : count - k)];
        for (std::size_t r = 0; r < kRules; ++r) sums[r] += azimuth.rules[r][c] * value;
      }
      const double in = theta_in.rules[0][a];
      const double out = theta_out.rules[0][b];
      changes.value += in * out * sums[0];
      along.in[a] += out * sums[0];
      along.out[b] += in * sums[0];
      for (std::size_t r = 1; r < kRules; ++r) {
        changes.lower[0][r] += theta_in.rules[r][a] * out * sums[0];
        changes.lower[1][r] += in * theta_out.rules[r][b] * sums[0];
        changes.lower[2][r] += in * out * sums[r];
      }
    }
  }
  changes.kinks = {kink_of(std::span(along.in).first(theta_in.size)),
                   kink_of(std::span(along.out).first(theta_out.size)), 0};
  return changes.estimate();
}

Estimate Interpolator::general_sum(std::size_t channel, const Stencil& theta_in, const Stencil& theta_out, double in,
                                   double out) const {
  const Stencil phi_in = azimuth_stencil(in);
  const Stencil phi_out = azimuth_stencil(out);
  const auto count = static_cast<long>(table_.grid.n_phi());
  const std::size_t nodes = table_.grid.nodes();
  const double* const values = table_.channel(channel).data();
  const auto node = [count](long ring, long azimuth) {
    const long turned = ring < 0 ? azimuth + count / 2 : azimuth;
    return static_cast<std::size_t>((ring < 0 ? -1 - ring : ring) * count + ((turned % count) + count) % count);
  };
  Changes<4> changes;
  AlongThetas along;
  for (std::size_t a = 0; a < theta_in.size; ++a) {
    for (std::size_t p = 0; p < phi_in.size; ++p) {
      const double* const row = values + node(theta_in.index[a], phi_in.index[p]) * nodes;
      // Sums over V: of degree 5, and with a lower degree in theta or in azimuth.
      const double weight = theta_in.rules[0][a] * phi_in.rules[0][p];
      double sum = 0;
      std::array<double, kRules> theta_sums{};
      std::array<double, kRules> phi_sums{};
      for (std::size_t b = 0; b < theta_out.size; ++b) {
        for (std::size_t q = 0; q < phi_out.size; ++q) {
          const double value = row[node(theta_out.index[b], phi_out.index[q])];
          sum += theta_out.rules[0][b] * phi_out.rules[0][q] * value;
          along.out[b] += weight * phi_out.rules[0][q] * value;
          for (std::size_t r = 1; r < kRules; ++r) {
            theta_sums[r] += theta_out.rules[r][b] * phi_out.rules[0][q] * value;
            phi_sums[r] += theta_out.rules[0][b] * phi_out.rules[r][q] * value;
          }
        }
      }
      changes.value += weight * sum;
      along.in[a] += phi_in.rules[0][p] * sum;
      for (std::size_t r = 1; r < kRules; ++r) {
        changes.lower[0][r] += theta_in.rules[r][a] * phi_in.rules[0][p] * sum;
        changes.lower[1][r] += theta_in.rules[0][a] * phi_in.rules[r][p] * sum;
        changes.lower[2][r] += weight * theta_sums[r];
        changes.lower[3][r] += weight * phi_sums[r];
      }
    }
  }
  changes.kinks = {kink_of(std::span(along.in).first(theta_in.size)), 0,
                   kink_of(std::span(along.out).first(theta_out.size)), 0};
  return changes.estimate();
}

Estimate Interpolator::sum(std::size_t channel, const Stencil& theta_in, const Stencil& theta_out, double phi_in,
                           double phi_out) const {
  return table_.form == TableForm::isotropic ? isotropic_sum(channel, theta_in, theta_out, phi_out - phi_in)
                                             : general_sum(channel, theta_in, theta_out, phi_in, phi_out);
}

Estimate Interpolator::product_at(std::size_t channel, Direction in, Direction out) const {
  const Stencil theta_in = theta_stencil(in.theta);
  const Stencil theta_out = theta_stencil(out.theta);
  const Estimate value = sum(channel, theta_in, theta_out, in.phi, out.phi);
  double error = 2 * value.error + node_error(channel, theta_in, theta_out);
  if (theta_in.spans_normal || theta_out.spans_normal) {
    const Estimate one_sided = sum(channel, theta_in.spans_normal ? one_sided_stencil(in.theta) : theta_in,
                                   theta_out.spans_normal ? one_sided_stencil(out.theta) : theta_out, in.phi, out.phi);
    error += std::abs(value.value - one_sided.value);
  }
  if (table_.grid.has_cells()) error += averaging_error(channel, in, out);
  return {value.value, error};
}

Estimate Interpolator::at(std::size_t channel, Direction in, Direction out) const {
  const HemisphereGrid& grid = table_.grid;
  return grid.is_product() ? product_at(channel, in, out) : cell_at(channel, in, out);
}

double Interpolator::averaging_error(std::size_t channel, Direction in, Direction out) const {
  // The mean over a step h is f + h^2/24 f''; steps in theta and phi, of L and of V. Six times that, because second
  // differences of averages are smaller than those of values: half of it was too little at the normal. Means by
  // projected solid angle are besides those about another angle than the node's.
  constexpr double kAveragingShare = 0.25;
  const HemisphereGrid& grid = table_.grid;
  const double phi_step = 2 * std::numbers::pi / static_cast<double>(grid.n_phi());
  const auto ring_at = [&](Direction d) -> const Ring& { return grid.rings()[grid.ring_of(grid.node_at(d))]; };
  const auto value = [&](Direction l, Direction v) {
    return sum(channel, theta_stencil(l.theta), theta_stencil(v.theta), l.phi, v.phi).value;
  };
  const double middle = value(in, out);
  // shift: of the middle of the cell, in steps
  const auto change = [&](Direction step_in, Direction step_out, double shift) {
    const auto moved = [&](double sign) {
      // Beyond the normal and the horizon the polynomial goes on.
      return value({in.theta + sign * step_in.theta, in.phi + sign * step_in.phi},
                   {out.theta + sign * step_out.theta, out.phi + sign * step_out.phi});
    };
    const double ahead = moved(1);
    const double behind = moved(-1);
    return std::abs(ahead - 2 * middle + behind) * kAveragingShare + std::abs(ahead - behind) / 2 * std::abs(shift);
  };
  const Ring& ring_in = ring_at(in);
  const Ring& ring_out = ring_at(out);
  const double step_in = ring_in.theta_high - ring_in.theta_low;
  const double step_out = ring_out.theta_high - ring_out.theta_low;
  return change({step_in, 0}, {}, (mean_theta(ring_in) - ring_in.theta) / step_in) +
         change({}, {step_out, 0}, (mean_theta(ring_out) - ring_out.theta) / step_out) + change({0, phi_step}, {}, 0) +
         change({}, {0, phi_step}, 0);
}

double Interpolator::cell_change(std::size_t channel, std::size_t row, std::size_t column) const {
  const HemisphereGrid& grid = table_.grid;
  const std::size_t rings = grid.rings().size();
  const double* const values = table_.channel(channel).data();
  const double value = values[row * grid.nodes() + column];
  // Half of the larger change to both neighbours along azimuth, and to those of the rings beside.
  const auto half_change = [&](std::size_t node, const auto& value_at) {
    const Ring& ring = grid.rings()[grid.ring_of(node)];
    const std::size_t place = node - ring.first_node;
    const auto change = [&](std::size_t other) { return 0.5 * std::abs(value_at(other) - value); };
    double along = 0;
    for (const std::size_t step : {std::size_t{1}, ring.count - 1}) {
      along = std::max(along, change(ring.first_node + (place + step) % ring.count));
    }
    double across = 0;
    for (const std::size_t beside : {grid.ring_of(node) - 1, grid.ring_of(node) + 1}) {
      if (beside >= rings) continue;
      const Ring& other = grid.rings()[beside];
      across = std::max(across, change(grid.node_at({other.theta, grid.directions()[node].phi})));
    }
    return along + across;
  };
  return half_change(row, [&](std::size_t node) { return values[node * grid.nodes() + column]; }) +
         half_change(column, [&](std::size_t node) { return values[row * grid.nodes() + node]; });
}

Estimate Interpolator::cell_at(std::size_t channel, Direction in, Direction out) const {
  const HemisphereGrid& grid = table_.grid;
  const std::size_t row = grid.node_at(in);
  const std::size_t column = grid.node_at(out);
  const std::size_t rings = grid.rings().size();
  return {table_.channel(channel)[row * grid.nodes() + column],
          cell_change(channel, row, column) +
              table_.error[(channel * rings + grid.ring_of(row)) * rings + grid.ring_of(column)]};
}

Estimate Interpolator::row_part(const std::vector<double>& parts, std::size_t channel, Direction in) const {
  constexpr double kSafety = 2;
  if (parts.empty()) return {};
  const HemisphereGrid& grid = table_.grid;
  const double* const values = parts.data() + channel * table_.rows();
  if (!grid.is_product()) {
    const std::size_t node = grid.node_at(in);
    double change = 0;
    for (const std::size_t beside : {grid.ring_of(node) - 1, grid.ring_of(node) + 1}) {
      if (beside >= grid.rings().size()) continue;
      const double other = values[grid.node_at({grid.rings()[beside].theta, grid.directions()[node].phi})];
      change = std::max(change, std::abs(other - values[node]));
    }
    return {values[node], change / 2};
  }
  const Stencil theta = theta_stencil(in.theta);
  const Stencil azimuth = azimuth_stencil(in.phi);
  const auto count = static_cast<long>(grid.n_phi());
  const auto along_theta = [&](std::size_t of_azimuth) {
    std::array<double, kNodes> along{};
    for (std::size_t a = 0; a < theta.size; ++a) {
      const long i = theta.index[a];
      const long ring = i < 0 ? -1 - i : i;
      if (table_.form == TableForm::isotropic) {
        along[a] = values[ring];
        continue;
      }
      for (std::size_t p = 0; p < azimuth.size; ++p) {
        const long k = (((azimuth.index[p] + (i < 0 ? count / 2 : 0)) % count) + count) % count;
        along[a] += azimuth.rules[of_azimuth][p] * values[ring * count + k];
      }
    }
    return along;
  };
  const auto at_rule = [&](std::size_t of_theta, std::size_t of_azimuth) {
    const auto values_along = along_theta(of_azimuth);
    double sum = 0;
    for (std::size_t a = 0; a < theta.size; ++a) sum += theta.rules[of_theta][a] * values_along[a];
    return sum;
  };
  const double value = at_rule(0, 0);
  const auto along = along_theta(0);
  double by_theta = kink_of(std::span(along).first(theta.size));
  double by_azimuth = 0;
  for (std::size_t rule = 1; rule < kRules; ++rule) {
    by_theta = std::max(by_theta, std::abs(at_rule(rule, 0) - value));
    if (table_.form == TableForm::general) by_azimuth = std::max(by_azimuth, std::abs(at_rule(0, rule) - value));
  }
  return {value, kSafety * (by_theta + by_azimuth)};
}

}  // namespace lobe
