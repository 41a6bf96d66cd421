#include "plot/panels.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <vector>

#include "plot/gnuplot.hpp"

namespace lobe {
namespace {

constexpr double kHeading = 84;
constexpr std::size_t kMostColumns = 3;
constexpr double kTitleCharacter = 9.2;  // width in pixels of DejaVu Sans Bold, 11 points, on average

/// Bytes of the first so many characters of a UTF-8 text.
std::size_t bytes_of(std::string_view text, std::size_t characters) {
  std::size_t count = 0;
  for (std::size_t at = 0; at < text.size(); ++at) {
    const bool begins = (static_cast<unsigned char>(text[at]) & 0xc0U) != 0x80U;
    if (begins && count++ == characters) return at;
  }
  return text.size();
}

std::string cut(std::string_view text, std::size_t characters) {
  if (gnuplot::character_count(text) <= characters) return std::string(text);
  return std::string(text.substr(0, bytes_of(text, characters - 1))) + "…";
}

}  // namespace

std::string in_two_lines(std::string_view text, std::size_t characters) {
  if (gnuplot::character_count(text) <= characters) return std::string(text);
  const std::size_t room = bytes_of(text, characters);
  const auto after = [&](const char* marks) {
    const std::size_t mark = text.substr(0, room).find_last_of(marks);
    return mark == std::string_view::npos || mark < room / 3 ? std::size_t{0} : mark + 1;
  };
  std::size_t first = after(",+(|");
  if (first == 0) first = after(" ");
  if (first == 0) first = room;
  const std::size_t end = text.substr(0, first).find_last_not_of(' ') + 1;
  const std::size_t second = std::min(text.find_first_not_of(' ', first), text.size());
  return std::string(text.substr(0, end)) + "\n" + cut(text.substr(second), characters);
}

PanelLayout::PanelLayout(std::size_t count, double width, double height, Room room, double extra)
    : count_(count), panel_width_(width), panel_height_(height), room_(room), extra_(extra) {}

std::size_t PanelLayout::columns() const {
  return std::min(count_, kMostColumns);
}

int PanelLayout::width() const {
  return static_cast<int>(static_cast<double>(columns()) * (room_.left + panel_width_ + room_.right) + extra_);
}

int PanelLayout::height() const {
  const std::size_t rows = (count_ + columns() - 1) / columns();
  return static_cast<int>(kHeading + static_cast<double>(rows) * (room_.top + panel_height_ + room_.bottom));
}

std::string PanelLayout::heading(std::string_view title, std::string_view note) const {
  const double x = 24.0 / width();
  const auto characters = static_cast<std::size_t>(std::max(width() - 48, 110) / 11);
  return fmt::format(
      "set label 1 {} at screen {:.6f},{:.6f} left font 'DejaVu Sans Bold,13'\n"
      "set label 2 {} at screen {:.6f},{:.6f} left textcolor rgb '#555555'\n",
      gnuplot::string_literal(cut(title, characters)), x, 1 - 26.0 / height(), gnuplot::string_literal(note), x,
      1 - 52.0 / height());
}

std::string PanelLayout::end_heading() {
  return "unset label 1\nunset label 2\n";
}

std::string PanelLayout::frame(std::size_t k, std::string_view title) const {
  const auto column = static_cast<double>(k % columns());
  const std::size_t row = k / columns();
  const double left = column * (room_.left + panel_width_ + room_.right) + room_.left;
  const double top =
      height() - kHeading - static_cast<double>(row) * (room_.top + panel_height_ + room_.bottom) - room_.top;
  const auto characters = static_cast<std::size_t>((room_.left + panel_width_ + room_.right) / kTitleCharacter);
  return fmt::format(
      "set lmargin at screen {:.6f}\nset rmargin at screen {:.6f}\n"
      "set bmargin at screen {:.6f}\nset tmargin at screen {:.6f}\n"
      "set title {} font 'DejaVu Sans Bold,11'\n",
      left / width(), (left + panel_width_) / width(), (top - panel_height_) / height(), top / height(),
      gnuplot::string_literal(in_two_lines(title, characters)));
}

std::string PanelLayout::colour_bar() const {
  const double left = width() - extra_ + 10;
  const double top = height() - kHeading - room_.top;
  return fmt::format("set colorbox vertical user origin screen {:.6f},{:.6f} size screen {:.6f},{:.6f} noborder\n",
                     left / width(), (top - panel_height_) / height(), 20.0 / width(), panel_height_ / height());
}

}  // namespace lobe
