#pragma once

#include <filesystem>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include "lobe/cluster/clustering.hpp"
#include "lobe/cluster/embedding.hpp"
#include "lobe/compare/literature_metric.hpp"
#include "lobe/compare/rank_correlation.hpp"
#include "lobe/core/progress.hpp"
#include "lobe/core/tolerance.hpp"
#include "lobe/device/device.hpp"
#include "lobe/fit/approximation.hpp"
#include "lobe/formats/measured.hpp"
#include "lobe/hemisphere/grid.hpp"
#include "lobe/metric/metric.hpp"
#include "lobe/model/label.hpp"
#include "lobe/model/material.hpp"
#include "lobe/study/chart.hpp"
#include "lobe/study/material_curves.hpp"
#include "lobe/study/published.hpp"

namespace [[gnu::visibility("default")]] lobe {

/// Constraints on the combinations of a family's materials by which families represent materials (family_residuals()).
enum class FamilyFit {
  linear,       ///< any
  non_negative  ///< combinations without negative coefficients
};
/// Name of a fit: "linear" or "non-negative".
[[nodiscard]] std::string_view to_string(FamilyFit fit);

/// A file used as a material, a measured file or a table.
struct MaterialFile {
  std::filesystem::path path;  ///< path of the file
  std::string name;            ///< name as in the study file, for results
  ReadOptions options;         ///< options for reading it
};

/// A material of a study: a formula, or a file that is read when the study is computed.
class StudyMaterial {
 public:
  /// Makes a material of a formula, with the formula's name and family.
  StudyMaterial(Material formula);  // NOLINT(google-explicit-constructor)
  /// Makes a material of a file.
  StudyMaterial(MaterialLabel label, MaterialFile file);
  /// Makes a material of which only name and family are known: a formula in results of another version.
  explicit StudyMaterial(MaterialLabel label);

  [[nodiscard]] const MaterialLabel& label() const { return label_; }        ///< name and family
  [[nodiscard]] const std::string& name() const { return label_.name; }      ///< distinct within the study
  [[nodiscard]] const std::string& family() const { return label_.family; }  ///< the family's name
  [[nodiscard]] const Material* formula() const;                             ///< null for all but formulas
  [[nodiscard]] const MaterialFile* file() const;                            ///< null for all but files

 private:
  MaterialLabel label_;
  std::variant<std::monostate, Material, MaterialFile> content_;
};

/// A text file from which a study was read.
struct StudyText {
  std::string name;  ///< without folders; for an included file, its path from the study file's folder
  std::string text;  ///< its whole text
};

/// Origin of a part of a study.
struct Origin {
  std::string file;                    ///< a name in Study::texts; empty: in no file
  std::size_t line = 0;                ///< line from 1 on: the heading of a [[family]], or the row
  std::string swept;                   ///< values that distinguish it from others with its line: "m=0.1, scale=0.5"
  std::vector<std::string> overrides;  ///< keys set from outside that changed it: "family.Ward.m"
};
/// Text of an origin: "gloss.toml:6 (m=0.1), --set family.Ward.m"; "default" if no file states it.
[[nodiscard]] std::string to_string(const Origin& origin);

/// Origins of the parts of a study: as many as there are parts, or none for studies made in code.
struct StudyOrigins {
  std::vector<Origin> materials;            ///< the tables or rows that define them
  std::vector<Origin> lightings;            ///< the keys that request them
  std::vector<Origin> comparison_metrics;   ///< the keys that request them
  std::vector<Origin> published;            ///< the tables or rows of the figures
  std::vector<Origin> charts;               ///< their tables
  std::vector<std::vector<Origin>> curves;  ///< by chart
  std::optional<Origin> grid;               ///< the key that names it
};

/// A study: a set of materials and the computations on them; the content of a study file (docs/study-files.md).
struct Study {
  std::string name;                      ///< stem of the output files
  std::string title;                     ///< for people
  std::string comment;                   ///< for people
  std::vector<std::string> references;   ///< citations of the material data
  std::vector<std::string> channels;     ///< names; load_study: a single "value" if the file names none
  std::vector<double> channel_weights;   ///< one per channel; empty: equal, with sum 1
  std::vector<StudyMaterial> materials;  ///< in file order, a family's materials together
  /// Grid on which materials are tabulated to be measured; none: as choose_route() decides.
  std::optional<HemisphereGrid> grid;
  bool allow_unresolved = false;                                   ///< keep tables that the grid does not resolve
  std::vector<Lighting> lightings;                                 ///< lightings of the distances
  std::vector<MaterialFile> lighting_files;                        ///< files among the lightings, in their order
  std::vector<PublishedFigure> published;                          ///< printed numbers to compute again
  std::vector<Chart> charts;                                       ///< curves to draw
  double tolerance = MetricOptions{}.tolerance;                    ///< for scalar products, as in MetricOptions
  double patch_tolerance = MetricOptions{}.patch_tolerance;        ///< for patch lights, if larger
  double function_tolerance = MetricOptions{}.function_tolerance;  ///< for files, as in MetricOptions
  double domain_theta_max = MetricOptions{}.theta_max;             ///< domain of scalar products, as in MetricOptions
  std::vector<LiteratureMetric> comparison_metrics;                ///< distances from the literature, in addition
  double comparison_tolerance = LiteratureOptions{}.tolerance;     ///< as in LiteratureOptions
  std::vector<FamilyFit> approximations;              ///< every material by every family, under each lighting
  Precision precision = Precision::double_precision;  ///< arithmetic of the models
  ClusteringOptions clustering;                       ///< options for trees and representatives
  /// Equivalent study file: the file's text or, with includes and values set from outside, all written out as one file.
  std::string configuration;
  std::vector<StudyText> texts;        ///< the study file, then those it includes, unchanged
  std::vector<std::string> overrides;  ///< as given to load_study()
  StudyOrigins origins;                ///< where in these texts its parts stand
};

/// Lists names and families of a study's materials, in their order.
[[nodiscard]] std::vector<MaterialLabel> labels(const Study& study);
/// Lists the formulas among a study's materials, in their order.
[[nodiscard]] std::vector<Material> formulas(const Study& study);
/// Counts the files among a study's materials.
[[nodiscard]] std::size_t count_files(const Study& study);

/// Reads a study file and the files that it includes.
/// \param overrides values set from outside, "KEY=VALUE" each, in this order: "study.tolerance=1e-4",
///   "family.Ward.m.count=20", "chart.gloss.curves.0.n=30"; VALUE is TOML, texts may stand without quotes
/// \throws IoError if it cannot be read; ArgumentError "FILE:LINE:COLUMN: ..." for any mistake in it, "--set KEY=VALUE:
///   ..." for a mistake in an override
[[nodiscard]] Study load_study(const std::filesystem::path& path, std::span<const std::string> overrides = {});

/// Whether a TOML file is a study file rather than a material file: it has a [study], a [[family]], [[material]],
/// [[measured]], [[published]] or [[chart]], or includes files.
/// \throws as load_study() if it is not TOML
[[nodiscard]] bool is_study_file(const std::filesystem::path& path);

/// Reads a material file (a study file's [[material]] table without the brackets).
/// \throws as load_study()
[[nodiscard]] Material load_material_file(const std::filesystem::path& path);

/// Time spent in one stage of a run.
struct StageTime {
  std::string stage;   ///< name of the stage
  double seconds = 0;  ///< its duration
};

/// Agreement of the study's metrics in ranking its pairs of materials by their combined distances.
struct MetricAgreement {
  std::vector<std::string> metrics;  ///< names of lightings, then of comparison metrics
  RankAgreement all_pairs;           ///< over all pairs of materials
  /// Mean over families of the rank correlations between pairs within one family (rank_agreement_within()), in which a
  /// factor that shifts whole families does not count. Empty unless there are several families, one of them with three
  /// or more materials.
  RankAgreement within_families;
};

/// How a file of results was written.
struct StudyProvenance {
  std::string software_version;  ///< version of lobe
  std::string commit;            ///< commit of the build, if known
  std::string hdf5_version;      ///< version of the library that wrote the file
  std::string command_line;      ///< command line of `lobe run`
  std::string created;           ///< ISO 8601
  bool states_grid = true;       ///< whether the file says on which grid, if any; older ones do not
};

/// A study's results, with everything needed to repeat them. run_study() computes them, write_study() writes them, and
/// load_study_results() reads them.
struct StudyResult {
  Study study;                          ///< the study as it was computed
  StudyProvenance provenance;           ///< empty in results that were not read from a file
  DeviceInfo device;                    ///< the device that computed it
  std::vector<MetricResult> metrics;    ///< one per lighting of the study
  std::vector<Embedding> embeddings;    ///< one per lighting, from the combined distances
  std::vector<Clustering> clusterings;  ///< one per lighting, from the combined distances
  /// Family residuals, lighting by lighting, one per entry of Study::approximations for each.
  std::vector<FamilyResiduals> residuals;
  std::vector<LiteratureResult> comparisons;  ///< one per comparison metric of the study
  MetricAgreement agreement;                  ///< empty for fewer than two metrics or three materials
  std::vector<PublishedCheck> published;      ///< one per published figure of the study
  std::vector<ChartValues> charts;            ///< one per chart of the study
  std::vector<MissedTolerance> missed;        ///< albedos of charts whose errors stay above the tolerance
  CurveAngles curve_angles;                   ///< angles of the curves
  std::vector<MaterialCurves> curves;         ///< one per material of the study
  std::vector<StageTime> stages;              ///< stages in the order of computation
  /// In studies with files, one text per material: JSON with file, format, conventions and remarks; empty for formulas.
  /// In results that were read, also the JSON of formulas with models that this version does not know.
  std::vector<std::string> files;
};

/// Options for measure() that a study requests.
[[nodiscard]] MetricOptions metric_options(const Study& study);

/// Runs a study. The study in the result has its channels named and weighted, even if the given one has not.
/// \throws as load_reflectance(), measure(), compare() and family_residuals(); ArgumentError if channels and channel
///   weights differ in number, and for more clusters than materials
[[nodiscard]] StudyResult run_study(const Device& device, const Study& study, const ProgressCallback& progress = {});

/// Options for writing results.
struct OutputOptions {
  bool overwrite = false;          ///< replace files that exist
  std::string command_line;        ///< recorded in the file's history attribute
  ProgressCallback progress = {};  ///< called before each picture; return false to stop drawing, which is not an error
};

/// Names of the tables that write_study() writes for a study, in its order: `NAME.LIGHTING.distance.csv`,
/// `.medoids.csv`, `.neighbours.csv`, `.nearest-models.csv`, `NAME.LIGHTING.FIT-residuals.csv`,
/// `NAME.COMPARISON-METRIC.distance.csv`, `NAME.agreement.csv`, `NAME.published.csv`, `NAME.chart.CHART.csv`.
[[nodiscard]] std::vector<std::string> csv_names(const Study& study);

/// Names of the pages that write_study() writes for a study: NAME.published.md, if it recomputes printed figures.
[[nodiscard]] std::vector<std::string> page_names(const Study& study);

/// Files that write_study() wrote, and why others are missing.
struct StudyFiles {
  std::filesystem::path table;               ///< NAME.h5
  std::vector<std::filesystem::path> csv;    ///< files named by csv_names()
  std::vector<std::filesystem::path> pages;  ///< files named by page_names()
  std::vector<std::filesystem::path>
      pictures;  ///< `NAME.LIGHTING.{distance,map,dendrogram}.png`, `NAME.chart.CHART.png` and others
  std::vector<std::filesystem::path> scripts;  ///< the gnuplot scripts and data beside the pictures
  std::string note;                            ///< why pictures are missing; empty if none are
};

/// Writes NAME.h5 (schema lobe-study/1), the tables of csv_names(), the pages of page_names() and the pictures into a
/// directory, each by writing a temporary file and renaming it; creates the directory if needed. Without gnuplot the
/// pictures are left out and `note` says so.
/// \throws IoError if a file exists and overwrite is false, or if it cannot be written; nothing half-written stays
StudyFiles write_study(const StudyResult& result, const std::filesystem::path& directory,
                       const OutputOptions& options = {});

}  // namespace lobe
