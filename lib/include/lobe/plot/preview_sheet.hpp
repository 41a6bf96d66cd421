#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <span>
#include <string>
#include <vector>

#include "lobe/plot/table_pictures.hpp"
#include "lobe/render/preview.hpp"

namespace [[gnu::visibility("default")]] lobe {

/// A displayed sphere, on the sheet's background.
struct DisplayedSphere {
  std::size_t size = 0;           ///< pixels along an edge
  std::vector<std::uint8_t> rgb;  ///< sRGB, three bytes per pixel, in rows from the upper left
  std::size_t pixels = 0;         ///< pixels that the sphere covers, if only in part
  std::size_t clipped = 0;        ///< pixels with some channel above the display's white
  std::size_t negative = 0;  ///< pixels with some channel below 0 by half a level (out of gamut, or negative values)
  double largest_error = 0;  ///< largest error of displayed linear values, relative to white
  double mean_error = 0;     ///< mean error over the pixels
};

/// Converts a sphere to display values.
/// \param image image with one channel, a grey, or three, linear sRGB
/// \param exposure factor on radiances, after which 1 is white
/// \throws ArgumentError for other numbers of channels
[[nodiscard]] DisplayedSphere display(const SphereImage& image, double exposure);

/// A material on a contact sheet.
struct SheetCell {
  std::string name;                      ///< name below the spheres, in at most two lines
  std::vector<DisplayedSphere> spheres;  ///< one per kind of light, side by side
};

/// Options for the layout of a sheet and its file.
struct SheetOptions {
  std::size_t columns = 0;  ///< cells per row; 0: a picture of about 4 : 3
  bool overwrite = false;   ///< replace a file that exists
};

/// Picture format of a contact sheet, by the extension of its name.
/// \throws ArgumentError for extensions other than .png and .svg
[[nodiscard]] PictureFormat sheet_format(const std::filesystem::path& path);

/// Draws cells in rows below a caption and writes the picture, PNG or SVG by the extension, using gnuplot.
/// \param caption one line
/// \return width and height in pixels
/// \throws ArgumentError for no cells, cells that differ in number or size of spheres, and other extensions; IoError if
///   the file exists and overwrite is false, if it cannot be written, or if gnuplot is missing or fails
std::array<std::size_t, 2> write_preview_sheet(std::span<const SheetCell> cells, const std::string& caption,
                                               const std::filesystem::path& path, const SheetOptions& options = {});

}  // namespace lobe
