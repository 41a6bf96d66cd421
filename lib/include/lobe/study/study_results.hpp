#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <filesystem>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "lobe/metric/approximation.hpp"
#include "lobe/metric/clustering.hpp"
#include "lobe/metric/embedding.hpp"
#include "lobe/study/material_curves.hpp"
#include "lobe/study/study.hpp"

namespace lobe {

/// Distances of a study's materials by one lighting or comparison metric, all channels together, and what follows.
struct StudyDistances {
  std::string name;                      ///< "point", "patch:0.5", "ngan-l2"
  bool is_lighting = true;               ///< else a comparison metric
  std::string definition;                ///< of the scalar product, one line; empty for comparison metrics
  std::string origin;                    ///< what the study asks for it by, as StudyMaterial::origin
  std::string unit;                      ///< of norms and distances, as UDUNITS writes it: "1", "sr^0.5"
  Eigen::VectorXd norm;                  ///< n; of comparison metrics the distance from black
  Eigen::VectorXd norm_error;            ///< n, bounds
  Eigen::MatrixXd distance;              ///< n x n
  Eigen::MatrixXd distance_error;        ///< n x n, bounds
  std::size_t unresolved_pairs = 0;      ///< that did not reach the tolerance
  std::optional<Embedding> embedding;    ///< of lightings
  std::optional<Clustering> clustering;  ///< idem; costs of medoids are left out
  /// Idem; what the study asks for, in this order: linear, non-negative.
  std::vector<FamilyResiduals> residuals;
};

/// A material of a study as its results name it.
struct StudyMaterial {
  std::string name;    ///< unique in the study
  std::string family;  ///< group it belongs to
  std::string json;    ///< as to_json() gives it; of materials that are files an object without "terms"
  /// to_string() of where it stands in the study's files; empty where that is unknown, and in older files.
  std::string origin;
};

/// How results came about.
struct StudyProvenance {
  std::string software_version;        ///< of lobe
  std::string commit;                  ///< of the build, where it was known
  std::string hdf5_version;            ///< of the library that wrote the file
  std::string command_line;            ///< of `lobe run`
  std::string created;                 ///< ISO 8601
  std::string configuration;           ///< a study file that says all of the study: Study::configuration
  std::vector<StudyText> texts;        ///< the study's files; none in older results
  std::vector<std::string> overrides;  ///< what was set from outside them, "KEY=VALUE"
  std::string platform;                ///< OpenCL, and so the next ones
  std::string platform_version;        ///< of OpenCL
  std::string device;                  ///< its name
  std::string device_version;          ///< of OpenCL that it offers
  std::string driver;                  ///< its version
  std::string precision;               ///< "double" or "single"
  double tolerance = 0;                ///< of scalar products
  double patch_tolerance = 0;          ///< of those under patch lights
  double comparison_tolerance = 0;     ///< of distances of the literature
  double domain_theta_max_deg = 90;    ///< largest angle of scalar products; 90: those of whole hemispheres
  std::optional<std::string> grid;     ///< that materials were measured on, empty: none; nothing in older files
};

/// What a file that write_study() left says of materials and their distances.
struct StudyResults {
  std::string name;                       ///< stem of the file
  std::string title;                      ///< for people
  std::string comment;                    ///< for people
  std::string references;                 ///< a line each
  std::vector<StudyMaterial> materials;   ///< in the order of the study
  std::vector<std::string> channels;      ///< names
  std::vector<double> channel_weights;    ///< one per channel
  std::vector<StudyDistances> distances;  ///< by lightings, then by comparison metrics
  MetricAgreement agreement;              ///< empty where the study has none
  CurveAngles curve_angles;               ///< at which angles the curves are
  std::vector<MaterialCurves> curves;     ///< one per material, with all channels; none in older files
  std::size_t published_figures = 0;      ///< that the file has besides
  std::size_t charts = 0;                 ///< idem
  StudyProvenance provenance;             ///< what computed all this
};

/// What was computed of a study, without the numbers.
struct StudySummary {
  std::string name;                                          ///< stem of the file
  std::string title;                                         ///< for people
  std::string comment;                                       ///< for people
  std::string references;                                    ///< a line each
  std::vector<StudyMaterial> materials;                      ///< none where the study has only figures and charts
  std::vector<std::string> channels;                         ///< names
  std::vector<std::pair<std::string, std::string>> metrics;  ///< lightings, then comparison metrics, with their origins
  std::vector<std::pair<std::string, std::string>> published;  ///< "TABLE, FIGURE", idem
  std::vector<std::pair<std::string, std::string>> charts;     ///< idem
  StudyProvenance provenance;                                  ///< what computed all this
};

/// Whether a file is what `lobe run` left, of this version or another.
/// \throws IoError for a file whose bytes have changed since it was written
[[nodiscard]] bool is_study_results(const std::filesystem::path& path);

/// Reads what NAME.h5 says of the study.
/// \throws IoError as load_study_results(), but for studies without materials.
[[nodiscard]] StudySummary load_study_summary(const std::filesystem::path& path);

/// Reads what `lobe run` left as NAME.h5 (docs/file-formats.md).
/// \throws IoError "cannot read FILE: ..." for files that are none, of a newer version, or damaged, and for studies
///   without materials.
[[nodiscard]] StudyResults load_study_results(const std::filesystem::path& path);

}  // namespace lobe
