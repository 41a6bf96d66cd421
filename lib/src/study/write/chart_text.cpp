#include "study/write/chart_text.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <iterator>
#include <limits>

#include "core/text.hpp"
#include "lobe/core/directions.hpp"
#include "plot/panels.hpp"
#include "plot/picture_files.hpp"

namespace lobe {
namespace {

using std::back_inserter;

constexpr double kHorizon = 90;

/// In the unit of tables and pictures, free of the rounding of conversions.
double abscissa(const Chart& chart, std::size_t k) {
  constexpr double kDigits = 1e10;
  return is_over_angle(chart.quantity) ? std::round(chart.x[k] / kDegree * kDigits) / kDigits + 0.0 : chart.x[k];
}

std::string abscissa_name(const Chart& chart) {
  if (!is_over_angle(chart.quantity)) return chart.parameter;
  return is_over_viewer(chart.quantity) ? "theta_out_deg" : "theta_in_deg";
}

/// Along the axis of the picture.
double place(const Chart& chart, std::size_t k) {
  return chart.log_x && is_over_angle(chart.quantity) ? kHorizon - abscissa(chart, k) : abscissa(chart, k);
}

std::string x_label(const Chart& chart) {
  if (!is_over_angle(chart.quantity)) return chart.parameter;
  if (is_over_viewer(chart.quantity)) return "θ_out / °  (below 0: the light's side)";
  return chart.log_x ? "90° − θ / °" : "θ / °";
}

std::string y_label(const Chart& chart) {
  constexpr std::array<const char*, 5> kLabels{"albedo", "f(L,R) cos θ", "f(L,V)", "f(L,V) cos θ_in", "mean albedo"};
  const std::string label = kLabels.at(static_cast<std::size_t>(chart.quantity));
  if (chart.unit) return fmt::format("{} / f(N,N) of {}", label, chart.unit->terms.front().model);
  const bool is_number = chart.quantity == ChartQuantity::albedo || chart.quantity == ChartQuantity::mean_albedo;
  return is_number ? label : label + " / sr⁻¹";
}

std::string x_axis(const Chart& chart) {
  if (!is_over_angle(chart.quantity)) {
    return fmt::format("set xrange [{:.10g}:{:.10g}]\n{}", chart.x.front(), chart.x.back(),
                       chart.log_x ? "set logscale x\n" : "");
  }
  if (is_over_viewer(chart.quantity)) return "set xrange [-90:90]\nset xtics 30\n";
  if (!chart.log_x) return "set xrange [0:90]\nset xtics 15\n";
  return fmt::format("set logscale x\nset xrange [{:.10g}:{:.10g}]\nset format x '%g'\n", place(chart, 0),
                     place(chart, chart.x.size() - 1));
}

/// Many models grow without bound towards the horizon; with a logarithmic axis that is what is looked at.
bool sets_scale(const Chart& chart, std::size_t k) {
  return chart.log_x || !is_over_angle(chart.quantity) || std::abs(chart.x[k]) <= kGrazing;
}

std::string y_axis(const Chart& chart, const ChartValues& values) {
  const char* const logarithmic = chart.log_y ? "set logscale y\nset format y '%g'\n" : "";
  if (chart.y_range) {
    return fmt::format("{}set yrange [{:.10g}:{:.10g}]\n", logarithmic, chart.y_range->first, chart.y_range->second);
  }
  double low = chart.log_y ? std::numeric_limits<double>::infinity() : 0;
  double high = 0;
  for (const auto& curve : values) {
    for (std::size_t k = 0; k < curve.size(); ++k) {
      const double value = curve[k].value;
      if (!sets_scale(chart, k) || (chart.log_y && !(value > 0))) continue;
      low = std::min(low, value);
      high = std::max(high, value);
    }
  }
  if (!(high > low)) return logarithmic;
  constexpr double kRoom = 1.05;
  return fmt::format("{}set yrange [{:.6g}:{:.6g}]\n", logarithmic, chart.log_y ? low / kRoom : low * kRoom,
                     high * kRoom);
}

std::string note_of(const ChartValues& values) {
  double worst = 0;
  double high = 0;
  for (const auto& curve : values) {
    for (const auto& value : curve) {
      worst = std::max(worst, value.error);
      high = std::max(high, std::abs(value.value));
    }
  }
  return high > 0 ? fmt::format("errors at most {:.1g} of the largest value", worst / high) : "";
}

}  // namespace

std::string chart_csv(const Chart& chart, const ChartValues& values) {
  std::string text = fmt::format("curve,{},value,error\n", csv_field(abscissa_name(chart)));
  for (std::size_t i = 0; i < values.size(); ++i) {
    for (std::size_t k = 0; k < values[i].size(); ++k) {
      fmt::format_to(back_inserter(text), "{},{},{},{}\n", csv_field(chart.curves[i].label),
                     shortest(abscissa(chart, k)), shortest(values[i][k].value), shortest(values[i][k].error));
    }
  }
  return text;
}

gnuplot::Picture chart_picture(const std::string& stem, const Chart& chart, const ChartValues& values) {
  constexpr double kWidth = 560;
  constexpr double kHeight = 380;
  constexpr double kLeft = 84;
  constexpr double kSample = 70;  // pixels of a line in the key
  constexpr double kCharacter = 8.6;
  // Colours come apart in print, too, by their dashes.
  constexpr std::array<const char*, 6> kDashes{"1", "(14,5)", "(3,3)", "(14,4,3,4)", "(7,4)", "(14,4,3,4,3,4)"};
  std::size_t longest = 0;
  for (const auto& curve : chart.curves) longest = std::max(longest, gnuplot::character_count(curve.label));
  const PanelLayout layout(1, kWidth, kHeight, {.left = kLeft, .right = 24, .top = 0, .bottom = 66},
                           kSample + kCharacter * static_cast<double>(longest) + 20);
  std::string script = gnuplot::preamble(stem, chart.title, layout.width(), layout.height());
  script += layout.heading(chart.title, note_of(values));
  script += layout.frame(0, "");
  script += x_axis(chart) + y_axis(chart, values);
  fmt::format_to(
      back_inserter(script),
      "set tics nomirror out textcolor rgb '#000000'\n"
      "set grid xtics ytics linetype 1 linewidth 0.8 linecolor rgb '#dcdcdc'\nset border 3 linecolor rgb '#888888'\n"
      "set xlabel {} font ',11'\nset ylabel {} font ',11'\n"
      "set key at screen {:.6f},graph 1 left top reverse Left samplen 4 spacing 1.4 font ',11'\n",
      gnuplot::string_literal(x_label(chart)), gnuplot::string_literal(y_label(chart)),
      (kLeft + kWidth + 24) / layout.width());
  std::string data = gnuplot::data_comment(x_label(chart) + ", value, error; a block per curve");
  for (std::size_t i = 0; i < values.size(); ++i) {
    fmt::format_to(back_inserter(script),
                   "{} index {} with lines linewidth 2.2 dashtype {} linecolor rgb '{}' title {}",
                   i == 0 ? "plot data_file" : ", \\\n     ''", i, kDashes.at(i % kDashes.size()),
                   gnuplot::family_colour(i), gnuplot::string_literal(chart.curves[i].label));
    for (std::size_t k = 0; k < values[i].size(); ++k) {
      fmt::format_to(back_inserter(data), "{:.10g} {:.10g} {:.3g}\n", place(chart, k), values[i][k].value,
                     values[i][k].error);
    }
    data += "\n\n";
  }
  return {script + '\n', std::move(data)};
}

PictureFiles write_chart_picture(const Chart& chart, const ChartValues& values, const std::filesystem::path& directory,
                                 const std::string& stem, bool overwrite) {
  const NamedPicture picture{stem, chart_picture(stem, chart, values)};
  return write_pictures({&picture, 1}, directory, {.overwrite = overwrite});
}

}  // namespace lobe
