#include "algebra/composition_error.hpp"

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <optional>

#include "algebra/smooth_product.hpp"
#include "device/isotropic_product.hpp"
#include "device/multiply_matrices.hpp"
#include "hemisphere/embedded_rule.hpp"
#include "lobe/table/cell_error.hpp"
#include "model/traits.hpp"
#include "table/even_error.hpp"
#include "table/lobe_tabulator.hpp"

namespace lobe {
namespace {

// A kink anywhere in the integrand leaves errors that fall by 2^1.5 to 5 at the resolution of the check, so that the
// difference of the two is 0.65 to 0.8 of the error; smooth integrands leave none there.
constexpr double kCheckSafety = 1.3;
constexpr double kThinnedSafety = 2;        // of what is left of differences of rules with half as many nodes
constexpr double kCheckedLeastDecay = 0.2;  // of the differences of such rules: kinks leave no less, but by accident
constexpr double kCheckedFarShare = 0.4;    // of relative errors within an eighth of the rings
constexpr double kSumRounding = 1e-15;      // of a sum of products in double precision, relative to their sizes
constexpr double kRoundingSingle = 1e-6;    // the same in single precision
constexpr std::size_t kRingsInFull = 64;    // tables of at most so many rings are checked at all of them
constexpr std::size_t kRingsSampled = 33;   // of larger ones
constexpr std::size_t kAzimuths = 4;        // azimuths checked per ring on grids that are no product
constexpr std::size_t kThinnedRows = 8;     // azimuths of L per ring at which general products are checked
constexpr std::size_t kCellSamples = 4;     // per coordinate, as tabulate() takes by default

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
  some.directions.points = nodes.directions.points;
  some.directions.count = chosen.size();
  for (const std::size_t node : chosen) {
    const auto first = nodes.directions.directions.begin() + static_cast<std::ptrdiff_t>(node * some.directions.points);
    some.directions.directions.insert(some.directions.directions.end(), first,
                                      first + static_cast<std::ptrdiff_t>(some.directions.points));
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
        bounds[i * rings_ + j] = size_[i * rings_ + j] * std::max(near, kCheckedFarShare * far);
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

  /// [ring][ring] bounds from differences, largest over azimuth.
  /// \param value of the product at ring, ring, k
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

/// Errors for two formulas on any grid: one L per ring, a few V per ring; a few L, too, where their azimuth counts.
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

/// Weights of every so manieth ring of a gauss grid, per radian of azimuth.
std::vector<double> thinned_weights(const HemisphereGrid& grid, std::size_t stride) {
  if (stride > 1) return embedded_ring_weights(grid, stride);
  std::vector<double> weights;
  for (const Ring& ring : grid.rings()) {
    weights.push_back(ring.weight * static_cast<double>(ring.count) / (2 * std::numbers::pi));
  }
  return weights;
}

/// An isotropic product on a gauss grid with X on some of its rings and azimuths.
class ThinnedProduct {
 public:
  ThinnedProduct(const Device& device, const BrdfTable& f, const BrdfTable& g, std::size_t channel, Precision precision)
      : device_(device), f_(f), g_(g), channel_(channel), precision_(precision) {}

  /// At every azimuth_stride-th azimuth, [ring][ring][k].
  /// \param ring_stride every so manieth ring of X
  [[nodiscard]] TableValues at(std::size_t ring_stride, std::size_t azimuth_stride) const {
    const std::size_t rings = f_.grid.n_theta();
    const std::size_t half = f_.grid.half_azimuths();
    const std::size_t coarse_half = (half - 1) / azimuth_stride + 1;
    const std::size_t inner = rings / ring_stride;
    const auto weights = ring_weights(ring_stride);
    TableValues a(rings * inner * coarse_half);
    TableValues b(a.size());
    for (std::size_t i = 0; i < rings; ++i) {
      for (std::size_t x = 0; x < inner; ++x) {
        const std::size_t ring = ring_stride * (x + 1) - 1;
        for (std::size_t k = 0; k < coarse_half; ++k) {
          // The weights go to one side: they need not be positive.
          a[(i * inner + x) * coarse_half + k] =
              weights[ring] * f_.channel(channel_)[(i * rings + ring) * half + k * azimuth_stride];
          b[(x * rings + i) * coarse_half + k] = g_.channel(channel_)[(ring * rings + i) * half + k * azimuth_stride];
        }
      }
    }
    TableValues c(rings * rings * coarse_half);
    multiply_isotropic(device_, rings, inner, rings, f_.grid.n_phi() / azimuth_stride, a, b,
                       std::vector<double>(inner, 1.0), c, precision_);
    return c;
  }

 private:
  [[nodiscard]] std::vector<double> ring_weights(std::size_t stride) const { return thinned_weights(f_.grid, stride); }

  const Device& device_;
  const BrdfTable& f_;
  const BrdfTable& g_;
  std::size_t channel_;
  Precision precision_;
};

/// Largest and root mean square differences over azimuth of two products, [ring][ring]; of them as many azimuths as the
/// coarser one has.
struct Differences {
  std::vector<double> largest, mean;

  Differences(std::span<const double> a, std::span<const double> b, std::size_t pairs) : largest(pairs), mean(pairs) {
    const std::size_t a_half = a.size() / pairs;
    const std::size_t b_half = b.size() / pairs;
    const std::size_t count = std::min(a_half, b_half);
    if (count == 1) return;
    const std::size_t a_step = (a_half - 1) / (count - 1);
    const std::size_t b_step = (b_half - 1) / (count - 1);
    for (std::size_t pair = 0; pair < pairs; ++pair) {
      double sum = 0;
      for (std::size_t k = 0; k < count; ++k) {
        const double change = std::abs(a[pair * a_half + k * a_step] - b[pair * b_half + k * b_step]);
        raise(largest[pair], change);
        sum += (k == 0 || k + 1 == count ? 0.5 : 1) * change * change / static_cast<double>(count - 1);
      }
      mean[pair] = std::sqrt(sum);
    }
  }
};

/// Remaining error of a rule: the difference to one with half as many nodes, less by the factor by which that
/// is less than the difference before, which is a power of two where there are kinks and much less of smooth
/// integrands. Of both the largest next to a pair counts.
std::vector<double> remainders(const Spread& spread, const std::vector<double>& last,
                               const std::vector<double>& before) {
  std::vector<double> bounds = spread.bounds(last);
  const std::vector<double> larger = spread.bounds(before);
  for (std::size_t at = 0; at < bounds.size(); ++at) {
    if (bounds[at] < larger[at]) bounds[at] *= std::max(bounds[at] / larger[at], kCheckedLeastDecay);
  }
  return bounds;
}

/// Bounds on the quadrature errors of an isotropic product on a gauss grid, [ring][ring].
struct ThinnedBounds {
  std::vector<double> largest;  ///< over azimuth
  std::vector<double> mean;     ///< root mean square
};

/// From products with X on every second and fourth ring, and on every second and fourth azimuth.
ThinnedBounds thinned_bounds(const Device& device, const BrdfTable& f, const BrdfTable& g, std::size_t channel,
                             std::span<const double> product, Precision precision) {
  const std::size_t rings = f.grid.n_theta();
  const std::size_t pairs = rings * rings;
  const std::size_t half = f.grid.half_azimuths();
  std::vector<double> largest(pairs);
  for (std::size_t at = 0; at < product.size(); ++at) raise(largest[at / half], std::abs(product[at]));
  const Spread spread(all_rings(rings), rings, sizes(largest, rings));
  const ThinnedProduct thinned(device, f, g, channel, precision);
  ThinnedBounds sum{std::vector<double>(pairs), std::vector<double>(pairs)};
  const auto add = [&](const TableValues& second, const TableValues& fourth) {
    const Differences last(product, second, pairs);
    const Differences before(second, fourth, pairs);
    const auto of_largest = remainders(spread, last.largest, before.largest);
    const auto of_mean = remainders(spread, last.mean, before.mean);
    for (std::size_t at = 0; at < pairs; ++at) {
      sum.largest[at] += of_largest[at];
      sum.mean[at] += of_mean[at];
    }
  };
  add(thinned.at(2, 1), rings >= 4 ? thinned.at(4, 1) : thinned.at(2, 1));
  if (f.grid.n_phi() % 8 == 0) {
    add(thinned.at(1, 2), thinned.at(1, 4));
  } else if (f.grid.n_phi() % 4 == 0) {
    const TableValues second = thinned.at(1, 2);
    add(second, second);
  }
  return sum;
}

/// A general product on a gauss grid, at some L of each ring and all V, with X on some of its rings and azimuths.
class ThinnedRows {
 public:
  ThinnedRows(const Device& device, const BrdfTable& f, const BrdfTable& g, std::size_t channel, Precision precision)
      : device_(device), f_(f), g_(g), channel_(channel), precision_(precision) {
    const std::size_t azimuths = f.grid.n_phi();
    const std::size_t count = std::min(azimuths, kThinnedRows);
    for (const Ring& ring : f.grid.rings()) {
      for (std::size_t k = 0; k < count; ++k) {
        // By turns on azimuths that the thinned rules keep and on others.
        const std::size_t shift = azimuths >= 2 * count ? k % 2 : 0;
        rows_.push_back(ring.first_node + k * azimuths / count + shift);
      }
    }
  }

  [[nodiscard]] std::span<const std::size_t> rows() const { return rows_; }

  /// [row][node of V]
  [[nodiscard]] TableValues at(std::size_t ring_stride, std::size_t azimuth_stride) const {
    const HemisphereGrid& grid = f_.grid;
    const std::size_t nodes = grid.nodes();
    const auto weights = thinned_weights(grid, ring_stride);
    const double step = 2 * std::numbers::pi * static_cast<double>(azimuth_stride) / static_cast<double>(grid.n_phi());
    std::vector<std::size_t> inner;
    for (std::size_t ring = ring_stride - 1; ring < grid.n_theta(); ring += ring_stride) {
      for (std::size_t k = 0; k < grid.n_phi(); k += azimuth_stride) {
        inner.push_back(grid.rings()[ring].first_node + k);
      }
    }
    TableValues a(rows_.size() * inner.size());
    TableValues b(inner.size() * nodes);
    for (std::size_t i = 0; i < rows_.size(); ++i) {
      const double* const row = f_.channel(channel_).data() + rows_[i] * nodes;
      // The weights go to one side: they need not be positive.
      for (std::size_t x = 0; x < inner.size(); ++x) {
        a[i * inner.size() + x] = step * weights[grid.ring_of(inner[x])] * row[inner[x]];
      }
    }
    for (std::size_t x = 0; x < inner.size(); ++x) {
      std::copy_n(g_.channel(channel_).data() + inner[x] * nodes, nodes, b.data() + x * nodes);
    }
    TableValues c(rows_.size() * nodes);
    multiply(device_, {a.data(), rows_.size(), inner.size(), inner.size()}, {b.data(), inner.size(), nodes, nodes},
             std::vector<double>(inner.size(), 1.0), {c.data(), rows_.size(), nodes, nodes}, precision_);
    return c;
  }

 private:
  const Device& device_;
  const BrdfTable& f_;
  const BrdfTable& g_;
  std::size_t channel_;
  Precision precision_;
  std::vector<std::size_t> rows_;
};

/// thinned_bounds() of a general product, the largest over azimuth alone.
std::vector<double> thinned_row_bounds(const Device& device, const BrdfTable& f, const BrdfTable& g,
                                       std::size_t channel, std::span<const double> product, Precision precision) {
  const HemisphereGrid& grid = f.grid;
  const std::size_t rings = grid.n_theta();
  const std::size_t nodes = grid.nodes();
  std::vector<double> largest(rings * rings);
  for (std::size_t at = 0; at < product.size(); ++at) {
    raise(largest[grid.ring_of(at / nodes) * rings + grid.ring_of(at % nodes)], std::abs(product[at]));
  }
  const Spread spread(all_rings(rings), rings, sizes(largest, rings));
  const ThinnedRows thinned(device, f, g, channel, precision);
  TableValues full;
  for (const std::size_t row : thinned.rows()) {
    full.insert(full.end(), product.data() + row * nodes, product.data() + (row + 1) * nodes);
  }
  const auto differences = [&](const TableValues& a, const TableValues& b) {
    std::vector<double> found(rings * rings);
    for (std::size_t at = 0; at < a.size(); ++at) {
      const std::size_t row = grid.ring_of(thinned.rows()[at / nodes]);
      raise(found[row * rings + grid.ring_of(at % nodes)], std::abs(a[at] - b[at]));
    }
    return found;
  };
  std::vector<double> sum(rings * rings);
  const auto add = [&](const TableValues& second, const TableValues& fourth) {
    const auto part = remainders(spread, differences(full, second), differences(second, fourth));
    for (std::size_t at = 0; at < sum.size(); ++at) sum[at] += part[at];
  };
  // Without a rule on every fourth ring or azimuth the difference counts in full.
  const auto of_rings = thinned.at(2, 1);
  add(of_rings, rings >= 4 ? thinned.at(4, 1) : full);
  if (grid.n_phi() % 2 == 0) {
    const auto of_azimuths = thinned.at(1, 2);
    add(of_azimuths, grid.n_phi() % 4 == 0 ? thinned.at(1, 4) : full);
  }
  return sum;
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

Matrix matrix_of(std::span<const double> pairs, const BrdfTable& table) {
  const auto rings = static_cast<Eigen::Index>(table.grid.rings().size());
  return Eigen::Map<const Matrix>(pairs.data(), rings, rings);
}

std::span<const double> of_channel(const std::vector<double>& numbers, const BrdfTable& table, std::size_t channel) {
  const std::size_t pairs = table.grid.rings().size() * table.grid.rings().size();
  return std::span(numbers).subspan(channel * pairs, pairs);
}

/// Root mean square over azimuth of an isotropic table between rings, of a channel.
Matrix root_mean_square(const BrdfTable& table, std::size_t channel) {
  const auto rings = static_cast<Eigen::Index>(table.grid.rings().size());
  const std::size_t half = table.grid.half_azimuths();
  const auto values = table.channel(channel);
  Matrix mean(rings, rings);
  for (Eigen::Index at = 0; at < rings * rings; ++at) {
    double sum = 0;
    for (std::size_t k = 0; k < half; ++k) {
      const double value = values[static_cast<std::size_t>(at) * half + k];
      sum += (k == 0 || k + 1 == half ? 1 : 2) * value * value;
    }
    mean.data()[at] = std::sqrt(sum / static_cast<double>(table.grid.n_phi()));
  }
  return mean;
}

/// Errors by pair of rings, [ring][ring].
struct PairErrors {
  Matrix largest;  ///< over azimuth
  Matrix even;     ///< of the mean of both signs of delta_phi, root mean square
  Matrix odd;      ///< half the difference of both signs, root mean square
};

/// Errors of the product from the operands' errors and rounding: e_f |g| + |f| e_g, integrated over X. Of convolutions
/// over azimuth root mean squares are at most that of one factor times the mean size of the other, and values the
/// product of both root mean squares. Two odd parts make an even one.
PairErrors propagated(const BrdfTable& f, const BrdfTable& g, std::size_t channel, Precision precision,
                      bool with_operands) {
  const auto rings = f.grid.rings();
  Eigen::VectorXd weights(static_cast<Eigen::Index>(rings.size()));
  for (std::size_t r = 0; r < rings.size(); ++r) {
    weights(static_cast<Eigen::Index>(r)) = rings[r].weight * static_cast<double>(rings[r].count);
  }
  const Matrix f_size = mean_size(f, channel);
  const Matrix g_size = mean_size(g, channel);
  const double rounding = precision == Precision::double_precision ? kSumRounding : kRoundingSingle;
  PairErrors bound;
  bound.largest = rounding * (f_size * weights.asDiagonal() * g_size);
  bound.even = bound.largest;
  bound.odd = Matrix::Zero(f_size.rows(), f_size.cols());
  if (!with_operands) return bound;
  const auto even_of = [&](const BrdfTable& table) { return matrix_of(even_errors(table, channel), table); };
  const auto odd_of = [&](const BrdfTable& table) -> Matrix {
    if (table.odd_part.empty()) return Matrix::Zero(f_size.rows(), f_size.cols());
    return matrix_of(of_channel(table.odd_part, table, channel), table);
  };
  const bool is_isotropic = f.form == TableForm::isotropic;
  const auto largest_of = [&](const BrdfTable& table) {
    return matrix_of(of_channel(table.error, table, channel), table);
  };
  Matrix of_f = largest_of(f) * weights.asDiagonal() * g_size;
  Matrix of_g = f_size * weights.asDiagonal() * largest_of(g);
  if (is_isotropic && !f.even_error.empty()) {
    of_f = of_f.cwiseMin((even_of(f) + odd_of(f)) * weights.asDiagonal() * root_mean_square(g, channel));
  }
  if (is_isotropic && !g.even_error.empty()) {
    of_g = of_g.cwiseMin(root_mean_square(f, channel) * weights.asDiagonal() * (even_of(g) + odd_of(g)));
  }
  const Matrix of_both = odd_of(f) * weights.asDiagonal() * odd_of(g);
  bound.largest += of_f + of_g + of_both;
  bound.even += even_of(f) * weights.asDiagonal() * g_size + f_size * weights.asDiagonal() * even_of(g) + of_both;
  bound.odd = odd_of(f) * weights.asDiagonal() * g_size + f_size * weights.asDiagonal() * odd_of(g);
  return bound;
}

void append(const Matrix& matrix, std::vector<double>& numbers) {
  numbers.insert(numbers.end(), matrix.data(), matrix.data() + matrix.size());
}

/// Whether the parts of errors are worth to be kept apart.
bool tells_parts(const BrdfTable& f, const BrdfTable& g) {
  return f.form == TableForm::isotropic && !(f.even_error.empty() && g.even_error.empty());
}

bool can_refine_rings(const BrdfTable& table, const std::vector<Material>& materials) {
  return !materials.empty() && table.grid.is_product() && std::ranges::all_of(materials, is_isotropic);
}

}  // namespace

CompositionErrors composition_error(const Device& device, const BrdfTable& f, const BrdfTable& g,
                                    const TableValues& product, Precision precision) {
  const HemisphereGrid& grid = f.grid;
  const std::size_t rings = grid.rings().size();
  const std::vector<Material> materials = chain(f, g);
  const bool is_gauss = grid.kind() == GridKind::gauss && rings > 1;
  std::optional<RefinedRings> refined;
  if (can_refine_rings(f, materials)) refined.emplace(device, grid, materials, precision);
  const bool has_thinned = !refined && materials.size() != 2 && is_gauss;
  const bool is_thinned = has_thinned && f.form == TableForm::isotropic;
  // The check of a chain of three and more by formulas sees the errors of its operands, too.
  const bool with_operands = materials.empty() || materials.size() == 2 || has_thinned;
  CompositionErrors errors;
  for (std::size_t channel = 0; channel < f.channels; ++channel) {
    const std::span values = std::span(product).subspan(channel * f.size(), f.size());
    std::vector<double> quadrature;
    std::vector<double> mean;
    if (refined) {
      const std::size_t half = grid.half_azimuths();
      const std::size_t n_phi = grid.n_phi();
      const bool is_isotropic = f.form == TableForm::isotropic;
      quadrature = refined->bounds(channel, [&](std::size_t i, std::size_t j, std::size_t k) {
        return is_isotropic ? values[(i * rings + j) * half + k] : values[i * n_phi * grid.nodes() + j * n_phi + k];
      });
    } else if (materials.size() == 2) {
      quadrature = refined_nodes(device, grid, materials, channel, values, precision);
    } else if (is_thinned) {
      ThinnedBounds bounds = thinned_bounds(device, f, g, channel, values, precision);
      quadrature = std::move(bounds.largest);
      mean = std::move(bounds.mean);
    } else if (has_thinned) {
      quadrature = thinned_row_bounds(device, f, g, channel, values, precision);
    } else {
      // Operators that are constant on cells multiply exactly; of other ones, and of long chains of formulas that they
      // stand for, nothing is known.
      const bool is_exact = materials.empty() && is_constant_on_cells(f);
      quadrature.assign(rings * rings, is_exact ? 0 : std::numeric_limits<double>::quiet_NaN());
    }
    if (mean.empty()) mean = quadrature;
    const double safety = has_thinned ? kThinnedSafety : kCheckSafety;
    const PairErrors other = propagated(f, g, channel, precision, with_operands);
    append(safety * matrix_of(quadrature, f) + other.largest, errors.largest);
    if (!is_thinned && !tells_parts(f, g)) continue;
    append(safety * matrix_of(mean, f) + other.even, errors.even);
    append(other.odd, errors.odd);
  }
  return errors;
}

std::vector<double> propagated_error(const BrdfTable& f, const BrdfTable& g, Precision precision) {
  std::vector<double> errors;
  for (std::size_t channel = 0; channel < f.channels; ++channel) {
    append(propagated(f, g, channel, precision, true).largest, errors);
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
  } else if (f.grid.kind() == GridKind::gauss && f.form == TableForm::general) {
    const std::uint64_t nodes = f.grid.nodes();
    const std::uint64_t inner = (nodes + 1) / 2;
    const std::uint64_t checked = rings * std::min(f.grid.n_phi(), kThinnedRows);
    bytes = sizeof(double) * (inner * nodes + checked * inner + 3 * checked * nodes) +
            multiply_workspace_bytes(device, checked, inner, nodes, precision);
  } else if (f.grid.kind() == GridKind::gauss) {
    // The largest: both operands on every second azimuth, and two products, one of them with all azimuths.
    const std::uint64_t half = f.grid.half_azimuths();
    bytes = sizeof(double) * rings * rings * 3 * half +
            isotropic_workspace_bytes(device, {rings, rings / 2, rings, f.grid.n_phi()}, precision);
  }
  return bytes;
}

}  // namespace lobe
