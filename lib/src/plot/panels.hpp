#pragma once

#include <cstddef>
#include <numbers>
#include <span>
#include <string>
#include <string_view>

#include "lobe/table/table.hpp"

namespace lobe {

/// Many models grow without bound towards the horizon: what lies beyond this angle does not set the scale of a picture.
constexpr double kGrazing = 80 * std::numbers::pi / 180;

/// Panels of equal size, at most three in a row, below a heading. Pixels.
class PanelLayout {
 public:
  /// Room around a panel, for its title and axes.
  struct Room {
    double left = 0;
    double right = 0;
    double top = 0;
    double bottom = 0;
  };

  /// Width and height are those of a panel.
  /// \param extra room on the right of all panels
  PanelLayout(std::size_t count, double width, double height, Room room, double extra);

  [[nodiscard]] int width() const;
  [[nodiscard]] int height() const;

  /// gnuplot lines: title and, smaller, a note above all panels. To be taken back by end_heading() after the first
  /// panel, or every panel would draw them again.
  [[nodiscard]] std::string heading(std::string_view title, std::string_view note) const;
  [[nodiscard]] static std::string end_heading();

  /// gnuplot lines: margins and title of the k-th panel. A long title is broken into two lines or cut.
  [[nodiscard]] std::string frame(std::size_t k, std::string_view title) const;

  /// gnuplot lines: place of a colour bar on the right.
  [[nodiscard]] std::string colour_bar() const;

 private:
  [[nodiscard]] std::size_t columns() const;

  std::size_t count_;
  double panel_width_;
  double panel_height_;
  Room room_;
  double extra_;
};

/// A text in at most two lines of so many characters, broken after a comma, plus sign, bar or parenthesis where there
/// is one, else at a space.
[[nodiscard]] std::string in_two_lines(std::string_view text, std::size_t characters);

}  // namespace lobe
