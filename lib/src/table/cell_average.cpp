#include "table/cell_average.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <numeric>
#include <optional>
#include <utility>
#include <vector>

#include "lobe/core/error.hpp"
#include "table/cell_cubature.hpp"

namespace lobe {
namespace {

using std::numbers::pi;

constexpr std::size_t kBoxesAtOnce = 100000;  // that are integrated together
// Shares of the budget and of the least that are taken over four coordinates, where halving is slow.
constexpr std::size_t kShareOfFour = 3;
constexpr std::size_t kTimesOfFour = 8;
constexpr std::size_t kLeastOfFour = std::size_t{1} << 20U;

double square(double x) {
  return x * x;
}

/// Many channels take memory, of which parts that wait for halving have a share each.
std::size_t budget_of(const AveragedFunction& function, const BrdfTable& table) {
  constexpr std::size_t kFewChannels = 8;
  return function.effort.budget / (1 + table.channels / kFewChannels);
}

/// Gauss nodes per coordinate of a box, of which a cell has at least two boxes: fewer the more there are.
int nodes_of(std::size_t boxes, std::size_t dimensions, std::size_t points) {
  const int wanted = std::max(1, static_cast<int>((points + 1) / 2));
  if (dimensions == 3) return boxes <= 30000 ? std::max(3, wanted) : boxes <= 600000 ? std::max(2, wanted) : wanted;
  return boxes <= 200000 ? std::max(2, wanted) : wanted > 2 ? wanted : 1;
}

/// The average over a pair of cells, by channel.
struct Average {
  double value = 0;
  double error = 0;
};

/// Puts averages where a table has them.
class TableFiller {
 public:
  explicit TableFiller(BrdfTable& table) : table_(table), rings_(table.grid.rings().size()) {
    table.values.assign(table.channels * table.size(), 0.0);
    table.error.assign(table.channels * rings_ * rings_, 0.0);
  }

  void put(std::size_t channel, std::size_t at, std::size_t ring_in, std::size_t ring_out, const Average& average) {
    table_.values[channel * table_.size() + at] = average.value;
    double& error = table_.error[(channel * rings_ + ring_in) * rings_ + ring_out];
    // A maximum that keeps NaN: unknown.
    if (std::isnan(average.error) || average.error > error) error = average.error;
  }

  /// Adds the rounding of sums.
  void add_rounding(double relative) {
    for (std::size_t c = 0; c < table_.channels; ++c) {
      std::vector<double> largest(rings_);
      const auto values = table_.channel(c);
      const std::size_t row_size = table_.size() / table_.rows();
      for (std::size_t at = 0; at < values.size(); ++at) {
        const std::size_t row = at / row_size;
        const std::size_t ring = table_.form == TableForm::isotropic ? row : table_.grid.ring_of(row);
        largest[ring] = std::max(largest[ring], std::abs(values[at]));
      }
      for (std::size_t pair = 0; pair < rings_ * rings_; ++pair) {
        table_.error[c * rings_ * rings_ + pair] += relative * largest[pair / rings_];
      }
    }
  }

 private:
  BrdfTable& table_;
  std::size_t rings_;
};

/// Averages of isotropic functions between cells of two rings, by the difference of the cells' azimuths.
class RingPair {
 public:
  /// \param is_even delta_phi in [0, pi] is enough
  RingPair(const HemisphereGrid& grid, std::size_t in, std::size_t out, bool is_even)
      : in_(grid.rings()[in]), out_(grid.rings()[out]), is_even_(is_even) {
    a_ = 2 * pi / static_cast<double>(in_.count);
    b_ = 2 * pi / static_cast<double>(out_.count);
    first_ = grid.directions()[out_.first_node].phi - grid.directions()[in_.first_node].phi;
    std::vector<double> limits;
    const auto add = [&](double x) {
      const double turned = std::remainder(x, 2 * pi);
      for (const double limit : {turned, -turned}) {
        if (!is_even_ || limit >= 0) limits.push_back(limit);
      }
    };
    for (std::size_t k = 0; k < steps(); ++k) {
      const double centre = azimuth(k);
      for (const double reach : {a_ + b_, a_ - b_}) {
        add(centre + reach / 2);
        add(centre - reach / 2);
      }
    }
    for (const double x : {0.0, pi / 2, pi}) add(x);  // boxes are at most a quarter of a turn
    limits.push_back(is_even_ ? 0 : -pi);
    std::ranges::sort(limits);
    for (const double limit : limits) {
      if (limits_.empty() || limit - limits_.back() > 1e-9) limits_.push_back(limit);
    }
  }

  [[nodiscard]] std::vector<PairBox> boxes() const {
    std::vector<PairBox> boxes;
    for (std::size_t k = 0; k + 1 < limits_.size(); ++k) {
      boxes.push_back(
          {{in_.theta_low, out_.theta_low, limits_[k], 0}, {in_.theta_high, out_.theta_high, limits_[k + 1], 0}});
    }
    return boxes;
  }

  /// Differences of azimuths of the cells' centres, of a turn.
  [[nodiscard]] std::size_t steps() const { return std::lcm(in_.count, out_.count); }
  /// The difference 0 is among them.
  [[nodiscard]] bool is_centred() const { return first_ == 0; }

  /// \param integrals of boxes(), with `channels` each
  /// \param difference of azimuths, in steps
  [[nodiscard]] Average average(std::span<const BoxIntegral> integrals, std::size_t channels, std::size_t channel,
                                std::size_t difference) const {
    Average sum;
    const double centre = std::remainder(azimuth(difference), 2 * pi);
    for (int turn = -2; turn <= 2; ++turn) {
      add(integrals, channels, channel, centre + 2 * pi * turn, sum);
      if (is_even_) add(integrals, channels, channel, -centre + 2 * pi * turn, sum);
    }
    const double u_in = (square(std::sin(in_.theta_high)) - square(std::sin(in_.theta_low))) / 2;
    const double u_out = (square(std::sin(out_.theta_high)) - square(std::sin(out_.theta_low))) / 2;
    const double measure = a_ * b_ * u_in * u_out;
    return {sum.value / measure, sum.error / measure};
  }

 private:
  [[nodiscard]] double azimuth(std::size_t steps_on) const {
    return first_ + 2 * pi * static_cast<double>(steps_on) / static_cast<double>(steps());
  }

  /// The integrals times the azimuths that both cells share, whose centres are this far apart.
  void add(std::span<const BoxIntegral> integrals, std::size_t channels, std::size_t channel, double azimuth,
           Average& sum) const {
    const double reach = (a_ + b_) / 2;
    const auto shared = [&](double delta_phi) {
      return std::clamp(reach - std::abs(delta_phi - azimuth), 0.0, std::min(a_, b_));
    };
    const auto begin = std::ranges::upper_bound(limits_, azimuth - reach);
    for (auto k = static_cast<std::size_t>(std::max<std::ptrdiff_t>(begin - limits_.begin() - 1, 0));
         k + 1 < limits_.size() && limits_[k] < azimuth + reach; ++k) {
      const BoxIntegral& part = integrals[k * channels + channel];
      const double low = shared(limits_[k]);
      const double high = shared(limits_[k + 1]);
      sum.value += low * part.value + (high - low) * part.moment / (limits_[k + 1] - limits_[k]);
      sum.error += std::max(low, high) * (part.error + part.given);
    }
  }

  Ring in_;
  Ring out_;
  bool is_even_;
  double a_ = 0;
  double b_ = 0;
  double first_ = 0;            ///< difference of the first cells' azimuths
  std::vector<double> limits_;  ///< of delta_phi
};

/// Puts a ring pair's averages into a table; by way of the transposed pair where the function is reciprocal.
void put_ring_pair(const RingPair& pair, std::span<const BoxIntegral> integrals, std::size_t in, std::size_t out,
                   bool is_transposed, const AveragedFunction& function, const BrdfTable& table, TableFiller& filler) {
  const HemisphereGrid& grid = table.grid;
  const std::size_t rings = grid.rings().size();
  const std::size_t row_ring = is_transposed ? out : in;
  const std::size_t column_ring = is_transposed ? in : out;
  const Ring& from = grid.rings()[in];
  const Ring& to = grid.rings()[out];
  for (std::size_t c = 0; c < table.channels; ++c) {
    std::vector<std::optional<Average>> known(pair.steps());
    // By steps that V's cell is further on than L's: numbers, so that equal averages are equal to the bit.
    const auto average = [&](std::size_t steps) {
      const std::size_t other = (pair.steps() - steps) % pair.steps();
      auto& found = known[function.is_bilateral && pair.is_centred() ? std::min(steps, other) : steps];
      if (!found) {
        found = pair.average(integrals, table.channels, c, static_cast<std::size_t>(&found - known.data()));
      }
      return *found;
    };
    if (table.form == TableForm::isotropic) {
      const std::size_t half = grid.half_azimuths();
      for (std::size_t k = 0; k < half; ++k) {
        const std::size_t back = (pair.steps() - k) % pair.steps();
        Average value = average(is_transposed ? back : k);
        if (!function.is_bilateral) {
          const Average other = average(is_transposed ? k : back);
          value = {(value.value + other.value) / 2,
                   (value.error + other.error) / 2 + std::abs(value.value - other.value) / 2};
        }
        filler.put(c, (row_ring * rings + column_ring) * half + k, row_ring, column_ring, value);
      }
      continue;
    }
    for (std::size_t i = 0; i < from.count; ++i) {
      for (std::size_t j = 0; j < to.count; ++j) {
        const std::size_t steps =
            (j * (pair.steps() / to.count) + (from.count - i) * (pair.steps() / from.count)) % pair.steps();
        const std::size_t row = from.first_node + i;
        const std::size_t column = to.first_node + j;
        filler.put(c, is_transposed ? column * grid.nodes() + row : row * grid.nodes() + column, row_ring, column_ring,
                   average(steps));
      }
    }
  }
}

void average_rings(const AveragedFunction& function, BrdfTable& table, std::size_t points,
                   const ProgressCallback& progress) {
  struct Task {
    std::size_t in, out;
    RingPair pair;
  };
  const std::size_t rings = table.grid.rings().size();
  std::vector<Task> tasks;
  std::size_t all = 0;
  for (std::size_t in = 0; in < rings; ++in) {
    for (std::size_t out = function.is_reciprocal ? in : 0; out < rings; ++out) {
      tasks.push_back({in, out, RingPair(table.grid, in, out, function.is_bilateral)});
      all += tasks.back().pair.boxes().size();
    }
  }
  const CellCubature cubature(function, table.grid, table.channels, PairCoordinates::rings, nodes_of(all, 3, points));
  TableFiller filler(table);
  std::size_t budget = budget_of(function, table);
  std::size_t done = 0;
  for (std::size_t first = 0; first < tasks.size();) {
    std::vector<PairBox> boxes;
    std::size_t last = first;
    for (; last < tasks.size() && boxes.size() < kBoxesAtOnce; ++last) {
      const auto more = tasks[last].pair.boxes();
      boxes.insert(boxes.end(), more.begin(), more.end());
    }
    // Each batch has its share of what is left.
    std::size_t share = boxes.size() * cubature.least_pairs();
    share += static_cast<std::size_t>(static_cast<double>(budget) * static_cast<double>(boxes.size()) /
                                      static_cast<double>(all - done));
    const std::size_t before = share;
    const auto integrals = cubature.integrate(boxes, share, progress);
    const std::size_t used = before - share;
    budget -= std::min(budget, used - std::min(used, boxes.size() * cubature.least_pairs()));
    done += boxes.size();
    std::size_t box = 0;
    for (; first < last; ++first) {
      const Task& task = tasks[first];
      const std::size_t count = task.pair.boxes().size();
      const auto part = std::span(integrals).subspan(box * table.channels, count * table.channels);
      put_ring_pair(task.pair, part, task.in, task.out, false, function, table, filler);
      if (function.is_reciprocal && task.in != task.out) {
        put_ring_pair(task.pair, part, task.in, task.out, true, function, table, filler);
      }
      box += count;
    }
  }
  filler.add_rounding(function.rounding);
}

/// All pairs of directions of two cells.
PairBox pair_box(const HemisphereGrid& grid, std::size_t in, std::size_t out) {
  const Ring& from = grid.rings()[grid.ring_of(in)];
  const Ring& to = grid.rings()[grid.ring_of(out)];
  return {{from.theta_low, 0, to.theta_low, 0}, {from.theta_high, 1, to.theta_high, 1}, in, out};
}

/// Nodes after turns of the hemisphere that an isotropic function does not see, and after the mirror image of azimuths.
std::vector<std::vector<std::size_t>> symmetries(const HemisphereGrid& grid, const AveragedFunction& function) {
  std::vector<std::vector<std::size_t>> maps;
  const int turns = function.is_isotropic ? 4 : 1;
  const int signs = function.is_isotropic && function.is_bilateral ? 2 : 1;
  for (int turn = 0; turn < turns; ++turn) {
    for (int sign = 0; sign < signs; ++sign) {
      std::vector<std::size_t> map;
      for (const Direction& at : grid.directions()) {
        map.push_back(grid.node_at({at.theta, (sign == 0 ? at.phi : -at.phi) + turn * pi / 2}));
      }
      maps.push_back(std::move(map));
    }
  }
  return maps;
}

/// Isotropic functions reach this on the squares of Shirley and Chiu alone, which quarter turns map onto each other.
void average_pairs(const AveragedFunction& function, BrdfTable& table, std::size_t points,
                   const ProgressCallback& progress) {
  const HemisphereGrid& grid = table.grid;
  const std::size_t n = grid.nodes();
  const auto maps = symmetries(grid, function);
  std::vector<bool> is_known(n * n);
  std::vector<std::pair<std::size_t, std::size_t>> tasks;
  for (std::size_t in = 0; in < n; ++in) {
    for (std::size_t out = 0; out < n; ++out) {
      if (is_known[in * n + out]) continue;
      tasks.emplace_back(in, out);
      for (const auto& map : maps) {
        is_known[map[in] * n + map[out]] = true;
        if (function.is_reciprocal) is_known[map[out] * n + map[in]] = true;
      }
    }
  }
  const CellCubature cubature(function, grid, table.channels, PairCoordinates::cells,
                              nodes_of(tasks.size(), 4, points));
  TableFiller filler(table);
  std::size_t budget = std::min(budget_of(function, table) / kShareOfFour,
                                std::max(kLeastOfFour, kTimesOfFour * tasks.size() * cubature.least_pairs()));
  for (std::size_t first = 0; first < tasks.size(); first += kBoxesAtOnce) {
    const std::size_t count = std::min(kBoxesAtOnce, tasks.size() - first);
    std::vector<PairBox> boxes;
    for (std::size_t k = first; k < first + count; ++k) {
      boxes.push_back(pair_box(grid, tasks[k].first, tasks[k].second));
    }
    std::size_t share = count * cubature.least_pairs();
    share += static_cast<std::size_t>(static_cast<double>(budget) * static_cast<double>(count) /
                                      static_cast<double>(tasks.size() - first));
    const std::size_t before = share;
    const auto integrals = cubature.integrate(boxes, share, progress);
    const std::size_t used = before - share;
    budget -= std::min(budget, used - std::min(used, count * cubature.least_pairs()));
    for (std::size_t k = 0; k < count; ++k) {
      const auto [in, out] = tasks[first + k];
      const double measure = cubature.measure(boxes[k]);
      for (std::size_t c = 0; c < table.channels; ++c) {
        const BoxIntegral& sum = integrals[k * table.channels + c];
        const Average average{sum.value / measure, (sum.error + sum.given) / measure};
        for (const auto& map : maps) {
          const std::size_t i = map[in];
          const std::size_t j = map[out];
          filler.put(c, i * n + j, grid.ring_of(i), grid.ring_of(j), average);
          if (function.is_reciprocal) filler.put(c, j * n + i, grid.ring_of(j), grid.ring_of(i), average);
        }
      }
    }
  }
  filler.add_rounding(function.rounding);
}

}  // namespace

void average_over_cells(const AveragedFunction& function, BrdfTable& table, std::size_t points,
                        const ProgressCallback& progress) {
  if (function.is_isotropic && table.grid.kind() != GridKind::shirley_chiu) {
    average_rings(function, table, points, progress);
  } else {
    average_pairs(function, table, points, progress);
  }
}

}  // namespace lobe
