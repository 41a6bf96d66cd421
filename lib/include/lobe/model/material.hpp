#pragma once

#include <cstddef>
#include <initializer_list>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "lobe/model/model.hpp"

namespace [[gnu::visibility("default")]] lobe {

/// A factor h(L, V; values) that multiplies a reflectance; see factors().
struct Factor {
  std::string name;            ///< as factors() lists it
  std::vector<double> values;  ///< one per parameter, in the order of factors()
};

/// A reflectance in sr^-1 written as a formula: the model "custom".
struct Formula {
  /// Expression in the language of docs/formulas.md, using its names and the parameters.
  std::string text = {};
  std::vector<std::string> parameters = {};  ///< names of the parameters, at most kFormulaParameters
  /// Angle of the half-vector (radians) over which the reflectance falls by about 1/e near its peak, from which
  /// quadrature starts. Much narrower features may be missed.
  double width = 0.1;
  bool reciprocal = true;  ///< whether f(L,V) = f(V,L), which adjusted() tests
  std::string file = {};   ///< file that contains the text, for messages; may be empty
  unsigned line = 1;       ///< line of the text in that file
  unsigned column = 1;     ///< column in that line where the text begins
};

/// Largest number of parameters of a formula.
inline constexpr std::size_t kFormulaParameters = 9;
/// Model name of a term with a formula.
inline constexpr std::string_view kCustomModel = "custom";

/// The divisor g in pumping-up, f* = f / g (Neumann 2001, eq. 2.16), with a the albedo of f.
enum class Correction {
  g1,          ///< max(a(L), a(V)) (2.20)
  g2,          ///< max(a(L), a(V), N.L, N.V) (2.21); applied repeatedly it does not behave as 2.3.2 says
  controlled,  ///< k steps divide by G_k = max(G_(k-1) max(a(L), a(V)), N.L, N.V) in all, for which 2.3.2 holds
  complement,  ///< 1 / ((1 - a(L)) (1 - a(V))): the share that is left over at both ends, for `kulla_conty` only
  viewer       ///< the curve at V alone, for `turquin` only: what it divides is not reciprocal
};
/// Name of a correction: "g1", "g2", "controlled", "complement" or "viewer".
[[nodiscard]] std::string_view to_string(Correction correction);

/// Albedos by which a term is divided, step by step, as found by adjusted(): piecewise Chebyshev series over the angle
/// of incidence (kernels/lobes/pumping.clh), 28 times 12 numbers each.
struct Pumping {
  Correction correction = Correction::g1;    ///< the divisor
  std::vector<std::vector<double>> albedos;  ///< one curve per step
};

/// An adjustment of a material as a whole, which needs its albedo; adjusted() applies it.
struct Adjustment {
  /// Kinds of adjustments.
  enum class Kind {
    normalise,  ///< divide by the largest albedo up to 89.9999 degrees, over all channels
    pump,       ///< divide by `correction`, `times` in a row, channel by channel
    mirror,     ///< add an ideal mirror for the light that is left, f + (1 - a) mirror (Neumann 2001, eq. 4.56)
    /// add what facets scatter more than once (Kulla and Conty 2017; Kelemen and Szirmay-Kalos 2001): f + m (1 - a(L))
    /// (1 - a(V)) / (pi (1 - A)), m = F^2 A / (1 - F (1 - A)), with a and A albedo and mean albedo of the model for f0
    /// = 1, F = f0 + (1 - f0)/21 the mean of Schlick's Fresnel term, 1 for models without
    kulla_conty,
    /// scale towards the viewer (Turquin 2019): f (1 + F (1 - a(V)) / a(V)), with a the albedo of the model for f0 = 1,
    /// F = f0, or a Fresnel term's value at the normal, 1 for models without; not reciprocal
    turquin
  };
  Kind kind = Kind::normalise;             ///< the kind of adjustment
  Correction correction = Correction::g1;  ///< the divisor for `pump`
  int times = 1;                           ///< number of steps for `pump`
  /// Refractive index ior - ik of the mirror (4.57); without it the mirror reflects everything.
  std::optional<double> ior = std::nullopt;
  double k = 0;  ///< extinction coefficient of the mirror

  /// Whether all members are equal.
  [[nodiscard]] bool operator==(const Adjustment&) const = default;
};
/// Relative error that a scale of `normalise` and a step of `pump` may have.
inline constexpr double kAdjustmentError = 2e-6;
/// Text of an adjustment: "normalise", "pump:correction=g1,times=2", "mirror:ior=1.5,k=0", "kulla_conty", "turquin".
[[nodiscard]] std::string to_string(const Adjustment& adjustment);
/// Reads an adjustment as to_string() writes it; "pump" alone is g1, once, and "mirror" alone reflects everything.
/// \throws ArgumentError for an unknown word, with the nearest known one, and for a number out of range
[[nodiscard]] Adjustment parse_adjustment(std::string_view text);

/// One lobe of a material: weight * model(values) * factors / pumping * (1 - complement_of).
struct Term {
  std::string model;                 ///< name in the catalogue, or kCustomModel
  std::vector<double> values;        ///< one per parameter of the model, in the order of the catalogue or the formula
  std::vector<double> weight;        ///< one factor for all channels, or one per channel
  std::vector<Factor> factors = {};  ///< at most three
  std::optional<Formula> formula = std::nullopt;  ///< the formula if the model is kCustomModel, else none
  std::optional<Pumping> pumping = std::nullopt;  ///< divisor of pumping-up; none: not pumped up
  /// For delta parts only: an albedo over the angle of incidence, as a curve like those of Pumping; empty: none.
  std::vector<double> complement_of = {};
};

/// Traits of a term: those of its model, not reciprocal where it is divided by a curve at V. Its factors are
/// reciprocal, isotropic and not negative.
/// \throws ArgumentError for an unknown model
[[nodiscard]] Traits traits_of(const Term& term);

/// Names of the parameters of a term's model, one per value.
/// \throws ArgumentError for an unknown model
[[nodiscard]] std::vector<std::string> parameter_names(const Term& term);

/// A linear combination of models, f_c = sum_t weight_t[c] * model_t, for one or several channels c.
struct Material {
  std::string name;                          ///< label, unique within a study
  std::string family;                        ///< group it belongs to in tables and pictures
  std::vector<Term> terms;                   ///< the terms of the sum
  std::vector<Adjustment> adjustments = {};  ///< in order; computations need none, see adjusted()

  /// Number of channels: the largest number of weights of any term (a single weight serves all channels).
  [[nodiscard]] std::size_t channels() const;
};

/// A parameter's name and value.
using NamedValue = std::pair<std::string, double>;

/// Makes a material of one term with weight 1.
/// \throws ArgumentError for an unknown model or parameter, a missing parameter, or a value out of range
[[nodiscard]] Material make_material(std::string_view model,
                                     std::initializer_list<std::pair<std::string_view, double>> parameters = {});
/// Makes a material of one term, with its parameters in a list.
[[nodiscard]] Material make_material(std::string_view model, const std::vector<NamedValue>& parameters);

/// Makes a factor with its parameters.
/// \throws ArgumentError as make_material()
[[nodiscard]] Factor make_factor(std::string_view name, const std::vector<NamedValue>& parameters);

/// Makes terms of weight 1 for a model whose values may differ by channel: a single term if they do not, otherwise one
/// term per channel with weight 1 in that channel and 0 in the others.
/// \param values one list per given parameter, each with one entry, or all longer lists with the same number of entries
/// \throws ArgumentError as make_material(), and if the numbers of entries differ
[[nodiscard]] std::vector<Term> make_terms(std::string_view model,
                                           const std::vector<std::pair<std::string, std::vector<double>>>& values);

/// Reads a specification: MODEL[:key=value,...][*FACTOR[:key=value,...]].... Besides the model's parameters, the key
/// `scale` multiplies the term. Terms are joined by '+', as in "lambert:scale=0.3+ward:m=0.1,scale=0.5". A value with
/// slashes has an entry per channel: "ward:m=0.1/0.12/0.2". Adjustments of the whole stand at the end:
/// "phong:n=20*cos_max@normalise". The material is named after the text.
/// \throws ArgumentError with the position and, for an unknown word, the nearest known one
[[nodiscard]] Material parse_material(std::string_view specification);

/// Writes a material as JSON text: {"name", "family", "terms": [{"model", "parameters": {...}, "weight": [...]}]}, plus
/// "factors": [{"name", "parameters"}] and "formula": {"text", "width", "reciprocal"} for terms that have them.
[[nodiscard]] std::string to_json(const Material& material);

/// Reads a material from the JSON of to_json(); it is identical to the last bit.
/// \throws ArgumentError for text that is not such JSON, and as make_material()
[[nodiscard]] Material material_from_json(std::string_view text);

}  // namespace lobe
