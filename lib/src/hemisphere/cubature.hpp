#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <functional>
#include <span>
#include <vector>

#include "hemisphere/gauss.hpp"

namespace lobe {

/// A part of a panel: where panel_point() is from `from` to `to`.
struct PanelPart {
  PanelEdge low, high;
  double from = 0;
  double to = 1;
};

/// A rectangle of two variables.
struct Rectangle {
  PanelPart u, v;
};

struct CubaturePoint {
  double u = 0;
  double v = 0;
};

/// Values of integrands at points, points x integrands.
using Integrands = std::function<Eigen::MatrixXd(std::span<const CubaturePoint>)>;

/// When to stop. Only the first integrands count, as many as `steering`; the others are carried along.
struct CubatureGoal {
  double relative = 1e-5;       ///< error wanted, of the integral
  std::size_t most_points = 0;  ///< after which no rectangle is halved
  Eigen::Index steering = 0;
  /// The others are errors that the first ones have besides, in the same order, NaN where unknown: what is small beside
  /// them is good enough.
  bool has_errors = false;
};

/// Integrals with what is known of their errors.
struct CubatureSums {
  Eigen::RowVectorXd value;
  Eigen::RowVectorXd error;  ///< estimate of the absolute error
  std::size_t points = 0;    ///< of evaluation
};

/// Integrals over rectangles, globally adaptive: those with the largest errors are halved, across the variable that
/// the error comes from, until what is left is small enough. Each has 7 x 7 Kronrod nodes, with the Gauss rule of 3 and
/// a null rule on each axis, and a point at either end of each axis, where the integrand has to be what the polynomial
/// through the nodes leads to: a kink or jump before the first node is seen by no rule. Where a small rectangle touches
/// a large one, the large one is looked at there, too, for kinks and jumps and for ridges that run on between its
/// nodes. Errors of rectangles have either sign, as kinks and jumps cause them: that of the integral is the root of
/// the sum of their squares, twice that where it comes from one of them, in between by how many there are, and twice
/// where rectangles do not resolve the integrand; or 1.5 times their sum where that is less. Along a kink across one
/// axis they have the same sign: of rectangles with the same part of an axis the differences are summed first.
[[nodiscard]] CubatureSums integrate_rectangles(std::vector<Rectangle> rectangles, const Integrands& integrands,
                                                const CubatureGoal& goal);

}  // namespace lobe
