#include "algebra/composition_error.hpp"

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <optional>

#include "algebra/smooth_product.hpp"
#include "device/isotropic_product.hpp"
#include "device/matrix_product.hpp"
#include "hemisphere/embedded_rule.hpp"
#include "lobe/cell_error.hpp"
#include "model/traits.hpp"
#include "table/lobe_tabulator.hpp"

namespace lobe {
namespace {

// A kink anywhere in the integrand leaves errors that fall by 2^1.5 to 5 at the resolution of the check, so that the
// difference of the two is 0.65 to 0.8 of the error; smooth integrands leave none there.
constexpr double kSafety = 1.3;
constexpr double kFarShare = 0.4;          // of relative errors within an eighth of the rings
constexpr double kRounding = 1e-15;        // of a sum of products in double precision, relative to their sizes
constexpr double kRoundingSingle = 1e-6;   // the same in single precision
constexpr std::size_t kRingsInFull = 64;   // tables of at most so many rings are checked at all of them
constexpr std::size_t kRingsSampled = 33;  // of larger ones
constexpr std::size_t kAzimuths = 4;       // azimuths checked per ring on grids that are no product
constexpr std::size_t kCellSamples = 4;    // per coordinate, as tabulate() takes by default

/// The rings of a grid at which the quadrature is checked: all, or evenly spread ones with the first and the last.
std::vector<std::size_t> checked_rings(std::size_t rings) {
  const std::size_t count = rings <= kRingsInFull ? rings : kRingsSampled;
  std::vector<std::size_t> chosen;
  for (std::size_t k = 0; k < count; ++k) chosen.push_back(count == 1 ? 0 : k * (rings - 1) / (count - 1));
  return chosen;
}

std::vector<std::size_t> all_rings(std::size_t rings) {
  std::vector<std::size_t> all(rings);
  std::iota(all.begin(), all.end(), std::size_t{0});
  return all;
}

NodeSet pick(const NodeSet& nodes, std::span<const std::size_t> chosen) {
  NodeSet some;
  some.directions.samples = nodes.directions.samples;
  some.directions.count = chosen.size();
  for (const std::size_t node : chosen) {
    const auto first =
        nodes.directions.directions.begin() + static_cast<std::ptrdiff_t>(node * some.directions.samples);
    some.directions.directions.insert(some.directions.directions.end(), first,
                                      first + static_cast<std::ptrdiff_t>(some.directions.samples));
    some.weights.push_back(nodes.weights[node]);
  }
  return some;
}

/// [a][b][block] to [b][a][block].
TableValues swap_axes(const TableValues& values, std::size_t a, std::size_t b) {
  TableValues swapped(values.size());
  const std::size_t block = values.size() / (a * b);
  for (std::size_t i = 0; i < a; ++i) {
    for (std::size_t j = 0; j < b; ++j) {
      std::copy_n(values.data() + (i * b + j) * block, block, swapped.data() + (j * a + i) * block);
    }
  }
  return swapped;
}

/// A maximum that keeps NaN, which stands for an unknown error.
void raise(double& bound, double value) {
  if (!(value <= bound)) bound = value;
}

/// Largest value of a product between each pair of rings, [ring][ring], bounded by the largest of both rings: the size
/// that errors are compared with.
std::vector<double> sizes(std::span<const double> largest_values, std::size_t rings) {
  std::vector<double> row(rings);
  std::vector<double> column(rings);
  for (std::size_t i = 0; i < rings; ++i) {
    for (std::size_t j = 0; j < rings; ++j) {
      row[i] = std::max(row[i], largest_values[i * rings + j]);
      column[j] = std::max(column[j], largest_values[i * rings + j]);
    }
  }
  std::vector<double> size(rings * rings);
  for (std::size_t i = 0; i < rings; ++i) {
    for (std::size_t j = 0; j < rings; ++j) size[i * rings + j] = std::min(row[i], column[j]);
  }
  return size;
}

/// Differences at checked pairs of rings made into bounds for all pairs: each takes the largest of the checked ones
/// next to it and, relative to the size of the product, a share of the largest in a wider neighbourhood. An error which
/// happens to vanish at one pair, or where two errors change sign against each other, is so not believed.
class Spread {
 public:
  /// \param size [ring][ring], see sizes()
  Spread(std::vector<std::size_t> checked, std::size_t rings, std::vector<double> size)
      : checked_(std::move(checked)), rings_(rings), size_(std::move(size)) {}

  [[nodiscard]] std::vector<double> bounds(std::span<const double> differences) const {
    const std::size_t count = checked_.size();
    std::vector<double> relative(differences.begin(), differences.end());
    for (std::size_t at = 0; at < relative.size(); ++at) {
      const double size = size_[checked_[at / count] * rings_ + checked_[at % count]];
      if (size > 0) relative[at] /= size;
    }
    std::vector<double> bounds(rings_ * rings_);
    for (std::size_t i = 0; i < rings_; ++i) {
      for (std::size_t j = 0; j < rings_; ++j) {
        const double near = largest(relative, i, j, 1);
        const double far = largest(relative, i, j, std::max<std::size_t>(2, count / 8));
        bounds[i * rings_ + j] = size_[i * rings_ + j] * std::max(near, kFarShare * far);
      }
    }
    return bounds;
  }

 private:
  /// First and last checked ring within reach: those on both sides of a ring, or itself and its neighbours.
  [[nodiscard]] std::pair<std::size_t, std::size_t> around(std::size_t ring, std::size_t reach) const {
    const auto above = static_cast<std::size_t>(std::ranges::lower_bound(checked_, ring) - checked_.begin());
    const bool is_checked = above < checked_.size() && checked_[above] == ring;
    return {above - std::min(above, reach), std::min(checked_.size() - 1, above + reach - (is_checked ? 0 : 1))};
  }

  [[nodiscard]] double largest(std::span<const double> values, std::size_t i, std::size_t j, std::size_t reach) const {
    const auto [i_first, i_last] = around(i, reach);
    const auto [j_first, j_last] = around(j, reach);
    double found = 0;
    for (std::size_t a = i_first; a <= i_last; ++a) {
      for (std::size_t b = j_first; b <= j_last; ++b) raise(found, values[a * checked_.size() + b]);
    }
    return found;
  }

  std::vector<std::size_t> checked_;
  std::size_t rings_;
  std::vector<double> size_;
};

/// Formulas of both factors in a row; none when one is unknown or not reciprocal (the check tabulates V for L).
std::vector<Material> chain(const BrdfTable& f, const BrdfTable& g) {
  if (f.source.empty() || g.source.empty()) return {};
  std::vector<Material> materials = f.source;
  materials.insert(materials.end(), g.source.begin(), g.source.end());
  return std::ranges::all_of(materials, is_reciprocal) ? materials : std::vector<Material>{};
}

/// Grids of X that a product on a product grid is checked with: rings and azimuths refined apart, because their errors
/// may have opposite signs. Not twice as many rings: then those of L would keep their place between those of X over
/// many rings, and where the kink of max(N.L, N.V) happens to do no harm its error would be missed. Cells are halved in
/// both coordinates, so that they are averaged over the same directions.
std::vector<HemisphereGrid> finer_grids(const HemisphereGrid& grid) {
  const std::size_t rings = (12 * grid.n_theta() + 4) / 5;
  const std::size_t azimuths = grid.n_phi();
  if (grid.kind() == GridKind::gauss) {
    return {HemisphereGrid::gauss(rings, azimuths), HemisphereGrid::gauss(grid.n_theta(), 2 * azimuths)};
  }
  if (grid.kind() == GridKind::uniform) {
    return {HemisphereGrid::uniform(rings, azimuths), HemisphereGrid::uniform(grid.n_theta(), 2 * azimuths)};
  }
  return {grid.refined()};
}

/// The quadrature over X repeated on finer grids for isotropic formulas on a product grid.
class RefinedRings {
 public:
  RefinedRings(const Device& device, const HemisphereGrid& grid, const std::vector<Material>& materials,
               Precision precision)
      : device_(device), grid_(grid), precision_(precision), checked_(checked_rings(grid.n_theta())) {
    for (const auto& material : materials) tabulators_.emplace_back(device, material, precision);
  }

  /// [ring][ring] bounds from differences, largest over azimuth. \param value of the product at ring, ring, k
  template <typename Value>
  std::vector<double> bounds(std::size_t channel, const Value& value) const {
    const std::size_t rings = grid_.n_theta();
    const Spread spread(checked_, rings, sizes(largest_values(value), rings));
    std::vector<double> sum(rings * rings);
    for (const HemisphereGrid& fine : finer_grids(grid_)) {
      const auto part = spread.bounds(differences(channel, value, fine));
      for (std::size_t at = 0; at < sum.size(); ++at) sum[at] += part[at];
    }
    return sum;
  }

 private:
  template <typename Value>
  std::vector<double> differences(std::size_t channel, const Value& value, const HemisphereGrid& fine) const {
    const std::size_t count = checked_.size();
    const TableValues refined = product(channel, fine);
    const std::size_t step = fine.n_phi() / grid_.n_phi();
    std::vector<double> largest(count * count);
    for (std::size_t at = 0; at < largest.size(); ++at) {
      for (std::size_t k = 0; k < grid_.half_azimuths(); ++k) {
        raise(largest[at], std::abs(value(checked_[at / count], checked_[at % count], k) -
                                    refined[at * fine.half_azimuths() + step * k]));
      }
    }
    return largest;
  }

  template <typename Value>
  std::vector<double> largest_values(const Value& value) const {
    const std::size_t rings = grid_.n_theta();
    std::vector<double> largest(rings * rings);
    for (std::size_t at = 0; at < largest.size(); ++at) {
      for (std::size_t k = 0; k < grid_.half_azimuths(); ++k) {
        raise(largest[at], std::abs(value(at / rings, at % rings, k)));
      }
    }
    return largest;
  }

  /// f_1 o ... o f_n between the checked rings with all X on a grid: [a][b][k] at its azimuths.
  [[nodiscard]] TableValues product(std::size_t channel, const HemisphereGrid& fine) const {
    const std::size_t count = checked_.size();
    const std::size_t rings = fine.n_theta();
    const auto scale = inner_scale(fine, TableForm::isotropic);
    TableValues left = edge(0, channel, fine);
    for (std::size_t m = 1; m + 1 < tabulators_.size(); ++m) {
      const NodeSet rows = ring_nodes(fine, kCellSamples / 2);
      const NodeSet columns = half_nodes(fine, kCellSamples / 2);
      TableValues middle(rings * columns.weights.size());
      tabulators_[m].channel(channel, rows.directions, columns.directions, {}, middle);
      TableValues next(left.size());
      multiply_isotropic(device_, count, rings, rings, fine.n_phi(), left, middle, scale, next, precision_);
      left = std::move(next);
    }
    const TableValues right = swap_axes(edge(tabulators_.size() - 1, channel, fine), count, rings);
    TableValues result(count * count * fine.half_azimuths());
    multiply_isotropic(device_, count, rings, count, fine.n_phi(), left, right, scale, result, precision_);
    return result;
  }

  /// A factor between the checked rings and the nodes of the finer grid, [count][rings][k].
  [[nodiscard]] TableValues edge(std::size_t factor, std::size_t channel, const HemisphereGrid& fine) const {
    const NodeSet rows = pick(ring_nodes(grid_, kCellSamples), checked_);
    const NodeSet columns = half_nodes(fine, kCellSamples / 2);
    TableValues values(rows.weights.size() * columns.weights.size());
    tabulators_[factor].channel(channel, rows.directions, columns.directions, {}, values);
    return values;
  }

  const Device& device_;
  const HemisphereGrid& grid_;
  Precision precision_;
  std::vector<std::size_t> checked_;
  std::vector<LobeTabulator> tabulators_;
};

/// The same for two formulas on any grid: one L per ring, a few V per ring; a few L, too, where their azimuth counts.
std::vector<double> refined_nodes(const Device& device, const HemisphereGrid& grid,
                                  const std::vector<Material>& materials, std::size_t channel,
                                  std::span<const double> product, Precision precision) {
  const HemisphereGrid fine = grid.refined();
  std::vector<std::size_t> rows;
  std::vector<std::size_t> columns;
  const bool one_azimuth = std::ranges::all_of(materials, is_isotropic);
  for (const Ring& ring : grid.rings()) {
    const std::size_t step = std::max<std::size_t>(1, ring.count / kAzimuths);
    for (std::size_t k = 0; k < ring.count; k += step) {
      columns.push_back(ring.first_node + k);
      if (k == 0 || !one_azimuth) rows.push_back(ring.first_node + k);
    }
  }
  const NodeSet nodes = all_nodes(grid, kCellSamples);
  const NodeSet inner = all_nodes(fine, kCellSamples / 2);
  const NodeSet row_set = pick(nodes, rows);
  const NodeSet column_set = pick(nodes, columns);
  TableValues a(rows.size() * fine.nodes());
  TableValues b(columns.size() * fine.nodes());
  LobeTabulator(device, materials[0], precision).channel(channel, row_set.directions, inner.directions, {}, a);
  LobeTabulator(device, materials[1], precision).channel(channel, column_set.directions, inner.directions, {}, b);
  b = swap_axes(b, columns.size(), fine.nodes());
  TableValues c(rows.size() * columns.size());
  multiply(device, {a.data(), rows.size(), fine.nodes(), fine.nodes()},
           {b.data(), fine.nodes(), columns.size(), columns.size()}, inner_scale(fine, TableForm::general),
           {c.data(), rows.size(), columns.size(), columns.size()}, precision);

  const std::size_t rings = grid.rings().size();
  std::vector<double> differences(rings * rings);
  std::vector<double> largest(rings * rings);
  for (std::size_t i = 0; i < rows.size(); ++i) {
    for (std::size_t j = 0; j < columns.size(); ++j) {
      const std::size_t at = grid.ring_of(rows[i]) * rings + grid.ring_of(columns[j]);
      const double value = product[rows[i] * grid.nodes() + columns[j]];
      raise(differences[at], std::abs(value - c[i * columns.size() + j]));
      raise(largest[at], std::abs(value));
    }
  }
  return Spread(all_rings(rings), rings, sizes(largest, rings)).bounds(differences);
}

/// Change of an isotropic product on a gauss grid when X takes every second ring and azimuth only.
std::vector<double> embedded_differences(const Device& device, const BrdfTable& f, const BrdfTable& g,
                                         std::size_t channel, std::span<const double> product, Precision precision) {
  const std::size_t rings = f.grid.n_theta();
  const std::size_t half = f.grid.half_azimuths();
  const std::size_t step = f.grid.n_phi() % 4 == 0 ? 2 : 1;
  const std::size_t coarse_half = (half - 1) / step + 1;
  const std::size_t inner = rings / 2;
  const auto weights = embedded_ring_weights(f.grid);
  TableValues a(rings * inner * coarse_half);
  TableValues b(a.size());
  for (std::size_t i = 0; i < rings; ++i) {
    for (std::size_t x = 0; x < inner; ++x) {
      for (std::size_t k = 0; k < coarse_half; ++k) {
        // The weights go to one side: they need not be positive.
        a[(i * inner + x) * coarse_half + k] =
            weights[2 * x + 1] * f.channel(channel)[(i * rings + 2 * x + 1) * half + k * step];
        b[(x * rings + i) * coarse_half + k] = g.channel(channel)[((2 * x + 1) * rings + i) * half + k * step];
      }
    }
  }
  TableValues c(rings * rings * coarse_half);
  multiply_isotropic(device, rings, inner, rings, f.grid.n_phi() / step, a, b, std::vector<double>(inner, 1.0), c,
                     precision);
  std::vector<double> differences(rings * rings);
  std::vector<double> largest(rings * rings);
  for (std::size_t block = 0; block < rings * rings; ++block) {
    for (std::size_t k = 0; k < coarse_half; ++k) {
      raise(differences[block], std::abs(product[block * half + k * step] - c[block * coarse_half + k]));
      raise(largest[block], std::abs(product[block * half + k * step]));
    }
  }
  return Spread(all_rings(rings), rings, sizes(largest, rings)).bounds(differences);
}

using Matrix = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;

/// Mean of |f| over azimuth between rings, of a channel.
Matrix mean_size(const BrdfTable& table, std::size_t channel) {
  const auto rings = static_cast<Eigen::Index>(table.grid.rings().size());
  Matrix mean = Matrix::Zero(rings, rings);
  const auto values = table.channel(channel);
  if (table.form == TableForm::isotropic) {
    const std::size_t half = table.grid.half_azimuths();
    for (Eigen::Index at = 0; at < rings * rings; ++at) {
      double sum = 0;
      for (std::size_t k = 0; k < half; ++k) {
        sum += (k == 0 || k + 1 == half ? 1 : 2) * std::abs(values[static_cast<std::size_t>(at) * half + k]);
      }
      mean.data()[at] = sum / static_cast<double>(table.grid.n_phi());
    }
    return mean;
  }
  // The largest of the means over V that any L of a ring has.
  const std::size_t nodes = table.grid.nodes();
  for (std::size_t row = 0; row < nodes; ++row) {
    Eigen::RowVectorXd of_row = Eigen::RowVectorXd::Zero(rings);
    for (std::size_t node = 0; node < nodes; ++node) {
      const std::size_t ring = table.grid.ring_of(node);
      of_row(static_cast<Eigen::Index>(ring)) +=
          std::abs(values[row * nodes + node]) / static_cast<double>(table.grid.rings()[ring].count);
    }
    auto largest = mean.row(static_cast<Eigen::Index>(table.grid.ring_of(row)));
    largest = largest.cwiseMax(of_row);
  }
  return mean;
}

Eigen::Map<const Matrix> errors_of(const BrdfTable& table, std::size_t channel) {
  const auto rings = static_cast<Eigen::Index>(table.grid.rings().size());
  return {table.error.data() + static_cast<Eigen::Index>(channel) * rings * rings, rings, rings};
}

/// What the operands' errors and rounding make of the product: e_f |g| + |f| e_g, integrated over X.
Matrix propagated(const BrdfTable& f, const BrdfTable& g, std::size_t channel, Precision precision,
                  bool with_operands) {
  const auto rings = f.grid.rings();
  Eigen::VectorXd weights(static_cast<Eigen::Index>(rings.size()));
  for (std::size_t r = 0; r < rings.size(); ++r) {
    weights(static_cast<Eigen::Index>(r)) = rings[r].weight * static_cast<double>(rings[r].count);
  }
  const Matrix f_size = mean_size(f, channel);
  const Matrix g_size = mean_size(g, channel);
  const double rounding = precision == Precision::double_precision ? kRounding : kRoundingSingle;
  Matrix bound = rounding * (f_size * weights.asDiagonal() * g_size);
  if (with_operands) {
    bound += errors_of(f, channel) * weights.asDiagonal() * g_size;
    bound += f_size * weights.asDiagonal() * errors_of(g, channel);
  }
  return bound;
}

bool can_refine_rings(const BrdfTable& table, const std::vector<Material>& materials) {
  return !materials.empty() && table.grid.is_product() && std::ranges::all_of(materials, is_isotropic);
}

}  // namespace

std::vector<double> composition_error(const Device& device, const BrdfTable& f, const BrdfTable& g,
                                      const TableValues& product, Precision precision) {
  const HemisphereGrid& grid = f.grid;
  const std::size_t rings = grid.rings().size();
  const std::vector<Material> materials = chain(f, g);
  // The check of a chain of three and more sees the errors of its operands, too.
  const bool with_operands = materials.empty() || materials.size() == 2;
  std::optional<RefinedRings> refined;
  if (can_refine_rings(f, materials)) refined.emplace(device, grid, materials, precision);
  std::vector<double> errors;
  for (std::size_t channel = 0; channel < f.channels; ++channel) {
    const std::span values = std::span(product).subspan(channel * f.size(), f.size());
    std::vector<double> quadrature;
    if (refined) {
      const std::size_t half = grid.half_azimuths();
      const std::size_t n_phi = grid.n_phi();
      const bool is_isotropic = f.form == TableForm::isotropic;
      quadrature = refined->bounds(channel, [&](std::size_t i, std::size_t j, std::size_t k) {
        return is_isotropic ? values[(i * rings + j) * half + k] : values[i * n_phi * grid.nodes() + j * n_phi + k];
      });
    } else if (materials.size() == 2) {
      quadrature = refined_nodes(device, grid, materials, channel, values, precision);
    } else if (grid.kind() == GridKind::gauss && f.form == TableForm::isotropic && rings > 1) {
      quadrature = embedded_differences(device, f, g, channel, values, precision);
    } else {
      // Operators that are constant on cells multiply exactly; of other ones, and of long chains of formulas that they
      // stand for, nothing is known.
      const bool is_exact = materials.empty() && is_constant_on_cells(f);
      quadrature.assign(rings * rings, is_exact ? 0 : std::numeric_limits<double>::quiet_NaN());
    }
    const Matrix other = propagated(f, g, channel, precision, with_operands);
    for (std::size_t at = 0; at < rings * rings; ++at) errors.push_back(kSafety * quadrature[at] + other.data()[at]);
  }
  return errors;
}

std::vector<double> propagated_error(const BrdfTable& f, const BrdfTable& g, Precision precision) {
  std::vector<double> errors;
  for (std::size_t channel = 0; channel < f.channels; ++channel) {
    const Matrix of_channel = propagated(f, g, channel, precision, true);
    errors.insert(errors.end(), of_channel.data(), of_channel.data() + of_channel.size());
  }
  return errors;
}

std::uint64_t composition_error_bytes(const Device& device, const BrdfTable& f, const BrdfTable& g,
                                      Precision precision) {
  const std::vector<Material> materials = chain(f, g);
  const std::uint64_t rings = f.grid.rings().size();
  std::uint64_t bytes = 0;
  if (can_refine_rings(f, materials)) {
    const std::uint64_t count = checked_rings(rings).size();
    // Two edges, one of them while its axes are swapped, then their product; in chains each middle factor's before.
    for (const HemisphereGrid& fine : finer_grids(f.grid)) {
      const std::uint64_t inner = fine.n_theta();
      const std::uint64_t line = sizeof(double) * fine.half_azimuths();
      const std::uint64_t edge = count * inner * line;
      const auto workspace = [&](std::uint64_t columns) {
        return isotropic_workspace_bytes(device, {count, inner, columns, fine.n_phi()}, precision);
      };
      bytes = std::max({bytes, 3 * edge, 2 * edge + count * count * line + workspace(count)});
      if (materials.size() > 2) bytes = std::max(bytes, 2 * edge + inner * inner * line + workspace(inner));
    }
  } else if (materials.size() == 2) {
    const std::uint64_t azimuths = std::ranges::all_of(materials, is_isotropic) ? 1 : kAzimuths;
    bytes = sizeof(double) * (azimuths + 2 * kAzimuths) * rings * 4 * f.grid.nodes();
  } else if (f.grid.kind() == GridKind::gauss && f.form == TableForm::isotropic) {
    const std::uint64_t azimuths = f.grid.n_phi() / (f.grid.n_phi() % 4 == 0 ? 2 : 1);
    bytes = sizeof(double) * (rings * rings + 2 * rings * (rings / 2)) * (azimuths / 2 + 1) +
            isotropic_workspace_bytes(device, {rings, rings / 2, rings, azimuths}, precision);
  }
  return bytes;
}

}  // namespace lobe
