#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <filesystem>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "lobe/cluster/clustering.hpp"
#include "lobe/cluster/embedding.hpp"
#include "lobe/fit/approximation.hpp"
#include "lobe/study/material_curves.hpp"
#include "lobe/study/study.hpp"

namespace [[gnu::visibility("default")]] lobe {

/// Distances between a study's materials by one lighting or comparison metric, all channels together, with derived
/// results.
struct StudyDistances {
  std::string name;                      ///< "point", "patch:0.5", "ngan-l2"
  bool is_lighting = true;               ///< whether it is a lighting rather than a comparison metric
  std::string definition;                ///< definition of the scalar product, one line; empty for comparison metrics
  std::string origin;                    ///< where the study requests it, as StudyMaterial::origin
  std::string unit;                      ///< unit of norms and distances, as UDUNITS writes it: "1", "sr^0.5"
  Eigen::VectorXd norm;                  ///< n; for comparison metrics the distance from black
  Eigen::VectorXd norm_error;            ///< n, bounds
  Eigen::MatrixXd distance;              ///< n x n
  Eigen::MatrixXd distance_error;        ///< n x n, bounds
  std::size_t unresolved_pairs = 0;      ///< number of pairs that did not reach the tolerance
  std::optional<Embedding> embedding;    ///< for lightings only
  std::optional<Clustering> clustering;  ///< for lightings only; costs of medoids are left out
  /// Family residuals that the study requests, for lightings only, in this order: linear, non-negative.
  std::vector<FamilyResiduals> residuals;
};

/// A material of a study as its results name it.
struct StudyMaterial {
  std::string name;    ///< unique in the study
  std::string family;  ///< group it belongs to
  std::string json;    ///< as to_json() gives it; for files an object without "terms"
  /// Origin in the study's files, from to_string(); empty if unknown, and in older files.
  std::string origin;
};

/// Provenance of results.
struct StudyProvenance {
  std::string software_version;        ///< version of lobe
  std::string commit;                  ///< commit of the build, if known
  std::string hdf5_version;            ///< version of the library that wrote the file
  std::string command_line;            ///< command line of `lobe run`
  std::string created;                 ///< ISO 8601
  std::string configuration;           ///< equivalent study file: Study::configuration
  std::vector<StudyText> texts;        ///< the study's files; none in older results
  std::vector<std::string> overrides;  ///< values set from outside the files, "KEY=VALUE"
  std::string platform;                ///< name of the OpenCL platform
  std::string platform_version;        ///< version of the platform
  std::string device;                  ///< name of the device
  std::string device_version;          ///< OpenCL version of the device
  std::string driver;                  ///< version of the driver
  std::string precision;               ///< "double" or "single"
  double tolerance = 0;                ///< for scalar products
  double patch_tolerance = 0;          ///< for patch lights
  double comparison_tolerance = 0;     ///< for distances from the literature
  double domain_theta_max_deg = 90;    ///< largest angle of scalar products; 90: whole hemispheres
  std::optional<std::string> grid;     ///< grid of the study, empty: none; no value in older files
};

/// Materials and distances read back from a file of write_study().
struct StudyResults {
  std::string name;                       ///< stem of the file
  std::string title;                      ///< for people
  std::string comment;                    ///< for people
  std::string references;                 ///< a line each
  std::vector<StudyMaterial> materials;   ///< in the order of the study
  std::vector<std::string> channels;      ///< names
  std::vector<double> channel_weights;    ///< one per channel
  std::vector<StudyDistances> distances;  ///< by lightings, then by comparison metrics
  MetricAgreement agreement;              ///< empty if the study has none
  CurveAngles curve_angles;               ///< angles of the curves
  std::vector<MaterialCurves> curves;     ///< one per material, with all channels; none in older files
  std::size_t published_figures = 0;      ///< number of published figures in the file
  std::size_t charts = 0;                 ///< number of charts in the file
  StudyProvenance provenance;             ///< how the results were computed
};

/// Summary of a study's results, without the numbers.
struct StudySummary {
  std::string name;                                          ///< stem of the file
  std::string title;                                         ///< for people
  std::string comment;                                       ///< for people
  std::string references;                                    ///< a line each
  std::vector<StudyMaterial> materials;                      ///< none if the study has only figures and charts
  std::vector<std::string> channels;                         ///< names
  std::vector<std::pair<std::string, std::string>> metrics;  ///< lightings, then comparison metrics, with their origins
  std::vector<std::pair<std::string, std::string>> published;  ///< "TABLE, FIGURE", with their origins
  std::vector<std::pair<std::string, std::string>> charts;     ///< names of charts, with their origins
  StudyProvenance provenance;                                  ///< how the results were computed
};

/// Whether a file holds results of `lobe run`, of this version or another.
/// \throws IoError for a file whose bytes have changed since it was written
[[nodiscard]] bool is_study_results(const std::filesystem::path& path);

/// Reads the summary of a study from NAME.h5.
/// \throws IoError as load_study_results(), except for studies without materials
[[nodiscard]] StudySummary load_study_summary(const std::filesystem::path& path);

/// Reads the results that `lobe run` wrote as NAME.h5 (docs/file-formats.md).
/// \throws IoError "cannot read FILE: ..." for files that hold no such results, are of a newer version, or damaged, and
///   for studies without materials
[[nodiscard]] StudyResults load_study_results(const std::filesystem::path& path);

}  // namespace lobe
