#include "table/cell_cubature.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <utility>

#include "core/parallel.hpp"
#include "lobe/core/error.hpp"

namespace lobe {
namespace {

using std::numbers::pi;

// Tolerance of averages, relative to the value and to the mean one: over three coordinates and over four.
constexpr double kTolerance = 1e-5;
constexpr double kToleranceOfFour = 1e-4;
constexpr std::size_t kPairsAtOnce = 4096;   // that a thread asks for
constexpr std::size_t kPairsInTurn = 65536;  // that a function which takes one call at a time is asked for
constexpr double kFinest = 1e-7;             // length of a box that is halved no further, relative to the hemisphere

// What is left of a difference after halving: at first a quarter, as of kinks; then what the last halving left, but no
// less than rules of three nodes promise, and no more than half, as of jumps.
constexpr double kFirstRate = 0.25;
constexpr double kLeastRate = 1.0 / 32;
constexpr double kLargestRate = 0.5;
constexpr double kLuck = 1.0 / 16;  // of the expected difference is an error where there is none by accident

bool overlap(double a_low, double a_high, double b_low, double b_high) {
  return a_low <= b_high && b_low <= a_high;
}

/// Whether two arcs of azimuth overlap.
bool arcs_overlap(double a_low, double a_high, double b_low, double b_high) {
  const double between = std::remainder((a_low + a_high - b_low - b_high) / 2, 2 * pi);
  return std::abs(between) <= (a_high - a_low + b_high - b_low) / 2 + 1e-12;
}

}  // namespace

CellCubature::CellCubature(const AveragedFunction& function, const HemisphereGrid& grid, std::size_t channels,
                           PairCoordinates coordinates, int nodes)
    : function_(function), channels_(channels), coordinates_(coordinates), rule_(gauss_rule(nodes)) {
  if (coordinates == PairCoordinates::rings) return;
  for (std::size_t node = 0; node < grid.nodes(); ++node) cells_.push_back(arc_cell(grid, node));
}

std::size_t CellCubature::least_pairs() const {
  const auto nodes = static_cast<std::size_t>(std::pow(rule_.nodes.size(), dimensions()));
  return nodes * (1 + (std::size_t{1} << dimensions()));
}

double CellCubature::extent(const PairBox& box, std::size_t axis) const {
  if (!is_polar(axis)) return box.high[axis] - box.low[axis];
  if (coordinates_ == PairCoordinates::cells) {
    return cells_[axis == 0 ? box.in : box.out].measure(std::sin(box.low[axis]), std::sin(box.high[axis]));
  }
  // sin^2 b - sin^2 a = sin(b + a) sin(b - a)
  return std::sin(box.high[axis] + box.low[axis]) * std::sin(box.high[axis] - box.low[axis]) / 2;
}

double CellCubature::measure(const PairBox& box) const {
  double product = 1;
  for (std::size_t k = 0; k < dimensions(); ++k) product *= extent(box, k);
  return product;
}

double CellCubature::density(const PairBox& box, std::size_t axis, double x) const {
  if (!is_polar(axis)) return 1;
  if (coordinates_ == PairCoordinates::rings) return std::sin(2 * x) / 2;
  const ArcCell& cell = cells_[axis == 0 ? box.in : box.out];
  const double r = std::sin(x);
  return ((cell.high.turn - cell.low.turn) * r + cell.high.bend - cell.low.bend) * std::cos(x);
}

Directions CellCubature::pair_at(const PairBox& box, const std::array<double, 4>& x) const {
  if (coordinates_ == PairCoordinates::rings) return {x[0], x[1], x[2], 0};
  const auto azimuth = [](const ArcCell& cell, double theta, double share) {
    const double r = std::sin(theta);
    return (1 - share) * cell.low.at(r) + share * cell.high.at(r);
  };
  const double phi_in = azimuth(cells_[box.in], x[0], x[1]);
  return {x[0], x[2], azimuth(cells_[box.out], x[2], x[3]) - phi_in, phi_in};
}

std::pair<double, double> CellCubature::azimuths(const PairBox& box, bool is_out) const {
  const std::size_t k = is_out ? 2 : 0;
  std::vector<double> corners;
  for (const double theta : {box.low[k], box.high[k]}) {
    for (const double share : {box.low[k + 1], box.high[k + 1]}) {
      const ArcCell& cell = cells_[is_out ? box.out : box.in];
      const double r = std::max(std::sin(theta), 1e-12);
      corners.push_back((1 - share) * cell.low.at(r) + share * cell.high.at(r));
    }
  }
  const auto [least, most] = std::ranges::minmax(corners);
  return {least, most};
}

std::array<double, 4> CellCubature::longest(const PairBox& box, double scale) const {
  constexpr double kWidths = 6;  // of a lobe over V is twice the half-vector's
  std::array<double, 4> lengths{};
  lengths.fill(std::numeric_limits<double>::infinity());
  const bool is_rings = coordinates_ == PairCoordinates::rings;
  const std::size_t out = is_rings ? 1 : 2;
  if (!overlap(box.low[0], box.high[0], box.low[out], box.high[out])) return lengths;
  for (const bool is_retro : {false, true}) {
    const double of_lobe = is_retro ? function_.retro_width : function_.width;
    if (of_lobe >= 1) continue;
    const double width = scale * kWidths * of_lobe;
    const double turn = is_retro ? 0 : pi;
    // Across the plane of incidence a lobe is narrower by the cosine, and an azimuth shorter by the sine.
    const double azimuth = std::max(width / std::max(std::tan(std::min(box.high[0], 1.5)), width / pi), 0.05 * width);
    if (is_rings) {
      if (!arcs_overlap(box.low[2], box.high[2], turn, turn)) continue;
      lengths[2] = std::min(lengths[2], azimuth);
    } else {
      const auto [in_low, in_high] = azimuths(box, false);
      const auto [out_low, out_high] = azimuths(box, true);
      if (!arcs_overlap(in_low + turn, in_high + turn, out_low, out_high)) continue;
      const auto share = [&](const ArcCell& cell, double theta) {
        return azimuth / (cell.high.at(std::sin(theta)) - cell.low.at(std::sin(theta)));
      };
      lengths[1] = std::min(lengths[1], share(cells_[box.in], box.high[0]));
      lengths[3] = std::min(lengths[3], share(cells_[box.out], box.high[2]));
    }
    lengths[0] = std::min(lengths[0], width);
    lengths[out] = std::min(lengths[out], width);
  }
  return lengths;
}

void CellCubature::cut(const PairBox& box, std::size_t target, double scale, std::vector<Part>& parts) const {
  const auto lengths = longest(box, scale);
  std::size_t axis = 0;
  double excess = 1;
  for (std::size_t k = 0; k < dimensions(); ++k) {
    const double times = (box.high[k] - box.low[k]) / lengths[k];
    if (times > excess) {
      excess = times;
      axis = k;
    }
  }
  if (excess == 1) {
    parts.push_back({.box = box, .target = target});
    return;
  }
  const double middle = (box.low[axis] + box.high[axis]) / 2;
  PairBox half = box;
  half.high[axis] = middle;
  cut(half, target, scale, parts);
  half = box;
  half.low[axis] = middle;
  cut(half, target, scale, parts);
}

std::vector<CellCubature::Part> CellCubature::first_parts(std::span<const PairBox> boxes, std::size_t budget) const {
  std::vector<Part> parts;
  for (double scale = 1;; scale *= 2) {
    parts.clear();
    for (std::size_t target = 0; target < boxes.size(); ++target) cut(boxes[target], target, scale, parts);
    // Half of what there is beyond the least is enough for looking.
    if (2 * (parts.size() - boxes.size()) * least_pairs() <= budget) return parts;
  }
}

void CellCubature::halve(const Part& part, std::vector<Part>& halves) const {
  for (std::size_t which = 0; which < (std::size_t{1} << dimensions()); ++which) {
    Part half{.box = part.box, .target = part.target};
    for (std::size_t k = 0; k < dimensions(); ++k) {
      const double middle = (part.box.low[k] + part.box.high[k]) / 2;
      ((which >> k & 1U) == 0 ? half.box.high[k] : half.box.low[k]) = middle;
    }
    halves.push_back(half);
  }
}

void CellCubature::evaluate(std::span<const PairBox> targets, Parts& parts) const {
  parts.integrals.assign(parts.parts.size() * channels_, {});
  const auto nodes = static_cast<std::size_t>(std::pow(rule_.nodes.size(), dimensions()));
  const std::size_t block = std::max<std::size_t>(1, (function_.is_concurrent ? kPairsAtOnce : kPairsInTurn) / nodes);
  const std::size_t blocks = (parts.parts.size() + block - 1) / block;
  const auto work = [&](std::size_t b) {
    evaluate(targets, parts, b * block, std::min(block, parts.parts.size() - b * block));
  };
  if (function_.is_concurrent) {
    parallel_for(blocks, work);
  } else {
    for (std::size_t b = 0; b < blocks; ++b) work(b);
  }
}

void CellCubature::evaluate(std::span<const PairBox> targets, Parts& parts, std::size_t first,
                            std::size_t count) const {
  const std::size_t n = rule_.nodes.size();
  const std::size_t axes = dimensions();
  const auto nodes = static_cast<std::size_t>(std::pow(n, axes));
  std::vector<Directions> pairs;
  std::vector<double> weights;
  std::vector<double> distances;
  pairs.reserve(count * nodes);
  for (std::size_t p = first; p < first + count; ++p) {
    const PairBox& box = parts.parts[p].box;
    std::array<std::vector<double>, 4> at;
    std::array<std::vector<double>, 4> weight;
    for (std::size_t k = 0; k < axes; ++k) {
      double sum = 0;
      for (std::size_t i = 0; i < n; ++i) {
        at[k].push_back(box.low[k] + (box.high[k] - box.low[k]) * rule_.nodes[i]);
        weight[k].push_back(rule_.weights[i] * density(box, k, at[k][i]));
        sum += weight[k][i];
      }
      // Constants are exact.
      for (double& w : weight[k]) w *= extent(box, k) / sum;
    }
    for (std::size_t node = 0; node < nodes; ++node) {
      std::array<double, 4> x{};
      double w = 1;
      std::size_t rest = node;
      for (std::size_t k = 0; k < axes; ++k) {
        x[k] = at[k][rest % n];
        w *= weight[k][rest % n];
        rest /= n;
      }
      weights.push_back(w);
      distances.push_back(axes == 3 ? x[2] - targets[parts.parts[p].target].low[2] : 0);
      pairs.push_back(pair_at(box, x));
    }
  }
  const BrdfValues values = function_.at(pairs);
  if (!values.value.allFinite()) {
    throw NumericError("'" + function_.name + "' has values that are no finite numbers");
  }
  for (std::size_t p = 0; p < count; ++p) {
    Part& part = parts.parts[first + p];
    for (std::size_t c = 0; c < channels_; ++c) {
      BoxIntegral& sum = parts.integrals[(first + p) * channels_ + c];
      const auto channel = static_cast<Eigen::Index>(c);
      double size = 0;
      double total = 0;
      for (std::size_t node = p * nodes; node < (p + 1) * nodes; ++node) {
        const auto row = static_cast<Eigen::Index>(node);
        const double value = weights[node] * values.value(row, channel);
        sum.value += value;
        sum.moment += value * distances[node];
        size += std::abs(value);
        total += weights[node];
        if (values.error.size() > 0) sum.given += weights[node] * values.error(row, channel);
      }
      double variation = 0;
      for (std::size_t node = p * nodes; node < (p + 1) * nodes; ++node) {
        const double value = values.value(static_cast<Eigen::Index>(node), channel);
        variation += weights[node] * std::abs(value - sum.value / total);
      }
      // Channels count alike, and boxes by how much they change.
      if (size > 0) part.variation = std::max(part.variation, variation + 1e-3 * size);
    }
  }
}

CellCubature::Parts CellCubature::refine(std::span<const PairBox> targets, const Parts& parts,
                                         std::span<const double> allowed) const {
  const std::size_t halves = std::size_t{1} << dimensions();
  Parts fine;
  fine.parts.reserve(parts.parts.size() * halves);
  for (const Part& part : parts.parts) halve(part, fine.parts);
  evaluate(targets, fine);
  for (std::size_t p = 0; p < parts.parts.size(); ++p) {
    const BoxIntegral* const before = parts.integrals.data() + p * channels_;
    BoxIntegral* const after = fine.integrals.data() + p * halves * channels_;
    double variation = 0;
    for (std::size_t h = 0; h < halves; ++h) variation += fine.parts[p * halves + h].variation;
    std::vector<double> changes(channels_);
    double size = 0;
    double size_before = 0;
    for (std::size_t c = 0; c < channels_; ++c) {
      for (std::size_t h = 0; h < halves; ++h) changes[c] += after[h * channels_ + c].value;
      changes[c] = std::abs(changes[c] - before[c].value);
      if (allowed.empty()) continue;
      size += changes[c] / allowed[parts.parts[p].target * channels_ + c];
      size_before += before[c].change / allowed[parts.parts[p].target * channels_ + c];
    }
    const bool has_history = size_before > 0;
    const double rate = has_history ? std::clamp(size / size_before, kLeastRate, kLargestRate) : kFirstRate;
    for (std::size_t h = 0; h < halves; ++h) {
      const double share =
          variation > 0 ? fine.parts[p * halves + h].variation / variation : 1 / static_cast<double>(halves);
      for (std::size_t c = 0; c < channels_; ++c) {
        const double change = has_history ? std::max(changes[c], kLuck * before[c].change) : changes[c];
        after[h * channels_ + c].change = change * share;
        after[h * channels_ + c].error = change * share * rate / (1 - rate);
      }
    }
  }
  return fine;
}

std::vector<double> CellCubature::allowed_errors(std::span<const BoxIntegral> sums,
                                                 std::span<const double> volumes) const {
  const double tolerance = std::max(function_.effort.tolerance, dimensions() == 3 ? kTolerance : kToleranceOfFour);
  std::vector<double> level(channels_);
  double volume = 0;
  for (std::size_t target = 0; target < volumes.size(); ++target) {
    volume += volumes[target];
    for (std::size_t c = 0; c < channels_; ++c) level[c] += std::abs(sums[target * channels_ + c].value);
  }
  std::vector<double> allowed;
  for (std::size_t at = 0; at < sums.size(); ++at) {
    const double of_mean = level[at % channels_] / volume * volumes[at / channels_];
    allowed.push_back(std::max(tolerance * (std::abs(sums[at].value) + of_mean), std::numeric_limits<double>::min()));
  }
  return allowed;
}

std::vector<bool> CellCubature::chosen_parts(const Parts& active, std::span<const BoxIntegral> sums,
                                             std::span<const double> allowed, std::size_t most) const {
  constexpr double kKept = 0.5;  // of what is allowed, that parts which are left as they are may have
  std::vector<std::vector<std::pair<double, std::size_t>>> by_target(sums.size() / channels_);
  for (std::size_t p = 0; p < active.parts.size(); ++p) {
    const Part& part = active.parts[p];
    double excess = 0;
    for (std::size_t c = 0; c < channels_; ++c) {
      const std::size_t at = part.target * channels_ + c;
      if (sums[at].error > allowed[at]) {
        excess = std::max(excess, active.integrals[p * channels_ + c].error / allowed[at]);
      }
    }
    if (excess > 0) by_target[part.target].emplace_back(excess, p);
  }
  std::vector<std::pair<double, std::size_t>> wanted;
  for (auto& parts : by_target) {
    std::ranges::sort(parts);
    double kept = 0;
    for (const auto& [excess, p] : parts) {
      kept += excess;
      if (kept <= kKept) continue;
      double length = 0;
      for (std::size_t k = 0; k < dimensions(); ++k) {
        length = std::max(length, active.parts[p].box.high[k] - active.parts[p].box.low[k]);
      }
      if (length > kFinest) wanted.emplace_back(excess, p);
    }
  }
  if (wanted.size() > most) {
    std::ranges::nth_element(wanted, wanted.begin() + static_cast<std::ptrdiff_t>(most), std::greater<>());
    wanted.resize(most);
  }
  std::vector<bool> is_chosen(active.parts.size());
  for (const auto& [excess, p] : wanted) is_chosen[p] = true;
  return is_chosen;
}

void CellCubature::move(const Parts& from, std::size_t part, Parts& to) const {
  to.parts.push_back(from.parts[part]);
  const auto begin = from.integrals.begin() + static_cast<std::ptrdiff_t>(part * channels_);
  to.integrals.insert(to.integrals.end(), begin, begin + static_cast<std::ptrdiff_t>(channels_));
}

void CellCubature::add(const Parts& from, std::size_t part, std::span<BoxIntegral> sums) const {
  for (std::size_t c = 0; c < channels_; ++c) {
    BoxIntegral& sum = sums[from.parts[part].target * channels_ + c];
    const BoxIntegral& more = from.integrals[part * channels_ + c];
    sum.value += more.value;
    sum.moment += more.moment;
    sum.given += more.given;
    sum.error += more.error;
  }
}

std::vector<BoxIntegral> CellCubature::integrate(std::span<const PairBox> boxes, std::size_t& budget,
                                                 const ProgressCallback& progress) const {
  const std::size_t pairs_of_halves = least_pairs() - least_pairs() / ((std::size_t{1} << dimensions()) + 1);
  std::vector<double> volumes;
  for (const PairBox& box : boxes) volumes.push_back(measure(box));
  std::vector<BoxIntegral> settled(boxes.size() * channels_);

  Parts active;
  active.parts = first_parts(boxes, budget);
  evaluate(boxes, active);
  budget -= std::min(budget, active.parts.size() * least_pairs());
  active = refine(boxes, active, {});
  for (std::size_t pass = 1; !active.parts.empty(); ++pass) {
    if (progress && !progress("averaging over cells", 1 - 1 / (1 + 0.2 * static_cast<double>(pass)))) {
      throw Cancelled("cancelled");
    }
    std::vector<BoxIntegral> sums = settled;
    for (std::size_t p = 0; p < active.parts.size(); ++p) add(active, p, sums);
    const auto allowed = allowed_errors(sums, volumes);
    const auto is_chosen = chosen_parts(active, sums, allowed, budget / pairs_of_halves);
    std::vector<bool> is_open(boxes.size());
    for (std::size_t p = 0; p < active.parts.size(); ++p) {
      if (is_chosen[p]) is_open[active.parts[p].target] = true;
    }
    Parts chosen;
    Parts kept;
    for (std::size_t p = 0; p < active.parts.size(); ++p) {
      if (is_chosen[p]) {
        move(active, p, chosen);
      } else if (is_open[active.parts[p].target]) {
        move(active, p, kept);
      } else {
        add(active, p, settled);
      }
    }
    budget -= std::min(budget, chosen.parts.size() * pairs_of_halves);
    active = refine(boxes, chosen, allowed);
    for (std::size_t p = 0; p < kept.parts.size(); ++p) move(kept, p, active);
  }
  return settled;
}

}  // namespace lobe
