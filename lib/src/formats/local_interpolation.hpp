#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <memory>
#include <span>
#include <vector>

namespace lobe {

/// Points that are searched for neighbours.
class PointIndex {
 public:
  /// \param points dimensions x count, up to 4 x 2^31
  explicit PointIndex(Eigen::MatrixXd points);

  [[nodiscard]] const Eigen::MatrixXd& points() const;
  [[nodiscard]] std::size_t size() const { return static_cast<std::size_t>(points().cols()); }

  struct Neighbour {
    std::size_t index;
    double distance;
  };
  /// The nearest ones, by distance; fewer where there are fewer.
  [[nodiscard]] std::vector<Neighbour> nearest(const double* point, std::size_t count) const;
  /// All within a distance, by distance.
  [[nodiscard]] std::vector<Neighbour> within(const double* point, double distance) const;

 private:
  struct Tree;
  std::shared_ptr<const Tree> tree_;
};

/// How values between points are found: radial basis functions -r^exponent and a constant through the `neighbours`
/// nearest points, with linear terms of prior weight `trend`. They pass the range of the values of these points by at
/// most a quarter of it, and 0.3, also beyond the points, and zero not at all unless some of them do.
struct LocalScheme {
  static constexpr double kBeyond = 0.25;  ///< of the range
  static constexpr double kMostBeyond = 0.3;

  double exponent = 1;  ///< 1, 1.5 or 1.75
  double trend = 1;
  std::size_t neighbours = 40;
};

/// Predicts values at a point from its neighbours, leaving out the point and all others within a radius of it (but at
/// most 5 of 6 of the neighbours considered).
/// \param values points x channels
/// \param radii one for each of `which`
/// \return which x channels
[[nodiscard]] Eigen::MatrixXd left_out(const PointIndex& index, const Eigen::MatrixXd& values,
                                       const LocalScheme& scheme, std::span<const std::size_t> which,
                                       std::span<const double> radii);

/// Interpolates values at scattered points: every point has radial basis functions through it and its neighbours, and
/// between points those of the nearest ones are blended, with weights that fall to 0 before another one comes in
/// (modified Shepard method, Franke and Nielson 1980). Continuous, and exact at the points.
class LocalInterpolation {
 public:
  static constexpr std::size_t kMostValues = 2'000'000;  ///< which take some two gigabytes

  /// \param values points x channels, up to kMostValues in all
  LocalInterpolation(PointIndex index, const Eigen::MatrixXd& values, const LocalScheme& scheme);

  /// A point whose functions are blended; the weights of a blend add up to 1.
  struct Share {
    std::size_t index;
    double weight;
    double distance;
  };
  /// The blend at a point, the nearest one first.
  [[nodiscard]] std::vector<Share> blend(const double* point) const;
  /// The value of a blend at its point, by channel.
  [[nodiscard]] Eigen::RowVectorXd value(const double* point, std::span<const Share> blend) const;
  /// How far from 0 the value of a blend can be at most, by channel.
  [[nodiscard]] Eigen::RowVectorXd largest(std::span<const Share> blend) const;
  [[nodiscard]] Eigen::Index channels() const;

 private:
  struct Patches;

  PointIndex index_;
  std::shared_ptr<const Patches> patches_;
};

}  // namespace lobe
