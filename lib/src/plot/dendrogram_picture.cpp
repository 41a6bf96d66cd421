#include "plot/dendrogram_picture.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <vector>

#include "plot/colour_range.hpp"
#include "plot/families.hpp"
#include "plot/matrix_block.hpp"

namespace lobe {
namespace {

using std::back_inserter;

constexpr double kBoldCharacterWidth = 0.62;  // of DejaVu Sans Bold, in font heights
constexpr double kStrip = 12;                 // width of the families' colours beside the matrix
constexpr double kStripGap = 3;
constexpr double kBar = 20;  // width of the colour bar
constexpr double kLegendFont = 14;
constexpr double kLegendLine = 22;
constexpr const char* kMixedColour = "#555555";

/// The materials in the order of the leaves.
struct Leaves {
  std::vector<std::size_t> material;  ///< place -> material
  std::vector<std::size_t> family;    ///< place -> number of the family
  std::vector<bool> is_medoid;        ///< by place
};

Leaves leaves_of(const FamilyOrder& order, const Clustering& clustering) {
  std::vector<std::size_t> family(order.material.size());
  for (std::size_t k = 0; k < order.blocks.size(); ++k) {
    for (std::size_t i = order.blocks[k].begin; i < order.blocks[k].end; ++i) family[order.material[i]] = k;
  }
  Leaves leaves;
  for (const auto material : clustering.leaf_order) {
    leaves.material.push_back(material);
    leaves.family.push_back(family[material]);
    leaves.is_medoid.push_back(std::ranges::binary_search(clustering.medoids.medoid, material));
  }
  return leaves;
}

/// A label beside the matrix. Pixels from the top of the matrix.
struct Label {
  std::size_t place = 0;
  double row = 0;  ///< middle of the material's row
  double at = 0;   ///< middle of the label
};

/// Sizes in pixels.
struct TreeLayout {
  double count = 1;
  double side = 0;  ///< side of the matrix
  double tree = 0;  ///< width of the tree
  double label_font = 0;
  std::vector<Label> labels;
  bool has_all_labels = true;
  double left = 30;
  double top = 130;
  double bottom = 66;
  double label_room = 0;
  double right = 0;

  /// Room for the lines from rows to labels that need not stand beside them.
  [[nodiscard]] double leader() const { return has_all_labels ? 8 : 36; }
  [[nodiscard]] double cell() const { return side / count; }
  [[nodiscard]] double matrix_left() const { return left + tree + kStrip + 2 * kStripGap; }
  [[nodiscard]] double matrix_right() const { return matrix_left() + side; }
  [[nodiscard]] int width() const { return static_cast<int>(matrix_right() + label_room + right); }
  [[nodiscard]] int height() const { return static_cast<int>(bottom + side + top); }
  /// Parts of the picture's width and height, y from the top of the matrix.
  [[nodiscard]] double x(double pixels) const { return pixels / width(); }
  [[nodiscard]] double y(double pixels) const { return 1 - (top + pixels) / height(); }
};

/// Moves labels apart that are too near, none out of [0, side]: down from the top, then up from the bottom.
void spread(std::vector<Label>& labels, double distance, double side) {
  double least = distance / 2;
  for (auto& label : labels) {
    label.at = std::max(label.row, least);
    least = label.at + distance;
  }
  double most = side - distance / 2;
  for (auto label = labels.rbegin(); label != labels.rend(); ++label) {
    label->at = std::min(label->at, most);
    most = label->at - distance;
  }
}

/// The medoids and, between them, as many others as find room, from the top downwards.
std::vector<Label> choose_labels(const Leaves& leaves, double cell, double distance) {
  const auto row = [&](std::size_t place) { return (static_cast<double>(place) + 0.5) * cell; };
  std::vector<double> medoids;
  for (std::size_t place = 0; place < leaves.material.size(); ++place) {
    if (leaves.is_medoid[place]) medoids.push_back(row(place));
  }
  std::vector<Label> labels;
  for (std::size_t place = 0; place < leaves.material.size(); ++place) {
    const bool is_near_medoid =
        std::ranges::any_of(medoids, [&](double medoid) { return std::abs(medoid - row(place)) < distance; });
    const bool is_near_last = !labels.empty() && row(place) - labels.back().row < distance;
    if (leaves.is_medoid[place] || !(is_near_medoid || is_near_last)) labels.push_back({place, row(place), row(place)});
  }
  return labels;
}

TreeLayout arrange(const FamilyOrder& order, const Leaves& leaves, std::span<const DrawnMaterial> materials) {
  constexpr double kLeastForAllLabels = 12;
  TreeLayout layout;
  const std::size_t count = leaves.material.size();
  layout.count = static_cast<double>(count);
  const double cell = count <= 12 ? 36 : count <= 24 ? 26 : count <= 80 ? 17 : count <= 150 ? 12 : count <= 400 ? 4 : 0;
  layout.side = cell > 0 ? std::max(cell * layout.count, std::floor(360 / layout.count) * layout.count) : 1600;
  layout.tree = std::clamp(layout.side * 0.4, 280.0, 520.0);
  layout.has_all_labels = layout.cell() >= kLeastForAllLabels;
  layout.label_font = layout.has_all_labels ? std::clamp(layout.cell() * 0.78, 10.0, 14.0) : 13;
  const double line = layout.has_all_labels ? 0 : 1.35 * layout.label_font;
  layout.labels = choose_labels(leaves, layout.cell(), line);
  if (!layout.has_all_labels) spread(layout.labels, line, layout.side);
  std::size_t longest = 0;
  for (const auto& label : layout.labels) {
    longest = std::max(longest, gnuplot::character_count(materials[leaves.material[label.place]].label.name));
  }
  layout.label_room = static_cast<double>(longest) * kBoldCharacterWidth * layout.label_font + layout.leader() + 10;
  std::size_t longest_family = 0;
  for (const auto& block : order.blocks) {
    longest_family = std::max(longest_family, gnuplot::character_count(block.name));
  }
  layout.right = 24 + std::max(130.0, 40 + static_cast<double>(longest_family) * kBoldCharacterWidth * kLegendFont);
  return layout;
}

/// Heights of the tree: linear from 0, or logarithmic when many merges would lie at the leaves otherwise; of these, one
/// in thirty may still do so.
ColourRange height_range(const Dendrogram& tree) {
  std::vector<double> heights;
  for (const auto& merge : tree.merges) {
    if (merge.height.value > 0) heights.push_back(merge.height.value);
  }
  if (heights.empty()) return {};
  const double high = heights.back();
  if (high <= 30 * heights[heights.size() / 4]) return {0, 1.03 * high, false};
  return {std::max(0.8 * heights[heights.size() / 30], 1e-6 * high), 1.15 * high, true};
}

void append_rectangle(std::string& script, const TreeLayout& layout, double left, double top, double right,
                      double bottom, const std::string& colour) {
  fmt::format_to(back_inserter(script),
                 "set object rectangle from screen {:.6f},{:.6f} to screen {:.6f},{:.6f} fillcolor rgb '{}' "
                 "fillstyle solid noborder front noclip\n",
                 layout.x(left), layout.y(bottom), layout.x(right), layout.y(top), colour);
}

/// Colours of the families left of the matrix and above it, a rectangle for each run of one family.
void append_families(std::string& script, const Leaves& leaves, const TreeLayout& layout) {
  const double near = layout.matrix_left() - kStripGap;
  for (std::size_t begin = 0; begin < leaves.family.size();) {
    std::size_t end = begin;
    while (end < leaves.family.size() && leaves.family[end] == leaves.family[begin]) ++end;
    const double from = static_cast<double>(begin) * layout.cell();
    const double to = static_cast<double>(end) * layout.cell();
    const std::string colour = gnuplot::family_colour(leaves.family[begin]);
    append_rectangle(script, layout, near - kStrip, from, near, to, colour);
    append_rectangle(script, layout, layout.matrix_left() + from, -kStripGap - kStrip, layout.matrix_left() + to,
                     -kStripGap, colour);
    begin = end;
  }
}

void append_labels(std::string& script, const Leaves& leaves, std::span<const DrawnMaterial> materials,
                   const TreeLayout& layout) {
  for (const auto& label : layout.labels) {
    const std::string colour = gnuplot::family_colour(leaves.family[label.place]);
    const double text = layout.matrix_right() + layout.leader();
    if (!layout.has_all_labels) {
      fmt::format_to(
          back_inserter(script),
          "set arrow from screen {0:.6f},{1:.6f} to screen {2:.6f},{3:.6f} nohead front linewidth 0.7 linecolor "
          "rgb '{4}'\n",
          layout.x(layout.matrix_right() + 2), layout.y(label.row), layout.x(text - 5), layout.y(label.at), colour);
    }
    fmt::format_to(back_inserter(script),
                   "set label {} at screen {:.6f},{:.6f} left front textcolor rgb '{}' font 'DejaVu Sans{},{:.1f}'\n",
                   gnuplot::string_literal(materials[leaves.material[label.place]].label.name), layout.x(text),
                   layout.y(label.at), colour, leaves.is_medoid[label.place] ? " Bold" : "",
                   layout.label_font / kPixelsPerPoint);
  }
}

/// White lines where the cut tree's clusters end.
void append_borders(std::string& script, const Leaves& leaves, const Clustering& clustering) {
  for (std::size_t place = 1; place < leaves.material.size(); ++place) {
    if (clustering.tree_cluster[leaves.material[place]] == clustering.tree_cluster[leaves.material[place - 1]])
      continue;
    const double at = static_cast<double>(place) - 0.5;
    fmt::format_to(back_inserter(script),
                   "set arrow from first {0},graph 0 to first {0},graph 1 nohead front linewidth 1.5 linecolor rgb "
                   "'#ffffff'\n"
                   "set arrow from graph 0,first {0} to graph 1,first {0} nohead front linewidth 1.5 linecolor rgb "
                   "'#ffffff'\n",
                   at);
  }
}

/// Families with their colours below the colour bar, as many as there is room for.
void append_legend(std::string& script, const FamilyOrder& order, const TreeLayout& layout, double top) {
  const double left = layout.matrix_right() + layout.label_room + 24;
  const auto room = static_cast<std::size_t>(std::max(1.0, (layout.side - top) / kLegendLine));
  const std::size_t shown = order.blocks.size() <= room ? order.blocks.size() : room - 1;
  const auto write = [&](std::size_t line, const std::string& text, const std::string& colour) {
    fmt::format_to(back_inserter(script),
                   "set label {} at screen {:.6f},{:.6f} left front textcolor rgb '{}' font 'DejaVu Sans,{:.1f}'\n",
                   gnuplot::string_literal(text), layout.x(left + kBar),
                   layout.y(top + kLegendLine * (static_cast<double>(line) + 0.5)), colour,
                   kLegendFont / kPixelsPerPoint);
  };
  for (std::size_t k = 0; k < shown; ++k) {
    const double middle = top + kLegendLine * (static_cast<double>(k) + 0.5);
    append_rectangle(script, layout, left, middle - kStrip / 2, left + kStrip, middle + kStrip / 2,
                     gnuplot::family_colour(k));
    write(k, order.blocks[k].name, gnuplot::family_colour(k));
  }
  if (shown < order.blocks.size()) {
    write(shown, fmt::format("and {} more families", order.blocks.size() - shown), kMixedColour);
  }
}

/// A merge as the lines of the tree: from its parts' heights to its own.
std::string tree_block(const Leaves& leaves, const Clustering& clustering) {
  constexpr std::size_t kMixed = static_cast<std::size_t>(-1);
  struct Branch {
    double height = 0;
    double place = 0;
    std::size_t family = kMixed;
  };
  const auto& merges = clustering.tree.merges;
  std::vector<Branch> branches(leaves.material.size() + merges.size());
  for (std::size_t place = 0; place < leaves.material.size(); ++place) {
    branches[leaves.material[place]] = {0, static_cast<double>(place), leaves.family[place]};
  }
  const auto colour = [](std::size_t family) {
    return (family == kMixed ? std::string(kMixedColour) : gnuplot::family_colour(family)).substr(1);
  };
  std::string block = "# tree: height, place and colour along each merge\n";
  for (std::size_t i = 0; i < merges.size(); ++i) {
    const Branch& first = branches[merges[i].first];
    const Branch& second = branches[merges[i].second];
    Branch& whole = branches[leaves.material.size() + i];
    whole = {merges[i].height.value, (first.place + second.place) / 2,
             first.family == second.family ? first.family : kMixed};
    fmt::format_to(back_inserter(block), "{0:.8g} {1:.8g} 0x{2}\n{3:.8g} {1:.8g} 0x{2}\n\n", first.height, first.place,
                   colour(first.family), whole.height);
    fmt::format_to(back_inserter(block), "{0:.8g} {1:.8g} 0x{2}\n{3:.8g} {1:.8g} 0x{2}\n\n", second.height,
                   second.place, colour(second.family), whole.height);
    fmt::format_to(back_inserter(block), "{0:.8g} {1:.8g} 0x{3}\n{0:.8g} {2:.8g} 0x{3}\n\n", whole.height, first.place,
                   second.place, colour(whole.family));
  }
  return block;
}

std::string note_of(const Clustering& clustering, const TreeLayout& layout, const ColourRange& colours) {
  const std::size_t clusters = clustering.medoids.medoid.size();
  const std::string correlation =
      std::isfinite(clustering.cophenetic_correlation.value)
          ? fmt::format(", cophenetic correlation {:.3f}", clustering.cophenetic_correlation.value)
          : "";
  std::string medoids = fmt::format("bold: {} medoid{}{}", clusters, clusters > 1 ? "s" : "",
                                    clustering.candidates.empty() ? "" : ", by the best mean silhouette");
  if (clusters > 1) medoids += fmt::format("; dashed, white lines: the tree cut into {} clusters", clusters);
  return fmt::format("{} materials, average linkage{}; {}\n{}", layout.count, correlation, colours.note(), medoids);
}

/// The height at which the tree is cut, within the tree's picture.
double cut_height(const Clustering& clustering, const ColourRange& heights) {
  const auto& merges = clustering.tree.merges;
  const std::size_t above = merges.size() + 1 - clustering.medoids.medoid.size();  // merges below the cut
  const auto shown = [&](double height) { return std::max(height, heights.low); };
  const double low = above == 0 ? heights.low : shown(merges[above - 1].height.value);
  const double high = shown(merges[above].height.value);
  return heights.logarithmic ? std::sqrt(low * high) : (low + high) / 2;
}

}  // namespace

gnuplot::Picture dendrogram_picture(const std::string& stem, std::string_view title, std::string_view unit,
                                    std::span<const DrawnMaterial> materials, const Eigen::MatrixXd& distance,
                                    const Clustering& clustering) {
  const FamilyOrder order = order_by_family(materials);
  const Leaves leaves = leaves_of(order, clustering);
  const TreeLayout layout = arrange(order, leaves, materials);
  const ColourRange colours = colour_range(distance);
  const ColourRange heights = height_range(clustering.tree);
  const std::string unit_text = unit.empty() ? "" : fmt::format(" / {}", unit);

  std::string script =
      gnuplot::preamble(stem, "Tree of the materials beside their distance matrix", layout.width(), layout.height());
  const std::string note = note_of(clustering, layout, colours);
  const std::size_t line_break = note.find('\n');
  fmt::format_to(back_inserter(script),
                 "set label {0} at screen {1:.6f},{2:.6f} left font 'DejaVu Sans Bold,13'\n"
                 "set label {3} at screen {1:.6f},{4:.6f} left textcolor rgb '#555555'\n"
                 "set label {5} at screen {1:.6f},{6:.6f} left textcolor rgb '#555555'\n",
                 gnuplot::string_literal(title), layout.x(layout.left), 1 - 30.0 / layout.height(),
                 gnuplot::string_literal(note.substr(0, line_break)), 1 - 56.0 / layout.height(),
                 gnuplot::string_literal(note.substr(line_break + 1)), 1 - 78.0 / layout.height());
  script += "set border 0\nunset key\nunset xtics\nunset ytics\nset multiplot\n";
  fmt::format_to(back_inserter(script),
                 "set lmargin at screen {:.6f}\nset rmargin at screen {:.6f}\n"
                 "set tmargin at screen {:.6f}\nset bmargin at screen {:.6f}\n",
                 layout.x(layout.matrix_left()), layout.x(layout.matrix_right()), layout.y(0), layout.y(layout.side));
  append_families(script, leaves, layout);
  append_labels(script, leaves, materials, layout);
  append_borders(script, leaves, clustering);
  const double bar_height = std::min(layout.side * 0.5, 420.0);
  append_legend(script, order, layout, bar_height + 30);
  script += gnuplot::viridis();
  if (colours.logarithmic) script += "set logscale cb\n";
  fmt::format_to(back_inserter(script),
                 "set cbrange [{0:.6g}:{1:.6g}]\nset format cb '%g'\nset cblabel {2} offset 1.5\n"
                 "set colorbox vertical user origin screen {3:.6f},{4:.6f} size screen {5:.6f},{6:.6f} noborder\n"
                 "low = {0:.6g}\n"
                 "shown(d) = d > low ? d : low\n"
                 "set xrange [-0.5:{7}]\nset yrange [{7}:-0.5]\n"
                 "plot data_file index 0 matrix using 1:2:(shown($3)) with image\n",
                 colours.low, colours.high, gnuplot::string_literal("distance" + unit_text),
                 layout.x(layout.matrix_right() + layout.label_room + 24), layout.y(bar_height), layout.x(kBar),
                 bar_height / layout.height(), layout.count - 0.5);

  script += "unset label\nunset arrow\nunset object\nunset colorbox\n";
  fmt::format_to(back_inserter(script), "set lmargin at screen {:.6f}\nset rmargin at screen {:.6f}\n",
                 layout.x(layout.left), layout.x(layout.left + layout.tree));
  if (clustering.medoids.medoid.size() > 1) {
    fmt::format_to(
        back_inserter(script),
        "set arrow from first {0:.8g},graph 0 to first {0:.8g},graph 1 nohead front dashtype 2 linewidth 1.5 "
        "linecolor rgb '#999999'\n",
        cut_height(clustering, heights));
  }
  if (heights.logarithmic) script += "set logscale x\n";
  fmt::format_to(back_inserter(script),
                 "set xrange [{1:.6g}:{0:.6g}]\nset xtics nomirror out\nset format x '%g'\nset border 1 linecolor rgb "
                 "'#888888'\nset xtics textcolor rgb '#000000'\nset xlabel {2}\n"
                 "lowest = {0:.6g}\n"
                 "height(h) = h > lowest ? h : lowest\n"
                 "plot data_file index 1 using (height($1)):2:3 with lines linewidth {3} linecolor rgb variable\n"
                 "unset multiplot\n",
                 heights.low, heights.high, gnuplot::string_literal("mean distance between clusters" + unit_text),
                 layout.count <= 150 ? 1.8 : 1.2);

  std::vector<std::string> names;
  for (const auto material : leaves.material) names.push_back(materials[material].label.name);
  std::string data =
      matrix_block(std::string(title) + ": distances", names, distance(leaves.material, leaves.material));
  data += "\n\n" + tree_block(leaves, clustering);
  return {std::move(script), std::move(data)};
}

}  // namespace lobe
