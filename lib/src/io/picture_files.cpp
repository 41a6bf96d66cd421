#include "io/picture_files.hpp"

#include <system_error>

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
                                 PictureFormat format) {
  RenderedPictures rendered;
  for (const auto& [stem, picture] : pictures) {
    const fs::path target = directory / (stem + gnuplot::extension(format));
    const std::string reason = rendered.note.empty() ? gnuplot::render(directory, stem, format) : rendered.note;
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

}  // namespace lobe
