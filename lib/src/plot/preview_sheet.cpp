#include "lobe/plot/preview_sheet.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <iterator>
#include <system_error>

#include "core/file_set.hpp"
#include "core/files.hpp"
#include "core/unfinished.hpp"
#include "lobe/core/colour.hpp"
#include "lobe/core/error.hpp"
#include "plot/gnuplot.hpp"
#include "plot/panels.hpp"

namespace lobe {
namespace {

namespace fs = std::filesystem;

constexpr double kBackground = 0.032;  // linear: dark, so that neither black nor white spheres vanish
constexpr double kHalfLevel = 1.0 / 510;

// Pixels.
constexpr std::size_t kMargin = 16;
constexpr std::size_t kCaption = 26;
constexpr std::size_t kSphereGap = 8;    // between the spheres of a cell
constexpr std::size_t kCellGap = 20;     // between cells
constexpr std::size_t kNames = 40;       // below the spheres
constexpr double kCharacter = 6.6;       // average width, DejaVu Sans, 8 points
constexpr double kCaptionCharacter = 7;  // and 9 points

std::uint8_t level_of(double linear) {
  return static_cast<std::uint8_t>(std::lround(255 * encode_srgb(linear)));
}

/// Where cells stand.
struct SheetLayout {
  std::size_t size, spheres, columns, rows;

  [[nodiscard]] std::size_t cell_width() const { return spheres * size + (spheres - 1) * kSphereGap; }
  [[nodiscard]] std::size_t width() const { return 2 * kMargin + columns * cell_width() + (columns - 1) * kCellGap; }
  [[nodiscard]] std::size_t height() const { return kMargin + kCaption + rows * (size + kNames) + kMargin / 2; }
  [[nodiscard]] std::size_t left(std::size_t k) const { return kMargin + k % columns * (cell_width() + kCellGap); }
  [[nodiscard]] std::size_t top(std::size_t k) const { return kMargin + kCaption + k / columns * (size + kNames); }
};

/// \throws ArgumentError
SheetLayout layout_of(std::span<const SheetCell> cells, std::size_t columns) {
  if (cells.empty() || cells.front().spheres.empty()) {
    throw ArgumentError("a contact sheet without spheres; expected at least one");
  }
  const auto& first = cells.front().spheres;
  for (const SheetCell& cell : cells) {
    const bool fits = cell.spheres.size() == first.size() &&
                      std::ranges::all_of(cell.spheres, [&](const auto& s) { return s.size == first.front().size; });
    if (!fits) throw ArgumentError("spheres of '" + cell.name + "' differ in number or size from those of others");
  }
  SheetLayout layout{first.front().size, first.size(), 1, 1};
  if (columns == 0) {
    const double aspect =
        static_cast<double>(layout.size + kNames) / static_cast<double>(layout.cell_width() + kCellGap);
    columns = static_cast<std::size_t>(
        std::max(1L, std::lround(std::sqrt(4.0 / 3 * aspect * static_cast<double>(cells.size())))));
  }
  layout.columns = std::min(columns, cells.size());
  layout.rows = (cells.size() + layout.columns - 1) / layout.columns;
  return layout;
}

/// The picture without its texts, three bytes per pixel.
std::string pixels_of(const SheetLayout& layout, std::span<const SheetCell> cells) {
  std::string pixels(3 * layout.width() * layout.height(), static_cast<char>(level_of(kBackground)));
  for (std::size_t k = 0; k < cells.size(); ++k) {
    for (std::size_t s = 0; s < layout.spheres; ++s) {
      const auto& rgb = cells[k].spheres[s].rgb;
      const std::size_t left = layout.left(k) + s * (layout.size + kSphereGap);
      for (std::size_t row = 0; row < layout.size; ++row) {
        const std::size_t at = 3 * ((layout.top(k) + row) * layout.width() + left);
        const auto from = rgb.begin() + static_cast<std::ptrdiff_t>(3 * row * layout.size);
        std::copy_n(from, 3 * layout.size, pixels.begin() + static_cast<std::ptrdiff_t>(at));
      }
    }
  }
  return pixels;
}

std::string script_of(const std::string& stem, const SheetLayout& layout, std::span<const SheetCell> cells,
                      const std::string& caption, PictureFormat format) {
  const std::size_t width = layout.width();
  const std::size_t height = layout.height();
  const auto caption_characters =
      static_cast<std::size_t>(static_cast<double>(width - 2 * kMargin) / kCaptionCharacter);
  std::string script =
      gnuplot::preamble(stem, "Contact sheet", static_cast<int>(width), static_cast<int>(height), format);
  // One pixel of the picture for one of the data; those of its rim are blended with what lies below.
  fmt::format_to(
      std::back_inserter(script),
      "set lmargin at screen 0\nset rmargin at screen 1\nset bmargin at screen 0\nset tmargin at screen 1\n"
      "set object 1 rectangle from screen -0.1,-0.1 to screen 1.1,1.1 behind fillcolor rgb '#{5:02x}{5:02x}{5:02x}' "
      "fillstyle solid noborder\n"
      "unset border\nunset tics\nunset key\nset xrange [-0.5:{0}-0.5]\nset yrange [{1}-0.5:-0.5]\n"
      "set label 1 {2} at {3},{4} left front font ',9' textcolor rgb '#d8d8d8'\n",
      width, height, gnuplot::string_literal(in_two_lines(caption, caption_characters)), kMargin, kMargin + 4,
      level_of(kBackground));
  const auto characters = static_cast<std::size_t>(static_cast<double>(layout.cell_width()) / kCharacter);
  for (std::size_t k = 0; k < cells.size(); ++k) {
    const std::string lines = in_two_lines(cells[k].name, std::max<std::size_t>(characters, 8));
    const std::size_t line_break = std::min(lines.find('\n'), lines.size());
    const std::array<std::string, 2> texts{lines.substr(0, line_break),
                                           line_break < lines.size() ? lines.substr(line_break + 1) : ""};
    for (std::size_t line = 0; line < texts.size(); ++line) {
      if (texts[line].empty()) continue;
      fmt::format_to(std::back_inserter(script),
                     "set label {} {} at {},{} center front font ',8' textcolor rgb '#f0f0f0'\n", 2 + 2 * k + line,
                     gnuplot::string_literal(texts[line]),
                     static_cast<double>(layout.left(k)) + static_cast<double>(layout.cell_width()) / 2,
                     layout.top(k) + layout.size + 9 + 13 * line);
    }
  }
  return script +
         fmt::format("plot data_file binary array=({},{}) format='%uchar%uchar%uchar' using 1:2:3 with rgbimage\n",
                     width, height);
}

}  // namespace

PictureFormat sheet_format(const fs::path& path) {
  if (path.extension() == ".png") return PictureFormat::png;
  if (path.extension() == ".svg") return PictureFormat::svg;
  throw ArgumentError(path.string() + " is no name of a contact sheet; expected one that ends with .png or .svg");
}

DisplayedSphere display(const SphereImage& image, double exposure) {
  const Eigen::Index channels = image.radiance.rows();
  if (channels != 1 && channels != 3) {
    throw ArgumentError("a picture of " + std::to_string(channels) +
                        " channels; expected 1, a grey, or 3, linear sRGB");
  }
  DisplayedSphere shown;
  shown.size = image.size;
  for (Eigen::Index pixel = 0; pixel < image.radiance.cols(); ++pixel) {
    const double beside = (1 - image.coverage(pixel)) * kBackground;
    bool is_clipped = false;
    bool is_negative = false;
    double worst = 0;
    for (Eigen::Index c = 0; c < 3; ++c) {
      const Eigen::Index channel = channels == 1 ? 0 : c;
      const double value = exposure * image.radiance(channel, pixel) + beside;
      const double error = exposure * image.error(channel, pixel);
      const auto displayed = [](double x) { return std::clamp(x, 0.0, 1.0); };
      worst =
          std::max({worst, displayed(value + error) - displayed(value), displayed(value) - displayed(value - error)});
      is_clipped = is_clipped || value > 1;
      is_negative = is_negative || value < -kHalfLevel;
      shown.rgb.push_back(level_of(value));
    }
    if (!(image.coverage(pixel) > 0)) continue;
    ++shown.pixels;
    shown.clipped += is_clipped ? 1 : 0;
    shown.negative += is_negative ? 1 : 0;
    shown.largest_error = std::max(shown.largest_error, worst);
    shown.mean_error += worst;
  }
  if (shown.pixels > 0) shown.mean_error /= static_cast<double>(shown.pixels);
  return shown;
}

std::array<std::size_t, 2> write_preview_sheet(std::span<const SheetCell> cells, const std::string& caption,
                                               const fs::path& path, const SheetOptions& options) {
  const PictureFormat format = sheet_format(path);
  const SheetLayout layout = layout_of(cells, options.columns);
  write_atomically(path, options.overwrite, [&](const fs::path& temporary) {
    const std::string stem = "sheet";
    const Unfinished scratch(temporary.string() + ".parts");
    make_directory(scratch.path());
    write_text(scratch.path() / (stem + ".gp"), false, script_of(stem, layout, cells, caption, format));
    write_text(scratch.path() / (stem + ".dat"), false, pixels_of(layout, cells));
    const std::string complaint = gnuplot::render(scratch.path(), stem, format);
    if (!complaint.empty()) throw IoError("cannot draw " + path.string() + ": " + complaint);
    fs::rename(scratch.path() / (stem + gnuplot::extension(format)), temporary);
  });
  return {layout.width(), layout.height()};
}

}  // namespace lobe
