#pragma once

#include <filesystem>
#include <span>
#include <string>
#include <vector>

#include "core/file_set.hpp"
#include "lobe/core/progress.hpp"
#include "lobe/plot/table_pictures.hpp"
#include "plot/gnuplot.hpp"

namespace lobe {

struct NamedPicture {
  std::string stem;
  gnuplot::Picture picture;
};

/// \throws IoError when a picture, its script or its data exists.
void require_pictures_absent(std::span<const NamedPicture> pictures, const std::filesystem::path& directory,
                             PictureFormat format);

/// Writes scripts and data into a set.
/// \return where in the directory they will be
std::vector<std::filesystem::path> write_scripts(std::span<const NamedPicture> pictures,
                                                 const std::filesystem::path& directory, FileSet& set);

struct RenderedPictures {
  std::vector<std::filesystem::path> pictures;
  std::string note;  ///< why pictures are missing; empty when they are there
};

/// Renders pictures, whose scripts and data are in the directory, as a set of their own. What fails is a note: pictures
/// can be drawn again, numbers cannot. They are left out from the first that fails on, or from when `progress`, asked
/// before each, is false.
/// \param name of the set
RenderedPictures draw_pictures(std::span<const NamedPicture> pictures, const std::filesystem::path& directory,
                               const std::string& name, PictureFormat format, bool overwrite,
                               const ProgressCallback& progress = {});

/// Leaves pictures with their scripts and data in a directory, which is made where it is missing.
/// \throws IoError when a file exists that may not be overwritten, or cannot be written; nothing half-written stays.
PictureFiles write_pictures(std::span<const NamedPicture> pictures, const std::filesystem::path& directory,
                            const TablePictureOptions& options);

}  // namespace lobe
