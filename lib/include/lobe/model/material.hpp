#pragma once

#include <cstddef>
#include <initializer_list>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "lobe/model/model.hpp"

namespace lobe {

/// h(L, V; values), by which a reflectance is multiplied; see factors().
struct Factor {
  std::string name;            ///< as factors() lists it
  std::vector<double> values;  ///< one per parameter of the factor, in that list's order
};

/// A reflectance in sr^-1 that is written out: the model "custom".
struct Formula {
  /// An expression in the language of docs/formulas.md, over its names and those of the parameters.
  std::string text = {};
  std::vector<std::string> parameters = {};  ///< names, at most kFormulaParameters
  /// Angle of the half-vector (radians) over which the reflectance falls by about 1/e near its peak: where quadrature
  /// starts. What is much narrower may be overlooked.
  double width = 0.1;
  bool reciprocal = true;  ///< f(L,V) = f(V,L), which adjusted() tests
  std::string file = {};   ///< where the text stands, for messages; may be empty
  unsigned line = 1;       ///< of the text in that file
  unsigned column = 1;     ///< where the text begins in that line
};

/// At most so many parameters of a formula.
inline constexpr std::size_t kFormulaParameters = 9;
/// What a term calls the model that its formula defines.
inline constexpr std::string_view kCustomModel = "custom";

/// The divisor of pumping-up, f* = f / g (Neumann 2001, eq. 2.16), a the albedo of f.
enum class Correction {
  g1,         ///< max(a(L), a(V)) (2.20)
  g2,         ///< max(a(L), a(V), N.L, N.V) (2.21); applied again and again it does not do what 2.3.2 says
  controlled  ///< of the k-th step in all G_k = max(G_(k-1) max(a(L), a(V)), N.L, N.V), for which 2.3.2 holds
};
/// "g1", "g2", "controlled".
[[nodiscard]] std::string_view to_string(Correction correction);

/// Albedos that a term is divided by, step by step, as adjusted() finds them: piecewise Chebyshev series over the
/// angle of incidence (kernels/pumping.clh), 28 times 12 numbers each.
struct Pumping {
  Correction correction = Correction::g1;    ///< which divisor
  std::vector<std::vector<double>> albedos;  ///< one curve per step
};

/// What is to be done to a material as a whole, which takes its albedo; adjusted() does it.
struct Adjustment {
  /// What is done.
  enum class Kind {
    normalise,  ///< divided by its largest albedo, up to 89.9999 degrees and over all channels
    pump,       ///< divided by `correction`, `times` in a row, channel by channel
    mirror  ///< extended by an ideal mirror with the light that it leaves, f + (1 - a) mirror (Neumann 2001, eq. 4.56)
  };
  Kind kind = Kind::normalise;             ///< what is done
  Correction correction = Correction::g1;  ///< of `pump`
  int times = 1;                           ///< of `pump`
  /// Refractive index ior - ik of the mirror (4.57); none: it reflects everything.
  std::optional<double> ior = std::nullopt;
  double k = 0;  ///< extinction coefficient of the mirror

  /// Whether all members are the same.
  [[nodiscard]] bool operator==(const Adjustment&) const = default;
};
/// What a scale of `normalise` and a step of `pump` may be off by, relative.
inline constexpr double kAdjustmentError = 2e-6;
/// "normalise", "pump:correction=g1,times=2", "mirror:ior=1.5,k=0".
[[nodiscard]] std::string to_string(const Adjustment& adjustment);
/// Reads such a text; "pump" alone is g1, once, "mirror" alone reflects everything.
/// \throws ArgumentError for an unknown word, with the nearest known one, and for a number out of range.
[[nodiscard]] Adjustment parse_adjustment(std::string_view text);

/// weight * model(values) * factors / pumping * (1 - complement_of): one lobe of a material.
struct Term {
  std::string model;           ///< name in the catalogue, or kCustomModel
  std::vector<double> values;  ///< one per parameter of the model, in the catalogue's order or that of the formula
  std::vector<double> weight;  ///< one factor, or one per channel
  std::vector<Factor> factors = {};               ///< at most three
  std::optional<Formula> formula = std::nullopt;  ///< of kCustomModel, and of no other
  std::optional<Pumping> pumping = std::nullopt;  ///< what pumping-up divides by; none: nothing
  /// Of delta parts only: an albedo over the angle of incidence, a curve as those of Pumping; empty: none.
  std::vector<double> complement_of = {};
};

/// What is known of a term's model; its factors are reciprocal, isotropic and not negative.
/// \throws ArgumentError for an unknown model
[[nodiscard]] Traits traits_of(const Term& term);

/// Names of the parameters of a term's model, one per value.
/// \throws ArgumentError for an unknown model
[[nodiscard]] std::vector<std::string> parameter_names(const Term& term);

/// A linear combination of models, f_c = sum_t weight_t[c] * model_t, for one or several channels c.
struct Material {
  std::string name;                          ///< label, unique within a study
  std::string family;                        ///< group it belongs to in tables and pictures
  std::vector<Term> terms;                   ///< what is added up
  std::vector<Adjustment> adjustments = {};  ///< in order; computations want none, see adjusted()

  /// Number of channels: the largest number of weights of any term (a single weight serves all channels).
  [[nodiscard]] std::size_t channels() const;
};

/// Name and value of a parameter.
using NamedValue = std::pair<std::string, double>;

/// A material of one term with weight 1.
/// \throws ArgumentError for an unknown model or parameter, a missing parameter, a value out of range.
[[nodiscard]] Material make_material(std::string_view model,
                                     std::initializer_list<std::pair<std::string_view, double>> parameters = {});
/// The same of parameters in a list.
[[nodiscard]] Material make_material(std::string_view model, const std::vector<NamedValue>& parameters);

/// A factor with its parameters.
/// \throws ArgumentError as make_material().
[[nodiscard]] Factor make_factor(std::string_view name, const std::vector<NamedValue>& parameters);

/// A term of weight 1 whose values may differ by channel: one term for all channels where they do not, else one per
/// channel with the weight 1 in that channel and 0 in the others.
/// \param values one per parameter given, each with one entry or as many as the others with several
/// \throws ArgumentError as make_material(), and when the numbers of entries differ
[[nodiscard]] std::vector<Term> make_terms(std::string_view model,
                                           const std::vector<std::pair<std::string, std::vector<double>>>& values);

/// Reads a specification: MODEL[:key=value,...][*FACTOR[:key=value,...]]..., where besides the model's parameters
/// `scale` multiplies the term; several terms are joined by '+', as in "lambert:scale=0.3+ward:m=0.1,scale=0.5". A
/// value with slashes has an entry per channel: "ward:m=0.1/0.12/0.2". An adjustment of the whole stands at the end:
/// "phong:n=20*cos_max@normalise". The name is the text itself.
/// \throws ArgumentError with the position and, where a word is unknown, the nearest known one.
[[nodiscard]] Material parse_material(std::string_view specification);

/// The material as JSON text: {"name", "family", "terms": [{"model", "parameters": {...}, "weight": [...]}]}; where a
/// term has them, "factors": [{"name", "parameters"}] and "formula": {"text", "width", "reciprocal"}.
[[nodiscard]] std::string to_json(const Material& material);

/// Reads what to_json() wrote; the material is the same to the last bit.
/// \throws ArgumentError for text that is no such JSON, and as make_material().
[[nodiscard]] Material material_from_json(std::string_view text);

}  // namespace lobe
