#pragma once

#include <cstddef>
#include <filesystem>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "lobe/device/device.hpp"
#include "lobe/lut/lut.hpp"

namespace [[gnu::visibility("default")]] lobe {

/// Form of a function that stands for a lookup table: a polynomial of its arguments, or a quotient of two. A single
/// degree is the largest sum of exponents; one degree per axis is the largest exponent of each.
struct LutFitForm {
  std::vector<unsigned> numerator;         ///< degree, or degrees by axis
  std::vector<unsigned> denominator = {};  ///< degree, or degrees by axis; empty: a polynomial

  /// Whether all members are equal.
  [[nodiscard]] bool operator==(const LutFitForm&) const = default;
};

/// Reads a form: "polynomial:3" (sum of exponents), "polynomial:3,2" (by axis), "rational:2,2/1,1".
/// \throws ArgumentError for other texts, and for degrees beyond 20
[[nodiscard]] LutFitForm parse_lut_fit_form(std::string_view text);
/// Text of a form, as parse_lut_fit_form() reads it.
[[nodiscard]] std::string to_string(const LutFitForm& form);
/// Number of coefficients of a form with some number of axes; the first one of a denominator, which is 1, is none.
/// \throws ArgumentError for another number of degrees than 1 or that of the axes
[[nodiscard]] std::size_t lut_fit_size(const LutFitForm& form, std::size_t axes);

/// A function that stands for one column of a lookup table.
struct LutFitColumn {
  /// Coefficients of the powers, by exponents in lexicographic order, those of the last axis the quickest.
  std::vector<double> numerator;
  std::vector<double> denominator;  ///< likewise, the first one 1; empty for a polynomial
  double bound = 0;                 ///< no function of this form has a smaller largest error at the entries
  LutErrors errors;                 ///< in double precision; `between` and `all` as of tables, on the finer grid
  LutErrors single_errors;          ///< in single precision, arguments and coefficients rounded to it
};

/// Functions that stand for a lookup table, one per column, with the smallest largest difference from its entries.
/// Their arguments are what the entries are equally spaced in: the value of an axis, its root, square or logarithm.
struct LutFit {
  LutRequest request;                ///< definition of the table
  std::vector<std::string> columns;  ///< names of its columns
  LutFitForm form;                   ///< form of the functions
  bool is_centred = false;           ///< whether powers are those of 2 u - 1 instead of the coordinate u, from 0 to 1
  std::vector<LutFitColumn> functions;  ///< one per column
};

/// Fits functions to a lookup table. Powers are those of the coordinates u, from 0 to 1; of 2 u - 1 where single
/// precision would add more than a hundredth to the largest error, and a quarter of that or less with these.
/// \param exact a table of make_lut()
/// \param refinement steps between two entries at which errors are measured, from 1 (entries alone) to 16
/// \throws ArgumentError for a form that has too many coefficients for the entries or degrees for the axes, for a denominator
///   that has zeros between the entries, and as lut_errors(); NumericError where the fit fails
[[nodiscard]] LutFit fit_lut(const Device& device, const Lut& exact, const LutFitForm& form, unsigned refinement = 2,
                             const LutOptions& options = {});

/// Value of a function in double precision.
/// \param coordinates one per axis, from 0 to 1
[[nodiscard]] double lut_fit_value(const LutFit& fit, std::span<const double> coordinates, std::size_t column);

/// Text of a form for people: "polynomial in sqrt(alpha) and cos_theta, of degrees 3 and 2: 12 coefficients".
[[nodiscard]] std::string lut_fit_text(const LutRequest& request, const LutFitForm& form);

/// A language for functions.
enum class LutFitLanguage {
  c,      ///< C99, a function of floats for each column
  glsl,   ///< GLSL, a function for each column and one of all as a vector
  python  ///< Python, functions of numbers or NumPy arrays in double precision
};
/// Names of all languages: "c", "glsl", "python".
[[nodiscard]] std::vector<std::string_view> lut_fit_language_names();
/// Reads the name of a language.
/// \throws ArgumentError for an unknown name
[[nodiscard]] LutFitLanguage parse_lut_fit_language(std::string_view name);
/// Language by the ending of a file name: .h or .c, .glsl, .py.
/// \throws ArgumentError for another ending
[[nodiscard]] LutFitLanguage lut_fit_language_of(const std::filesystem::path& path);

/// How functions are written.
struct LutFitFileOptions {
  LutFitLanguage language = LutFitLanguage::c;  ///< their language
  std::string name = "lut";                     ///< their name, before that of the column
  std::string command_line = {};                ///< stands in the header as origin
};

/// Content of a file, whose comment states axes, conventions and errors.
/// \throws ArgumentError for a name that is no identifier, and for GLSL with more than 4 columns
[[nodiscard]] std::string lut_fit_file(const LutFit& fit, const LutFitFileOptions& options);

/// A fit of the two terms of GGX with Schlick's Fresnel term that somebody has published.
enum class PublishedLutFit {
  lazarov,   ///< Lazarov 2013, "Getting More Physical in Call of Duty: Black Ops II" (of Blinn-Phong by gloss)
  karis,     ///< Karis 2014, "Physically Based Shading on Mobile", EnvBRDFApprox()
  materialx  ///< MaterialX, mx_ggx_dir_albedo_analytic()
};
/// Names of all published fits: "lazarov", "karis", "materialx".
[[nodiscard]] std::vector<std::string_view> published_lut_fit_names();
/// Reads the name of a published fit.
/// \throws ArgumentError for an unknown name
[[nodiscard]] PublishedLutFit parse_published_lut_fit(std::string_view name);
/// Title of a published fit, with what it stands for.
[[nodiscard]] std::string published_lut_fit_text(PublishedLutFit fit);

/// Scale and bias of an albedo.
struct LutTerms {
  double scale = 0;  ///< factor of the reflectance at normal incidence
  double bias = 0;   ///< the rest
};
/// Value of a published fit. Lazarov's gloss g is that of exponent 8192^g, as alpha^2 = 2 / (exponent + 2).
[[nodiscard]] LutTerms published_lut_fit(PublishedLutFit fit, double alpha, double cos_theta);

/// Measures the errors of a published fit, by column (scale, then bias), as those of fit_lut().
/// \throws ArgumentError for a table of other columns than scale and bias, or other axes than alpha and an angle; as
///   lut_errors()
[[nodiscard]] std::vector<LutErrors> published_lut_fit_errors(const Device& device, PublishedLutFit fit,
                                                              const Lut& exact, unsigned refinement = 2,
                                                              const LutOptions& options = {});

}  // namespace lobe
