#pragma once

#include <optional>
#include <span>
#include <string>
#include <vector>

namespace lobe {

/// A place in pixels, x to the right and y upwards.
struct PixelPoint {
  double x = 0;
  double y = 0;
};

struct PixelBox {
  double left = 0;
  double bottom = 0;
  double right = 0;
  double top = 0;
};

/// Finds places for texts beside their points, so that no text covers another, a point, a line, or the frame.
/// Texts are placed first come, first served; each tries the right, the left, above, below, then the corners.
/// \param points all points that must stay visible
/// \param texts one per point; empty ones need no place
/// \param lines further places that must stay visible: dots along the lines of the picture
/// \param height of a line of text in pixels
/// \return per point the middle of the text's left edge; nothing where there is no room
[[nodiscard]] std::vector<std::optional<PixelPoint>> place_labels(std::span<const PixelPoint> points,
                                                                  std::span<const std::string> texts,
                                                                  std::span<const PixelPoint> lines, double height,
                                                                  const PixelBox& frame);

/// Places at least `distance` apart whose summed squared distances from the wanted ones are the smallest.
/// \param wanted in ascending order
[[nodiscard]] std::vector<double> keep_apart(std::span<const double> wanted, double distance);

}  // namespace lobe
