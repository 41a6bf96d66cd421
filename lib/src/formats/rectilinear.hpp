#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <span>
#include <vector>

namespace lobe {

/// How an axis of angles goes on beyond its nodes.
enum class AxisEnds {
  open,      ///< the outermost values stay
  mirrored,  ///< the values are even about 0 and about pi
  circular   ///< after a whole turn it begins again
};

/// An axis of a grid.
struct GridAxis {
  std::vector<double> nodes;  ///< rising, radians; circular ones span less than a whole turn
  AxisEnds ends = AxisEnds::open;
  std::size_t stride = 1;  ///< between the points of neighbouring nodes
};

/// Values on the product of lists of angles, linear in each angle between them.
///
/// The stated error is what second differences say: along each axis s (1-s) h^2 / 2 times the larger curvature of both
/// nodes, at a share s of the gap h, taken half as large again (kMargin); the axes' parts add up. Beyond the outermost
/// node of an open axis it is what the slope and the curvature there would make of the distance. Where an open axis has
/// one node the error off it is unknown (NaN), where it has two it is s (1-s) times their difference.
class RectilinearGrid {
 public:
  /// Factor on second differences. On lobes of 0.05 to 0.8 radians on grids of 5 to 15 degrees, second differences
  /// alone cover 76 to 98 % of arbitrary pairs of directions; with this factor they cover 97 to 100 %, and are 1.4 to
  /// 2.5 times the true errors (root mean squares).
  static constexpr double kMargin = 1.5;

  /// \param values the channels of a point one after the other, points by the strides of the axes
  /// \param errors of the values, in the same order; empty: none
  RectilinearGrid(std::vector<GridAxis> axes, std::size_t channels, std::vector<double> values,
                  std::vector<double> errors);

  [[nodiscard]] std::size_t channels() const { return channels_; }
  /// Values and what is stated of them, by channel.
  /// \param angles one for each axis
  void at(std::span<const double> angles, Eigen::Ref<Eigen::RowVectorXd> value,
          Eigen::Ref<Eigen::RowVectorXd> error) const;

 private:
  struct Place;

  [[nodiscard]] Place place_on(const GridAxis& axis, double angle) const;
  [[nodiscard]] double curvature(const GridAxis& axis, std::size_t line, std::size_t node, std::size_t channel) const;
  [[nodiscard]] double axis_error(const GridAxis& axis, const Place& place, std::size_t line,
                                  std::size_t channel) const;
  [[nodiscard]] double value_at(std::size_t point, std::size_t channel) const {
    return values_[point * channels_ + channel];
  }

  std::vector<GridAxis> axes_;
  std::size_t channels_;
  std::vector<double> values_;
  std::vector<double> errors_;
};

}  // namespace lobe
