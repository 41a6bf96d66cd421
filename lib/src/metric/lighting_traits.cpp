#include "metric/lighting_traits.hpp"

#include <array>

#include "metric/table_lighting.hpp"

namespace lobe {
namespace {

using enum Lighting::Kind;

using Integrator = void(const Device&, const LobeSet&, const MetricOptions&, ProductSums&, WorkDone&);

/// An integrator that knows its lighting.
template <Integrator* integrate>
void of_one(const Device& device, const LobeSet& lobes, const Lighting&, const MetricOptions& options,
            ProductSums& sums, WorkDone& work) {
  integrate(device, lobes, options, sums, work);
}

/// In the order of the enumeration.
constexpr auto kRows = std::to_array<LightingTraits>({
    {.kind = point,
     .name = "point",
     .takes_deltas = false,
     .rule = "half-difference rule",
     .has_slabs = true,
     .tabulate = tabulate_point_light,
     .integrate = of_one<integrate_point_products>,
     .slabs = point_slabs},
    {.kind = daylight,
     .name = "daylight",
     .product_power = 1,
     .rule = "albedo rule",
     .tabulate = tabulate_daylight,
     .integrate = of_one<integrate_daylight_products>,
     .slabs = daylight_slabs},
    {.kind = mean_albedo,
     .name = "mean-albedo",
     .product_power = 2,
     .is_of_means = true,
     .rule = "albedo rule",
     .integrate = of_one<integrate_mean_albedo_products>},
    {.kind = patches,
     .name = "patch",
     .takes_anisotropic = false,
     .has_operator = true,
     .has_patch_tolerance = true,
     .rule = "polynomials of the base plane, degree 24 to 270, as products ask for",
     .tabulate = tabulate_patch_light,
     .integrate = integrate_patch_products},
    {.kind = table,
     .name = "table",
     .has_operator = true,
     .takes_functions = false,
     .is_tabulated = true,
     .is_by_tables = true,
     .rule = "tables",
     .tabulate = tabulate_given_light},
    {.kind = material,
     .name = "material",
     .has_operator = true,
     .takes_functions = false,
     .is_by_tables = true,
     .is_pattern = true,
     .has_patch_tolerance = true,
     .rule = "tables",
     .tabulate = tabulate_material_light},
});

constexpr bool is_in_order() {
  for (std::size_t k = 0; k < kRows.size(); ++k) {
    if (static_cast<std::size_t>(kRows[k].kind) != k) return false;
  }
  return true;
}
static_assert(is_in_order());

}  // namespace

const LightingTraits& traits_of(Lighting::Kind kind) {
  return kRows[static_cast<std::size_t>(kind)];
}

}  // namespace lobe
