#pragma once

/// Averages over pairs of cells by plain product rules: all four coordinates, no symmetry, no refinement.

#include <functional>

#include "reference/vector.hpp"

namespace lobe::reference {

/// A cell between two angles from the normal and two azimuths, radians.
struct PolarCell {
  double theta_low, theta_high, phi_low, phi_high;
};

/// A cell of Shirley and Chiu's square [-1, 1]^2: its lower corner and its side.
struct SquareCell {
  double a, b, side;
};

using Reflectance = std::function<Real(const Vector& light, const Vector& view)>;

/// Mean of f over both cells, weighted by projected solid angles, by `order` Gauss nodes in each of the coordinates.
[[nodiscard]] double cell_average(const Reflectance& f, const PolarCell& in, const PolarCell& out, int order);

/// The same by squares that are cut along their diagonals, on which the map has kinks; with `order` nodes in both
/// coordinates of each half.
[[nodiscard]] double cell_average(const Reflectance& f, const SquareCell& in, const SquareCell& out, int order);

}  // namespace lobe::reference
