#pragma once

#include <limits>
#include <optional>
#include <span>
#include <string_view>
#include <vector>

namespace [[gnu::visibility("default")]] lobe {

/// One free parameter of a reflectance model.
struct Parameter {
  std::string_view name;                                     ///< name as written in a specification
  std::string_view unit;                                     ///< "1", "rad", ...
  double minimum = 0;                                        ///< smallest allowed value
  double maximum = std::numeric_limits<double>::infinity();  ///< largest allowed value
  std::optional<double> default_value;                       ///< none: the parameter must be given
  std::string_view description;                              ///< its meaning, one phrase
};

/// Properties of a model that hold for all values of its parameters.
struct Traits {
  bool isotropic = true;         ///< invariant under rotation about the normal
  bool reciprocal = true;        ///< f(L, V) = f(V, L)
  bool conserves_energy = true;  ///< albedo <= 1 for every direction, at scale 1
  bool has_delta = false;        ///< contains a mirror or retro-reflecting delta part
  bool non_negative = true;      ///< no value below 0
};

/// An entry of the catalogue. Values are in sr^-1.
struct Model {
  std::string_view name;              ///< as written in a material specification
  std::string_view family;            ///< label of its kind, for example "Cook-Torrance"
  std::string_view formula;           ///< f(L, V) in the notation of docs/conventions.md
  std::string_view source;            ///< publication and equation, with every deviation from the printed version
  std::vector<Parameter> parameters;  ///< in the order of their values
  Traits traits;                      ///< its properties for all parameter values
};

/// Lists all models, in alphabetical order of their names.
[[nodiscard]] std::span<const Model> catalogue();

/// Finds a model by its name.
/// \throws ArgumentError for an unknown name, with the nearest known one.
[[nodiscard]] const Model& find_model(std::string_view name);

/// Name of the function in kernels/models/NAME.clh that computes a model (NAME_anisotropic if the model sees azimuths);
/// empty for delta parts.
/// \throws ArgumentError for an unknown name, with the nearest known one
[[nodiscard]] std::string_view kernel_name(std::string_view model);

/// A function h(L, V) that may multiply a reflectance. It is reciprocal, isotropic and not negative.
struct FactorModel {
  std::string_view name;              ///< as written in a specification
  std::string_view formula;           ///< h(L, V)
  std::string_view source;            ///< publication and equation, with every deviation from the printed version
  std::vector<Parameter> parameters;  ///< in the order of their values
};

/// Lists all factors, in alphabetical order of their names.
[[nodiscard]] std::span<const FactorModel> factors();

/// Finds a factor by its name.
/// \throws ArgumentError for an unknown name, with the nearest known one.
[[nodiscard]] const FactorModel& find_factor(std::string_view name);

}  // namespace lobe
