#pragma once

#include <span>
#include <string>
#include <vector>

#include "plot/drawn_reflectance.hpp"
#include "plot/gnuplot.hpp"

namespace lobe {

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

/// One half-disc for each.
[[nodiscard]] gnuplot::Picture polar_picture(const std::string& stem, std::span<const DrawnReflectance> drawn,
                                             PictureFormat format);

}  // namespace lobe
