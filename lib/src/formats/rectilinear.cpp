#include "formats/rectilinear.hpp"
#include "core/numbers.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <utility>

namespace lobe {
namespace {

using std::numbers::pi;

constexpr std::size_t kMostAxes = 4;

}  // namespace

/// Between which nodes an angle lies.
struct RectilinearGrid::Place {
  std::size_t before = 0;
  std::size_t after = 0;
  double share = 0;   ///< from the former to the latter
  double gap = 0;     ///< between them
  double beyond = 0;  ///< distance from the outermost node, on open axes
};

RectilinearGrid::RectilinearGrid(std::vector<GridAxis> axes, std::size_t channels, std::vector<double> values,
                                 std::vector<double> errors)
    : axes_(std::move(axes)), channels_(channels), values_(std::move(values)), errors_(std::move(errors)) {}

RectilinearGrid::Place RectilinearGrid::place_on(const GridAxis& axis, double angle) const {
  const auto& nodes = axis.nodes;
  const std::size_t last = nodes.size() - 1;
  if (axis.ends == AxisEnds::mirrored) angle = std::abs(std::remainder(angle, 2 * pi));
  if (axis.ends == AxisEnds::circular) {
    angle = nodes.front() + std::fmod(angle - nodes.front(), 2 * pi);
    if (angle < nodes.front()) angle += 2 * pi;
  }
  const auto above = static_cast<std::size_t>(std::ranges::upper_bound(nodes, angle) - nodes.begin());
  if (above > 0 && above <= last) {
    const double gap = nodes[above] - nodes[above - 1];
    return {above - 1, above, (angle - nodes[above - 1]) / gap, gap, 0};
  }
  if (axis.ends == AxisEnds::circular && last > 0) {
    const double gap = nodes.front() + 2 * pi - nodes.back();
    return {last, 0, std::min((angle - nodes.back()) / gap, 1.0), gap, 0};
  }
  if (above == 0) return {0, 0, 0, 0, nodes.front() - angle};
  return {last, last, 0, 0, angle - nodes.back()};
}

/// The second derivative along an axis at a node, from its neighbours; at ends that of the next node.
/// \param line the point of the axis' first node
double RectilinearGrid::curvature(const GridAxis& axis, std::size_t line, std::size_t node, std::size_t channel) const {
  const auto& nodes = axis.nodes;
  const std::size_t last = nodes.size() - 1;
  std::size_t lower = node - 1;
  std::size_t upper = node + 1;
  double below = 0;
  double above = 0;
  if (axis.ends == AxisEnds::circular) {
    lower = node == 0 ? last : node - 1;
    upper = node == last ? 0 : node + 1;
    below = node == 0 ? nodes.front() + 2 * pi - nodes.back() : nodes[node] - nodes[lower];
    above = node == last ? nodes.front() + 2 * pi - nodes.back() : nodes[upper] - nodes[node];
  } else if (axis.ends == AxisEnds::mirrored && (node == 0 || node == last)) {
    // The node's other neighbour is the mirror image of the one it has; the node itself, where it does not lie on the
    // mirror.
    const double to_mirror = node == 0 ? nodes.front() : pi - nodes.back();
    const std::size_t inner = node == 0 ? 1 : last - 1;
    const bool is_on_mirror = to_mirror < 1e-9;
    lower = node == 0 ? (is_on_mirror ? inner : node) : inner;
    upper = node == 0 ? inner : (is_on_mirror ? inner : node);
    const double inside = std::abs(nodes[inner] - nodes[node]);
    const double outside = is_on_mirror ? inside : 2 * to_mirror;
    below = node == 0 ? outside : inside;
    above = node == 0 ? inside : outside;
  } else {
    if (node == 0 || node == last) return curvature(axis, line, node == 0 ? 1 : last - 1, channel);
    below = nodes[node] - nodes[lower];
    above = nodes[upper] - nodes[node];
  }
  const double here = value_at(line + node * axis.stride, channel);
  const double up = (value_at(line + upper * axis.stride, channel) - here) / above;
  const double down = (here - value_at(line + lower * axis.stride, channel)) / below;
  return 2 * (up - down) / (above + below);
}

double RectilinearGrid::axis_error(const GridAxis& axis, const Place& place, std::size_t line,
                                   std::size_t channel) const {
  const std::size_t count = axis.nodes.size();
  const bool is_open = axis.ends == AxisEnds::open;
  if (count == 1) return is_open && place.beyond > 0 ? kUnknown : 0;
  const bool has_curvature = !is_open || count > 2;
  if (place.beyond > 0) {
    if (!is_open) {
      // A parabola about the mirror, of which the value at the node is taken.
      const double to_mirror = place.before == 0 ? axis.nodes.front() : pi - axis.nodes.back();
      return std::abs(curvature(axis, line, place.before, channel)) * place.beyond * (to_mirror - place.beyond / 2);
    }
    const std::size_t inner = place.before == 0 ? 1 : place.before - 1;
    const double gap = std::abs(axis.nodes[inner] - axis.nodes[place.before]);
    const double slope =
        (value_at(line + place.before * axis.stride, channel) - value_at(line + inner * axis.stride, channel)) / gap;
    const double bend = has_curvature ? std::abs(curvature(axis, line, place.before, channel)) : std::abs(slope) / gap;
    return place.beyond * std::abs(slope) + place.beyond * place.beyond / 2 * bend;
  }
  const double part = place.share * (1 - place.share);
  if (part == 0) return 0;
  if (!has_curvature) {
    return part * std::abs(value_at(line + place.after * axis.stride, channel) -
                           value_at(line + place.before * axis.stride, channel));
  }
  return part * place.gap * place.gap / 2 *
         std::max(std::abs(curvature(axis, line, place.before, channel)),
                  std::abs(curvature(axis, line, place.after, channel)));
}

void RectilinearGrid::at(std::span<const double> angles, Eigen::Ref<Eigen::RowVectorXd> value,
                         Eigen::Ref<Eigen::RowVectorXd> error) const {
  std::array<Place, kMostAxes> places{};
  for (std::size_t a = 0; a < axes_.size(); ++a) places[a] = place_on(axes_[a], angles[a]);
  value.setZero();
  error.setZero();
  for (unsigned corner = 0; corner < 1U << axes_.size(); ++corner) {
    double weight = 1;
    std::size_t point = 0;
    for (std::size_t a = 0; a < axes_.size(); ++a) {
      const bool is_after = (corner >> a & 1U) != 0;
      weight *= is_after ? places[a].share : 1 - places[a].share;
      point += axes_[a].stride * (is_after ? places[a].after : places[a].before);
    }
    if (weight == 0) continue;
    for (std::size_t c = 0; c < channels_; ++c) {
      const auto column = static_cast<Eigen::Index>(c);
      value[column] += weight * value_at(point, c);
      if (!errors_.empty()) error[column] += weight * std::abs(errors_[point * channels_ + c]);
      // Lines along an axis count with the weights of both their corners, which make up that of the line.
      for (std::size_t a = 0; a < axes_.size(); ++a) {
        const bool is_after = (corner >> a & 1U) != 0;
        const std::size_t line = point - axes_[a].stride * (is_after ? places[a].after : places[a].before);
        error[column] += kMargin * weight * axis_error(axes_[a], places[a], line, c);
      }
    }
  }
}

}  // namespace lobe
