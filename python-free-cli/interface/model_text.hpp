#pragma once

#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "lobe/model/model.hpp"

namespace lobe::cli {

/// A bound of a range, short: "1e10" instead of "1e+10".
[[nodiscard]] std::string bound_text(double value);

/// A specification of the model with values that make sense.
[[nodiscard]] std::string example_specification(const Model& model);

/// "isotropic, reciprocal, conserves energy".
[[nodiscard]] std::string traits_text(const Traits& traits);

/// "n, f0"; "-" for none.
[[nodiscard]] std::string names_of(std::span<const Parameter> parameters);

/// The start of a source without its remarks: "Burley 2012, section 5.3"; for the dissertation "eq. 4.2 and 4.7".
[[nodiscard]] std::string_view citation(const Model& model);

/// Chapter of the dissertation whose equation a source cites first; 0 beyond it.
[[nodiscard]] int chapter_of(const Model& model);

/// The models that a source places in a chapter.
struct Chapter {
  std::string_view title;
  std::vector<const Model*> models;
};

/// The catalogue by chapters of the dissertation, what goes beyond it last.
[[nodiscard]] std::vector<Chapter> chapters();

}  // namespace lobe::cli
