#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "lobe/clustering.hpp"
#include "lobe/device.hpp"
#include "lobe/embedding.hpp"
#include "lobe/material.hpp"
#include "lobe/metric.hpp"
#include "lobe/progress.hpp"

namespace lobe {

/// A set of materials and what to compute of them; the content of a study file (docs/study-files.md).
struct Study {
  std::string name;  ///< stem of the output files
  std::string title;
  std::string comment;
  std::vector<std::string> references;  ///< citations of the material data
  std::vector<std::string> channels;    ///< names; load_study: a single "value" where the file names none
  std::vector<double> channel_weights;  ///< one per channel; empty: equal, with sum 1
  std::vector<Material> materials;      ///< in file order, a family's materials together
  std::vector<Lighting> lightings;
  double tolerance = 1e-6;
  Precision precision = Precision::double_precision;
  ClusteringOptions clustering;
  std::string configuration;  ///< the file's text, for provenance
};

/// Reads a study file.
/// \throws IoError when it cannot be read; ArgumentError "FILE:LINE:COLUMN: ..." for anything wrong in it.
[[nodiscard]] Study load_study(const std::filesystem::path& path);

/// Whether a TOML file is a study file rather than a material file: it has a [study], a [[family]] or a [[material]].
/// \throws as load_study() for what is no TOML.
[[nodiscard]] bool is_study_file(const std::filesystem::path& path);

/// Reads a material file (a study file's [[material]] table without the brackets).
/// \throws as load_study().
[[nodiscard]] Material load_material(const std::filesystem::path& path);

/// Seconds spent in one stage of a run.
struct StageTime {
  std::string stage;
  double seconds = 0;
};

/// A study's results, with all that is needed to repeat them.
struct StudyResult {
  Study study;
  DeviceInfo device;
  std::vector<MetricResult> metrics;    ///< one per lighting of the study
  std::vector<Embedding> embeddings;    ///< one per lighting, of the combined distances
  std::vector<Clustering> clusterings;  ///< idem
  std::vector<StageTime> stages;
};

/// Computes a study. The study in the result has its channels named and weighted, also where the given one has not.
/// \throws as measure(); ArgumentError when channels and channel weights differ in number, and for more clusters than
///   materials.
[[nodiscard]] StudyResult run_study(const Device& device, const Study& study, const ProgressCallback& progress = {});

/// How results are written.
struct OutputOptions {
  bool overwrite = false;
  std::string command_line;  ///< recorded in the file's history attribute
};

/// What write_study left, and what it could not.
struct StudyFiles {
  std::filesystem::path table;                  ///< NAME.h5
  std::vector<std::filesystem::path> csv;       ///< NAME.<lighting>.{distance,medoids,neighbours}.csv
  std::vector<std::filesystem::path> pictures;  ///< NAME.<lighting>.{distance,map,dendrogram}.png
  std::vector<std::filesystem::path> scripts;   ///< the gnuplot scripts and data beside the pictures
  std::string note;                             ///< why pictures are missing; empty when they are there
};

/// Writes NAME.h5 (schema lobe-study/1), the tables of distances, medoids and neighbours and the pictures into a
/// directory, each by writing a temporary file and renaming it; makes the directory where there is none. Without
/// gnuplot the pictures are left out and `note` says so. \throws IoError when a file exists and overwrite is false, or
/// cannot be written; nothing half-written stays.
StudyFiles write_study(const StudyResult& result, const std::filesystem::path& directory,
                       const OutputOptions& options = {});

}  // namespace lobe
