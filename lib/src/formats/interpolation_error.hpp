#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <span>
#include <vector>

#include "formats/local_interpolation.hpp"
#include "formats/pair_coordinates.hpp"
#include "lobe/core/directions.hpp"

namespace lobe {

/// The value below which a share of the others lies; 0 of none.
[[nodiscard]] double quantile_of(std::vector<double> values, double share);

/// Pairs that values may be asked for: within the largest angles of both directions of samples, half of them anywhere,
/// half about the mirror direction, where lobes are.
[[nodiscard]] std::vector<Directions> arbitrary_pairs(std::span<const Directions> samples);

/// How large the gaps between samples are: for some samples the median distance of the arbitrary pairs around it from
/// their nearest sample.
/// \param samples in `coordinates`
/// \param arbitrary pairs, at least one
/// \param which samples are wanted
[[nodiscard]] std::vector<double> gaps_between(const PointIndex& samples, const PairCoordinates& coordinates,
                                               std::span<const Directions> arbitrary,
                                               std::span<const std::size_t> which);

/// The error of interpolated values anywhere, from deviations of samples that were left out: the squared mean root of
/// those around, from the ones of samples left out alone to the ones of samples left out with the gap about them, by
/// the distance from the nearest sample. It grows beyond the gaps, and is scaled to cover 93 % of the deviations, each
/// judged by the others. Means of roots, because single deviations at a peak are a hundred times those beside it.
class InterpolationError {
 public:
  /// Deviations of samples when they were left out.
  struct Deviations {
    Eigen::MatrixXd points;      ///< dimensions x samples
    Eigen::MatrixXd alone;       ///< left out alone; absolute, samples x channels
    Eigen::MatrixXd surrounded;  ///< left out with all within the gap
    std::vector<double> gaps;
  };
  /// \param deviations of one sample at least
  explicit InterpolationError(Deviations deviations);

  /// By channel.
  /// \param distance from the nearest sample
  [[nodiscard]] Eigen::RowVectorXd at(const double* point, double distance) const;

 private:
  [[nodiscard]] Eigen::RowVectorXd unscaled(std::span<const PointIndex::Neighbour> near, double distance) const;
  void calibrate();

  PointIndex index_;
  Eigen::MatrixXd alone_;
  Eigen::MatrixXd surrounded_;
  std::vector<double> gaps_;
  Eigen::RowVectorXd anywhere_;  ///< mean of the surrounded ones
  double factor_ = 1;
};

}  // namespace lobe
