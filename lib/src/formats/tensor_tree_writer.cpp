#include "formats/tensor_tree_writer.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstddef>
#include <iterator>
#include <limits>
#include <numbers>
#include <utility>
#include <vector>

#include "core/parallel.hpp"
#include "formats/window_xml.hpp"
#include "hemisphere/gauss.hpp"
#include "hemisphere/square_map.hpp"
#include "lobe/core/directions.hpp"
#include "lobe/core/error.hpp"

namespace lobe {
namespace {

using std::numbers::pi;

constexpr std::size_t kIsotropicLeaves = 64;
constexpr std::size_t kAnisotropicLeaves = 16;
constexpr std::size_t kMostIsotropic = 128;
constexpr std::size_t kMostAnisotropic = 32;
// Difference of two rules that is let be, of a leaf's value or of the mean one; and how often a leaf is halved for
// more.
constexpr double kRelative3 = 1e-3;
constexpr double kRelative4 = 5e-3;
constexpr std::size_t kHalvings3 = 4;
constexpr std::size_t kHalvings4 = 2;
constexpr std::size_t kAtOnce = 256;  // leaves of a thread

/// Coordinates of a tree, each from 0 to 1.
using Point = std::array<double, 4>;

/// A part of a leaf.
struct Box {
  Point low{};
  Point size{};
  double share = 1;  ///< of the leaf
};

/// Averages of a function over boxes of a tree's coordinates.
class LeafAverages {
 public:
  LeafAverages(const BrdfFunction& brdf, std::size_t dimensions) : brdf_(brdf), dimensions_(dimensions) {}

  /// Values by channel.
  /// \param floor value below which relative differences do not count
  [[nodiscard]] std::vector<double> at(const std::vector<Box>& leaves, double floor) const {
    const std::size_t channels = brdf_.channels.size();
    std::vector<double> values(leaves.size() * channels, 0.0);
    std::vector<std::pair<std::size_t, Box>> open;
    for (std::size_t i = 0; i < leaves.size(); ++i) open.emplace_back(i, leaves[i]);
    const std::size_t halvings = dimensions_ == 3 ? kHalvings3 : kHalvings4;
    const double relative = dimensions_ == 3 ? kRelative3 : kRelative4;
    for (std::size_t stage = 0; !open.empty(); ++stage) {
      const Sums coarse = averages(open, gauss_rule(2));
      const Sums fine = averages(open, gauss_rule(3));
      std::vector<std::pair<std::size_t, Box>> next;
      for (std::size_t k = 0; k < open.size(); ++k) {
        const auto& [leaf, box] = open[k];
        bool is_smooth = true;
        for (std::size_t c = 0; c < channels; ++c) {
          const double value = fine[k * channels + c];
          // What parts leave over adds up as their root, for it has either sign.
          const double allowed = relative * std::max(std::abs(value), floor) / std::sqrt(box.share);
          is_smooth = is_smooth && std::abs(value - coarse[k * channels + c]) <= allowed;
        }
        if (is_smooth || stage == halvings) {
          for (std::size_t c = 0; c < channels; ++c) values[leaf * channels + c] += box.share * fine[k * channels + c];
        } else {
          halve(leaf, box, next);
        }
      }
      open = std::move(next);
    }
    return values;
  }

 private:
  using Sums = std::vector<double>;

  [[nodiscard]] Sums averages(const std::vector<std::pair<std::size_t, Box>>& boxes, const GaussRule& rule) const {
    const std::size_t nodes = rule.nodes.size();
    std::size_t count = 1;
    for (std::size_t d = 0; d < dimensions_; ++d) count *= nodes;
    std::vector<Directions> pairs;
    std::vector<double> weights;
    pairs.reserve(boxes.size() * count);
    for (const auto& [leaf, box] : boxes) {
      for (std::size_t i = 0; i < count; ++i) {
        Point point{};
        double weight = 1;
        std::size_t rest = i;
        for (std::size_t d = 0; d < dimensions_; ++d) {
          const std::size_t node = rest % nodes;
          rest /= nodes;
          point[d] = box.low[d] + box.size[d] * rule.nodes[node];
          weight *= rule.weights[node];
        }
        pairs.push_back(pair_at(point));
        // Squares keep areas; of rings the projected solid angle grows as their radius.
        weights.push_back(dimensions_ == 3 ? weight * (1 - 2 * point[0]) / (1 - 2 * box.low[0] - box.size[0]) : weight);
      }
    }
    const Eigen::MatrixXd values = brdf_.at(pairs).value;
    const std::size_t channels = brdf_.channels.size();
    Sums sums(boxes.size() * channels, 0.0);
    for (std::size_t i = 0; i < pairs.size(); ++i) {
      for (std::size_t c = 0; c < channels; ++c) {
        const double value = values(static_cast<Eigen::Index>(i), static_cast<Eigen::Index>(c));
        if (!std::isfinite(value)) {
          throw NumericError("'" + brdf_.name + "' has values that are no finite numbers");
        }
        sums[i / count * channels + c] += weights[i] * value;
      }
    }
    return sums;
  }

  /// Inverse of what readers do: light comes from 180 degrees away from where it goes to.
  [[nodiscard]] Directions pair_at(const Point& point) const {
    if (dimensions_ == 3) {
      const Direction out = square_to_hemisphere({2 * point[1] - 1, 2 * point[2] - 1});
      return {std::asin(std::clamp(1 - 2 * point[0], 0.0, 1.0)), out.theta, out.phi + pi, 0};
    }
    const Direction in = square_to_hemisphere({2 * point[0] - 1, 2 * point[1] - 1});
    const Direction out = square_to_hemisphere({2 * point[2] - 1, 2 * point[3] - 1});
    return {in.theta, out.theta, out.phi - in.phi - pi, in.phi + pi};
  }

  /// Into equal halves along all coordinates, with their shares of the projected solid angle.
  void halve(std::size_t leaf, const Box& box, std::vector<std::pair<std::size_t, Box>>& parts) const {
    const std::size_t count = std::size_t{1} << dimensions_;
    for (std::size_t i = 0; i < count; ++i) {
      Box part = box;
      for (std::size_t d = 0; d < dimensions_; ++d) {
        part.size[d] = box.size[d] / 2;
        if (i >> d & 1U) part.low[d] += part.size[d];
      }
      part.share = box.share / static_cast<double>(count);
      if (dimensions_ == 3) {
        const auto radius = [](const Box& ring) { return 1 - 2 * ring.low[0] - ring.size[0]; };
        part.share *= radius(part) / radius(box);
      }
      parts.emplace_back(leaf, part);
    }
  }

  const BrdfFunction& brdf_;
  std::size_t dimensions_;
};

std::size_t leaves_of(const BrdfFunction& brdf, const WriteOptions& options) {
  const std::size_t most = brdf.is_isotropic ? kMostIsotropic : kMostAnisotropic;
  const std::size_t leaves = options.leaves > 0  ? options.leaves
                             : brdf.is_isotropic ? kIsotropicLeaves
                                                 : kAnisotropicLeaves;
  if (leaves < 2 || leaves > most || !std::has_single_bit(leaves)) {
    throw ArgumentError(fmt::format("{} leaves along an axis of {} tensor tree; expected a power of two from 2 to {}",
                                    leaves, brdf.is_isotropic ? "an isotropic" : "an anisotropic", most));
  }
  return leaves;
}

/// All leaves, the first coordinate slowest; of isotropic trees those of its lower half.
std::vector<Box> all_leaves(std::size_t side, std::size_t dimensions) {
  const double size = 1 / static_cast<double>(side);
  const std::size_t first = dimensions == 3 ? side / 2 : side;
  std::size_t count = first;
  for (std::size_t d = 1; d < dimensions; ++d) count *= side;
  std::vector<Box> leaves(count);
  for (std::size_t i = 0; i < count; ++i) {
    std::size_t rest = i;
    for (std::size_t d = dimensions; d-- > 0;) {
      leaves[i].low[d] = size * static_cast<double>(rest % side);
      leaves[i].size[d] = size;
      rest /= side;
    }
  }
  return leaves;
}

/// A tree, or a part of it, whose leaves stand apart by spaces.
class TreeText {
 public:
  /// \param values of all leaves
  TreeText(const std::vector<double>& values, std::size_t side, std::size_t dimensions)
      : values_(values), side_(side), dimensions_(dimensions) {}

  [[nodiscard]] std::string text() {
    if (dimensions_ == 4) {
      append_leaves({}, side_);
      return std::move(text_);
    }
    // The upper half of the first coordinate has no directions. It is the part whose lowest bit is set.
    text_ += "{\n";
    const std::size_t half = side_ / 2;
    for (std::size_t part = 0; part < 8; ++part) {
      if (part & 1U) {
        text_ += "{ 0 }\n";
      } else {
        append_leaves({0, (part >> 1 & 1U) * half, (part >> 2 & 1U) * half}, half);
      }
    }
    text_ += "}\n";
    return std::move(text_);
  }

 private:
  void append_leaves(const std::array<std::size_t, 4>& first, std::size_t side) {
    std::size_t count = 1;
    for (std::size_t d = 0; d < dimensions_; ++d) count *= side;
    text_ += "{";
    for (std::size_t i = 0; i < count; ++i) {
      std::array<std::size_t, 4> at{};
      std::size_t rest = i;
      for (std::size_t d = dimensions_; d-- > 0;) {
        at[d] = first[d] + rest % side;
        rest /= side;
      }
      std::size_t place = 0;
      for (std::size_t d = 0; d < dimensions_; ++d) place = place * side_ + at[d];
      text_ += i % side == 0 ? '\n' : ' ';
      fmt::format_to(std::back_inserter(text_), "{}", static_cast<float>(values_[place]));
    }
    text_ += "\n}\n";
  }

  const std::vector<double>& values_;
  std::size_t side_;
  std::size_t dimensions_;
  std::string text_;
};

}  // namespace

std::string write_tensor_tree(const BrdfFunction& brdf, const WriteOptions& options) {
  const std::size_t side = leaves_of(brdf, options);
  const std::size_t dimensions = brdf.is_isotropic ? 3 : 4;
  const std::size_t channels = brdf.channels.size();
  const LeafAverages averages(brdf, dimensions);
  const std::vector<Box> leaves = all_leaves(side, dimensions);
  // A rough mean says what is little.
  const std::vector<double> rough = averages.at(all_leaves(4, dimensions), std::numeric_limits<double>::infinity());
  double floor = 0;
  for (const double value : rough) floor += std::abs(value) / static_cast<double>(rough.size());
  std::vector<std::vector<double>> values(channels, std::vector<double>(leaves.size()));
  const std::size_t rounds = (leaves.size() + kAtOnce - 1) / kAtOnce;
  constexpr std::size_t kRounds = 64;  // between two reports of progress
  for (std::size_t begin = 0; begin < rounds; begin += kRounds) {
    if (options.progress && !options.progress("leaves", static_cast<double>(begin) / static_cast<double>(rounds))) {
      throw Cancelled("cancelled");
    }
    parallel_for(std::min(kRounds, rounds - begin), [&](std::size_t round) {
      const std::size_t first = (begin + round) * kAtOnce;
      const std::size_t last = std::min(leaves.size(), first + kAtOnce);
      const std::vector<Box> here(leaves.begin() + static_cast<std::ptrdiff_t>(first),
                                  leaves.begin() + static_cast<std::ptrdiff_t>(last));
      const std::vector<double> found = averages.at(here, floor);
      for (std::size_t i = 0; i < here.size(); ++i) {
        for (std::size_t c = 0; c < channels; ++c) values[c][first + i] = found[i * channels + c];
      }
    });
  }
  return window_text(brdf, options, dimensions == 3 ? "TensorTree3" : "TensorTree4", "", [&](std::size_t channel) {
    return fmt::format(
        "        <AngleBasis>LBNL/Shirley-Chiu</AngleBasis>\n        <ScatteringDataType>BRDF</ScatteringDataType>\n"
        "        <ScatteringData>\n{}        </ScatteringData>\n",
        TreeText(values[channel], side, dimensions).text());
  });
}

}  // namespace lobe
