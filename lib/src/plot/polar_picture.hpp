#pragma once

#include <span>
#include <string>
#include <vector>

#include "lobe/table/table.hpp"
#include "plot/gnuplot.hpp"

namespace lobe {

/// f in the plane of incidence for one direction of light; theta_out is positive on the mirror side and rises.
struct IncidencePlane {
  double theta_in = 0;
  std::vector<double> theta_out;
  std::vector<double> f;  ///< mean of the channels, sr^-1
  bool has_mirror = false;
  bool has_retro = false;
};

/// Planes for light from 0, 30, 60 and 75 degrees, interpolated between the nodes, up to the last ring and
/// 85 degrees of view. On grids of
/// cells: those of the nearest rows, each row once, with steps.
[[nodiscard]] std::vector<IncidencePlane> incidence_planes(const BrdfTable& table);

/// How f becomes a radius: proportional where all lobes can be seen that way, else by its cube root, else by its
/// logarithm over four decades.
class RadialScale {
 public:
  /// \param peaks largest f of each curve
  explicit RadialScale(std::span<const double> peaks);

  /// f at the rim, a round number.
  [[nodiscard]] double top() const { return top_; }
  /// 0 to 1, where what exceeds top() is cut.
  [[nodiscard]] double radius(double f) const;
  /// Values for the rings of the grid; the last one has the radius 1.
  [[nodiscard]] std::vector<double> ticks() const;
  /// Note for the reader: "radius: cube root of f".
  [[nodiscard]] std::string note() const;

 private:
  enum class Kind { linear, cube_root, logarithmic };

  Kind kind_ = Kind::linear;
  double top_ = 1;
};

/// One half-disc per table.
[[nodiscard]] gnuplot::Picture polar_picture(const std::string& stem, std::span<const BrdfTable> tables,
                                             PictureFormat format);

}  // namespace lobe
