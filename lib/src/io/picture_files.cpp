#include "io/picture_files.hpp"

#include <system_error>
#include <utility>

namespace lobe {

namespace fs = std::filesystem;

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
    set.write(paths.back(), picture.script);
    paths.push_back(directory / (stem + ".dat"));
    set.write(paths.back(), picture.data);
  }
  return paths;
}

RenderedPictures render_pictures(std::span<const NamedPicture> pictures, const fs::path& directory,
                                 PictureFormat format, const ProgressCallback& progress) {
  RenderedPictures rendered;
  const auto draw = [&](const std::string& stem, double done) -> std::string {
    if (progress && !progress("pictures", done)) return "interrupted";
    return gnuplot::render(directory, stem, format);
  };
  for (std::size_t i = 0; i < pictures.size(); ++i) {
    const std::string& stem = pictures[i].stem;
    const fs::path target = directory / (stem + gnuplot::extension(format));
    const double done = static_cast<double>(i) / static_cast<double>(pictures.size());
    const std::string reason = rendered.note.empty() ? draw(stem, done) : rendered.note;
    if (reason.empty()) {
      rendered.pictures.push_back(target);
      continue;
    }
    if (rendered.note.empty()) rendered.note = "pictures left out: " + reason + "; their gnuplot scripts are written";
    std::error_code ignored;
    fs::remove(target, ignored);
  }
  return rendered;
}

PictureFiles write_pictures(std::span<const NamedPicture> pictures, const fs::path& directory,
                            const TablePictureOptions& options) {
  if (!options.overwrite) require_pictures_absent(pictures, directory, options.format);
  make_directory(directory);
  FileSet set(options.overwrite);
  PictureFiles files;
  files.scripts = write_scripts(pictures, directory, set);
  RenderedPictures rendered = render_pictures(pictures, directory, options.format);
  files.pictures = std::move(rendered.pictures);
  files.note = std::move(rendered.note);
  set.keep();
  return files;
}

}  // namespace lobe
