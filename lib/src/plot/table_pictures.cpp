#include "lobe/plot/table_pictures.hpp"

#include "lobe/core/error.hpp"
#include "plot/albedo_picture.hpp"
#include "plot/picture_files.hpp"
#include "plot/polar_picture.hpp"
#include "plot/slice_picture.hpp"

namespace lobe {

PictureFiles write_table_pictures(std::span<const BrdfTable> tables, const std::filesystem::path& directory,
                                  const std::string& stem, const TablePictureOptions& options) {
  if (tables.empty()) throw ArgumentError("no tables to draw; expected at least 1");
  for (const auto& table : tables) check(table);
  using Draw = gnuplot::Picture (*)(const std::string&, std::span<const BrdfTable>, PictureFormat);
  std::vector<NamedPicture> pictures;
  const auto add = [&](const char* kind, Draw draw) {
    const std::string name = stem + "." + kind;
    pictures.push_back({name, draw(name, tables, options.format)});
  };
  add("polar", polar_picture);
  add("slice", slice_picture);
  add("albedo", albedo_picture);
  return write_pictures(pictures, directory, options);
}

}  // namespace lobe
