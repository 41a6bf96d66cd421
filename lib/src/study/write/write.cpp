#include <fmt/format.h>

#include <array>
#include <utility>

#include "core/clock.hpp"
#include "core/file_set.hpp"
#include "lobe/metric/unit.hpp"
#include "lobe/study/study.hpp"
#include "plot/agreement_picture.hpp"
#include "plot/dendrogram_picture.hpp"
#include "plot/distance_picture.hpp"
#include "plot/map_picture.hpp"
#include "plot/picture_files.hpp"
#include "plot/table_text.hpp"
#include "study/run/agreement.hpp"
#include "study/run/nearest_models.hpp"
#include "study/run/picture_stems.hpp"
#include "study/write/chart_text.hpp"
#include "study/write/clustering_text.hpp"
#include "study/write/drawn_materials.hpp"
#include "study/write/published_text.hpp"
#include "study/write/study_hdf5.hpp"

namespace lobe {
namespace {

namespace fs = std::filesystem;

struct NamedTable {
  std::string name;
  std::string text;
};

std::vector<NamedTable> make_tables(const StudyResult& result) {
  const Study& study = result.study;
  const std::vector<MaterialLabel> materials = labels(study);
  std::vector<std::string> names_of_materials;
  for (const auto& material : materials) names_of_materials.push_back(material.name);
  std::vector<std::string> texts;
  for (std::size_t i = 0; i < result.metrics.size(); ++i) {
    const Metric& metric = result.metrics[i].combined;
    texts.push_back(csv_matrix("material", names_of_materials, metric.distance));
    texts.push_back(medoids_csv(materials, metric, result.clusterings[i]));
    texts.push_back(neighbours_csv(materials, result.clusterings[i]));
    if (has_nearest_models(study)) texts.push_back(nearest_models_csv(study, metric));
    const std::size_t fits = study.approximations.size();
    for (std::size_t k = 0; k < fits; ++k) texts.push_back(csv_text(result.residuals.at(i * fits + k)));
  }
  for (const auto& comparison : result.comparisons) {
    texts.push_back(csv_matrix("material", names_of_materials, comparison.combined.distance));
  }
  if (has_agreement(study)) texts.push_back(agreement_csv(result.agreement));
  if (!study.published.empty()) texts.push_back(published_csv(result));
  for (std::size_t i = 0; i < study.charts.size(); ++i)
    texts.push_back(chart_csv(study.charts[i], result.charts.at(i)));
  std::vector<NamedTable> tables;
  const auto names = csv_names(study);
  for (std::size_t i = 0; i < names.size(); ++i) tables.push_back({names[i], std::move(texts.at(i))});
  return tables;
}

std::vector<NamedPicture> make_pictures(const StudyResult& result) {
  const Study& study = result.study;
  const std::string& title = study.title.empty() ? study.name : study.title;
  const std::vector<std::string> stems = picture_stems(study);
  const std::vector<DrawnMaterial> materials = drawn_materials(study);
  std::vector<NamedPicture> pictures;
  // A picture by its stem.
  const auto add = [&](const auto& picture) {
    const std::string& stem = stems.at(pictures.size());
    pictures.push_back({stem, picture(stem)});
  };
  for (std::size_t i = 0; i < result.metrics.size(); ++i) {
    const MetricResult& metric = result.metrics[i];
    const std::string& lighting = metric.lighting.name();
    const std::string unit(norm_unit(metric.lighting, UnitStyle::printed));
    add([&](const std::string& stem) {
      return distance_picture(stem, fmt::format("{}, {} distance", title, lighting), unit, materials,
                              metric.combined.distance);
    });
    add([&](const std::string& stem) {
      return map_picture(stem, fmt::format("{}, map by {} distance", title, lighting), unit, materials,
                         result.embeddings[i]);
    });
    if (study.materials.size() < 2) continue;
    add([&](const std::string& stem) {
      return dendrogram_picture(stem, fmt::format("{}, tree by {} distance", title, lighting), unit, materials,
                                metric.combined.distance, result.clusterings[i]);
    });
  }
  for (const auto& comparison : result.comparisons) {
    const std::string_view name = to_string(comparison.metric);
    add([&](const std::string& stem) {
      return distance_picture(stem, fmt::format("{}, distance by {}", title, name), unit_of(comparison.metric),
                              materials, comparison.combined.distance);
    });
  }
  for (std::size_t i = 0; i < study.charts.size(); ++i) {
    add([&](const std::string& stem) { return chart_picture(stem, study.charts[i], result.charts.at(i)); });
  }
  const auto add_agreement = [&](std::string_view pairs, const RankAgreement& agreement) {
    add([&](const std::string& stem) {
      return agreement_picture(stem, fmt::format("{}, {}", title, pairs), result.agreement.metrics, agreement);
    });
  };
  if (has_agreement(study)) add_agreement("all pairs", result.agreement.all_pairs);
  if (has_agreement_within_families(study)) add_agreement("pairs of one family", result.agreement.within_families);
  return pictures;
}

}  // namespace

std::vector<std::string> csv_names(const Study& study) {
  std::vector<std::string> names;
  for (const auto& lighting : study.lightings) {
    const std::string stem = study.name + "." + lighting.stem();
    for (const char* content : {"distance", "medoids", "neighbours"}) names.push_back(stem + "." + content + ".csv");
    if (has_nearest_models(study)) names.push_back(stem + ".nearest-models.csv");
    for (const auto fit : study.approximations) {
      names.push_back(fmt::format("{}.{}-residuals.csv", stem, to_string(fit)));
    }
  }
  for (const auto comparison : study.comparison_metrics) {
    names.push_back(fmt::format("{}.{}.distance.csv", study.name, to_string(comparison)));
  }
  if (has_agreement(study)) names.push_back(study.name + ".agreement.csv");
  if (!study.published.empty()) names.push_back(study.name + ".published.csv");
  for (const auto& chart : study.charts) names.push_back(fmt::format("{}.chart.{}.csv", study.name, chart.name));
  return names;
}

std::vector<std::string> picture_stems(const Study& study) {
  std::vector<std::string> stems;
  for (const auto& lighting : study.lightings) {
    const std::string stem = study.name + "." + lighting.stem();
    for (const char* content : {"distance", "map"}) stems.push_back(stem + "." + content);
    if (study.materials.size() > 1) stems.push_back(stem + ".dendrogram");
  }
  for (const auto comparison : study.comparison_metrics) {
    stems.push_back(fmt::format("{}.{}.distance", study.name, to_string(comparison)));
  }
  for (const auto& chart : study.charts) stems.push_back(fmt::format("{}.chart.{}", study.name, chart.name));
  if (has_agreement(study)) stems.push_back(study.name + ".agreement");
  if (has_agreement_within_families(study)) stems.push_back(study.name + ".agreement-within-families");
  return stems;
}

std::vector<std::string> page_names(const Study& study) {
  if (study.published.empty()) return {};
  return {study.name + ".published.md"};
}

StudyFiles write_study(const StudyResult& result, const fs::path& directory, const OutputOptions& options) {
  const std::vector<NamedTable> tables = make_tables(result);
  const std::vector<NamedPicture> pictures = make_pictures(result);
  StudyFiles files;
  files.table = directory / (result.study.name + ".h5");
  for (const auto& table : tables) files.csv.push_back(directory / table.name);
  for (const auto& name : page_names(result.study)) files.pages.push_back(directory / name);
  if (!options.overwrite) {
    require_absent(files.table);
    for (const auto& path : files.csv) require_absent(path);
    for (const auto& path : files.pages) require_absent(path);
    require_pictures_absent(pictures, directory, PictureFormat::png);
  }
  {
    FileSet set(directory, result.study.name, options.overwrite);
    set.write(files.table.filename().string(), study_table(result, options.command_line, time_of_writing()));
    for (const auto& table : tables) set.write(table.name, table.text);
    for (const auto& name : page_names(result.study)) set.write(name, published_page(result));
    files.scripts = write_scripts(pictures, directory, set);
    // An older picture would show other data.
    for (const auto& picture : pictures) set.leave_out(picture.stem + gnuplot::extension(PictureFormat::png));
    set.keep();
  }
  RenderedPictures rendered =
      draw_pictures(pictures, directory, result.study.name, PictureFormat::png, options.overwrite, options.progress);
  files.pictures = std::move(rendered.pictures);
  files.note = std::move(rendered.note);
  return files;
}

}  // namespace lobe
