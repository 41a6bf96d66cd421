#pragma once

#include <filesystem>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "lobe/core/progress.hpp"
#include "lobe/core/tolerance.hpp"
#include "lobe/device/device.hpp"
#include "lobe/hemisphere/grid.hpp"
#include "lobe/io/measured.hpp"
#include "lobe/metric/approximation.hpp"
#include "lobe/metric/clustering.hpp"
#include "lobe/metric/comparison.hpp"
#include "lobe/metric/embedding.hpp"
#include "lobe/metric/metric.hpp"
#include "lobe/metric/rank_correlation.hpp"
#include "lobe/model/material.hpp"
#include "lobe/study/chart.hpp"
#include "lobe/study/material_curves.hpp"
#include "lobe/study/published.hpp"

namespace lobe {

/// Which combinations of a family's materials count when families are to represent materials (family_residuals()).
enum class FamilyFit {
  linear,       ///< any
  non_negative  ///< those without negative coefficients
};
/// "linear", "non-negative".
[[nodiscard]] std::string_view to_string(FamilyFit fit);

/// A file that is a material: of a foreign format, or a table.
struct MaterialFile {
  std::filesystem::path path;  ///< where it is
  std::string name;            ///< as the study file has it, for results
  ReadOptions options;         ///< what of it is read
};

/// A file that a study was read from.
struct StudyText {
  std::string name;  ///< of the study file, without folders; of an included one, the path from the study file's folder
  std::string text;  ///< all of it
};

/// Where something of a study comes from.
struct Origin {
  std::string file;                    ///< a name of Study::texts; empty: in none
  std::size_t line = 0;                ///< from 1 on; of a [[family]] the heading's, or that of the row
  std::string swept;                   ///< what tells it from others of its line: "m=0.1, scale=0.5"
  std::vector<std::string> overrides;  ///< keys from outside the files that changed it: "family.Ward.m"
};
/// "gloss.toml:6 (m=0.1), --set family.Ward.m"; "default" for what no file says.
[[nodiscard]] std::string to_string(const Origin& origin);

/// Where the parts of a study come from: as many as it has of each, or none for studies made in code.
struct StudyOrigins {
  std::vector<Origin> materials;            ///< the tables or rows that define them
  std::vector<Origin> lightings;            ///< the keys that ask for them
  std::vector<Origin> comparison_metrics;   ///< idem
  std::vector<Origin> published;            ///< the tables or rows of the figures
  std::vector<Origin> charts;               ///< their tables
  std::vector<std::vector<Origin>> curves;  ///< by chart
};

/// A set of materials and what to compute of them; the content of a study file (docs/study-files.md).
struct Study {
  std::string name;                     ///< stem of the output files
  std::string title;                    ///< for people
  std::string comment;                  ///< for people
  std::vector<std::string> references;  ///< citations of the material data
  std::vector<std::string> channels;    ///< names; load_study: a single "value" where the file names none
  std::vector<double> channel_weights;  ///< one per channel; empty: equal, with sum 1
  std::vector<Material> materials;      ///< in file order, a family's materials together
  /// One per material; those that are files have a name, a family and no terms. Empty where none are.
  std::vector<std::optional<MaterialFile>> files;
  /// Where materials are tabulated to be measured; none: as choose_route() has it.
  std::optional<HemisphereGrid> grid;
  bool allow_unresolved = false;                                   ///< keep tables that the grid does not resolve
  std::vector<Lighting> lightings;                                 ///< what distances are taken under
  std::vector<PublishedFigure> published;                          ///< printed numbers to compute again
  std::vector<Chart> charts;                                       ///< curves to draw
  double tolerance = MetricOptions{}.tolerance;                    ///< of scalar products, as in MetricOptions
  double patch_tolerance = MetricOptions{}.patch_tolerance;        ///< that of patch lights, where it is larger
  double function_tolerance = MetricOptions{}.function_tolerance;  ///< that of files, as in MetricOptions
  double domain_theta_max = MetricOptions{}.theta_max;             ///< domain of scalar products, as in MetricOptions
  std::vector<Comparison> comparison_metrics;                   ///< distances of the literature beside the lightings'
  double comparison_tolerance = ComparisonOptions{}.tolerance;  ///< as in ComparisonOptions
  std::vector<FamilyFit> approximations;                        ///< every material by every family, under each lighting
  Precision precision = Precision::double_precision;            ///< of the models
  ClusteringOptions clustering;                                 ///< how trees and representatives are made
  /// A study file that says all of this: the file's text, or, where it includes others or values were set from outside,
  /// all written out as one.
  std::string configuration;
  std::vector<StudyText> texts;        ///< the study file, then those it includes, as they are
  std::vector<std::string> overrides;  ///< as load_study() was given them
  StudyOrigins origins;                ///< where in these texts its parts stand
};

/// Reads a study file and those that it includes.
/// \param overrides values set from outside, "KEY=VALUE" each, in this order: "study.tolerance=1e-4",
///   "family.Ward.m.count=20", "chart.gloss.curves.0.n=30"; VALUE is TOML, texts may stand without quotes
/// \throws IoError when it cannot be read; ArgumentError "FILE:LINE:COLUMN: ..." for anything wrong in it, "--set
///   KEY=VALUE: ..." for what is wrong in an override.
[[nodiscard]] Study load_study(const std::filesystem::path& path, std::span<const std::string> overrides = {});

/// Whether a TOML file is a study file rather than a material file: it has a [study], a [[family]], [[material]],
/// [[measured]], [[published]] or [[chart]], or includes files.
/// \throws as load_study() for what is no TOML.
[[nodiscard]] bool is_study_file(const std::filesystem::path& path);

/// Reads a material file (a study file's [[material]] table without the brackets).
/// \throws as load_study().
[[nodiscard]] Material load_material_file(const std::filesystem::path& path);

/// Seconds spent in one stage of a run.
struct StageTime {
  std::string stage;   ///< what was done
  double seconds = 0;  ///< how long that took
};

/// How alike the study's metrics rank its pairs of materials by their combined distances.
struct MetricAgreement {
  std::vector<std::string> metrics;  ///< names of lightings, then of comparison metrics
  RankAgreement all_pairs;           ///< between all pairs of materials
  /// The mean over families of rank correlations between pairs of one family (rank_agreement_within()): a factor that
  /// sets whole families apart does not count. Empty unless there are several families, one of three or more.
  RankAgreement within_families;
};

/// A study's results, with all that is needed to repeat them.
struct StudyResult {
  Study study;                          ///< as it was computed
  DeviceInfo device;                    ///< on what
  std::vector<MetricResult> metrics;    ///< one per lighting of the study
  std::vector<Embedding> embeddings;    ///< one per lighting, of the combined distances
  std::vector<Clustering> clusterings;  ///< idem
  /// By lighting one after the other, of each one per entry of Study::approximations.
  std::vector<FamilyResiduals> residuals;
  std::vector<ComparisonResult> comparisons;  ///< one per comparison metric of the study
  MetricAgreement agreement;                  ///< empty for fewer than two metrics or three materials
  std::vector<PublishedCheck> published;      ///< one per published figure of the study
  std::vector<ChartValues> charts;            ///< one per chart of the study
  std::vector<MissedTolerance> missed;        ///< albedos of charts whose errors stay above the tolerance
  CurveAngles curve_angles;                   ///< at which angles the curves are
  std::vector<MaterialCurves> curves;         ///< one per material of the study
  std::vector<StageTime> stages;              ///< in the order in which they were done
  /// Of studies with files, one per material: JSON with file, format, conventions and remarks; empty for formulas.
  std::vector<std::string> files;
};

/// What a study asks of measure().
[[nodiscard]] MetricOptions metric_options(const Study& study);

/// Computes a study. The study in the result has its channels named and weighted, also where the given one has not.
/// \throws as measure(), compare() and family_residuals(); ArgumentError when channels and channel weights differ in
/// number, and for more clusters than
///   materials.
[[nodiscard]] StudyResult run_study(const Device& device, const Study& study, const ProgressCallback& progress = {});

/// How results are written.
struct OutputOptions {
  bool overwrite = false;          ///< replace files that exist
  std::string command_line;        ///< recorded in the file's history attribute
  ProgressCallback progress = {};  ///< asked before each picture; false: no more of them, which is no failure
};

/// Names of the tables that write_study() makes of a study, in its order: `NAME.LIGHTING.distance.csv`, `.medoids.csv`,
/// `.neighbours.csv`, `.nearest-models.csv`, `NAME.LIGHTING.FIT-residuals.csv`, `NAME.COMPARISON-METRIC.distance.csv`,
/// `NAME.agreement.csv`, `NAME.published.csv`, `NAME.chart.CHART.csv`.
[[nodiscard]] std::vector<std::string> csv_names(const Study& study);

/// Idem of the pages: NAME.published.md, where printed figures were computed again.
[[nodiscard]] std::vector<std::string> page_names(const Study& study);

/// What write_study left, and what it could not.
struct StudyFiles {
  std::filesystem::path table;               ///< NAME.h5
  std::vector<std::filesystem::path> csv;    ///< those of csv_names()
  std::vector<std::filesystem::path> pages;  ///< those of page_names()
  std::vector<std::filesystem::path>
      pictures;  ///< `NAME.LIGHTING.{distance,map,dendrogram}.png`, `NAME.chart.CHART.png` and others
  std::vector<std::filesystem::path> scripts;  ///< the gnuplot scripts and data beside the pictures
  std::string note;                            ///< why pictures are missing; empty when they are there
};

/// Writes NAME.h5 (schema lobe-study/1), the tables of csv_names(), the pages of page_names() and the pictures into a
/// directory, each by writing a temporary file and renaming it; makes the directory where there is none. Without
/// gnuplot the pictures are left out and `note` says so.
/// \throws IoError when a file exists and overwrite is false, or cannot be written; nothing half-written stays.
StudyFiles write_study(const StudyResult& result, const std::filesystem::path& directory,
                       const OutputOptions& options = {});

}  // namespace lobe
