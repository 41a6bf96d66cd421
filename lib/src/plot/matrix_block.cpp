#include "plot/matrix_block.hpp"

#include <fmt/format.h>

#include <iterator>

#include "plot/gnuplot.hpp"

namespace lobe {

using std::back_inserter;

std::string matrix_block(std::string_view what, std::span<const std::string> names, const Eigen::MatrixXd& values) {
  std::string data = gnuplot::data_comment(std::string(what) + ", rows and columns in the order");
  for (std::size_t place = 0; place < names.size(); ++place) {
    data += gnuplot::data_comment(fmt::format("{}: {}", place, names[place]));
  }
  for (Eigen::Index row = 0; row < values.rows(); ++row) {
    for (const double value : values.row(row)) fmt::format_to(back_inserter(data), "{:.8g} ", value);
    data.back() = '\n';
  }
  return data;
}

std::string matrix_frame(const MatrixFrame& frame, double heading_left, std::string_view title, std::string_view note) {
  const auto x = [&](double pixels) { return pixels / frame.width; };
  const auto y = [&](double pixels) { return pixels / frame.height; };
  std::string script = fmt::format(
      "set lmargin at screen {:.6f}\nset rmargin at screen {:.6f}\n"
      "set bmargin at screen {:.6f}\nset tmargin at screen {:.6f}\n",
      x(frame.left), x(frame.left + frame.side), y(frame.bottom), y(frame.bottom + frame.side));
  fmt::format_to(back_inserter(script),
                 "set label {0} at screen {1:.6f},{2:.6f} left font 'DejaVu Sans Bold,13'\n"
                 "set label {3} at screen {1:.6f},{4:.6f} left textcolor rgb '#555555'\n"
                 "set border 0\nunset key\n",
                 gnuplot::string_literal(title), x(heading_left), 1 - y(30), gnuplot::string_literal(note), 1 - y(56));
  return script;
}

}  // namespace lobe
