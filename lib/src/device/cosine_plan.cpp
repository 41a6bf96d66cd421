#include "device/cosine_plan.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace lobe {
namespace {

/// Orders that depend on a run of folded points only.
struct OrderClass {
  std::size_t first_point;       ///< where the run begins
  std::vector<unsigned> points;  ///< the azimuth k that stands for each point of the run
  std::vector<unsigned> orders;
};

/// Differences f[k] - f[length-k], left at length-k: orders stride, 3 stride, 5 stride, ...
OrderClass odd_class(std::size_t length, std::size_t stride) {
  OrderClass result{length / 2 + 1, {}, {}};
  for (std::size_t point = result.first_point; point <= length; ++point) {
    result.points.push_back(static_cast<unsigned>(length - point));
  }
  for (std::size_t q = 1; q <= length; q += 2) result.orders.push_back(static_cast<unsigned>(q * stride));
  return result;
}

/// Sums f[k] + f[length-k], left at k: orders 0, 2 stride, 4 stride, ...
OrderClass even_class(std::size_t length, std::size_t stride) {
  OrderClass result{0, {}, {}};
  for (std::size_t point = 0; 2 * point <= length; ++point) result.points.push_back(static_cast<unsigned>(point));
  for (std::size_t q = 0; q <= length; q += 2) result.orders.push_back(static_cast<unsigned>(q * stride));
  return result;
}

/// The classes in the sequence of their points, and how often to fold for them.
std::vector<OrderClass> separate(std::size_t half, std::size_t& levels) {
  std::vector<OrderClass> classes;
  std::size_t length = half;
  std::size_t stride = 1;
  for (levels = 1;; ++levels) {
    classes.push_back(odd_class(length, stride));
    // Only an even length folds again; sums that fill a single strip gain nothing by it.
    if (length % 2 != 0 || length / 2 + 1 <= CosinePlan::kStrip) break;
    length /= 2;
    stride *= 2;
  }
  classes.push_back(even_class(length, stride));
  std::reverse(classes.begin(), classes.end());
  return classes;
}

struct Run {
  std::size_t first, count;
};

/// Appends strips for a dense matrix; coefficient(output, input) counts from the beginning of either run.
template <typename Coefficient>
void append_strips(CosinePlan::Direction& direction, Run outputs, Run inputs, const Coefficient& coefficient) {
  constexpr std::size_t kStrip = CosinePlan::kStrip;
  for (std::size_t first = 0; first < outputs.count; first += kStrip) {
    direction.strips.push_back({static_cast<std::uint32_t>(outputs.first + first),
                                static_cast<std::uint32_t>(inputs.first), static_cast<std::uint32_t>(inputs.count),
                                static_cast<std::uint32_t>(direction.coefficients.size())});
    for (std::size_t input = 0; input < inputs.count; ++input) {
      for (std::size_t output = first; output < first + kStrip; ++output) {
        direction.coefficients.push_back(output < outputs.count ? coefficient(output, input) : 0.0);
      }
    }
  }
}

}  // namespace

double cosine_of(std::size_t m, std::size_t k, std::size_t half) {
  std::size_t turn = m * k % (2 * half);
  if (turn > half) turn = 2 * half - turn;
  const auto angle = [&](std::size_t part) {
    return std::numbers::pi_v<long double> * static_cast<long double>(part) / static_cast<long double>(half);
  };
  if (2 * turn == half) return 0.0;
  return static_cast<double>(2 * turn < half ? std::cos(angle(turn)) : -std::cos(angle(half - turn)));
}

CosinePlan make_cosine_plan(std::size_t azimuths) {
  const std::size_t half = azimuths / 2;
  CosinePlan plan{half + 1, 0, {}, {}, {}};
  // Trapezium rule over half a turn, and its mirror image: the ends count once, all else twice. Where sums were folded
  // about their middle, fold() has doubled that, and it counts as an end.
  const auto quadrature = 2 * std::numbers::pi / static_cast<double>(azimuths);
  const auto series = 1 / (2 * std::numbers::pi);
  for (const auto& part : separate(half, plan.levels)) {
    const Run points{part.first_point, part.points.size()};
    const Run orders{plan.orders.size(), part.orders.size()};
    const unsigned first_order = part.orders.front();
    const bool middle = first_order == 0 && half >> (plan.levels - 1) == std::size_t{2} * part.points.back();
    append_strips(plan.forward, orders, points, [&](std::size_t order, std::size_t point) {
      const unsigned k = part.points[point];
      const bool end = k == 0 || (middle && k == part.points.back());
      return (end ? 1 : 2) * quadrature * cosine_of(part.orders[order], k, half);
    });
    append_strips(plan.inverse, points, orders, [&](std::size_t point, std::size_t order) {
      const unsigned m = part.orders[order];
      return (m == 0 || m == half ? 1 : 2) * series * cosine_of(m, part.points[point], half);
    });
    plan.orders.insert(plan.orders.end(), part.orders.begin(), part.orders.end());
  }
  return plan;
}

}  // namespace lobe
