#pragma once

#include <cstddef>
#include <initializer_list>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace lobe {

/// weight * model(values): one lobe of a material.
struct Term {
  std::string model;           ///< name in the catalogue
  std::vector<double> values;  ///< one per parameter of the model, in the catalogue's order
  std::vector<double> weight;  ///< one factor, or one per channel
};

/// A linear combination of models, f_c = sum_t weight_t[c] * model_t, for one or several channels c.
struct Material {
  std::string name;    ///< label, unique within a study
  std::string family;  ///< group it belongs to in tables and pictures
  std::vector<Term> terms;

  /// Number of channels: the largest number of weights of any term (a single weight serves all channels).
  [[nodiscard]] std::size_t channels() const;
};

/// A material of one term with weight 1.
/// \throws ArgumentError for an unknown model or parameter, a missing parameter, a value out of range.
[[nodiscard]] Material make_material(std::string_view model,
                                     std::initializer_list<std::pair<std::string_view, double>> parameters = {});
[[nodiscard]] Material make_material(std::string_view model,
                                     const std::vector<std::pair<std::string, double>>& parameters);

/// Reads a specification: MODEL[:key=value,...], where besides the model's parameters `scale` multiplies the term;
/// several terms are joined by '+', as in "lambert:scale=0.3+ward:m=0.1,scale=0.5". The name is the text itself.
/// \throws ArgumentError with the position and, where a word is unknown, the nearest known one.
[[nodiscard]] Material parse_material(std::string_view specification);

/// The material as JSON text: {"name", "family", "terms": [{"model", "parameters": {...}, "weight": [...]}]}.
[[nodiscard]] std::string to_json(const Material& material);

/// Reads what to_json() wrote; the material is the same to the last bit.
/// \throws ArgumentError for text that is no such JSON, and as make_material().
[[nodiscard]] Material material_from_json(std::string_view text);

}  // namespace lobe
