#pragma once

#include <string>

#include "lobe/study/chart.hpp"
#include "plot/gnuplot.hpp"

namespace lobe {

/// A line per point: label of the curve, abscissa (angles in degrees), value, error.
[[nodiscard]] std::string chart_csv(const Chart& chart, const ChartValues& values);

/// The curves as a picture, told apart by colour and dashes, named beside it.
[[nodiscard]] gnuplot::Picture chart_picture(const std::string& stem, const Chart& chart, const ChartValues& values);

}  // namespace lobe
