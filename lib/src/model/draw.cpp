#include "model/draw.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <iterator>
#include <memory>
#include <numbers>
#include <utility>

#include "model/constants.hpp"

namespace lobe::draw {
namespace {

using std::numbers::pi;

UnitVector normalised(const UnitVector& a) {
  const double length = std::hypot(a[0], a[1], a[2]);
  return {a[0] / length, a[1] / length, a[2] / length};
}

/// A unit vector across another.
UnitVector across(const UnitVector& a) {
  // The axis farthest from a.
  const bool is_upright = std::abs(a[2]) > std::abs(a[0]);
  return normalised(is_upright ? UnitVector{a[2], 0, -a[0]} : UnitVector{-a[1], a[0], 0});
}

}  // namespace

UnitVector mirror_of(const UnitVector& light) {
  return {-light[0], -light[1], light[2]};
}

UnitVector inner_mirror(const UnitVector& light) {
  const double twice = 2 * light[2];
  return {-twice * light[0], -twice * light[1], twice * light[2] - 1};
}

ProposalPart cosine() {
  return {.strategy = Strategy::cosine};
}

ProposalPart power(const UnitVector& axis, double n, bool on_inner_sphere) {
  const UnitVector unit = normalised(axis);
  const UnitVector side = across(unit);
  return {.strategy = Strategy::power,
          .numbers = {unit[0], unit[1], unit[2], side[0], side[1], side[2], n, on_inner_sphere ? 1.0 : 0.0}};
}

ProposalPart uniform() {
  return power(kNormal, 0);
}

ProposalPart beckmann(double m_x, double m_y, double rotation) {
  return {.strategy = Strategy::beckmann, .numbers = {m_x, m_y, std::cos(rotation), std::sin(rotation)}};
}

ProposalPart cosine_facets(double n_u, double n_v, double rotation) {
  return {.strategy = Strategy::cosine_facets, .numbers = {n_u, n_v, std::cos(rotation), std::sin(rotation)}};
}

ProposalPart visible_facets(const UnitVector& light, double a_x, double a_y, double rotation) {
  const double cosine = std::cos(rotation);
  const double sine = std::sin(rotation);
  const UnitVector stretched =
      normalised({a_x * (cosine * light[0] + sine * light[1]), a_y * (cosine * light[1] - sine * light[0]), light[2]});
  const double length = std::hypot(stretched[0], stretched[1]);
  const bool is_upright = length == 0;
  return {.strategy = Strategy::visible_facets,
          .numbers = {a_x, a_y, cosine, sine, stretched[0], stretched[1], stretched[2],
                      is_upright ? 1 : -stretched[1] / length, is_upright ? 0 : stretched[0] / length}};
}

ProposalPart visible_facets(const UnitVector& light, double a) {
  return visible_facets(light, a, a, 0);
}

namespace {

/// angle - sin(angle) cos(angle): the area of a segment of the unit circle, of half that angle.
double segment_area(double angle) {
  constexpr double kSmall = 0.01;
  if (angle > kSmall) return angle - std::sin(angle) * std::cos(angle);
  const double square = angle * angle;
  return angle * square * (2.0 / 3 - square * (2.0 / 15 - square * 4 / 315));
}

/// As the way of kernels/sampling/patch.clh.
enum PatchWay { plain, lens, rejection };

}  // namespace

ProposalPart patch(const UnitVector& centre, double radius, PatchDraw draw) {
  constexpr double kWholePlane = 2;
  // At R = 2 rounding must not cut off the farthest direction at grazing angles.
  if (radius >= kWholePlane) radius *= std::numbers::sqrt2;
  const double distance = std::hypot(centre[0], centre[1]);
  const double smaller = std::min(1.0, radius);
  ProposalPart part{.strategy = Strategy::patch,
                    .numbers = {centre[0], centre[1], radius, plain, 1 / (pi * smaller * smaller)}};
  const double inside = centre[2] * centre[2] / (1 + distance);  // 1 - distance, without cancellation
  if (draw == PatchDraw::roulette || radius <= inside || radius >= 1 + distance) return part;
  const double unit_angle = 2 * std::asin(std::sqrt((radius - inside) * (radius + inside) / (4 * distance)));
  const double patch_angle =
      std::acos(std::clamp((radius * radius - inside * (1 + distance)) / (2 * distance * radius), -1.0, 1.0));
  const double unit_area = segment_area(unit_angle);
  const double area = unit_area + radius * radius * segment_area(patch_angle);
  auto& numbers = part.numbers;
  numbers[3] = draw == PatchDraw::exact ? lens : rejection;
  numbers[4] = 1 / area;
  numbers[5] = centre[0] / distance;
  numbers[6] = centre[1] / distance;
  numbers[7] = unit_area / area;
  numbers[8] = unit_angle;
  numbers[9] = patch_angle;
  numbers[10] = distance;
  return part;
}

namespace {

/// Radii from 0 to 2 that crowd towards 0 and, from below, towards 1, which is one of them.
/// \param finest the smallest above 0
std::vector<double> mixture_nodes(double finest) {
  constexpr double kStep = 0.03;    // of ln R
  constexpr double kCrowd = 1e-12;  // nearest to 1
  std::vector<double> even{0};
  for (double log_radius = std::log(finest); log_radius < std::log(2.0); log_radius += kStep) {
    even.push_back(std::exp(log_radius));
  }
  std::vector<double> crowded;
  for (double rest = 0.1; rest > kCrowd; rest /= 2) crowded.push_back(1 - rest);
  crowded.insert(crowded.end(), {1, 2});
  std::vector<double> nodes;
  nodes.reserve(even.size() + crowded.size());
  std::ranges::merge(even, crowded, std::back_inserter(nodes));
  nodes.erase(std::unique(nodes.begin(), nodes.end()), nodes.end());
  return nodes;
}

NumberTable table_of(const std::function<double(double)>& profile, std::vector<double> nodes) {
  const std::size_t count = nodes.size();
  std::vector<double> values;
  values.reserve(count);
  for (const double radius : nodes) values.push_back(profile(radius));
  std::vector<double> shares{0};
  for (std::size_t k = 0; k + 1 < count; ++k) {
    const double slope = (values[k] - values[k + 1]) / (nodes[k + 1] - nodes[k]);
    const double low = nodes[k];
    const double high = nodes[k + 1];
    const double moment = low >= 1 ? high - low : (high * high * high - low * low * low) / 3;
    shares.push_back(shares.back() + pi * slope * moment);
  }
  const double total = shares.back() + pi * values.back();
  auto table = std::make_shared<std::vector<double>>(std::move(nodes));
  for (const double share : shares) table->push_back(share / total);
  if (values.back() == 0) table->back() = 1;
  for (const double value : values) table->push_back(value / total);
  return table;
}

}  // namespace

NumberTable mixture_table(const std::function<double(double)>& profile, double scale) {
  constexpr double kFine = 1e-3;
  return table_of(profile, mixture_nodes(kFine * std::min(scale, 1.0)));
}

NumberTable bounded_table(const std::function<double(double)>& profile, double inner, double radius) {
  auto nodes = mixture_nodes(1e-3 * std::min(radius, 1.0));
  for (const double edge : {inner, radius}) nodes.insert(std::ranges::upper_bound(nodes, edge), edge);
  nodes.erase(std::unique(nodes.begin(), nodes.end()), nodes.end());
  return table_of(profile, std::move(nodes));
}

NumberTable KnownTables::table(Values parameters, const std::function<NumberTable()>& make) {
  constexpr std::size_t kMost = 8;
  const auto found =
      std::ranges::find_if(known_, [&](const Known& one) { return std::ranges::equal(one.parameters, parameters); });
  if (found != known_.end()) return found->table;
  Known made{{parameters.begin(), parameters.end()}, make()};
  const NumberTable table = made.table;
  if (known_.size() < kMost) {
    known_.push_back(std::move(made));
  } else {
    known_[next_] = std::move(made);
    next_ = (next_ + 1) % kMost;
  }
  return table;
}

ProposalPart patch_mixture(const UnitVector& centre, const NumberTable& table) {
  return {.strategy = Strategy::patch_mixture,
          .numbers = {centre[0], centre[1], static_cast<double>(table->size() / 3)},
          .table = table,
          .place_of_table = 3};
}

ProposalPart exponential_patch(const UnitVector& centre, double s) {
  return patch_mixture(
      centre, std::array{s}, [s](double distance) { return std::exp(-s * distance); }, 1 / s);
}

ProposalPart with_share(double share, ProposalPart part) {
  part.share = share;
  return part;
}

Parts general(const UnitVector& light, double width, double retro_width) {
  constexpr double kWide = 0.5;  // radians
  if (retro_width < kWide) {
    return {with_share(0.4, visible_facets(light, std::min(width, 1.0))),
            with_share(0.2, power(light, 1 / (2 * retro_width * retro_width))), with_share(0.2, cosine()),
            with_share(0.2, uniform())};
  }
  if (width > kWide) return {with_share(0.5, cosine()), with_share(0.5, uniform())};
  return {with_share(0.5, visible_facets(light, width)), with_share(0.25, cosine()), with_share(0.25, uniform())};
}

Parts diffuse(Values, const Scene&) {
  return {cosine()};
}

Parts limb(Values, const Scene& scene) {
  const double grazing = 0.1 + 0.5 * (1 - scene.light[2]);
  return {with_share(1 - grazing, cosine()), with_share(grazing, uniform())};
}

Parts mirror_power(Values v, const Scene& scene) {
  return {power(mirror_of(scene.light), v[0])};
}

Parts beckmann_facets(Values v, const Scene&) {
  return {beckmann(v[0], v[0], 0)};
}

Parts power_facets(Values v, const Scene&) {
  return {cosine_facets(v[0], v[0], 0)};
}

Parts power_facets_with_cosine(Values v, const Scene&) {
  return {cosine_facets(v[0] + 1, v[0] + 1, 0)};
}

Parts gaussian_facets(Values v, const Scene&) {
  return {with_share(0.85, beckmann(v[0], v[0], 0)), with_share(0.15, uniform())};
}

Parts trowbridge_facets(Values v, const Scene& scene) {
  return {visible_facets(scene.light, v[0])};
}

Parts schlick_facets(Values v, const Scene& scene) {
  return {visible_facets(scene.light, std::sqrt(v[0]))};
}

Parts long_tail(const UnitVector& light, double a) {
  const double width = std::min(a, 1.0);
  return {with_share(0.4, visible_facets(light, width)), with_share(0.3, visible_facets(light, std::sqrt(width))),
          with_share(0.3, uniform())};
}

Parts exponential(Values v, const Scene& scene) {
  return {exponential_patch(mirror_of(scene.light), v[0])};
}

}  // namespace lobe::draw
