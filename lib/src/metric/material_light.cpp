// Light of the pattern of a reflectance: what it makes of others.
#include "metric/material_light.hpp"

#include <algorithm>
#include <string>
#include <utility>

#include "algebra/function_composition.hpp"
#include "lobe/algebra/algebra.hpp"
#include "lobe/core/error.hpp"
#include "lobe/reflectance/adjusted.hpp"
#include "metric/grazing_growth.hpp"
#include "model/lobes.hpp"
#include "reflectance/prepared.hpp"

namespace lobe {
namespace {

bool are_nodes(const HemisphereGrid& grid) {
  return grid.is_product() && !grid.has_cells();
}

/// Whether a reflectance grows towards the horizon such that C_{eta,f} has no norm, for any eta.
bool has_no_lit_norm(const Reflectance& reflectance) {
  if (const Material* formula = reflectance.formula()) {
    const LobeKinds all{.with_deltas = true, .with_anisotropic = true, .with_irreciprocal = true};
    return !make_lobe_set({formula, 1}, all).infinite.empty();
  }
  const BrdfFunction* function = reflectance.function();
  return function != nullptr && function->cells == nullptr && function->ring_cells == nullptr &&
         has_infinite_norm(*function, Lighting::daylight());
}

}  // namespace

MaterialLight::MaterialLight(const Device& device, const Lighting& lighting, const HemisphereGrid& grid,
                             MaterialLightOptions options)
    : device_(device), grid_(grid), options_(std::move(options)), eta_(adjusted(device, lighting.material())) {}

const BrdfTable& MaterialLight::eta_table() const {
  if (!table_) {
    table_ = table_on(device_, eta_, grid_,
                      {.precision = options_.precision, .allow_unresolved = true, .cell_points = options_.cell_points});
  }
  return *table_;
}

BrdfTable MaterialLight::lit(const Reflectance& f) const {
  if (are_nodes(grid_) && are_lit_by_values(eta_, {&f, 1})) {
    return compose_factors(
        device_, eta_, f, grid_,
        {.precision = options_.precision, .tolerance = options_.tolerance, .progress = options_.progress});
  }
  if (f.table() != nullptr && f.table()->grid == grid_) return lit(*f.table());
  return lit(
      table_on(device_, f, grid_,
               {.precision = options_.precision, .allow_unresolved = true, .cell_points = options_.cell_points}));
}

BrdfTable MaterialLight::lit(const BrdfTable& f) const {
  return compose(device_, eta_table(), f,
                 {.precision = options_.precision,
                  .allow_unresolved = true,
                  .resolve_formulas = true,
                  .tolerance = options_.tolerance,
                  .progress = options_.progress});
}

bool are_lit_by_values(const Reflectance& eta, std::span<const Reflectance> reflectances) {
  return can_be_factor(eta) && std::ranges::all_of(reflectances, can_be_factor);
}

void require_lit_norms(const Lighting& lighting, const Reflectance& eta, std::span<const Reflectance> reflectances) {
  const auto require = [&](const Reflectance& reflectance) {
    if (!has_no_lit_norm(reflectance)) return;
    throw NumericError("the norm of '" + reflectance.name() + "' under lighting '" + lighting.name() +
                           "' is infinite: it grows as 1/(N.L) at grazing angles; expected 'mean-albedo', which takes "
                           "it",
                       {.fault = Fault::infinite_norm});
  };
  require(eta);
  for (const Reflectance& reflectance : reflectances) require(reflectance);
}

}  // namespace lobe
