#pragma once

#include "lobe/core/estimate.hpp"
#include "lobe/device/device.hpp"
#include "lobe/hemisphere/grid.hpp"
#include "lobe/metric/lighting.hpp"
#include "lobe/table/table.hpp"

namespace lobe {

/// f . g = tr(T_f T_g* W) of tables on one grid under any lighting (Neumann 2001, eq. 5.23, which is about reciprocal f
/// and g; of others W acts on the side of the light, so that squares are sums of squares), summed over channels with
/// equal weights that sum to 1. Patch lights and tables: one composition W T_f, then an integral with g; the discrete
/// product is exact. Delta parts are exact. The error has those
/// of the values and that of the grid's quadrature.
/// \throws as scalar_product() of tables and lighting_table().
[[nodiscard]] Estimate scalar_product(const Device& device, const BrdfTable& f, const BrdfTable& g,
                                      const Lighting& lighting);

/// |f - g|, integrated as such: no cancellation.
/// \throws as scalar_product(); NumericError where a tabulated W makes the square negative by more than its error: it
///   is no lighting then.
[[nodiscard]] Estimate distance(const Device& device, const BrdfTable& f, const BrdfTable& g, const Lighting& lighting);

// W of a kind of lighting as a table, symmetric (5.26).

[[nodiscard]] BrdfTable tabulate_point_light(const Device& device, const Lighting& lighting,
                                             const HemisphereGrid& grid);
[[nodiscard]] BrdfTable tabulate_daylight(const Device& device, const Lighting& lighting, const HemisphereGrid& grid);
/// On product grids values at the nodes, else means over pairs of cells.
/// \throws DeviceError
[[nodiscard]] BrdfTable tabulate_patch_light(const Device& device, const Lighting& lighting,
                                             const HemisphereGrid& grid);
/// \throws as resample()
[[nodiscard]] BrdfTable tabulate_given_light(const Device& device, const Lighting& lighting,
                                             const HemisphereGrid& grid);

/// eta* eta of the kind `material`, by the table of eta.
/// \throws as tabulate() and compose()
[[nodiscard]] BrdfTable tabulate_material_light(const Device& device, const Lighting& lighting,
                                                const HemisphereGrid& grid);

}  // namespace lobe
