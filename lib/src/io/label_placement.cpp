#include "io/label_placement.hpp"

#include <algorithm>
#include <array>

#include "io/gnuplot.hpp"

namespace lobe {
namespace {

constexpr double kPointRadius = 5;
constexpr double kLineRadius = 1;
constexpr double kGap = 3;
constexpr double kCharacterWidth = 0.52;  // in line heights

bool overlap(const PixelBox& a, const PixelBox& b) {
  return a.left < b.right && b.left < a.right && a.bottom < b.top && b.bottom < a.top;
}

bool contains(const PixelBox& outer, const PixelBox& inner) {
  return inner.left >= outer.left && inner.right <= outer.right && inner.bottom >= outer.bottom &&
         inner.top <= outer.top;
}

PixelBox around(const PixelPoint& point, double radius) {
  return {point.x - radius, point.y - radius, point.x + radius, point.y + radius};
}

}  // namespace

std::vector<std::optional<PixelPoint>> place_labels(std::span<const PixelPoint> points,
                                                    std::span<const std::string> texts,
                                                    std::span<const PixelPoint> lines, double height,
                                                    const PixelBox& frame) {
  std::vector<PixelBox> taken;
  for (const auto& point : points) taken.push_back(around(point, kPointRadius));
  for (const auto& dot : lines) taken.push_back(around(dot, kLineRadius));
  std::vector<std::optional<PixelPoint>> places(points.size());
  for (std::size_t i = 0; i < points.size(); ++i) {
    if (texts[i].empty() || !contains(frame, around(points[i], 0))) continue;
    const double width = static_cast<double>(gnuplot::character_count(texts[i])) * kCharacterWidth * height;
    const double side = kPointRadius + kGap;
    const double over = kPointRadius + height / 2;
    const std::array<PixelPoint, 8> offsets = {{{side, 0},
                                                {-side - width, 0},
                                                {-width / 2, over},
                                                {-width / 2, -over},
                                                {side, over},
                                                {side, -over},
                                                {-side - width, over},
                                                {-side - width, -over}}};
    for (const auto& offset : offsets) {
      const PixelPoint place{points[i].x + offset.x, points[i].y + offset.y};
      const PixelBox box{place.x, place.y - height / 2, place.x + width, place.y + height / 2};
      const auto hits = [&](const PixelBox& other) { return overlap(box, other); };
      if (!contains(frame, box) || std::any_of(taken.begin(), taken.end(), hits)) continue;
      taken.push_back(box);
      places[i] = place;
      break;
    }
  }
  return places;
}

}  // namespace lobe
