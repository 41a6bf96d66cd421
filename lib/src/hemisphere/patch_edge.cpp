#include "hemisphere/patch_edge.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "core/bisection.hpp"

namespace lobe {
namespace {

using std::numbers::pi;

constexpr double kGrowth = 3;    // of panels of tan(azimuth) from an axis
constexpr double kWidest = 1.2;  // azimuth from which on one panel reaches the next axis
constexpr double kZero = 1e-13;
constexpr int kEdgeHalvings = 52;

/// |x|^power is smooth in x.
bool is_even(double power) {
  return std::fmod(power, 2) == 0;
}

/// Azimuths from the longer axis to the one across. In x = ln(tan(azimuth) / ratio) the norm has the poles +-i pi/p,
/// and away from the axis across its reach falls in proportion to the tangent.
std::vector<PanelEdge> quarter_panels(const PatchEdge& edge) {
  const bool has_kinks = !is_even(edge.power);
  std::vector<PanelEdge> limits{{0, has_kinks}, {pi / 2, has_kinks}};
  const auto add = [&](double share) {
    const double azimuth = std::atan(edge.ratio * share);
    if (azimuth < kWidest) limits.push_back({azimuth});
  };
  for (double share = 1; std::atan(edge.ratio * share) < kWidest; share *= kGrowth) add(share);
  for (double step = kGrowth / edge.power; step < 1; step *= kGrowth) {
    add(std::exp(step));
    add(std::exp(-step));
  }
  tidy_edges(limits);
  return limits;
}

double within(double azimuth, double period) {
  return azimuth - period * std::floor(azimuth / period);
}

/// Zero of f in [low, high], at whose ends it has different signs.
double zero_between(const std::function<double(double)>& f, double low, double high) {
  const bool rises = f(low) < 0;
  const Bracket zero = bisect({low, high}, kEdgeHalvings, [&](double x) { return (f(x) < 0) == rises; });
  return (zero.low + zero.high) / 2;
}

}  // namespace

double PatchEdge::reach(double azimuth) const {
  const double u = ratio * std::abs(std::cos(azimuth - rotation));
  const double v = std::abs(std::sin(azimuth - rotation));
  const double larger = std::max(u, v);
  return radius / (larger * std::pow(1 + std::pow(std::min(u, v) / larger, power), 1 / power));
}

double PatchEdge::farthest() const {
  return radius / ratio * (power > 2 ? std::numbers::sqrt2 : 1);
}

std::vector<double> sign_changes(const std::function<double(double)>& f, std::span<const PanelEdge> limits) {
  constexpr int kSteps = 8;
  std::vector<double> zeros;
  std::vector<double> zeros_since;
  double last = limits.front().at;
  double value = f(last);
  for (std::size_t i = 1; i < limits.size(); ++i) {
    for (int k = 1; k <= kSteps; ++k) {
      const double at = limits[i - 1].at + (limits[i].at - limits[i - 1].at) * k / kSteps;
      const double next = f(at);
      if (std::abs(next) < kZero) {
        zeros_since.push_back(at);
        continue;
      }
      if (value * next < 0) {
        if (zeros_since.empty()) zeros_since.push_back(zero_between(f, last, at));
        zeros.insert(zeros.end(), zeros_since.begin(), zeros_since.end());
      }
      zeros_since.clear();
      last = at;
      value = next;
    }
  }
  return zeros;
}

std::vector<PanelEdge> norm_panels(std::span<const PatchEdge> edges, std::span<const double> radii) {
  std::vector<PanelEdge> limits;
  for (const PatchEdge& edge : edges) {
    for (const PanelEdge& limit : quarter_panels(edge)) {
      for (const double azimuth : {limit.at, -limit.at}) {
        limits.push_back({within(edge.rotation + azimuth, pi), limit.root});
      }
    }
  }
  tidy_edges(limits);
  limits.push_back({limits.front().at + pi, limits.front().root});
  std::vector<PanelEdge> crossings;
  const auto add_crossings = [&](const std::function<double(double)>& difference) {
    for (const double at : sign_changes(difference, limits)) crossings.push_back({at});
  };
  for (std::size_t i = 0; i < edges.size(); ++i) {
    if (std::isinf(edges[i].radius)) continue;
    const auto reach = [&edge = edges[i]](double azimuth) { return std::min(edge.reach(azimuth), 2.0); };
    for (const double radius : radii) add_crossings([&](double at) { return reach(at) - radius; });
    for (std::size_t k = 0; k < i; ++k) {
      add_crossings([&](double at) { return reach(at) - std::min(edges[k].reach(at), 2.0); });
    }
  }
  limits.insert(limits.end(), crossings.begin(), crossings.end());
  tidy_edges(limits);
  return limits;
}

PatchHorizon::PatchHorizon(const PatchEdge& edge) : edge_(edge) {
  constexpr std::size_t kSteps = 8;
  const auto panels = quarter_panels(edge);
  std::vector<double> quarter;
  for (std::size_t i = 0; i + 1 < panels.size(); ++i) {
    const double step = (panels[i + 1].at - panels[i].at) / kSteps;
    for (std::size_t k = 0; k < kSteps; ++k) quarter.push_back(panels[i].at + step * static_cast<double>(k));
  }
  quarter.push_back(pi / 2);
  const std::size_t steps = quarter.size() - 1;
  for (int k = 0; k < 4; ++k) {
    for (std::size_t i = 0; i < steps; ++i) {
      const double azimuth = k * pi / 2 + (k % 2 == 0 ? quarter[i] : pi / 2 - quarter[steps - i]);
      const double reach = edge.reach(edge.rotation + azimuth);
      outline_.push_back({azimuth, reach * std::cos(azimuth), reach * std::sin(azimuth)});
    }
  }
  outline_.push_back({2 * pi, outline_.front().x, outline_.front().y});
}

std::vector<PanelEdge> PatchHorizon::azimuths(double distance) const {
  std::vector<PanelEdge> quarter;
  for (const PanelEdge& limit : quarter_panels(edge_)) quarter.push_back({pi / 2 - limit.at});
  for (const double azimuth : touching(distance)) quarter.push_back({azimuth, true});
  for (const double azimuth : passing(distance)) quarter.push_back({azimuth, true});
  std::vector<PanelEdge> limits;
  for (const PanelEdge& limit : quarter) {
    for (const double azimuth : {limit.at, -limit.at}) {
      limits.push_back({within(edge_.rotation + azimuth, pi), limit.root});
    }
  }
  return limits;
}

std::vector<double> PatchHorizon::distances() const {
  constexpr int kSteps = 48;
  if (std::isinf(edge_.radius)) return {};
  std::vector<double> steps;
  for (int k = 1; k < kSteps; ++k) {
    const double share = static_cast<double>(k) / kSteps;
    steps.push_back(share);
    // Small patches reach the circle from near it only.
    steps.push_back(1 - 1.5 * share * edge_.reach(edge_.rotation));
  }
  steps.push_back(1);
  std::erase_if(steps, [](double step) { return !(step > 0); });
  std::ranges::sort(steps);
  const auto number = [&](double distance) { return touching(distance).size() + 16 * passing(distance).size(); };
  std::vector<double> found;
  for (std::size_t k = 1; k < steps.size(); ++k) {
    const auto above = number(steps[k]);
    if (number(steps[k - 1]) == above) continue;
    const auto is_below = [&](double distance) { return number(distance) != above; };
    found.push_back(bisect({steps[k - 1], steps[k]}, kEdgeHalvings, is_below).high);
  }
  return found;
}

// Between three points of the outline where the distance from the circle has its extremum it is taken for a parabola;
// so an edge that only just touches the circle does not slip through.
int PatchHorizon::crossings(double distance, double azimuth) const {
  const double x = distance * std::cos(azimuth);
  const double y = distance * std::sin(azimuth);
  const auto outside = [&](const Point& z) {
    // |c + z|^2 - 1 without the cancellation of small patches near the circle
    return (distance - 1) * (distance + 1) + z.x * (2 * x + z.x) + z.y * (2 * y + z.y);
  };
  const std::size_t points = outline_.size() - 1;
  int changes = 0;
  double before = outside(outline_[points - 1]);
  double value = outside(outline_[0]);
  double azimuth_before = outline_[points - 1].azimuth - 2 * pi;
  for (std::size_t i = 0; i < points; ++i) {
    const double next = outside(outline_[i + 1]);
    const double left = outline_[i].azimuth - azimuth_before;
    const double right = outline_[i + 1].azimuth - outline_[i].azimuth;
    const double slope_left = (value - before) / left;
    const double slope_right = (next - value) / right;
    double extreme = value;
    if (slope_left * slope_right < 0) {
      const double curvature = (slope_right - slope_left) / (left + right);
      const double slope = (slope_left * right + slope_right * left) / (left + right);
      extreme -= slope * slope / (4 * curvature);
    }
    if ((extreme > 0) != (value > 0)) changes += 2;
    if ((next > 0) != (value > 0)) ++changes;
    before = value;
    value = next;
    azimuth_before = outline_[i].azimuth;
  }
  return changes;
}

std::vector<double> PatchHorizon::touching(double distance) const {
  constexpr int kSteps = 32;
  std::vector<double> found;
  if (std::isinf(edge_.radius)) return found;
  int below = crossings(distance, 0);
  for (int k = 1; k <= kSteps; ++k) {
    const double low = pi / 2 * (k - 1) / kSteps;
    const double high = pi / 2 * k / kSteps;
    const int above = crossings(distance, high);
    if (above == below) continue;
    const auto is_below = [&](double axis) { return crossings(distance, axis) == below; };
    found.push_back(bisect({low, high}, kEdgeHalvings, is_below, kZero * low).high);
    below = above;
  }
  return found;
}

std::vector<double> PatchHorizon::passing(double distance) const {
  std::vector<double> found;
  if (std::isinf(edge_.radius) || is_even(edge_.power)) return found;
  const auto add = [&](double axis) {
    const double reach = edge_.reach(edge_.rotation + axis);
    const double cosine = ((1 - distance) * (1 + distance) - reach * reach) / (2 * distance * reach);
    if (std::abs(cosine) < 1) found.push_back(std::abs(axis - std::acos(std::abs(cosine))));
  };
  add(0);
  add(pi / 2);
  return found;
}

}  // namespace lobe
