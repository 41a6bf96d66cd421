#pragma once

#include <filesystem>
#include <span>
#include <string>
#include <vector>

#include "lobe/device/device.hpp"
#include "lobe/table/reflectance.hpp"
#include "lobe/table/table.hpp"

namespace [[gnu::visibility("default")]] lobe {

/// Formats of picture files.
enum class PictureFormat {
  png,  ///< pixels
  svg   ///< lines
};

/// Options for writing pictures.
struct TablePictureOptions {
  PictureFormat format = PictureFormat::png;  ///< format of the files
  bool overwrite = false;                     ///< replace files that exist
};

/// Pictures that were written, and why others are missing.
struct PictureFiles {
  std::vector<std::filesystem::path> pictures;  ///< STEM.KIND.png (or .svg)
  std::vector<std::filesystem::path> scripts;   ///< the gnuplot scripts and data beside the pictures
  std::string note;                             ///< why pictures are missing; empty if none are
};

/// Draws tables side by side, typically a composition and its two factors: f in the plane of incidence as polar curves,
/// f over the half-vector angles theta_h and theta_d at phi_d = 90 degrees in colours, and the albedos: STEM.polar.png,
/// .slice and .albedo. Several channels are drawn as their mean. Without gnuplot the pictures are left out and `note`
/// says so.
/// \throws ArgumentError for no tables or inconsistent ones; IoError if a file exists and overwrite is false, or if it
///   cannot be written; nothing half-written stays
PictureFiles write_table_pictures(std::span<const BrdfTable> tables, const std::filesystem::path& directory,
                                  const std::string& stem, const TablePictureOptions& options = {});

/// Draws reflectances in the same way: tables and cells as they are, formulas and functions by their own values at the
/// directions of the pictures, so that no grid blurs or misses a highlight.
/// \throws ArgumentError for no reflectances; as evaluate(), albedo() and write_table_pictures()
PictureFiles write_reflectance_pictures(const Device& device, const ReflectanceList& reflectances,
                                        const std::filesystem::path& directory, const std::string& stem,
                                        const TablePictureOptions& options = {});

}  // namespace lobe
