#include "plot/distance_picture.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <vector>

#include "plot/colour_range.hpp"
#include "plot/families.hpp"
#include "plot/label_placement.hpp"
#include "plot/matrix_block.hpp"

namespace lobe {
namespace {

using std::back_inserter;

/// Sizes in pixels.
struct Layout {
  int cell_count = 1;
  int side = 0;  ///< side of the matrix
  double label_font = 0;
  std::vector<bool> labelled;  ///< whether a material has a label, by its place
  double family_font = 15;
  int left = 0;
  int bottom = 0;
  int top = 84;
  int right = 150;
  double label_room = 0;
  bool names_upright = false;  ///< family names below the matrix are turned, because they are wider than their family

  [[nodiscard]] double cell() const { return static_cast<double>(side) / cell_count; }
  [[nodiscard]] int width() const { return left + side + right; }
  [[nodiscard]] int height() const { return bottom + side + top; }
};

double text_width(std::size_t characters, double font) {
  return static_cast<double>(characters) * kCharacterWidth * font;
}

/// Which materials have room for a label: of each family the first, and others a step and more apart.
std::vector<bool> labelled_places(const FamilyOrder& order, std::size_t step) {
  std::vector<bool> labelled(order.material.size());
  std::size_t free = 0;  // from here on there is room
  for (const auto& block : order.blocks) {
    for (std::size_t place = std::max(block.begin, free); place < block.end; place += step) {
      const bool hides_next_family = place > block.begin && place + step > block.end && block.end < labelled.size();
      if (hides_next_family) break;
      labelled[place] = true;
      free = place + step;
    }
  }
  return labelled;
}

/// A family of one material is named by the material's own label.
bool has_own_name(const FamilyOrder& order, const FamilyBlock& block, const std::vector<bool>& labelled) {
  return !block.name.empty() &&
         !(block.end - block.begin == 1 && order.label[block.begin] == block.name && labelled[block.begin]);
}

Layout arrange(const FamilyOrder& order) {
  Layout layout;
  const auto count = static_cast<int>(order.material.size());
  layout.cell_count = std::max(count, 1);
  const int cell = count <= 12 ? 36 : count <= 24 ? 26 : count <= 80 ? 17 : count <= 150 ? 10 : count <= 400 ? 4 : 0;
  layout.side = cell > 0 ? std::max(cell * count, 320) : 1600;
  if (cell > 0) layout.side -= layout.side % layout.cell_count;  // whole pixels per cell
  layout.label_font = std::clamp(layout.cell() * 0.78, 10.0, 14.0);
  layout.labelled = labelled_places(
      order, static_cast<std::size_t>(std::max(1.0, std::ceil(layout.label_font * 1.2 / layout.cell() - 0.1))));
  std::size_t longest_label = 1;
  std::size_t longest_family = 0;
  for (const auto& label : order.label) longest_label = std::max(longest_label, gnuplot::character_count(label));
  for (const auto& block : order.blocks) {
    if (has_own_name(order, block, layout.labelled)) {
      const std::size_t length = gnuplot::character_count(block.name);
      longest_family = std::max(longest_family, length);
      layout.names_upright = layout.names_upright || text_width(length, layout.family_font) + 6 >
                                                         static_cast<double>(block.end - block.begin) * layout.cell();
    }
  }
  layout.label_room = text_width(longest_label, layout.label_font) + 16;
  const double names = longest_family == 0 ? 0 : text_width(longest_family, layout.family_font) + 16;
  layout.left = static_cast<int>(layout.label_room + names) + 14;
  layout.bottom = layout.names_upright || names == 0 ? layout.left : static_cast<int>(layout.label_room) + 40;
  return layout;
}

void append_labels(std::string& script, const FamilyOrder& order, const Layout& layout) {
  for (std::size_t place = 0; place < order.label.size(); ++place) {
    if (!layout.labelled[place]) continue;
    std::string label;
    for (const char c : order.label[place]) label += c == '%' ? std::string("%%") : std::string(1, c);
    fmt::format_to(back_inserter(script), "set {0}tics add ({1} {2})\nset {3}tics add ({1} {2})\n", 'x',
                   gnuplot::string_literal(label), place, 'y');
  }
}

/// Middles of the families' names along the matrix, as parts of its side: as near to those of the families as names of
/// a line's height can stand.
std::vector<double> name_places(const FamilyOrder& order, const Layout& layout) {
  std::vector<double> middles;
  for (const auto& block : order.blocks) {
    if (has_own_name(order, block, layout.labelled)) {
      middles.push_back(static_cast<double>(block.begin + block.end) / 2 / layout.cell_count);
    }
  }
  return keep_apart(middles, layout.family_font * 1.2 / layout.side);
}

void append_families(std::string& script, const FamilyOrder& order, const Layout& layout) {
  const double count = layout.cell_count;
  const double strip_offset = 3.0 / layout.side;
  const double strip = 9.0 / layout.side;
  const double name_offset = (layout.label_room + 8) / layout.side;
  const std::vector<double> places = name_places(order, layout);
  auto place = places.begin();
  for (std::size_t k = 0; k < order.blocks.size(); ++k) {
    const auto& block = order.blocks[k];
    const double begin = static_cast<double>(block.begin) / count;
    const double end = static_cast<double>(block.end) / count;
    const std::string colour = gnuplot::string_literal(gnuplot::family_colour(k));
    fmt::format_to(back_inserter(script),
                   "set object rectangle from graph {0:.6f},{1:.6f} to graph {2:.6f},{3:.6f} fillcolor rgb {4} "
                   "fillstyle solid noborder front noclip\n"
                   "set object rectangle from graph {5:.6f},{0:.6f} to graph {6:.6f},{2:.6f} fillcolor rgb {4} "
                   "fillstyle solid noborder front noclip\n",
                   -strip, 1 - end, -strip_offset, 1 - begin, colour, begin, end);
    if (block.end < order.material.size()) {
      fmt::format_to(
          back_inserter(script),
          "set arrow from graph {0:.6f},0 to graph {0:.6f},1 nohead front linewidth 1.5 linecolor rgb '#ffffff'\n"
          "set arrow from graph 0,{1:.6f} to graph 1,{1:.6f} nohead front linewidth 1.5 linecolor rgb '#ffffff'\n",
          end, 1 - end);
    }
    if (has_own_name(order, block, layout.labelled)) {
      const double beside = *place++;
      const double below = layout.names_upright ? beside : (begin + end) / 2;
      const double points = layout.family_font / kPixelsPerPoint;
      fmt::format_to(
          back_inserter(script),
          "set label {0} at graph {1:.6f},{2:.6f} right front textcolor rgb {3} font 'DejaVu Sans Bold,{4:.1f}'\n"
          "set label {0} at graph {5:.6f},{6:.6f} {7} front textcolor rgb {3} "
          "font 'DejaVu Sans Bold,{4:.1f}'\n",
          gnuplot::string_literal(block.name), -name_offset, 1 - beside, colour, points, below,
          layout.names_upright ? -name_offset : -name_offset - 8.0 / layout.side,
          layout.names_upright ? "right rotate by 90" : "center");
    }
  }
}

}  // namespace

gnuplot::Picture distance_picture(const std::string& stem, std::string_view title, std::string_view unit,
                                  std::span<const DrawnMaterial> materials, const Eigen::MatrixXd& distance) {
  const FamilyOrder order = order_by_family(materials);
  const Layout layout = arrange(order);
  const ColourRange range = colour_range(distance);
  const double width = layout.width();
  const double height = layout.height();

  std::string script = gnuplot::preamble(stem, "Distance matrix, ordered by family", layout.width(), layout.height());
  script += matrix_frame({layout.left, layout.bottom, layout.side, layout.width(), layout.height()}, layout.left, title,
                         fmt::format("{} materials; {}", materials.size(), range.note()));
  fmt::format_to(back_inserter(script),
                 "set xtics scale 0 rotate by 90 right font ',{0:.1f}' offset 0,graph {1:.6f} ()\n"
                 "set ytics scale 0 font ',{0:.1f}' offset graph {1:.6f},0 ()\n",
                 layout.label_font / kPixelsPerPoint, -6.0 / layout.side);
  append_labels(script, order, layout);
  append_families(script, order, layout);
  script += gnuplot::viridis();
  if (range.logarithmic) script += "set logscale cb\n";
  const double bar_height = std::min(1.0, 420.0 / layout.side) * layout.side / height;
  fmt::format_to(back_inserter(script),
                 "set cbrange [{0:.6g}:{1:.6g}]\nset format cb '%g'\nset cblabel {2} offset 1.5\n"
                 "set colorbox vertical user origin screen {3:.6f},{4:.6f} size screen {5:.6f},{6:.6f} noborder\n"
                 "low = {0:.6g}\n"
                 "shown(d) = d > low ? d : low\n"
                 "set xrange [-0.5:{7}]\nset yrange [{7}:-0.5]\n"
                 "plot data_file matrix using 1:2:(shown($3)) with image\n",
                 range.low, range.high,
                 gnuplot::string_literal(unit.empty() ? "distance" : fmt::format("distance / {}", unit)),
                 (layout.left + layout.side + 24) / width, (layout.bottom + layout.side) / height - bar_height,
                 20 / width, bar_height, layout.cell_count - 0.5);

  std::vector<std::string> names;
  for (const auto material : order.material) names.push_back(materials[material].label.name);
  return {std::move(script),
          matrix_block(std::string(title) + ": distances", names, distance(order.material, order.material))};
}

}  // namespace lobe
