#pragma once

#include <span>
#include <vector>

#include "lobe/core/directions.hpp"
#include "lobe/table/table.hpp"

namespace [[gnu::visibility("default")]] lobe {

/// Whether a table stands for an operator that is constant on pairs of cells, as Klems files and tensor trees define
/// one: on the grids klems and shirley_chiu. Its albedos, products and compositions with others on its grid are sums
/// over cells, exact but for rounding and the errors of the values.
[[nodiscard]] bool is_constant_on_cells(const BrdfTable& table);

/// Cell errors: how far a continuous reflectance with the same averages over cells may be from the constant values,
/// judged by half of the change to neighbouring cells along azimuth and across rings, of both directions. No bound: of
/// what happens within a cell averages say nothing. Root mean square over all pairs of directions (weighted by
/// projected solid angles) over that of the values; [channel]. 0 for tables that are not constant on cells.
[[nodiscard]] std::vector<double> cell_error(const BrdfTable& table);

/// The same of albedos for light from some directions, 1: the integral over V of half of the changes;
/// [channel][direction].
[[nodiscard]] std::vector<std::vector<double>> albedo_cell_error(const BrdfTable& table,
                                                                 std::span<const Direction> incident);

}  // namespace lobe
