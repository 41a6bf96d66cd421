#include "plot/picture_files.hpp"

#include <system_error>
#include <utility>

#include "lobe/core/error.hpp"

namespace lobe {
namespace {

namespace fs = std::filesystem;

std::string left_out(const std::string& reason) {
  return "pictures left out: " + reason + "; their gnuplot scripts are written";
}

/// Renders pictures into a set until one fails, the reason of which would be the same for the others, or until
/// `progress`, asked before each, is false.
RenderedPictures render_pictures(std::span<const NamedPicture> pictures, const fs::path& directory,
                                 PictureFormat format, FileSet& set, const ProgressCallback& progress) {
  RenderedPictures rendered;
  const auto draw = [&](const std::string& stem, double done) -> std::string {
    if (progress && !progress("pictures", done)) return "interrupted";
    return gnuplot::render(directory, stem, format, set.staging());
  };
  for (std::size_t i = 0; i < pictures.size(); ++i) {
    const std::string& stem = pictures[i].stem;
    const std::string name = stem + gnuplot::extension(format);
    const double done = static_cast<double>(i) / static_cast<double>(pictures.size());
    const std::string reason = rendered.note.empty() ? draw(stem, done) : rendered.note;
    if (reason.empty()) {
      rendered.pictures.push_back(directory / name);
      set.add(name);
      continue;
    }
    if (rendered.note.empty()) rendered.note = left_out(reason);
  }
  return rendered;
}

}  // namespace

void require_pictures_absent(std::span<const NamedPicture> pictures, const fs::path& directory, PictureFormat format) {
  for (const auto& picture : pictures) {
    for (const auto& extension : {std::string(".gp"), std::string(".dat"), gnuplot::extension(format)}) {
      require_absent(directory / (picture.stem + extension));
    }
  }
}

std::vector<fs::path> write_scripts(std::span<const NamedPicture> pictures, const fs::path& directory, FileSet& set) {
  std::vector<fs::path> paths;
  for (const auto& [stem, picture] : pictures) {
    paths.push_back(directory / (stem + ".gp"));
    set.write(stem + ".gp", picture.script);
    paths.push_back(directory / (stem + ".dat"));
    set.write(stem + ".dat", picture.data);
  }
  return paths;
}

RenderedPictures draw_pictures(std::span<const NamedPicture> pictures, const fs::path& directory,
                               const std::string& name, PictureFormat format, bool overwrite,
                               const ProgressCallback& progress) {
  try {
    FileSet set(directory, name, overwrite);
    RenderedPictures rendered = render_pictures(pictures, directory, format, set, progress);
    set.keep();
    return rendered;
  } catch (const IoError& failure) {
    return {.pictures = {}, .note = left_out(failure.what())};
  }
}

PictureFiles write_pictures(std::span<const NamedPicture> pictures, const fs::path& directory,
                            const TablePictureOptions& options) {
  PictureFiles files;
  if (pictures.empty()) return files;
  // We complete files that are half there.
  const std::string& name = pictures.front().stem;
  const bool overwrite = options.overwrite || is_half_moved(directory, name);
  if (!overwrite) require_pictures_absent(pictures, directory, options.format);
  {
    FileSet scripts(directory, name, overwrite);
    files.scripts = write_scripts(pictures, directory, scripts);
    // An older picture would show other data.
    for (const auto& picture : pictures) scripts.leave_out(picture.stem + gnuplot::extension(options.format));
    scripts.keep();
  }
  RenderedPictures rendered = draw_pictures(pictures, directory, name, options.format, overwrite);
  files.pictures = std::move(rendered.pictures);
  files.note = std::move(rendered.note);
  return files;
}

}  // namespace lobe
