#include "formats/interpolation_error.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <utility>

#include "core/parallel.hpp"
#include "hemisphere/unit_vector.hpp"

namespace lobe {
namespace {

using std::numbers::pi;

constexpr std::size_t kNear = 24;  // deviations that an error is made of
constexpr double kCoverage = 0.93;
constexpr double kGrowth = 1.25;  // power of the distance beyond the gaps
constexpr double kMostGrowth = 10;

/// L and V by half-vector, at azimuth 0, and difference vector (Rusinkiewicz 1998), with L at an azimuth.
Directions pair_of(double theta_h, double theta_d, double phi_d, double phi_in) {
  const auto [in, out] = half_difference_vectors(theta_h, theta_d, phi_d);
  return {std::acos(std::clamp(in.z(), -1.0, 1.0)), std::acos(std::clamp(out.z(), -1.0, 1.0)),
          std::atan2(out.y(), out.x()) - std::atan2(in.y(), in.x()), phi_in};
}

}  // namespace

double quantile_of(std::vector<double> values, double share) {
  if (values.empty()) return 0;
  const auto place = values.begin() + static_cast<std::ptrdiff_t>(share * static_cast<double>(values.size() - 1));
  std::ranges::nth_element(values, place);
  return *place;
}

std::vector<Directions> arbitrary_pairs(std::span<const Directions> samples) {
  constexpr std::size_t kMostPairs = 4000;
  double most_in = 0;
  double most_out = 0;
  for (const Directions& pair : samples) {
    most_in = std::max(most_in, pair.theta_in);
    most_out = std::max(most_out, pair.theta_out);
  }
  // Points of the additive recurrence by powers of the generalised golden ratio (Roberts 2018).
  constexpr std::array<double, 4> kSteps{0.8566748838545029, 0.733891856627126, 0.6287067210378087, 0.5385972572236101};
  std::array<double, 4> place{0.5, 0.5, 0.5, 0.5};
  std::vector<Directions> pairs;
  for (std::size_t i = 0; i < std::min(4 * samples.size(), kMostPairs); ++i) {
    for (std::size_t d = 0; d < place.size(); ++d) place[d] = std::fmod(place[d] + kSteps[d], 1.0);
    const double phi_in = 2 * pi * place[3];
    if (i % 2 == 0) {
      pairs.push_back({std::asin(place[0] * std::sin(most_in)), std::asin(place[1] * std::sin(most_out)),
                       2 * pi * place[2], phi_in});
      continue;
    }
    const Directions pair = pair_of(pi / 2 * std::pow(place[0], 3), pi / 2 * place[1], 2 * pi * place[2], phi_in);
    if (pair.theta_in <= most_in && pair.theta_out <= most_out) pairs.push_back(pair);
  }
  return pairs;
}

std::vector<double> gaps_between(const PointIndex& samples, const PairCoordinates& coordinates,
                                 std::span<const Directions> arbitrary, std::span<const std::size_t> which) {
  constexpr std::size_t kAround = 9;
  const PointIndex pairs(coordinates.of(arbitrary));
  std::vector<double> distances;
  for (Eigen::Index i = 0; i < pairs.points().cols(); ++i) {
    distances.push_back(samples.nearest(pairs.points().col(i).data(), 1)[0].distance);
  }
  std::vector<double> gaps;
  for (const std::size_t sample : which) {
    std::vector<double> around;
    for (const auto& one : pairs.nearest(samples.points().col(static_cast<Eigen::Index>(sample)).data(), kAround)) {
      around.push_back(distances[one.index]);
    }
    gaps.push_back(quantile_of(std::move(around), 0.5));
  }
  return gaps;
}

InterpolationError::InterpolationError(Deviations deviations)
    : index_(std::move(deviations.points)),
      alone_(std::move(deviations.alone)),
      surrounded_(std::move(deviations.surrounded)),
      gaps_(std::move(deviations.gaps)),
      anywhere_(surrounded_.colwise().mean()) {
  calibrate();
}

Eigen::RowVectorXd InterpolationError::at(const double* point, double distance) const {
  return factor_ * unscaled(index_.nearest(point, kNear), distance);
}

Eigen::RowVectorXd InterpolationError::unscaled(std::span<const PointIndex::Neighbour> near, double distance) const {
  Eigen::RowVectorXd roots = Eigen::RowVectorXd::Zero(alone_.cols());
  double gap = 0;
  double weights = 0;
  const double soft = near.back().distance / 2;
  for (const auto& one : near) {
    const auto row = static_cast<Eigen::Index>(one.index);
    const double weight = soft > 0 ? std::pow(soft / (soft + one.distance), 2) : 1;
    const double share = gaps_[one.index] > 0 ? std::min(1.0, std::pow(distance / gaps_[one.index], 2)) : 0;
    roots +=
        weight *
        ((1 - share) * alone_.row(row).cwiseAbs2() + share * surrounded_.row(row).cwiseAbs2()).cwiseSqrt().cwiseSqrt();
    gap += weight * gaps_[one.index];
    weights += weight;
  }
  const double growth = gap > 0 ? std::pow(std::clamp(distance * weights / gap, 1.0, kMostGrowth), kGrowth) : 1;
  // Where the nearest samples agree, others need not.
  return growth * (roots / weights).cwiseAbs2() + (growth - 1) * anywhere_;
}

void InterpolationError::calibrate() {
  const auto channels = static_cast<std::size_t>(alone_.cols());
  std::vector<double> ratios(index_.size() * 2 * channels, -1.0);
  parallel_for(index_.size(), [&](std::size_t i) {
    const auto row = static_cast<Eigen::Index>(i);
    auto near = index_.nearest(index_.points().col(row).data(), kNear + 1);
    std::erase_if(near, [&](const auto& one) { return one.index == i; });
    if (near.empty()) return;
    for (const bool is_alone : {true, false}) {
      const Eigen::RowVectorXd said = unscaled(near, is_alone ? 0 : gaps_[i]);
      for (std::size_t c = 0; c < channels; ++c) {
        const auto channel = static_cast<Eigen::Index>(c);
        const double deviation = (is_alone ? alone_ : surrounded_)(row, channel);
        if (said[channel] > 0) ratios[(2 * i + (is_alone ? 0 : 1)) * channels + c] = deviation / said[channel];
      }
    }
  });
  std::erase_if(ratios, [](double ratio) { return ratio < 0; });
  factor_ = std::max(1.0, quantile_of(std::move(ratios), kCoverage));
}

}  // namespace lobe
