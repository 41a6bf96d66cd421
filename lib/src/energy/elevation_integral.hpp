#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <functional>
#include <span>
#include <vector>

namespace lobe {

/// An elevation of a direction, and where its azimuths begin, as a share of their step: at each elevation elsewhere.
struct ElevationPlace {
  double elevation = 0;
  double turn = 0;
};

/// Integrands at an elevation, means over azimuths.
struct ElevationTerms {
  Eigen::RowVectorXd value;
  Eigen::RowVectorXd square;  ///< sums of squares of errors that have either sign
  Eigen::RowVectorXd odd;     ///< half of what the odd azimuths differ by from the even ones; empty for one azimuth
  Eigen::RowVectorXd own;     ///< of other integrands, without rules of their own: errors that add up
};

/// Terms at several places, in order.
using ElevationIntegrands = std::function<std::vector<ElevationTerms>(std::span<const ElevationPlace>)>;

/// When to stop.
struct ElevationGoal {
  double relative = 2e-4;        ///< error wanted, of the integral
  std::size_t most_panels = 12;  ///< after which none is halved
  double lowest = 0;             ///< elevation at which the domain ends
  Eigen::Index steering = 0;     ///< only the first integrands count, as many; the others are carried along
  /// `own` are the errors of the first integrands themselves: what is small beside them is good enough.
  bool has_errors = false;
};

/// Means over the hemisphere, of weight N.X.
struct ElevationSums {
  Eigen::RowVectorXd value;
  Eigen::RowVectorXd error;  ///< estimate of the absolute error
  Eigen::RowVectorXd own;
};

/// Means over all directions with N.X as weight: adaptive panels of the elevation, each with 7 Kronrod nodes, the Gauss
/// rule of 3, a null rule and the value at either end (hemisphere/kronrod.hpp). Errors of terms have either sign;
/// azimuths begin elsewhere at each elevation, and what the odd ones and the even ones differ by counts as error.
[[nodiscard]] ElevationSums integrate_elevations(const ElevationIntegrands& integrands, const ElevationGoal& goal);

}  // namespace lobe
