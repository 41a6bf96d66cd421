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

/// Albedos by ring, means of the channels and of the ring's nodes.
struct RingAlbedo {
  std::vector<double> in;
  std::vector<double> out;
  double mean = 0;
};

std::vector<double> by_ring(const BrdfTable& table, const std::vector<std::vector<Estimate>>& rows) {
  std::vector<double> means(table.grid.rings().size());
  std::vector<double> counts(means.size());
  for (const auto& channel : rows) {
    for (std::size_t row = 0; row < channel.size(); ++row) {
      const std::size_t ring = table.form == TableForm::isotropic ? row : table.grid.ring_of(row);
      means[ring] += channel[row].value;
      ++counts[ring];
    }
  }
  for (std::size_t ring = 0; ring < means.size(); ++ring) means[ring] /= counts[ring];
  return means;
}

RingAlbedo ring_albedo(const BrdfTable& table) {
  const TableAlbedo albedos = row_albedos(table);
  RingAlbedo result{by_ring(table, albedos.in), by_ring(table, albedos.out)};
  for (const auto& channel : albedos.mean) result.mean += channel.value / static_cast<double>(table.channels);
  return result;
}

/// Too near to be told apart in the picture.
bool are_alike(const RingAlbedo& albedo) {
  return std::ranges::equal(albedo.in, albedo.out, [](double a, double b) { return std::abs(a - b) < 2e-3; });
}

/// Away from the horizon, where some models grow without bound.
double largest(const HemisphereGrid& grid, const std::vector<double>& albedos) {
  double value = 0;
  for (std::size_t i = 0; i < albedos.size(); ++i) {
    if (grid.rings()[i].theta <= 85 * kDegree) value = std::max(value, albedos[i]);
  }
  return value;
}

/// theta in degrees and albedo; a step per ring on grids of cells.
std::string curve_block(const HemisphereGrid& grid, const std::vector<double>& albedos) {
  std::string block;
  for (std::size_t i = 0; i < albedos.size(); ++i) {
    const Ring& ring = grid.rings()[i];
    if (grid.has_cells()) {
      fmt::format_to(back_inserter(block), "{:.5f} {:.8g}\n{:.5f} {:.8g}\n", ring.theta_low / kDegree, albedos[i],
                     ring.theta_high / kDegree, albedos[i]);
    } else {
      fmt::format_to(back_inserter(block), "{:.5f} {:.8g}\n", ring.theta / kDegree, albedos[i]);
    }
  }
  return block + "\n\n";
}

std::string note_of(std::span<const BrdfTable> tables, bool has_both) {
  std::string note = fmt::format("{}; A: mean albedo",
                                 has_both ? "solid: in(L), by the light's angle; dashed: out(V), by the viewer's angle"
                                          : "in(L) = out(V), by the light's or the viewer's angle");
  if (std::ranges::any_of(tables, [](const auto& table) { return table.channels > 1; })) note += "; mean of channels";
  const bool has_azimuths =
      std::ranges::any_of(tables, [](const auto& table) { return table.form == TableForm::general; });
  if (has_azimuths) note += "; mean over azimuths";
  return note;
}

}  // namespace

gnuplot::Picture albedo_picture(const std::string& stem, std::span<const BrdfTable> tables, PictureFormat format) {
  std::vector<RingAlbedo> albedos;
  double top = 1;
  bool has_both = false;
  for (const auto& table : tables) {
    albedos.push_back(ring_albedo(table));
    top = std::max({top, largest(table.grid, albedos.back().in), largest(table.grid, albedos.back().out)});
    has_both = has_both || !are_alike(albedos.back());
  }

  constexpr double kWidth = 720;
  constexpr double kHeight = 400;
  constexpr double kKeyLine = 24;
  const double key_lines = static_cast<double>(tables.size());
  const PanelLayout layout(1, kWidth, kHeight,
                           {.left = 80, .right = 30, .top = 10, .bottom = 76 + kKeyLine * key_lines}, 0);
  std::string script = gnuplot::preamble(stem, "Albedo", layout.width(), layout.height(), format);
  script += layout.heading("Albedo, " + grid_names(tables), note_of(tables, has_both));
  script += layout.frame(0, "");
  fmt::format_to(
      back_inserter(script),
      "set xrange [0:90]\nset yrange [0:{:.4g}]\nset xtics 15\nset tics nomirror out textcolor rgb '#000000'\n"
      "set grid xtics ytics linetype 1 linewidth 0.8 linecolor rgb '#dcdcdc'\nset border 3 linecolor rgb '#888888'\n"
      "set xlabel 'θ / °' font ',11'\nset ylabel 'albedo' font ',11'\n"
      "set key at screen {:.6f},{:.6f} left bottom reverse Left samplen 2 spacing 1.25 font ',11'\n",
      top * 1.05, 80.0 / layout.width(), 14.0 / layout.height());
  std::string data = "# theta/deg, albedo; for every table by the light's angle, then by the viewer's\n";
  std::string plot;
  for (std::size_t k = 0; k < tables.size(); ++k) {
    const std::string colour = gnuplot::family_colour(k);
    data += curve_block(tables[k].grid, albedos[k].in) + curve_block(tables[k].grid, albedos[k].out);
    fmt::format_to(back_inserter(plot), "{} index {} with lines linewidth 2.2 linecolor rgb '{}' title {}",
                   plot.empty() ? "plot data_file" : ", \\\n     ''", 2 * k, colour,
                   gnuplot::string_literal(fmt::format("{}, A = {:.4f}", tables[k].expression, albedos[k].mean)));
    if (are_alike(albedos[k])) continue;
    fmt::format_to(back_inserter(plot),
                   ", \\\n     '' index {} with lines linewidth 2.2 dashtype 2 linecolor rgb '{}' notitle", 2 * k + 1,
                   colour);
  }
  return {script + plot + '\n', std::move(data)};
}

}  // namespace lobe
