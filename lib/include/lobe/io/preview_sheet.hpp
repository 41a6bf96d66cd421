#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <span>
#include <string>
#include <vector>

#include "lobe/energy/preview.hpp"
#include "lobe/io/table_pictures.hpp"

namespace lobe {

/// A sphere as it is displayed, on the sheet's background.
struct DisplayedSphere {
  std::size_t size = 0;           ///< pixels along an edge
  std::vector<std::uint8_t> rgb;  ///< sRGB, three bytes per pixel, from the upper left on in rows
  std::size_t pixels = 0;         ///< that the sphere covers, if only in part
  std::size_t clipped = 0;        ///< of them: some channel is above the display's white
  std::size_t negative = 0;  ///< of them: some channel is below 0 by half a level: out of gamut, or the reflectance is
  double largest_error = 0;  ///< of displayed linear values, relative to white
  double mean_error = 0;     ///< over the pixels
};

/// What a display shows of a sphere.
/// \param image of one channel, a grey, or of three, linear sRGB;
/// \param exposure the factor after which 1 is white
/// \throws ArgumentError for other numbers of channels
[[nodiscard]] DisplayedSphere display(const SphereImage& image, double exposure);

/// A material on a contact sheet.
struct SheetCell {
  std::string name;                      ///< stands below, in at most two lines
  std::vector<DisplayedSphere> spheres;  ///< one per kind of light, beside each other
};

/// How a sheet is laid out and written.
struct SheetOptions {
  std::size_t columns = 0;  ///< cells beside each other; 0: about 4 : 3
  bool overwrite = false;   ///< replace a file that exists
};

/// The format of a contact sheet by the extension of its name.
/// \throws ArgumentError for others than .png and .svg.
[[nodiscard]] PictureFormat sheet_format(const std::filesystem::path& path);

/// Draws cells in rows, the caption above, and writes the picture, PNG or SVG by the extension; gnuplot draws it.
/// \param caption one line
/// \return width and height in pixels
/// \throws ArgumentError for no cells, cells that differ in number or size of spheres, and other extensions; IoError
/// when
///   the file exists and overwrite is false, cannot be written, or gnuplot is missing or fails
std::array<std::size_t, 2> write_preview_sheet(std::span<const SheetCell> cells, const std::string& caption,
                                               const std::filesystem::path& path, const SheetOptions& options = {});

}  // namespace lobe
