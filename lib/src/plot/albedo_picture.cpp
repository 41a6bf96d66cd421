#include "plot/albedo_picture.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <iterator>

#include "lobe/core/directions.hpp"
#include "plot/panels.hpp"

namespace lobe {
namespace {

using std::back_inserter;

/// Too near to be told apart in the picture.
bool are_alike(const AlbedoByAngle& albedo) {
  return std::ranges::equal(albedo.in, albedo.out, [](double a, double b) { return std::abs(a - b) < 2e-3; });
}

/// Away from the horizon, where some models grow without bound.
double largest(const std::vector<double>& angles, const std::vector<double>& albedos) {
  double value = 0;
  for (std::size_t i = 0; i < albedos.size(); ++i) {
    if (angles[i] <= 85 * kDegree) value = std::max(value, albedos[i]);
  }
  return value;
}

/// theta in degrees and albedo.
std::string curve_block(const std::vector<double>& angles, const std::vector<double>& albedos) {
  std::string block;
  for (std::size_t i = 0; i < albedos.size(); ++i) {
    fmt::format_to(back_inserter(block), "{:.5f} {:.8g}\n", angles[i] / kDegree, albedos[i]);
  }
  return block + "\n\n";
}

std::string note_of(std::span<const DrawnReflectance> drawn, bool has_both) {
  std::string note = fmt::format("{}; A: mean albedo",
                                 has_both ? "solid: in(L), by the light's angle; dashed: out(V), by the viewer's angle"
                                          : "in(L) = out(V), by the light's or the viewer's angle");
  if (std::ranges::any_of(drawn, &DrawnReflectance::has_channels)) note += "; mean of channels";
  if (std::ranges::any_of(drawn, &DrawnReflectance::has_azimuths)) note += "; mean over azimuths";
  return note;
}

}  // namespace

gnuplot::Picture albedo_picture(const std::string& stem, std::span<const DrawnReflectance> drawn,
                                PictureFormat format) {
  double top = 1;
  bool has_both = false;
  for (const auto& one : drawn) {
    const AlbedoByAngle& albedo = one.albedo;
    top = std::max({top, largest(albedo.theta, albedo.in), largest(albedo.theta, albedo.out)});
    has_both = has_both || !are_alike(albedo);
  }

  constexpr double kWidth = 720;
  constexpr double kHeight = 400;
  constexpr double kKeyLine = 24;
  const double key_lines = static_cast<double>(drawn.size());
  const PanelLayout layout(1, kWidth, kHeight,
                           {.left = 80, .right = 30, .top = 10, .bottom = 76 + kKeyLine * key_lines}, 0);
  std::string script = gnuplot::preamble(stem, "Albedo", layout.width(), layout.height(), format);
  script += layout.heading("Albedo, " + source_names(drawn), note_of(drawn, has_both));
  script += layout.frame(0, "");
  fmt::format_to(
      back_inserter(script),
      "set xrange [0:90]\nset yrange [0:{:.4g}]\nset xtics 15\nset tics nomirror out textcolor rgb '#000000'\n"
      "set grid xtics ytics linetype 1 linewidth 0.8 linecolor rgb '#dcdcdc'\nset border 3 linecolor rgb '#888888'\n"
      "set xlabel 'θ / °' font ',11'\nset ylabel 'albedo' font ',11'\n"
      "set key at screen {:.6f},{:.6f} left bottom reverse Left samplen 2 spacing 1.25 font ',11'\n",
      top * 1.05, 80.0 / layout.width(), 14.0 / layout.height());
  std::string data = "# theta/deg, albedo; for each by the light's angle, then by the viewer's\n";
  std::string plot;
  for (std::size_t k = 0; k < drawn.size(); ++k) {
    const std::string colour = gnuplot::family_colour(k);
    const AlbedoByAngle& albedo = drawn[k].albedo;
    data += curve_block(albedo.theta, albedo.in) + curve_block(albedo.theta, albedo.out);
    fmt::format_to(back_inserter(plot), "{} index {} with lines linewidth 2.2 linecolor rgb '{}' title {}",
                   plot.empty() ? "plot data_file" : ", \\\n     ''", 2 * k, colour,
                   gnuplot::string_literal(fmt::format("{}, A = {:.4f}", drawn[k].name, albedo.mean)));
    if (are_alike(albedo)) continue;
    fmt::format_to(back_inserter(plot),
                   ", \\\n     '' index {} with lines linewidth 2.2 dashtype 2 linecolor rgb '{}' notitle", 2 * k + 1,
                   colour);
  }
  return {script + plot + '\n', std::move(data)};
}

}  // namespace lobe
