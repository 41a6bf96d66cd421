#include "plot/polar_picture.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <initializer_list>
#include <iterator>
#include <numbers>

#include "lobe/core/directions.hpp"
#include "plot/panels.hpp"
#include "table/interpolator.hpp"

namespace lobe {
namespace {

using std::back_inserter;
using std::numbers::pi;

constexpr std::array<double, 4> kPolarAngles = {0, 30, 60, 75};
// By rising theta_in, from viridis; its yellow is too pale on white.
constexpr std::array<std::string_view, 4> kPolarColours = {"#440154", "#2f6f9f", "#2fae6e", "#e08a00"};
constexpr double kDecades = 4;

std::size_t nearest_ring(const HemisphereGrid& grid, double theta) {
  const auto rings = grid.rings();
  const auto found =
      std::ranges::min_element(rings, {}, [&](const Ring& ring) { return std::abs(ring.theta - theta); });
  return static_cast<std::size_t>(found - rings.begin());
}

std::size_t nearest_node(const HemisphereGrid& grid, const Ring& ring, double phi) {
  std::size_t best = ring.first_node;
  for (std::size_t node = ring.first_node; node < ring.first_node + ring.count; ++node) {
    const auto distance = [&](std::size_t n) {
      return std::abs(std::remainder(grid.directions()[n].phi - phi, 2 * pi));
    };
    if (distance(node) < distance(best)) best = node;
  }
  return best;
}

/// Row of L and place of V within it, in the plane of incidence through the first node of ring i.
std::size_t value_index(const BrdfTable& table, std::size_t i, std::size_t j, bool on_mirror_side) {
  const HemisphereGrid& grid = table.grid;
  if (table.form == TableForm::isotropic) {
    const std::size_t half = grid.half_azimuths();
    return (i * grid.n_theta() + j) * half + (on_mirror_side ? half - 1 : 0);
  }
  const std::size_t in = grid.rings()[i].first_node;
  const double phi = grid.directions()[in].phi + (on_mirror_side ? pi : 0);
  return in * grid.nodes() + nearest_node(grid, grid.rings()[j], phi);
}

double mean_of_channels(const BrdfTable& table, std::size_t index) {
  double sum = 0;
  for (std::size_t c = 0; c < table.channels; ++c) sum += table.channel(c)[index];
  return sum / static_cast<double>(table.channels);
}

/// Polar angles at which the value of a ring of cells is drawn.
std::vector<double> drawn_angles(const Ring& ring) {
  const double span = ring.theta_high - ring.theta_low;
  const double steps = std::max(1.0, std::ceil(span / kDegree));
  std::vector<double> angles;
  for (double k = 0; k <= steps; ++k) angles.push_back(ring.theta_low + span * k / steps);
  return angles;
}

void mark_delta_parts(const BrdfTable& table, std::size_t i, IncidencePlane& plane) {
  const std::size_t row = table.form == TableForm::isotropic ? i : table.grid.rings()[i].first_node;
  plane.has_mirror = !table.mirror.empty() && table.mirror[row] != 0;
  plane.has_retro = !table.retro.empty() && table.retro[row] != 0;
}

IncidencePlane stepped_plane(const BrdfTable& table, std::size_t i) {
  IncidencePlane plane;
  plane.theta_in = table.grid.rings()[i].theta;
  for (const bool on_mirror_side : {false, true}) {
    for (std::size_t j = 0; j < table.grid.rings().size(); ++j) {
      const double f = mean_of_channels(table, value_index(table, i, j, on_mirror_side));
      for (const double theta : drawn_angles(table.grid.rings()[j])) {
        plane.theta_out.push_back(on_mirror_side ? theta : -theta);
        plane.f.push_back(f);
      }
    }
    if (on_mirror_side) continue;
    std::ranges::reverse(plane.theta_out);
    std::ranges::reverse(plane.f);
  }
  mark_delta_parts(table, i, plane);
  return plane;
}

/// Largest angle of view that is drawn: many models grow without bound beyond it, in a spike along the horizon.
constexpr double kLastDrawn = 85 * kDegree;

/// Polar angles across the normal, half a degree apart, with the directions of mirror and light.
std::vector<double> interpolated_angles(double theta_in, double last) {
  std::vector<double> angles = {-theta_in, theta_in};
  const auto steps = static_cast<int>(2 * last / kDegree);
  for (int k = -steps; k <= steps; ++k) angles.push_back(k * kDegree / 2);
  angles.insert(angles.end(), {-last, last});
  std::ranges::sort(angles);
  angles.erase(std::unique(angles.begin(), angles.end()), angles.end());
  return angles;
}

/// Between the nodes, where a table has values at directions.
IncidencePlane interpolated_plane(const BrdfTable& table, const Interpolator& interpolator, double theta_in) {
  IncidencePlane plane;
  plane.theta_in = theta_in;
  plane.theta_out = interpolated_angles(theta_in, std::min(table.grid.rings().back().theta, kLastDrawn));
  for (const double theta : plane.theta_out) {
    const Direction out = {std::abs(theta), theta < 0 ? 0 : pi};
    double sum = 0;
    for (std::size_t c = 0; c < table.channels; ++c) sum += interpolator.at(c, {theta_in, 0}, out).value;
    plane.f.push_back(sum / static_cast<double>(table.channels));
  }
  mark_delta_parts(table, nearest_ring(table.grid, theta_in), plane);
  return plane;
}

/// The smallest of these factors (1 to 10, rising) times a power of ten that is not below a value.
double round_up(double value, std::initializer_list<double> factors) {
  const double power = std::pow(10, std::floor(std::log10(value)));
  for (const double factor : factors) {
    if (factor * power >= value * (1 - 1e-9)) return factor * power;
  }
  return 10 * power;
}

std::string point(double theta, double radius) {
  return fmt::format("{:.5f} {:.5f}\n", radius * std::sin(theta), radius * std::cos(theta));
}

/// Circles and spokes.
std::string grid_block(const RadialScale& scale) {
  std::string block;
  for (const double tick : scale.ticks()) {
    for (int degree = -90; degree <= 90; degree += 2) block += point(degree * kDegree, scale.radius(tick));
    block += '\n';
  }
  for (int degree = -90; degree <= 90; degree += 30) block += point(0, 0) + point(degree * kDegree, 1) + '\n';
  return block + '\n';
}

std::string grid_labels(const RadialScale& scale) {
  std::string script;
  for (int degree = -90; degree <= 90; degree += 30) {
    fmt::format_to(back_inserter(script), "set label '{}{}°' at {:.4f},{:.4f} center textcolor rgb '#555555'\n",
                   degree < 0 ? "−" : "", std::abs(degree), 1.09 * std::sin(degree * kDegree),
                   1.065 * std::cos(degree * kDegree));
  }
  for (const double tick : scale.ticks()) {
    fmt::format_to(back_inserter(script), "set label '{:g}' at {:.4f},-0.06 center textcolor rgb '#555555'\n", tick,
                   scale.radius(tick));
  }
  return script +
         "set label 'f / sr⁻¹' at -0.06,-0.06 right textcolor rgb '#555555'\n"
         "set label 'retro side' at -0.5,-0.15 center textcolor rgb '#888888'\n"
         "set label 'mirror side' at 0.5,-0.15 center textcolor rgb '#888888'\n";
}

/// Largest f of a curve that sets the scale.
double peak_of(const IncidencePlane& plane) {
  double peak = 0;
  for (std::size_t i = 0; i < plane.f.size(); ++i) {
    if (std::abs(plane.theta_out[i]) <= kGrazing) peak = std::max(peak, plane.f[i]);
  }
  return peak;
}

/// The curve, then the light's place on the rim, then lines towards delta parts.
std::string curve_blocks(const IncidencePlane& plane, const RadialScale& scale) {
  std::string block;
  for (std::size_t i = 0; i < plane.f.size(); ++i) {
    // Nothing along the rim where the curve is beyond it, but for rounding.
    const double rim = scale.top() * (1 + 1e-9);
    const bool is_beyond = i > 0 && plane.f[i - 1] > rim && plane.f[i] > rim;
    if (!is_beyond) {
      block += point(plane.theta_out[i], scale.radius(plane.f[i]));
    } else if (!block.ends_with("\n\n")) {
      block += '\n';  // one empty line breaks a curve, two end it
    }
  }
  block += "\n\n" + point(-plane.theta_in, 1) + "\n\n";
  if (plane.has_mirror) block += point(0, 0) + point(plane.theta_in, 1) + '\n';
  if (plane.has_retro) block += point(0, 0) + point(-plane.theta_in, 1) + '\n';
  return block + (plane.has_mirror || plane.has_retro ? "\n" : "");
}

/// Lines of the plot command for one curve.
/// \param index of its first block; moved behind its last one
std::string curve_plot(const IncidencePlane& plane, std::string_view colour, std::size_t& index) {
  std::string plot = fmt::format(
      ", \\\n     '' index {} with lines linewidth 2.2 linecolor rgb '{}' title '{:.3g}°'"
      ", \\\n     '' index {} with points pointtype 7 pointsize 0.9 linecolor rgb '{}' notitle",
      index, colour, plane.theta_in / kDegree, index + 1, colour);
  index += 2;
  if (!plane.has_mirror && !plane.has_retro) return plot;
  return plot + fmt::format(", \\\n     '' index {} with lines linewidth 1.6 dashtype 2 linecolor rgb '{}' notitle",
                            index++, colour);
}

bool is_cut(const std::vector<std::vector<IncidencePlane>>& planes, const RadialScale& scale) {
  return std::ranges::any_of(planes, [&](const auto& of_table) {
    return std::ranges::any_of(of_table, [&](const auto& plane) { return std::ranges::max(plane.f) > scale.top(); });
  });
}

bool drawn_to_the_horizon(std::span<const BrdfTable> tables) {
  return std::ranges::all_of(tables, [](const auto& table) { return table.grid.has_cells(); });
}

std::string note_of(std::span<const BrdfTable> tables, const RadialScale& scale, bool is_cut) {
  std::string note = (drawn_to_the_horizon(tables) ? "f by θ_out; " : "f by θ_out up to 85°; ") + scale.note() +
                     (is_cut ? ", cut at the rim" : "") + "; dots: where the light comes from (θ_in)";
  if (std::ranges::any_of(tables, &BrdfTable::has_delta)) note += "; dashed: delta parts";
  if (std::ranges::any_of(tables, [](const auto& table) { return table.channels > 1; })) note += "; mean of channels";
  const bool has_azimuths =
      std::ranges::any_of(tables, [](const auto& table) { return table.form == TableForm::general; });
  if (has_azimuths) note += "; azimuth 0°";
  return note;
}

}  // namespace

std::vector<IncidencePlane> incidence_planes(const BrdfTable& table) {
  std::vector<IncidencePlane> planes;
  if (table.grid.has_cells()) {
    std::vector<std::size_t> rows;
    for (const double angle : kPolarAngles) rows.push_back(nearest_ring(table.grid, angle * kDegree));
    rows.erase(std::unique(rows.begin(), rows.end()), rows.end());
    for (const std::size_t row : rows) planes.push_back(stepped_plane(table, row));
    return planes;
  }
  const Interpolator interpolator(table);
  for (const double angle : kPolarAngles) {
    // Beyond the last ring a polynomial would be continued, not interpolated.
    if (angle * kDegree > table.grid.rings().back().theta) break;
    planes.push_back(interpolated_plane(table, interpolator, angle * kDegree));
  }
  return planes;
}

RadialScale::RadialScale(std::span<const double> peaks) {
  const auto [low, high] = std::ranges::minmax(peaks);
  if (!(high > 0)) return;
  top_ = round_up(high, {1, 1.5, 2, 3, 4, 5, 6, 8});
  const double ratio = high / std::max(low, high * 1e-9);
  kind_ = ratio <= 5 ? Kind::linear : ratio <= 1000 ? Kind::cube_root : Kind::logarithmic;
}

double RadialScale::radius(double f) const {
  const double share = std::clamp(f / top_, 0.0, 1.0);
  if (kind_ == Kind::linear) return share;
  if (kind_ == Kind::cube_root) return std::cbrt(share);
  return std::max(0.0, 1 + std::log10(std::max(share, 1e-300)) / kDecades);
}

std::vector<double> RadialScale::ticks() const {
  std::vector<double> ticks = {top_};
  if (kind_ == Kind::linear) {
    const double step = round_up(top_ / 5, {1, 2, 5});
    ticks.clear();
    for (double k = 1; k * step < top_ * (1 - 1e-9); ++k) ticks.push_back(k * step);
    if (radius(ticks.back()) > 0.85) ticks.pop_back();
    ticks.push_back(top_);
    return ticks;
  }
  constexpr double kSpacing = 0.16;
  for (double value = std::pow(10, std::floor(std::log10(top_))); radius(value) > kSpacing && ticks.size() < 7;) {
    if (radius(ticks.back()) - radius(value) >= kSpacing) ticks.push_back(value);
    // 10, 5, 2, 1, 0.5, ...
    const double digit = value / std::pow(10, std::floor(std::log10(value) + 1e-9));
    value = digit > 4 ? value / 2.5 : value / 2;
  }
  std::ranges::reverse(ticks);
  return ticks;
}

std::string RadialScale::note() const {
  if (kind_ == Kind::linear) return "radius: proportional to f";
  if (kind_ == Kind::cube_root) return "radius: cube root of f";
  return fmt::format("radius: logarithm of f, centre: {:g} sr⁻¹ and below", top_ * std::pow(10, -kDecades));
}

gnuplot::Picture polar_picture(const std::string& stem, std::span<const BrdfTable> tables, PictureFormat format) {
  std::vector<std::vector<IncidencePlane>> planes;
  std::vector<double> peaks;
  for (const auto& table : tables) {
    planes.push_back(incidence_planes(table));
    for (const auto& plane : planes.back()) peaks.push_back(peak_of(plane));
  }
  const RadialScale scale(peaks);

  constexpr double kLeft = -1.2;
  constexpr double kRight = 1.2;
  constexpr double kLow = -0.2;
  constexpr double kHigh = 1.12;
  const double width = tables.size() == 1 ? 760 : tables.size() == 2 ? 600 : 480;
  const PanelLayout layout(tables.size(), width, width * (kHigh - kLow) / (kRight - kLeft),
                           {.left = 16, .right = 16, .top = 44, .bottom = 12}, 0);
  std::string script = gnuplot::preamble(stem, "Plane of incidence", layout.width(), layout.height(), format);
  script += "set multiplot\n" +
            layout.heading("Plane of incidence, " + grid_names(tables), note_of(tables, scale, is_cut(planes, scale)));
  fmt::format_to(back_inserter(script),
                 "unset border\nunset tics\nset xrange [{}:{}]\nset yrange [{}:{}]\n"
                 "set key at graph 1,graph 1 right top reverse Left samplen 1.6 spacing 1.15 title 'θ_in'\n",
                 kLeft, kRight, kLow, kHigh);
  script += grid_labels(scale);

  std::string data =
      "# Circles and spokes; then, for every curve, its points, the light's place and delta parts: x, y\n";
  data += grid_block(scale);
  std::size_t index = 1;
  for (std::size_t k = 0; k < tables.size(); ++k) {
    script += layout.frame(k, tables[k].expression);
    script += "plot data_file index 0 with lines linewidth 0.7 linecolor rgb '#c8c8c8' notitle";
    for (std::size_t i = 0; i < planes[k].size(); ++i) {
      data += curve_blocks(planes[k][i], scale);
      script += curve_plot(planes[k][i], kPolarColours[i], index);
    }
    script += '\n';
    if (k == 0) script += PanelLayout::end_heading();
  }
  return {script + "unset multiplot\n", std::move(data)};
}

}  // namespace lobe
