#include <fmt/format.h>

#include <array>
#include <utility>

#include "core/clock.hpp"
#include "core/file_set.hpp"
#include "io/dendrogram_picture.hpp"
#include "io/distance_picture.hpp"
#include "io/map_picture.hpp"
#include "io/picture_files.hpp"
#include "io/table_text.hpp"
#include "lobe/study.hpp"
#include "study/clustering_text.hpp"
#include "study/study_table.hpp"

namespace lobe {
namespace {

namespace fs = std::filesystem;

struct NamedTable {
  std::string name;
  std::string text;
};

std::vector<NamedTable> make_tables(const StudyResult& result) {
  std::vector<std::string> labels;
  for (const auto& material : result.study.materials) labels.push_back(material.name);
  std::vector<NamedTable> tables;
  for (std::size_t i = 0; i < result.metrics.size(); ++i) {
    const Metric& metric = result.metrics[i].combined;
    const std::string stem = result.study.name + "." + result.metrics[i].lighting.stem();
    tables.push_back({stem + ".distance.csv", csv_matrix("material", labels, metric.distance)});
    tables.push_back({stem + ".medoids.csv", medoids_csv(result.study.materials, metric, result.clusterings[i])});
    tables.push_back({stem + ".neighbours.csv", neighbours_csv(result.study.materials, result.clusterings[i])});
  }
  return tables;
}

std::vector<NamedPicture> make_pictures(const StudyResult& result) {
  std::vector<NamedPicture> pictures;
  const Study& study = result.study;
  for (std::size_t i = 0; i < result.metrics.size(); ++i) {
    const MetricResult& metric = result.metrics[i];
    const std::string& lighting = metric.lighting.name();
    const std::string stem = metric.lighting.stem();
    const std::string distance_stem = fmt::format("{}.{}.distance", study.name, stem);
    const std::string map_stem = fmt::format("{}.{}.map", study.name, stem);
    const std::string& title = study.title.empty() ? study.name : study.title;
    constexpr std::array<const char*, 3> kUnits{"", "√sr", "sr"};
    const char* const unit = kUnits.at(static_cast<std::size_t>(metric.lighting.product_power()));
    pictures.push_back({distance_stem, distance_picture(distance_stem, fmt::format("{}, {} distance", title, lighting),
                                                        unit, study.materials, metric.combined.distance)});
    pictures.push_back({map_stem, map_picture(map_stem, fmt::format("{}, map by {} distance", title, lighting), unit,
                                              study.materials, result.embeddings[i])});
    if (study.materials.size() > 1) {
      const std::string tree_stem = fmt::format("{}.{}.dendrogram", study.name, stem);
      pictures.push_back(
          {tree_stem, dendrogram_picture(tree_stem, fmt::format("{}, tree by {} distance", title, lighting), unit,
                                         study.materials, metric.combined.distance, result.clusterings[i])});
    }
  }
  return pictures;
}

}  // namespace

StudyFiles write_study(const StudyResult& result, const fs::path& directory, const OutputOptions& options) {
  const std::vector<NamedTable> tables = make_tables(result);
  const std::vector<NamedPicture> pictures = make_pictures(result);
  StudyFiles files;
  files.table = directory / (result.study.name + ".h5");
  for (const auto& table : tables) files.csv.push_back(directory / table.name);
  if (!options.overwrite) {
    require_absent(files.table);
    for (const auto& path : files.csv) require_absent(path);
    require_pictures_absent(pictures, directory, PictureFormat::png);
  }
  make_directory(directory);

  FileSet set(options.overwrite);
  set.write(files.table, study_table(result, options.command_line, time_of_writing()));
  for (std::size_t i = 0; i < tables.size(); ++i) set.write(files.csv[i], tables[i].text);
  files.scripts = write_scripts(pictures, directory, set);
  RenderedPictures rendered = render_pictures(pictures, directory, PictureFormat::png);
  files.pictures = std::move(rendered.pictures);
  files.note = std::move(rendered.note);
  set.keep();
  return files;
}

}  // namespace lobe
