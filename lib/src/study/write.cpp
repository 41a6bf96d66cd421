#include <fmt/format.h>

#include <system_error>
#include <utility>

#include "core/files.hpp"
#include "io/distance_picture.hpp"
#include "io/gnuplot.hpp"
#include "io/map_picture.hpp"
#include "io/table_text.hpp"
#include "lobe/error.hpp"
#include "lobe/study.hpp"
#include "study/study_table.hpp"

namespace lobe {
namespace {

namespace fs = std::filesystem;

struct NamedPicture {
  std::string stem;
  gnuplot::Picture picture;
};

struct NamedTable {
  std::string name;
  std::string text;
};

/// Removes the files of an unfinished set, except those that replaced older ones.
class FileSet {
 public:
  explicit FileSet(bool overwrite) : overwrite_(overwrite) {}
  ~FileSet() {
    std::error_code ignored;
    for (const auto& path : fresh_) fs::remove(path, ignored);
  }
  FileSet(const FileSet&) = delete;
  FileSet& operator=(const FileSet&) = delete;

  void write(const fs::path& path, const std::string& text) {
    std::error_code ignored;
    const bool is_fresh = !fs::exists(path, ignored);
    write_text(path, overwrite_, text);
    if (is_fresh) fresh_.push_back(path);
  }
  void keep() { fresh_.clear(); }

 private:
  bool overwrite_;
  std::vector<fs::path> fresh_;
};

void require_absent(const fs::path& path) {
  std::error_code ignored;
  if (fs::exists(path, ignored)) {
    throw IoError(path.string() + " exists; use --force to replace it, or another output name");
  }
}

void make_directory(const fs::path& directory) {
  if (directory.empty()) return;
  std::error_code code;
  fs::create_directories(directory, code);
  if (code) throw IoError("cannot create directory " + directory.string() + ": " + code.message());
}

std::vector<NamedTable> make_tables(const StudyResult& result) {
  std::vector<std::string> labels;
  for (const auto& material : result.study.materials) labels.push_back(material.name);
  std::vector<NamedTable> tables;
  for (const auto& metric : result.metrics) {
    tables.push_back({result.study.name + "." + std::string(to_string(metric.lighting)) + ".distance.csv",
                      csv_matrix("material", labels, metric.combined.distance)});
  }
  return tables;
}

std::vector<NamedPicture> make_pictures(const StudyResult& result) {
  std::vector<NamedPicture> pictures;
  const Study& study = result.study;
  for (std::size_t i = 0; i < result.metrics.size(); ++i) {
    const MetricResult& metric = result.metrics[i];
    const std::string lighting(to_string(metric.lighting));
    const std::string distance_stem = fmt::format("{}.{}.distance", study.name, lighting);
    const std::string map_stem = fmt::format("{}.{}.map", study.name, lighting);
    const std::string& title = study.title.empty() ? study.name : study.title;
    const char* const unit = metric.lighting == Lighting::point ? "" : "√sr";
    pictures.push_back({distance_stem, distance_picture(distance_stem, fmt::format("{}, {} distance", title, lighting),
                                                        unit, study.materials, metric.combined.distance)});
    pictures.push_back({map_stem, map_picture(map_stem, fmt::format("{}, map by {} distance", title, lighting), unit,
                                              study.materials, result.embeddings[i])});
  }
  return pictures;
}

/// Renders pictures until one fails: the reason would be the same for the others. Of those that fail no older picture
/// stays, which would show other data.
void render_pictures(std::span<const NamedPicture> pictures, const fs::path& directory, StudyFiles& files) {
  for (const auto& [stem, picture] : pictures) {
    const fs::path target = directory / (stem + ".png");
    const std::string reason = files.note.empty() ? gnuplot::render(directory, stem) : files.note;
    if (reason.empty()) {
      files.pictures.push_back(target);
      continue;
    }
    if (files.note.empty()) files.note = "pictures left out: " + reason + "; their gnuplot scripts are written";
    std::error_code ignored;
    fs::remove(target, ignored);
  }
}

}  // namespace

StudyFiles write_study(const StudyResult& result, const fs::path& directory, const OutputOptions& options) {
  const std::vector<NamedTable> tables = make_tables(result);
  const std::vector<NamedPicture> pictures = make_pictures(result);
  StudyFiles files;
  files.table = directory / (result.study.name + ".h5");
  for (const auto& table : tables) files.csv.push_back(directory / table.name);
  for (const auto& picture : pictures) {
    files.scripts.push_back(directory / (picture.stem + ".gp"));
    files.scripts.push_back(directory / (picture.stem + ".dat"));
  }
  if (!options.overwrite) {
    require_absent(files.table);
    for (const auto& path : files.csv) require_absent(path);
    for (const auto& path : files.scripts) require_absent(path);
    for (const auto& picture : pictures) require_absent(directory / (picture.stem + ".png"));
  }
  make_directory(directory);

  FileSet set(options.overwrite);
  set.write(files.table, study_table(result, options.command_line, time_of_writing()));
  for (std::size_t i = 0; i < tables.size(); ++i) set.write(files.csv[i], tables[i].text);
  for (std::size_t i = 0; i < pictures.size(); ++i) {
    set.write(files.scripts[2 * i], pictures[i].picture.script);
    set.write(files.scripts[2 * i + 1], pictures[i].picture.data);
  }
  render_pictures(pictures, directory, files);
  set.keep();
  return files;
}

}  // namespace lobe
