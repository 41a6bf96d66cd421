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

namespace lobe {
namespace {

using std::back_inserter;
using std::numbers::pi;

// By rising theta_in, from viridis; its yellow is too pale on white.
constexpr std::array<std::string_view, 4> kPolarColours = {"#440154", "#2f6f9f", "#2fae6e", "#e08a00"};
constexpr double kDecades = 4;

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

std::string note_of(std::span<const DrawnReflectance> drawn, const RadialScale& scale, bool is_cut) {
  const bool to_the_horizon = std::ranges::all_of(drawn, &DrawnReflectance::has_steps);
  std::string note = (to_the_horizon ? "f by θ_out; " : "f by θ_out up to 85°; ") + scale.note() +
                     (is_cut ? ", cut at the rim" : "") + "; dots: where the light comes from (θ_in)";
  if (std::ranges::any_of(drawn, &DrawnReflectance::has_delta)) note += "; dashed: delta parts";
  if (std::ranges::any_of(drawn, &DrawnReflectance::has_channels)) note += "; mean of channels";
  if (std::ranges::any_of(drawn, &DrawnReflectance::has_azimuths)) note += "; azimuth 0°";
  return note;
}

}  // namespace

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

gnuplot::Picture polar_picture(const std::string& stem, std::span<const DrawnReflectance> drawn, PictureFormat format) {
  std::vector<std::vector<IncidencePlane>> planes;
  std::vector<double> peaks;
  for (const auto& one : drawn) {
    planes.push_back(one.planes);
    for (const auto& plane : planes.back()) peaks.push_back(peak_of(plane));
  }
  const RadialScale scale(peaks);

  constexpr double kLeft = -1.2;
  constexpr double kRight = 1.2;
  constexpr double kLow = -0.2;
  constexpr double kHigh = 1.12;
  const double width = drawn.size() == 1 ? 760 : drawn.size() == 2 ? 600 : 480;
  const PanelLayout layout(drawn.size(), width, width * (kHigh - kLow) / (kRight - kLeft),
                           {.left = 16, .right = 16, .top = 44, .bottom = 12}, 0);
  std::string script = gnuplot::preamble(stem, "Plane of incidence", layout.width(), layout.height(), format);
  script += "set multiplot\n" +
            layout.heading("Plane of incidence, " + source_names(drawn), note_of(drawn, scale, is_cut(planes, scale)));
  fmt::format_to(back_inserter(script),
                 "unset border\nunset tics\nset xrange [{}:{}]\nset yrange [{}:{}]\n"
                 "set key at graph 1,graph 1 right top reverse Left samplen 1.6 spacing 1.15 title 'θ_in'\n",
                 kLeft, kRight, kLow, kHigh);
  script += grid_labels(scale);

  std::string data =
      "# Circles and spokes; then, for every curve, its points, the light's place and delta parts: x, y\n";
  data += grid_block(scale);
  std::size_t index = 1;
  for (std::size_t k = 0; k < drawn.size(); ++k) {
    script += layout.frame(k, drawn[k].name);
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
