#include "lobe/plot/table_pictures.hpp"

#include "lobe/core/error.hpp"
#include "plot/albedo_picture.hpp"
#include "plot/drawn_reflectance.hpp"
#include "plot/picture_files.hpp"
#include "plot/polar_picture.hpp"
#include "plot/slice_picture.hpp"

namespace lobe {
namespace {

PictureFiles write_drawn(std::span<const DrawnReflectance> drawn, const std::filesystem::path& directory,
                         const std::string& stem, const TablePictureOptions& options) {
  using Draw = gnuplot::Picture (*)(const std::string&, std::span<const DrawnReflectance>, PictureFormat);
  std::vector<NamedPicture> pictures;
  const auto add = [&](const char* kind, Draw draw) {
    const std::string name = stem + "." + kind;
    pictures.push_back({name, draw(name, drawn, options.format)});
  };
  add("polar", polar_picture);
  add("slice", slice_picture);
  add("albedo", albedo_picture);
  return write_pictures(pictures, directory, options);
}

}  // namespace

PictureFiles write_table_pictures(std::span<const BrdfTable> tables, const std::filesystem::path& directory,
                                  const std::string& stem, const TablePictureOptions& options) {
  if (tables.empty()) throw ArgumentError("no tables to draw; expected at least 1");
  std::vector<DrawnReflectance> all;
  for (const auto& table : tables) all.push_back(drawn(table));
  return write_drawn(all, directory, stem, options);
}

PictureFiles write_reflectance_pictures(const Device& device, const ReflectanceList& reflectances,
                                        const std::filesystem::path& directory, const std::string& stem,
                                        const TablePictureOptions& options) {
  if (reflectances.empty()) throw ArgumentError("no reflectances to draw; expected at least 1");
  std::vector<DrawnReflectance> all;
  for (const auto& reflectance : reflectances) all.push_back(drawn(device, reflectance));
  return write_drawn(all, directory, stem, options);
}

}  // namespace lobe
