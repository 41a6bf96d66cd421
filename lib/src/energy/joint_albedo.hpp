#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <numbers>
#include <span>
#include <vector>

#include "hemisphere/cubature.hpp"
#include "lobe/table/brdf_function.hpp"

namespace lobe {

/// Integrals over a hemisphere: [function][channel], and of differences of functions [pair i < j][channel].
struct JointSums {
  Eigen::RowVectorXd value;
  Eigen::RowVectorXd quadrature;  ///< error of the quadrature
  Eigen::RowVectorXd own;         ///< integral of the functions' own errors, NaN where unknown
  Eigen::RowVectorXd difference;  ///< empty where not wanted
  Eigen::RowVectorXd difference_quadrature;
};

/// Albedos of functions by one adaptive quadrature over the direction that runs, so that differences of functions that
/// are nearly the same have errors as small. Points are its elevation and its azimuth from the mirror direction; both
/// signs of delta_phi count for each, of bilateral functions one for both.
class JointAlbedo {
 public:
  /// The direction that stays.
  enum class Stays { light, viewer };

  struct Options {
    Stays stays = Stays::light;
    double lobe_width = 1;  ///< least half-vector width of lobes, radians
    double lowest = 0;      ///< elevation at which the domain of the direction that runs ends
    bool with_differences = false;
  };

  /// \param functions without delta parts, with `channels` channels each or one for all
  JointAlbedo(std::span<const BrdfFunction> functions, std::size_t channels, const Options& options);

  /// \param relative error wanted, of each function and channel
  /// \param most_points after which no rectangle is halved; what is not resolved by then is in the error
  /// \throws NumericError for values that are no finite numbers
  [[nodiscard]] JointSums at(const Direction& stays, double relative, std::size_t most_points) const;

 private:
  [[nodiscard]] Eigen::MatrixXd values(const Direction& stays, std::span<const CubaturePoint> points) const;

  std::span<const BrdfFunction> functions_;
  std::size_t channels_;
  Options options_;
  bool is_isotropic_;
  bool is_bilateral_;
};

/// How many pairs i < j there are.
[[nodiscard]] constexpr std::size_t pairs_among(std::size_t count) {
  return count * (count - 1) / 2;
}

}  // namespace lobe
