#include "model/traits.hpp"

#include <algorithm>
#include <string>

#include "lobe/error.hpp"
#include "lobe/model.hpp"

namespace lobe {

bool is_reciprocal(const Material& material) {
  return std::ranges::all_of(material.terms, [](const Term& term) { return find_model(term.model).traits.reciprocal; });
}

bool is_isotropic(const Material& material) {
  return std::ranges::all_of(material.terms, [](const Term& term) { return find_model(term.model).traits.isotropic; });
}

void refuse_anisotropic(std::string_view material, std::string_view model) {
  throw NumericError("material '" + std::string(material) + "' contains the anisotropic model '" + std::string(model) +
                     "'; expected isotropic ones here, of others there are values, albedos, general tables, and "
                     "products under point light, daylight and mean-albedo");
}

}  // namespace lobe
