#pragma once

#include <Eigen/Core>
#include <functional>
#include <span>
#include <vector>

#include "lobe/core/directions.hpp"

namespace lobe {

/// Radiances towards the viewer under a sky of radiance 1, by direction of the viewer: rows x directions.
struct SkyValues {
  Eigen::MatrixXd value;
  Eigen::MatrixXd error;
};
using SkyFunction = std::function<SkyValues(std::span<const Direction> views)>;

/// Such a function by interpolation: Chebyshev series over theta, on panels that are halved where the series does not
/// converge, of trigonometric polynomials over azimuths.
class SkyMap {
 public:
  struct Symmetry {
    bool isotropic = true;  ///< does not depend on the azimuth
    bool half_turn = true;  ///< half a turn about the normal leaves it the same
  };
  /// \param tolerance wanted of radiances, absolute, and relative where they are above 1
  SkyMap(const SkyFunction& sky, Symmetry symmetry, double tolerance);

  /// Adds share times the radiance to the first rows, and share times its error to as many further ones.
  void add(Direction view, double share, Eigen::Ref<Eigen::VectorXd> rows) const;

 private:
  struct Panel {
    double low = 0;
    double high = 0;
    Eigen::MatrixXd series;  ///< (rows x azimuth terms) x Chebyshev terms
    Eigen::VectorXd error;   ///< by row
  };

  void choose_azimuths(const SkyFunction& sky, double tolerance);
  /// Values by azimuth to terms of the trigonometric polynomial.
  [[nodiscard]] Eigen::MatrixXd azimuth_transform() const;
  [[nodiscard]] std::vector<Direction> views_of(std::span<const double> thetas) const;
  /// Makes the series of panels.
  /// \return whether each has converged
  std::vector<bool> fill(const SkyFunction& sky, std::span<Panel> panels, double tolerance) const;

  Eigen::Index azimuths_ = 1;  ///< an odd number of them
  double frequency_ = 1;       ///< 2 where half a turn is a period
  double azimuth_error_ = 0;
  std::vector<Panel> panels_;  ///< rising
};

}  // namespace lobe
