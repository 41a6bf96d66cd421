#pragma once

#include <array>
#include <cstddef>
#include <span>
#include <string_view>

/// The keys of study files, table by table: those that readers know and that study_schema() describes to editors.
namespace lobe {

/// Kind of a key's value, from which the schema describes it.
enum class KeyValue {
  text,
  texts,
  truth,
  number,
  stem,            ///< a text that file names may begin with
  plain_name,      ///< a text that file names may contain
  channels,        ///< distinct texts, at least one
  channel_choice,  ///< texts and whole numbers from 1 on
  weights,         ///< numbers from 0 on, not all 0
  lightings,
  comparisons,
  fits,  ///< of FamilyFit
  tolerance,
  count,  ///< a whole number from 1 on
  precision,
  grid,
  files,  ///< a pattern of paths, or several
  luminance,
  degrees,  ///< in (0, 90]
  wavelengths,
  model,
  formula_width,
  points,  ///< pairs of numbers
  weight,  ///< a number, or one per channel
  factors,
  adjustments,
  pumping,
  zip,
  columns,
  rows,
  terms,
  term,
  curves,
  chart_quantity,
  published_quantity,
  angle,       ///< degrees in [0, 90)
  directions,  ///< [theta_in, theta_out, delta_phi] in degrees
  numbers,
  printed,    ///< a decimal number as a text
  corrected,  ///< the same, or empty
  abscissae,
  range,  ///< [lowest, highest]
  correction,
  albedos,
  table,
  tables  ///< tables headed [[key]]
};

struct Key {
  std::string_view name;
  KeyValue value;
  std::string_view meaning;  ///< a phrase, for editors
};

inline constexpr auto kFileKeys = std::to_array<Key>({
    {"include", KeyValue::texts, "other study files whose materials and settings are taken in"},
    {"study", KeyValue::table, "what to compute, and how"},
    {"family", KeyValue::tables, "materials of one kind: a sweep of a model's parameters, or a table of fits"},
    {"material", KeyValue::tables, "one material"},
    {"measured", KeyValue::tables, "materials that are files of measurements or tables"},
    {"published", KeyValue::tables, "printed figures to compute again"},
    {"chart", KeyValue::tables, "curves over an angle or a parameter"},
});

inline constexpr auto kStudyKeys = std::to_array<Key>({
    {"name", KeyValue::stem, "stem of the output files (default: that of this file)"},
    {"title", KeyValue::text, "title of pictures and tables (default: the name)"},
    {"comment", KeyValue::text, "goes into the result"},
    {"references", KeyValue::texts, "citations of the material data; go into the result"},
    {"channels", KeyValue::channels, "names of the channels, for example [\"r\", \"g\", \"b\"] (default: one)"},
    {"channel_weights", KeyValue::weights, "weight of each channel in the combined product (default: equal)"},
    {"lightings", KeyValue::lightings, "what distances are taken under (default: point and daylight)"},
    {"tolerance", KeyValue::tolerance, "largest error estimate of a product, relative to it (default: 1e-6)"},
    {"domain_theta_max", KeyValue::degrees, "largest angle from the normal that products reach to (default: 90)"},
    {"precision", KeyValue::precision, "arithmetic of the models; sums are in double either way (default: double)"},
    {"clusters", KeyValue::count, "number of clusters and medoids (default: by the largest mean silhouette)"},
    {"neighbours", KeyValue::count, "how many nearest materials are listed for each (default: 3)"},
    {"function_tolerance", KeyValue::tolerance, "the tolerance of products of files (default: 5e-3)"},
    {"patch_tolerance", KeyValue::tolerance, "the tolerance of patch lights, where it is larger (default: 1e-5)"},
    {"comparison_metrics", KeyValue::comparisons, "distances of the literature to hold the lightings against"},
    {"comparison_tolerance", KeyValue::tolerance,
     "largest relative error of these, but for 1 pair in 100 (default: 1e-3)"},
    {"approximations", KeyValue::fits, "how well every family represents every material under each lighting"},
    {"grid", KeyValue::grid, "grid to tabulate all materials on (default: by their formulas and functions)"},
    {"allow_unresolved", KeyValue::truth, "keep materials that the grid does not resolve (default: false)"},
});

/// Keys of a [[family]] without rows, beside its terms.
inline constexpr auto kSweepKeys = std::to_array<Key>({
    {"name", KeyValue::text, "name of the family"},
    {"label", KeyValue::text, "pattern of the materials' names; {family} and {parameter} are replaced"},
    {"zip", KeyValue::zip,
     "true: first values together, second values together, ...; or groups of names that go together"},
    {"adjustments", KeyValue::adjustments, "done to every material as a whole, in order"},
});

/// Keys of a [[family]] with rows, beside its terms.
inline constexpr auto kFitKeys = std::to_array<Key>({
    {"name", KeyValue::text, "name of the family"},
    {"label", KeyValue::text, "pattern of the materials' names; {family} and {column} are replaced"},
    {"columns", KeyValue::columns, "names of the columns, one of them \"name\"; \"$column\" stands for the entry"},
    {"rows", KeyValue::rows, "a list of entries for each material, one per column"},
    {"adjustments", KeyValue::adjustments, "done to every material as a whole, in order"},
});

/// Beside the terms.
inline constexpr auto kMaterialKeys = std::to_array<Key>({
    {"name", KeyValue::text, "name of the material"},
    {"family", KeyValue::text, "family that it is shown under (default: the kind of its model)"},
    {"adjustments", KeyValue::adjustments, "done to the material as a whole, in order"},
});

inline constexpr auto kTermKeys = std::to_array<Key>({
    {"model", KeyValue::model, "model of the catalogue ('lobe models'), or custom, profile, mixture"},
    {"scale", KeyValue::weight,
     "a number to multiply with, or one per channel (default: 1); beside rows also a product, \"1.27 * $ks\""},
    {"factor", KeyValue::number, "in older files: one more number to multiply with; write it into 'scale'"},
    {"factors", KeyValue::factors, "up to three functions that multiply the model"},
    {"pumping", KeyValue::pumping, "pumping-up as lobe writes it into material files"},
});

/// Instead of those of a term.
inline constexpr std::string_view kTermsKey = "terms";

/// Keys for model = "custom", beside the parameters that the formula uses.
inline constexpr auto kFormulaKeys = std::to_array<Key>({
    {"formula", KeyValue::text, "an expression in sr^-1 (docs/formulas.md)"},
    {"width", KeyValue::formula_width, "width of its narrowest lobe, rad"},
    {"reciprocal", KeyValue::truth, "f(L, V) = f(V, L) (default: true)"},
});

/// Keys for model = "profile" and "mixture".
inline constexpr auto kCurveModelKeys = std::to_array<Key>({
    {"points", KeyValue::points, "[distance in the base plane, value], ascending"},
});

inline constexpr auto kPumpingKeys = std::to_array<Key>({
    {"correction", KeyValue::correction, "what the material is divided by"},
    {"albedos", KeyValue::albedos, "albedos of each step"},
});

inline constexpr auto kMeasuredKeys = std::to_array<Key>({
    {"name", KeyValue::text, "name of the material of one file (default: stem of the file)"},
    {"family", KeyValue::text, "family that they are shown under (default: measured)"},
    {"file", KeyValue::text,
     "path of one file, from the folder of the study file; $NAME/ in front: an environment variable; [KEY=VALUE,...] "
     "behind it: options of this file"},
    {"files", KeyValue::files, "instead of file: a path with *, ?, [...], or several; every file is a material"},
    {"label", KeyValue::text, "pattern of the materials' names with {name}, the stem, and {family} (default: {name})"},
    {"channels", KeyValue::channel_choice, "names of the channels wanted, or numbers from 1 on"},
    {"luminance", KeyValue::luminance, "instead of channels: one, rec709 of red, green, blue or photopic of spectra"},
    {"component", KeyValue::text, "of files with several reflectances: \"reflection front\", \"reflection back\""},
    {"theta_max", KeyValue::degrees, "degrees up to which the file counts; beyond, values are those there"},
    {"wavelengths", KeyValue::wavelengths, "nm; instead of channels, those wavelengths of spectra"},
    {"srgb", KeyValue::truth, "true: values are sRGB-encoded (UTIA)"},
    {"entry", KeyValue::text, "function of a shader (default: the last one of two directions)"},
    {"uniforms", KeyValue::texts, "of shaders: \"NAME=VALUE\", or \"NAME=A/B/C\" for a vector"},
});

/// Beside the terms.
inline constexpr auto kPublishedKeys = std::to_array<Key>({
    {"title", KeyValue::text, "what the figures are printed in"},
    {"quantity", KeyValue::published_quantity, "what the figures are"},
    {"label", KeyValue::text, "pattern of the figures' names, in which every column may be used"},
    {"theta", KeyValue::angle, "of albedos: angle of incidence in degrees"},
    {"at", KeyValue::directions, "of reflectances: [theta_in, theta_out, delta_phi] in degrees"},
    {"coefficients", KeyValue::numbers, "of reflectances: a factor per entry of at (default: 1)"},
    {"unit", KeyValue::term, "a term; the quantity is divided by its f(N, N)"},
    {"offset", KeyValue::number, "a number to add at last"},
    {"tolerance", KeyValue::tolerance, "of albedos, relative, instead of the study's"},
    {"columns", KeyValue::columns, "names of the columns; \"$column\" stands for the entry"},
    {"rows", KeyValue::rows, "a list of entries for each figure, one per column"},
    {"printed", KeyValue::printed, "the figure as printed: its digits count"},
    {"corrected", KeyValue::corrected, "what should be printed, where that differs"},
});

inline constexpr auto kChartKeys = std::to_array<Key>({
    {"name", KeyValue::plain_name, "stands in the names of the files; no blanks, no /"},
    {"title", KeyValue::text, "title of the picture (default: the name)"},
    {"quantity", KeyValue::chart_quantity, "what the curves show"},
    {"parameter", KeyValue::text, "of mean albedos: which parameter x are values of"},
    {"x", KeyValue::abscissae, "abscissae, ascending; angles in degrees (default: dense towards grazing angles)"},
    {"curves", KeyValue::curves, "materials, each with a label"},
    {"log_x", KeyValue::truth, "logarithmic axis; of angles of incidence that of 90 - theta (default: false)"},
    {"log_y", KeyValue::truth, "logarithmic axis (default: false)"},
    {"tolerance", KeyValue::tolerance, "of albedos, relative (default: the study's)"},
    {"unit", KeyValue::term, "a term; values are divided by its f(N, N)"},
    {"y_range", KeyValue::range, "[lowest, highest] value shown"},
});

/// Beside the terms.
inline constexpr auto kCurveKeys = std::to_array<Key>({
    {"label", KeyValue::text, "name of the curve"},
    {"theta_in", KeyValue::angle, "of reflectances and radiances: angle of incidence in degrees"},
    {"adjustments", KeyValue::adjustments, "done to the material as a whole, in order"},
});

/// Keys of a parameter's values in a family.
inline constexpr auto kRangeKeys = std::to_array<Key>({
    {"values", KeyValue::numbers, "the values"},
    {"linspace", KeyValue::range, "[first, last]: equal steps, both ends included"},
    {"logspace", KeyValue::range, "[first, last]: equal ratios, both ends included"},
    {"count", KeyValue::count, "how many values a range has"},
});

/// The names that the key `quantity` takes, in the order of PublishedQuantity and of ChartQuantity.
[[nodiscard]] std::span<const std::string_view> published_quantities();
[[nodiscard]] std::span<const std::string_view> chart_quantities();

/// The names alone, as toml_reader::require_known_keys() takes them.
template <std::size_t N>
constexpr std::array<std::string_view, N> names_of(const std::array<Key, N>& keys) {
  std::array<std::string_view, N> names;
  for (std::size_t i = 0; i < N; ++i) names[i] = keys[i].name;
  return names;
}

}  // namespace lobe
