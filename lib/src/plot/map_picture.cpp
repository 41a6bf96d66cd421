#include "plot/map_picture.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <optional>
#include <vector>

#include "plot/families.hpp"
#include "plot/label_placement.hpp"

namespace lobe {
namespace {

using std::back_inserter;

constexpr std::size_t kMostLabels = 80;
constexpr double kLineHeight = 14;  // pixels of the labels' font

struct Point {
  double x = 0;
  double y = 0;
};

/// Part of the plane that a panel shows.
struct View {
  double left = 0;
  double right = 1;
  double bottom = 0;
  double top = 1;

  [[nodiscard]] double width() const { return right - left; }
  [[nodiscard]] double height() const { return top - bottom; }
  [[nodiscard]] double size() const { return std::max(width(), height()); }
  [[nodiscard]] bool contains(const Point& point) const {
    return point.x >= left && point.x <= right && point.y >= bottom && point.y <= top;
  }
};

/// A view and where it stands on the canvas, in pixels from the lower left corner.
struct Panel {
  View view;
  PixelBox box;

  [[nodiscard]] double scale() const { return (box.right - box.left) / view.width(); }
  [[nodiscard]] PixelPoint pixel(const Point& point) const {
    return {box.left + (point.x - view.left) * scale(), box.bottom + (point.y - view.bottom) * scale()};
  }
  [[nodiscard]] Point point(const PixelPoint& pixel) const {
    return {view.left + (pixel.x - box.left) / scale(), view.bottom + (pixel.y - box.bottom) / scale()};
  }
};

std::vector<Point> points_of(const Embedding& embedding, const FamilyOrder& order) {
  std::vector<Point> points;
  for (const auto material : order.material) {
    const auto row = static_cast<Eigen::Index>(material);
    points.push_back({embedding.coordinates.cols() > 0 ? embedding.coordinates(row, 0) : 0.0,
                      embedding.coordinates.cols() > 1 ? embedding.coordinates(row, 1) : 0.0});
  }
  return points;
}

View view_of(const std::vector<Point>& points) {
  if (points.empty()) return {};
  const auto by_x = std::minmax_element(points.begin(), points.end(), [](auto& a, auto& b) { return a.x < b.x; });
  const auto by_y = std::minmax_element(points.begin(), points.end(), [](auto& a, auto& b) { return a.y < b.y; });
  View view{by_x.first->x, by_x.second->x, by_y.first->y, by_y.second->y};
  const double margin = view.size() > 0 ? 0.06 * view.size() : 0.5;
  return {view.left - margin, view.right + margin, view.bottom - margin, view.top + margin};
}

/// The four fifths of the points that lie nearest to the median point.
std::vector<Point> core_of(std::vector<Point> points) {
  const auto middle = points.begin() + static_cast<std::ptrdiff_t>(points.size() / 2);
  std::nth_element(points.begin(), middle, points.end(), [](auto& a, auto& b) { return a.x < b.x; });
  const double x = middle->x;
  std::nth_element(points.begin(), middle, points.end(), [](auto& a, auto& b) { return a.y < b.y; });
  const double y = middle->y;
  std::sort(points.begin(), points.end(),
            [&](auto& a, auto& b) { return std::hypot(a.x - x, a.y - y) < std::hypot(b.x - x, b.y - y); });
  points.resize(points.size() * 4 / 5);
  return points;
}

/// Widens a view to a shape, height over width.
View with_shape(View view, double shape) {
  const double missing_width = view.height() / shape - view.width();
  const double missing_height = view.width() * shape - view.height();
  if (missing_width > 0) {
    view.left -= missing_width / 2;
    view.right += missing_width / 2;
  } else {
    view.bottom -= missing_height / 2;
    view.top += missing_height / 2;
  }
  return view;
}

struct Canvas {
  double width = 0;
  double height = 0;
  double key_left = 0;
  std::vector<Panel> panels;
};

Canvas arrange(const std::vector<Point>& points, const FamilyOrder& order) {
  constexpr double kLeft = 90;
  constexpr double kBottom = 64;
  constexpr double kTop = 84;
  const View whole = view_of(points);
  std::vector<View> views = {whole};
  if (points.size() >= 10) {
    const View core = view_of(core_of(points));
    if (core.size() < 0.35 * whole.size()) views.push_back(core);
  }
  const double side = views.size() == 1 ? 820 : 640;
  const double shape = std::clamp(whole.height() / whole.width(), 0.6, 1.0);
  std::size_t longest = 1;
  for (const auto& block : order.blocks) longest = std::max(longest, gnuplot::character_count(block.name));
  Canvas canvas;
  double left = kLeft;
  for (const auto& view : views) {
    canvas.panels.push_back(
        {with_shape(view, shape), {left, kBottom, left + side, kBottom + std::round(side * shape)}});
    left += side + kLeft;
  }
  canvas.key_left = left - kLeft + 14;
  canvas.width = std::round(canvas.key_left + 50 + 8.5 * static_cast<double>(longest));
  canvas.height = canvas.panels.front().box.top + kTop;
  return canvas;
}

void append_panel_frame(std::string& script, const Canvas& canvas, const Panel& panel) {
  fmt::format_to(back_inserter(script),
                 "set lmargin at screen {:.6f}\nset rmargin at screen {:.6f}\n"
                 "set bmargin at screen {:.6f}\nset tmargin at screen {:.6f}\n"
                 "set xrange [{:.8g}:{:.8g}]\nset yrange [{:.8g}:{:.8g}]\n",
                 panel.box.left / canvas.width, panel.box.right / canvas.width, panel.box.bottom / canvas.height,
                 panel.box.top / canvas.height, panel.view.left, panel.view.right, panel.view.bottom, panel.view.top);
}

void append_plot(std::string& script, const FamilyOrder& order, std::optional<std::size_t> label_index) {
  for (std::size_t k = 0; k < order.blocks.size(); ++k) {
    const auto& block = order.blocks[k];
    fmt::format_to(back_inserter(script),
                   "{} index {} using 1:2 with {} linecolor rgb {} pointtype {} pointsize {} title {}",
                   k == 0 ? "plot data_file" : ", \\\n     ''", k, block.is_sweep ? "linespoints" : "points",
                   gnuplot::string_literal(gnuplot::family_colour(k)), gnuplot::family_point(k),
                   order.material.size() <= kMostLabels ? 1.1 : 0.9, gnuplot::string_literal(block.name));
  }
  if (label_index) {
    fmt::format_to(back_inserter(script),
                   ", \\\n     '' index {} using 1:2:3:4 with labels left textcolor rgb variable font ',8' notitle",
                   *label_index);
  }
  script += '\n';
}

/// Dots along the lines that join the materials of a sweep.
std::vector<PixelPoint> line_dots(const std::vector<PixelPoint>& pixels, const FamilyOrder& order) {
  constexpr double kStep = 4;
  constexpr double kMostDots = 500;
  std::vector<PixelPoint> dots;
  for (const auto& block : order.blocks) {
    for (std::size_t i = block.begin; block.is_sweep && i + 1 < block.end; ++i) {
      const PixelPoint& a = pixels[i];
      const PixelPoint& b = pixels[i + 1];
      const double count = std::min(kMostDots, std::ceil(std::hypot(b.x - a.x, b.y - a.y) / kStep));
      for (double k = 1; k < count; ++k) {
        dots.push_back({a.x + (b.x - a.x) * k / count, a.y + (b.y - a.y) * k / count});
      }
    }
  }
  return dots;
}

/// Labels that find room in a panel, as a block of the data file.
/// \param detail part of the view that another panel shows; its labels stand there
std::string label_block(const Panel& panel, const View* detail, const std::vector<Point>& points,
                        const FamilyOrder& order) {
  std::vector<PixelPoint> pixels;
  pixels.reserve(points.size());
  for (const auto& point : points) pixels.push_back(panel.pixel(point));
  std::vector<std::string> labels = order.label;
  for (std::size_t i = 0; detail != nullptr && i < points.size(); ++i) {
    if (detail->contains(points[i])) labels[i].clear();
  }
  const auto places = place_labels(pixels, labels, line_dots(pixels, order), kLineHeight, panel.box);
  std::string block;
  for (std::size_t k = 0; k < order.blocks.size(); ++k) {
    for (std::size_t i = order.blocks[k].begin; i < order.blocks[k].end; ++i) {
      if (!places[i]) continue;
      const Point at = panel.point(*places[i]);
      fmt::format_to(back_inserter(block), "{:.8g} {:.8g} {} 0x{}\n", at.x, at.y,
                     gnuplot::string_literal(order.label[i]), gnuplot::family_colour(k).substr(1));
    }
  }
  return block;
}

}  // namespace

gnuplot::Picture map_picture(const std::string& stem, std::string_view title, std::string_view unit,
                             std::span<const DrawnMaterial> materials, const Embedding& embedding) {
  const FamilyOrder order = order_by_family(materials);
  const std::vector<Point> points = points_of(embedding, order);
  const Canvas canvas = arrange(points, order);

  std::string data = "# x, y and name of each material; a block per family, then the labels of each panel\n";
  for (const auto& block : order.blocks) {
    for (std::size_t i = block.begin; i < block.end; ++i) {
      fmt::format_to(back_inserter(data), "{:.10g} {:.10g} {}\n", points[i].x, points[i].y,
                     gnuplot::string_literal(materials[order.material[i]].label.name));
    }
    data += "\n\n";
  }
  std::size_t blocks = order.blocks.size();
  std::vector<std::optional<std::size_t>> label_index(canvas.panels.size());
  for (std::size_t p = 0; p < canvas.panels.size() && points.size() <= kMostLabels; ++p) {
    const View* detail = p + 1 < canvas.panels.size() ? &canvas.panels[p + 1].view : nullptr;
    const std::string block = label_block(canvas.panels[p], detail, points, order);
    if (block.empty()) continue;
    data += block + "\n\n";
    label_index[p] = blocks++;
  }

  std::string script = gnuplot::preamble(stem, "Map of the materials by classical scaling",
                                         static_cast<int>(canvas.width), static_cast<int>(canvas.height));
  const std::string note = fmt::format(
      "classical scaling of {} materials; the two axes explain {:.1f} % of the squared distances{}", materials.size(),
      100 * embedding.explained_share, canvas.panels.size() > 1 ? "; right: the framed part" : "");
  const double left = canvas.panels.front().box.left / canvas.width;
  fmt::format_to(back_inserter(script),
                 "set label {0} at screen {1:.6f},{2:.6f} left font 'DejaVu Sans Bold,13'\n"
                 "set label {3} at screen {1:.6f},{4:.6f} left textcolor rgb '#555555'\n",
                 gnuplot::string_literal(title), left, 1 - 30 / canvas.height, gnuplot::string_literal(note),
                 1 - 56 / canvas.height);
  const std::string unit_text = unit.empty() ? "" : fmt::format(" / {}", unit);
  fmt::format_to(
      back_inserter(script),
      "set xlabel {}\nset ylabel {}\nset format '%g'\nset tics nomirror\nset grid xtics ytics linecolor rgb '#e4e4e4'\n"
      "set border 31 linecolor rgb '#888888'\nset tics textcolor rgb '#000000'\n"
      "set key at screen {:.6f},{:.6f} left top reverse Left samplen 1.5 spacing 1.25\n",
      gnuplot::string_literal("axis 1" + unit_text), gnuplot::string_literal("axis 2" + unit_text),
      canvas.key_left / canvas.width, canvas.panels.front().box.top / canvas.height);
  const bool has_detail = canvas.panels.size() > 1;
  if (has_detail) {
    const View& detail = canvas.panels[1].view;
    fmt::format_to(
        back_inserter(script),
        "set multiplot\nset object 1 rectangle from {:.8g},{:.8g} to {:.8g},{:.8g} fillstyle empty border rgb "
        "'#000000' front\n",
        detail.left, detail.bottom, detail.right, detail.top);
  }
  append_panel_frame(script, canvas, canvas.panels[0]);
  append_plot(script, order, label_index[0]);
  if (has_detail) {
    script += "unset object 1\nunset label\nunset key\n";
    append_panel_frame(script, canvas, canvas.panels[1]);
    append_plot(script, order, label_index[1]);
    script += "unset multiplot\n";
  }
  return {std::move(script), std::move(data)};
}

}  // namespace lobe
