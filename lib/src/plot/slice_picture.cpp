#include "plot/slice_picture.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <limits>
#include <numbers>

#include "plot/panels.hpp"

namespace lobe {
namespace {

using std::back_inserter;
using std::numbers::pi;

constexpr std::size_t kPixels = 180;  // per axis

/// The error, of interpolation above all, is a third of the value or more. An unknown error (NaN) is no doubt.
bool is_doubtful(const Estimate& f) {
  return f.error > std::abs(f.value) / 3;
}

struct SliceRange {
  double low = 0;
  double high = 1;
  bool logarithmic = false;

  /// An error that large is seen in the colours.
  [[nodiscard]] double visible_error() const { return logarithmic ? std::sqrt(low * high) : high / 10; }
};

/// Linear from 0, or logarithmic over at most four decades where f spans more than a factor of 20.
SliceRange colour_range(std::span<const DrawnReflectance> drawn, std::span<const Directions> directions) {
  double low = std::numeric_limits<double>::infinity();
  double high = 0;
  for (const auto& one : drawn) {
    const auto& pixels = one.slice;
    for (std::size_t i = 0; i < pixels.size(); ++i) {
      if (directions[i].theta_in > kGrazing || is_doubtful(pixels[i]) || pixels[i].value < 0) continue;
      low = std::min(low, pixels[i].value);
      high = std::max(high, pixels[i].value);
    }
  }
  if (!(high > 0)) return {};
  if (low > high / 20) return {0, high, false};
  return {std::max(low, high * 1e-4), high, true};
}

/// The matrix of a slice.
/// \param has_gaps set where pixels are left out because their colours would be wrong
std::string matrix(const std::vector<Estimate>& pixels, const SliceRange& range, bool& has_gaps) {
  std::string text;
  for (std::size_t i = 0; i < pixels.size(); ++i) {
    const bool is_gap = is_doubtful(pixels[i]) && pixels[i].error > range.visible_error();
    has_gaps = has_gaps || is_gap;
    text += is_gap ? "nan" : fmt::format("{:.5g}", pixels[i].value);
    text += (i + 1) % kPixels == 0 ? '\n' : ' ';
  }
  return text;
}

std::string note_of(std::span<const DrawnReflectance> drawn, const SliceRange& range, bool has_gaps) {
  std::string note = range.logarithmic ? "φ_d = 90°; logarithmic colours" : "φ_d = 90°; linear colours";
  if (std::ranges::any_of(drawn, &DrawnReflectance::has_channels)) note += "; mean of channels";
  if (std::ranges::any_of(drawn, &DrawnReflectance::has_azimuths)) note += "; φ_h = 0°";
  return has_gaps ? note + "; white: too uncertain" : note;
}

}  // namespace

/// Row by row, theta_h rising within each.
std::vector<Directions> slice_directions() {
  constexpr double kStep = pi / 2 / kPixels;
  std::vector<Directions> directions;
  for (std::size_t up = 0; up < kPixels; ++up) {
    for (std::size_t across = 0; across < kPixels; ++across) {
      directions.push_back(half_difference_directions((static_cast<double>(across) + 0.5) * kStep,
                                                      (static_cast<double>(up) + 0.5) * kStep));
    }
  }
  return directions;
}

Directions half_difference_directions(double theta_h, double theta_d) {
  // With the half-vector at azimuth 0 both directions have the same height, and azimuths +-phi.
  const double theta = std::acos(std::clamp(std::cos(theta_h) * std::cos(theta_d), 0.0, 1.0));
  const double phi = std::atan2(std::sin(theta_d), std::sin(theta_h) * std::cos(theta_d));
  return {theta, theta, 2 * phi, -phi};
}

gnuplot::Picture slice_picture(const std::string& stem, std::span<const DrawnReflectance> drawn, PictureFormat format) {
  const SliceRange range = colour_range(drawn, slice_directions());
  bool has_gaps = false;
  std::string data = "# f / sr^-1: a block for each, rows by rising theta_d, columns by rising theta_h\n";
  for (const auto& one : drawn) data += matrix(one.slice, range, has_gaps) + "\n\n";

  const double side = drawn.size() == 1 ? 560 : 360;
  const PanelLayout layout(drawn.size(), side, side, {.left = 78, .right = 12, .top = 44, .bottom = 66}, 130);
  std::string script =
      gnuplot::preamble(stem, "Slice over half-vector angles", layout.width(), layout.height(), format);
  script += "set multiplot\n" + gnuplot::viridis();
  script += layout.heading("Slice over half-vector angles, " + source_names(drawn), note_of(drawn, range, has_gaps));
  script += layout.colour_bar();
  if (range.logarithmic) script += "set logscale cb\n";
  fmt::format_to(back_inserter(script),
                 "set cbrange [{0:.6g}:{1:.6g}]\nset format cb '%g'\nset cblabel 'f / sr⁻¹' font ',11' offset 1\n"
                 "low = {0:.6g}\nshown(f) = f < low ? low : f\nangle(i) = (i + 0.5) * 90.0 / {2}\n"
                 "set xrange [0:90]\nset yrange [0:90]\nset xtics 15 out nomirror\nset ytics 15 out nomirror\n"
                 "set border 31 linecolor rgb '#888888'\nset tics textcolor rgb '#000000'\nunset key\n"
                 "set xlabel 'θ_h / °   (half-vector; 0: mirror direction)' font ',11'\n"
                 "set ylabel 'θ_d / °   (0: retro-reflection, 90: grazing)' font ',11' offset 1\n",
                 range.low, range.high, kPixels);
  for (std::size_t k = 0; k < drawn.size(); ++k) {
    script += layout.frame(k, drawn[k].name);
    fmt::format_to(back_inserter(script),
                   "plot data_file index {} matrix using (angle($1)):(angle($2)):(shown($3)) with image\n", k);
    if (k == 0) script += PanelLayout::end_heading() + "unset colorbox\nunset ylabel\n";
  }
  return {script + "unset multiplot\n", std::move(data)};
}

}  // namespace lobe
