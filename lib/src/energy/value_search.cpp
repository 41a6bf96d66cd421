#include "energy/value_search.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>
#include <numeric>

namespace lobe {
namespace {

using std::numbers::pi;

constexpr double kNearest = 1e-6;  // to a peak or to the horizon, radians

/// Points of a unit cube that fill it evenly however many are taken: multiples of the powers of a root of
/// x^5 = x + 1, modulo 1.
class EvenPoints {
 public:
  std::array<double, 4> next() {
    constexpr double kRoot = 1.1673039782614187;
    std::array<double, 4> point{};
    ++count_;
    double power = 1;
    for (double& x : point) {
      power /= kRoot;
      x = std::fmod(0.5 + static_cast<double>(count_) * power, 1.0);
    }
    return point;
  }

 private:
  std::size_t count_ = 0;
};

/// Above the horizon, an angle beyond the normal on the other side of it.
double clamped(double theta) {
  return std::min(std::abs(theta), std::nextafter(pi / 2, 0));
}

/// From 1e-6 to 1 by its logarithm.
double spread(double x) {
  return std::pow(kNearest, 1 - x);
}

Directions anywhere(const std::array<double, 4>& x) {
  return {pi / 2 * x[0], pi / 2 * x[1], pi * (2 * x[2] - 1), 2 * pi * x[3]};
}

/// About a direction of the same elevation as the light at an azimuth beside it.
Directions near_peak(const std::array<double, 4>& x, double peak_azimuth) {
  const double theta = pi / 2 * x[0];
  const double away = spread(x[1]);
  const double turn = 2 * pi * x[2];
  const double across = away * std::sin(turn) / std::max(std::sin(theta), away);
  return {theta, clamped(theta + away * std::cos(turn)), peak_azimuth + across, 2 * pi * x[3]};
}

Directions grazing(const std::array<double, 4>& x) {
  return {clamped(pi / 2 - spread(x[0])), clamped(pi / 2 - spread(x[1])), pi * (2 * x[2] - 1), 2 * pi * x[3]};
}

}  // namespace

std::vector<Directions> spread_pairs(std::size_t count, bool with_azimuths) {
  EvenPoints points;
  const std::size_t quarter = std::max<std::size_t>(count / 4, 1);
  std::vector<Directions> pairs;
  for (std::size_t i = 0; i < 4 * quarter; ++i) {
    const auto x = points.next();
    const std::size_t kind = i / quarter;
    pairs.push_back(kind == 0 ? anywhere(x) : kind == 1 ? near_peak(x, pi) : kind == 2 ? near_peak(x, 0) : grazing(x));
    if (!with_azimuths) pairs.back().phi_in = 0;
  }
  return pairs;
}

Directions reversed(const Directions& pair) {
  return {pair.theta_out, pair.theta_in, -pair.delta_phi, pair.phi_in + pair.delta_phi};
}

FoundPair best_pair(const PairMerit& merit, std::span<const Directions> pairs, const Eigen::ArrayXd& merits,
                    bool with_azimuths) {
  constexpr std::size_t kStarts = 8;
  constexpr std::size_t kTrials = 24;  // around each
  constexpr double kFirstReach = 0.3;
  constexpr double kLastReach = 1e-5;
  std::vector<std::size_t> order(pairs.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  const auto at = [&](std::size_t i) { return merits(static_cast<Eigen::Index>(i)); };
  const std::size_t count = std::min(kStarts, order.size());
  std::partial_sort(order.begin(), order.begin() + static_cast<std::ptrdiff_t>(count), order.end(),
                    [&](std::size_t a, std::size_t b) { return at(a) > at(b) || (at(a) == at(b) && a < b); });
  std::vector<FoundPair> best;
  for (std::size_t i = 0; i < count; ++i) best.push_back({at(order[i]), pairs[order[i]]});

  EvenPoints points;
  for (double reach = kFirstReach; reach > kLastReach; reach *= 0.5) {
    std::vector<Directions> trials;
    for (const auto& found : best) {
      for (std::size_t k = 0; k < kTrials; ++k) {
        const auto x = points.next();
        const auto step = [&](std::size_t axis) { return reach * (2 * x[axis] - 1); };
        trials.push_back({clamped(found.at.theta_in + step(0)), clamped(found.at.theta_out + step(1)),
                          found.at.delta_phi + step(2), with_azimuths ? found.at.phi_in + step(3) : 0});
      }
    }
    const Eigen::ArrayXd values = merit(trials);
    for (std::size_t i = 0; i < trials.size(); ++i) {
      FoundPair& found = best[i / kTrials];
      const double value = values(static_cast<Eigen::Index>(i));
      if (value > found.merit) found = {value, trials[i]};
    }
  }
  return *std::ranges::max_element(best, {}, &FoundPair::merit);
}

}  // namespace lobe
