#include "lobe/reflectance/composition.hpp"

#include <algorithm>

#include "algebra/function_composition.hpp"
#include "algebra/pointwise.hpp"
#include "lobe/reflectance/adjusted.hpp"
#include "reflectance/prepared.hpp"

namespace lobe {

bool can_be_composed(const Reflectance& reflectance) {
  const Material* formula = reflectance.formula();
  if (formula == nullptr || formula->adjustments.empty()) return can_be_factor(reflectance);
  const bool gets_delta = std::ranges::any_of(
      formula->adjustments, [](const Adjustment& adjustment) { return adjustment.kind == Adjustment::Kind::mirror; });
  return !gets_delta && can_be_factor(reflectance);
}

BrdfTable compose(const Device& device, const Reflectance& f, const Reflectance& g, const HemisphereGrid& grid,
                  const ComposeOptions& options) {
  return compose_factors(device, adjusted(device, f), adjusted(device, g), grid, options);
}

std::vector<std::vector<Estimate>> composition_at(const Device& device, const Reflectance& f, const Reflectance& g,
                                                  std::span<const Directions> directions,
                                                  const PointwiseOptions& options) {
  const Reflectance first = adjusted(device, f);
  const Reflectance second = adjusted(device, g);
  if (first.formula() != nullptr && second.formula() != nullptr) {
    return composition_at(device, *first.formula(), *second.formula(), directions, options);
  }
  return composition_at(function_of(device, first), function_of(device, second), directions, options);
}

}  // namespace lobe
