// Reflectances as trees of variable resolution over Shirley and Chiu's squares, in the XML of WINDOW and Radiance.
// Source: Ward, Kurt and Bonneel 2012 ("A practical framework for sharing and rendering real-world bidirectional
// scattering distribution functions"), and Radiance's bsdf_t.c for the order of branches.
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <memory>
#include <numbers>
#include <utility>

#include "core/text.hpp"
#include "formats/format.hpp"
#include "formats/tensor_tree_writer.hpp"
#include "formats/window_xml.hpp"
#include "hemisphere/square_map.hpp"
#include "lobe/core/error.hpp"

namespace lobe {
namespace {

using std::numbers::pi;

constexpr std::size_t kDeepest = 20;                        // halvings of an axis
constexpr std::size_t kMostNumbers = std::size_t{1} << 28;  // numbers that a Node can address
constexpr std::size_t kLargestSide = 32;                    // side of cells made of a tree
constexpr std::size_t kMostCellValues = std::size_t{1} << 22;
constexpr std::size_t kMostSide = 128;  // side of cells made of a tree with three dimensions

/// Coordinates in [0, 1), as many as the tree has dimensions.
using Place = std::array<double, 4>;

/// A branch, whose 2^dimensions parts stand together, or a grid of (2^level)^dimensions numbers, the first coordinate
/// slowest.
struct Node {
  static constexpr std::uint32_t kBranch = 15;

  std::uint32_t kind : 4;  ///< kBranch, or the level of a grid
  std::uint32_t first : 28;
};

struct TensorTree {
  std::size_t dimensions = 0;
  std::size_t depth = 0;  ///< halvings of each axis up to its smallest leaves
  Node root{0, 0};
  std::vector<Node> nodes;
  std::vector<double> values;

  /// Bit k of a branch's number is the upper half of coordinate k.
  [[nodiscard]] double at(Place place) const {
    Node node = root;
    while (node.kind == Node::kBranch) {
      std::size_t part = 0;
      for (std::size_t k = 0; k < dimensions; ++k) {
        place[k] *= 2;
        if (place[k] >= 1) {
          place[k] -= 1;
          part |= std::size_t{1} << k;
        }
      }
      node = nodes[node.first + part];
    }
    std::size_t index = 0;
    for (std::size_t k = 0; k < dimensions; ++k) {
      index = (index << node.kind) + static_cast<std::size_t>(place[k] * static_cast<double>(1U << node.kind));
    }
    return values[node.first + index];
  }
};

/// Makes a tree of its words.
class TreeBuilder {
 public:
  /// \param block how many words and braces there will be
  TreeBuilder(const FileBytes& file, std::size_t dimensions, const WindowBlock& block) : file_(file), block_(block) {
    if (block.words >= kMostNumbers || block.braces >= kMostNumbers) {
      file.refuse_line(block.line, fmt::format("a tree of more than {} numbers", kMostNumbers));
    }
    tree_.dimensions = dimensions;
    tree_.nodes.reserve(block.braces);
    tree_.values.reserve(block.words);
  }

  void take(std::string_view word, std::size_t line) {
    if (word == "{") {
      open(line);
    } else if (word == "}") {
      close(line);
    } else {
      number(word, line);
    }
  }

  [[nodiscard]] TensorTree finish() && {
    if (!is_done_) file_.refuse_line(block_.line, "the tree is not closed; expected '{ ... }'");
    return std::move(tree_);
  }

 private:
  /// A node whose closing brace has not come.
  struct Open {
    std::size_t first = 0;  ///< first of its nodes or values
    std::size_t count = 0;
    bool is_branch = false;
  };

  [[nodiscard]] std::size_t parts() const { return std::size_t{1} << tree_.dimensions; }

  void open(std::size_t line) {
    if (is_done_) file_.refuse_line(line, "'{' after the end of the tree");
    if (!open_.empty()) begin_part(open_.back(), line);
    if (open_.size() > kDeepest) file_.refuse_line(line, fmt::format("a tree of more than {} levels", kDeepest));
    open_.push_back({tree_.values.size(), 0, false});
  }

  void begin_part(Open& parent, std::size_t line) {
    if (!parent.is_branch && parent.count > 0) file_.refuse_line(line, "'{' among numbers");
    if (!parent.is_branch) {
      // Every node but the root is a part, and has a brace.
      if (tree_.nodes.size() + parts() >= block_.braces) {
        file_.refuse_line(line, fmt::format("fewer braces than branches of {} parts need", parts()));
      }
      parent = {tree_.nodes.size(), 0, true};
      tree_.nodes.resize(tree_.nodes.size() + parts());
    }
    if (parent.count == parts()) file_.refuse_line(line, fmt::format("a branch of more than {} parts", parts()));
    ++parent.count;
  }

  void number(std::string_view word, std::size_t line) {
    if (open_.empty()) file_.refuse_line(line, fmt::format("'{}' outside the tree; expected '{{'", word));
    if (open_.back().is_branch) file_.refuse_line(line, fmt::format("'{}' among branches", word));
    tree_.values.push_back(window_number(file_, word, line));
    ++open_.back().count;
  }

  void close(std::size_t line) {
    if (open_.empty()) file_.refuse_line(line, "'}' without '{'");
    const Open done = open_.back();
    open_.pop_back();
    std::uint32_t kind = Node::kBranch;
    if (done.is_branch) {
      if (done.count != parts()) {
        file_.refuse_line(line, fmt::format("a branch of {} parts; expected {}", done.count, parts()));
      }
    } else {
      kind = level_of(done.count, line);
      tree_.depth = std::max(tree_.depth, open_.size() + kind);
      if (tree_.depth > kDeepest) file_.refuse_line(line, fmt::format("a tree of more than {} levels", kDeepest));
    }
    const Node node{kind & 0xFU, static_cast<std::uint32_t>(done.first) & 0xFFFFFFFU};
    if (open_.empty()) {
      tree_.root = node;
      is_done_ = true;
    } else {
      tree_.nodes[open_.back().first + open_.back().count - 1] = node;
    }
  }

  [[nodiscard]] std::uint32_t level_of(std::size_t count, std::size_t line) const {
    std::uint32_t level = 0;
    while ((std::size_t{1} << (level * tree_.dimensions)) < count) ++level;
    if (std::size_t{1} << (level * tree_.dimensions) != count) {
      file_.refuse_line(line, fmt::format("a leaf of {} numbers; expected a power of {}", count, parts()));
    }
    return level;
  }

  const FileBytes& file_;
  const WindowBlock& block_;
  TensorTree tree_;
  std::vector<Open> open_;
  bool is_done_ = false;
};

/// A point of [-1, 1]^2 as coordinates of a tree.
void put(Place& place, std::size_t first, SquarePoint p) {
  const double below_one = std::nextafter(1.0, 0.0);
  place[first] = std::clamp((p.a + 1) / 2, 0.0, below_one);
  place[first + 1] = std::clamp((p.b + 1) / 2, 0.0, below_one);
}

/// Radiance knows incident directions by where light goes to: 180 degrees away from L.
Place place_of(const Directions& pair, std::size_t dimensions) {
  Place place{};
  if (dimensions == 3) {
    // The upper half of the first axis is unused; the normal is the end of the lower one.
    place[0] = std::clamp((1 - std::sin(pair.theta_in)) / 2, 0.0, std::nextafter(0.5, 0.0));
    put(place, 1, hemisphere_to_square({pair.theta_out, pair.delta_phi - pi}));
  } else {
    put(place, 0, hemisphere_to_square({pair.theta_in, pair.phi_in + pi}));
    put(place, 2, hemisphere_to_square({pair.theta_out, pair.phi_in + pair.delta_phi}));
  }
  return place;
}

BrdfValues evaluate(const std::vector<TensorTree>& trees, std::span<const Directions> pairs) {
  BrdfValues values;
  values.value.resize(static_cast<Eigen::Index>(pairs.size()), static_cast<Eigen::Index>(trees.size()));
  for (std::size_t i = 0; i < pairs.size(); ++i) {
    const Place place = place_of(pairs[i], trees.front().dimensions);
    for (std::size_t c = 0; c < trees.size(); ++c) {
      values.value(static_cast<Eigen::Index>(i), static_cast<Eigen::Index>(c)) = trees[c].at(place);
    }
  }
  return values;
}

/// Leaves of four dimensions are products of cells of equal projected solid angle. Nothing where they are too many.
std::shared_ptr<const BrdfTable> cells_of(const BrdfFunction& brdf, const std::vector<TensorTree>& trees) {
  const std::size_t depth = std::ranges::max_element(trees, {}, &TensorTree::depth)->depth;
  const std::size_t side = std::max<std::size_t>(2, std::size_t{1} << depth);
  const std::size_t n = side * side;
  if (trees.front().dimensions != 4 || side > kLargestSide || trees.size() * n * n > kMostCellValues) return nullptr;
  BrdfTable table;
  table.grid = HemisphereGrid::shirley_chiu(side);
  table.form = TableForm::general;
  table.channels = trees.size();
  table.values.resize(trees.size() * n * n);
  Place place{};
  for (std::size_t in = 0; in < n; ++in) {
    put(place, 0, hemisphere_to_square(table.grid.directions()[table.grid.opposite(in)]));
    for (std::size_t out = 0; out < n; ++out) {
      put(place, 2, hemisphere_to_square(table.grid.directions()[out]));
      for (std::size_t c = 0; c < trees.size(); ++c) table.values[(c * n + in) * n + out] = trees[c].at(place);
    }
  }
  describe_cells(brdf, table);
  return std::make_shared<const BrdfTable>(std::move(table));
}

/// Cells of a tree with three dimensions; none if there are too many.
std::shared_ptr<const RingCells> ring_cells_of(const std::vector<TensorTree>& trees) {
  const std::size_t depth = std::ranges::max_element(trees, {}, &TensorTree::depth)->depth;
  const std::size_t side = std::size_t{1} << depth;
  const std::size_t rings = std::max<std::size_t>(1, side / 2);
  if (trees.front().dimensions != 3 || side > kMostSide || trees.size() * rings * side * side > kMostCellValues) {
    return nullptr;
  }
  RingCells cells{.rings = rings, .side = side, .values = {}};
  const auto middle = [](std::size_t k, std::size_t count) {
    return (static_cast<double>(k) + 0.5) / static_cast<double>(count);
  };
  cells.values.reserve(trees.size() * rings * side * side);
  for (const TensorTree& tree : trees) {
    for (std::size_t ring = 0; ring < rings; ++ring) {
      const double in = (1 - middle(ring, rings)) / 2;
      for (std::size_t a = 0; a < side; ++a) {
        for (std::size_t b = 0; b < side; ++b)
          cells.values.push_back(tree.at({in, middle(a, side), middle(b, side), 0}));
      }
    }
  }
  return std::make_shared<const RingCells>(std::move(cells));
}

std::vector<TensorTree> read_trees(const FileBytes& file, const WindowXml& xml, const WindowChoice& choice,
                                   std::size_t dimensions) {
  std::vector<TreeBuilder> builders;
  for (const std::size_t i : choice.blocks) {
    const WindowBlock& block = xml.blocks[i];
    if (!is_same_text(block.basis, "LBNL/Shirley-Chiu")) {
      file.refuse_line(block.line, fmt::format("angle basis '{}'; expected LBNL/Shirley-Chiu", block.basis));
    }
    builders.emplace_back(file, dimensions, block);
  }
  auto current = choice.blocks.begin();
  read_scattering_data(file, choice.blocks, [&](std::size_t block, std::string_view word, std::size_t line) {
    current = std::find(current, choice.blocks.end(), block);
    builders[static_cast<std::size_t>(current - choice.blocks.begin())].take(word, line);
  });
  std::vector<TensorTree> trees;
  for (TreeBuilder& builder : builders) trees.push_back(std::move(builder).finish());
  return trees;
}

std::size_t dimensions_of(const FileBytes& file, const WindowXml& xml) {
  if (is_same_text(xml.structure, "TensorTree3")) return 3;
  if (is_same_text(xml.structure, "TensorTree4")) return 4;
  file.refuse_line(xml.structure_line,
                   fmt::format("IncidentDataStructure '{}'; expected TensorTree3 or TensorTree4", xml.structure));
}

BrdfFunction read(const FileBytes& file, const ReadOptions& options) {
  const WindowXml xml = read_window_xml(file);
  const std::size_t dimensions = dimensions_of(file, xml);
  std::vector<std::string> remarks;
  const WindowChoice choice = choose_component(file, xml, options, remarks);
  const auto trees = std::make_shared<const std::vector<TensorTree>>(read_trees(file, xml, choice, dimensions));

  BrdfFunction brdf = window_function(file, xml, choice, kTensorTreeFormat.title);
  brdf.remarks = std::move(remarks);
  std::size_t negative = 0;
  std::size_t all = 0;
  for (const TensorTree& tree : *trees) {
    negative += static_cast<std::size_t>(std::ranges::count_if(tree.values, [](double value) { return value < 0; }));
    all += tree.values.size();
  }
  if (negative > 0) brdf.remarks.push_back(fmt::format("{} of {} values are negative, and kept", negative, all));
  brdf.is_isotropic = dimensions == 3;
  brdf.conventions = fmt::format(
      "{}, in sr^-1 without cosine, constant on the leaves of a tree of {} dimensions over the squares of Shirley and "
      "Chiu; incident directions turned by 180 degrees, for the file has them by where light goes; azimuths as the "
      "file "
      "counts them",
      choice.component, dimensions);
  brdf.cells = cells_of(brdf, *trees);
  brdf.ring_cells = ring_cells_of(*trees);
  brdf.at = [trees](std::span<const Directions> pairs) { return evaluate(*trees, pairs); };
  return brdf;
}

bool recognises(const FileBytes& head) {
  constexpr std::string_view kMark = "<IncidentDataStructure>";
  const std::size_t mark = head.content().find(kMark);
  return is_window_xml(head) && mark != head.content().npos &&
         is_tensor_tree(trim(head.content().substr(mark + kMark.size())));
}

}  // namespace

const Format kTensorTreeFormat{"tensor-tree",    "Tensor tree BSDF XML (Radiance)", recognises, read, false,
                               write_tensor_tree};

}  // namespace lobe
