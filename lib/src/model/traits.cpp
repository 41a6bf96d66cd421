#include "model/traits.hpp"

#include <algorithm>

#include "lobe/model.hpp"

namespace lobe {

bool is_reciprocal(const Material& material) {
  return std::ranges::all_of(material.terms, [](const Term& term) { return find_model(term.model).traits.reciprocal; });
}

}  // namespace lobe
