#include "model/traits.hpp"

#include <algorithm>
#include <string>

#include "lobe/core/error.hpp"
#include "model/formula.hpp"

namespace lobe {

Traits traits_of(const Term& term) {
  const bool is_scaled_for_viewers = term.pumping && term.pumping->correction == Correction::viewer;
  if (!term.formula) {
    Traits traits = find_model(term.model).traits;
    traits.reciprocal = traits.reciprocal && !is_scaled_for_viewers;
    return traits;
  }
  // Nobody has looked at what a formula's values are.
  return {.isotropic = !is_anisotropic(*term.formula),
          .reciprocal = term.formula->reciprocal && !is_scaled_for_viewers,
          .conserves_energy = false,
          .has_delta = false,
          .non_negative = false};
}

bool is_reciprocal(const Material& material) {
  return std::ranges::all_of(material.terms, [](const Term& term) { return traits_of(term).reciprocal; });
}

bool is_isotropic(const Material& material) {
  return std::ranges::all_of(material.terms, [](const Term& term) { return traits_of(term).isotropic; });
}

void refuse_anisotropic(std::string_view material, std::string_view model, std::string_view what) {
  throw NumericError("material '" + std::string(material) + "' contains the anisotropic model '" + std::string(model) +
                     "'; expected isotropic ones for " + std::string(what));
}

}  // namespace lobe
