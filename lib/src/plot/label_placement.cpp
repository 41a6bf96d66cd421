#include "plot/label_placement.hpp"

#include <algorithm>
#include <array>

#include "plot/gnuplot.hpp"

namespace lobe {
namespace {

constexpr double kPointRadius = 5;
constexpr double kLineRadius = 1;
constexpr double kLabelGap = 3;
constexpr double kLabelCharacterWidth = 0.52;  // in line heights

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
    const double width = static_cast<double>(gnuplot::character_count(texts[i])) * kLabelCharacterWidth * height;
    const double side = kPointRadius + kLabelGap;
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

// Isotonic regression of what is left of the places when the distances are taken off, by pooling neighbours.
std::vector<double> keep_apart(std::span<const double> wanted, double distance) {
  struct Pool {
    double sum = 0;
    std::size_t count = 0;
    [[nodiscard]] double mean() const { return sum / static_cast<double>(count); }
  };
  std::vector<Pool> pools;
  for (std::size_t i = 0; i < wanted.size(); ++i) {
    pools.push_back({wanted[i] - distance * static_cast<double>(i), 1});
    while (pools.size() > 1 && pools[pools.size() - 2].mean() > pools.back().mean()) {
      const Pool last = pools.back();
      pools.pop_back();
      pools.back().sum += last.sum;
      pools.back().count += last.count;
    }
  }
  std::vector<double> places;
  places.reserve(wanted.size());
  for (const Pool& pool : pools) {
    for (std::size_t k = 0; k < pool.count; ++k) {
      places.push_back(pool.mean() + distance * static_cast<double>(places.size()));
    }
  }
  return places;
}

}  // namespace lobe
