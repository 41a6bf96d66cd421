#include "lobe/reflectance/adjusted.hpp"

#include "energy/prepare.hpp"

namespace lobe {

Reflectance adjusted(const Device& device, const Reflectance& reflectance) {
  const Material* formula = reflectance.formula();
  if (formula == nullptr || !needs_preparation(*formula)) return reflectance;
  return prepare(device, *formula);
}

}  // namespace lobe
