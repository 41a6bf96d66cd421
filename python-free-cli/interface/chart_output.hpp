#pragma once

#include <filesystem>
#include <string_view>

#include "interface/session.hpp"
#include "lobe/study/chart.hpp"

namespace lobe::cli {

/// --plot FILE.
[[nodiscard]] Option plot_option(std::string_view help);

/// The file of --plot without its ending, if given.
/// \throws ArgumentError unless that is .png.
[[nodiscard]] std::optional<std::filesystem::path> picture_stem(const Arguments& arguments);

/// Draws a chart as STEM.png beside its script and data, and warns where there is no gnuplot.
/// \throws IoError
void draw_chart(Session& session, const Chart& chart, const ChartValues& values, const std::filesystem::path& stem);

}  // namespace lobe::cli
