#pragma once

#include <span>
#include <vector>

#include "lobe/core/directions.hpp"
#include "lobe/table/table.hpp"

namespace [[gnu::visibility("default")]] lobe {

/// Whether a table represents an operator that is constant on pairs of cells, as Klems files and tensor trees define
/// it, on the grids klems and shirley_chiu. Its albedos, products and compositions with others on its grid are sums
/// over cells, exact except for rounding and the errors of the values.
[[nodiscard]] bool is_constant_on_cells(const BrdfTable& table);

/// Cell error: an estimate, for each channel, of how far a continuous reflectance with the same averages over cells may
/// be from the constant values. It takes half of the change to neighbouring cells along azimuth and across rings, for
/// both directions. It is no bound, since averages say nothing about the inside of a cell. The result is the root mean
/// square over all pairs of directions (weighted by projected solid angles), relative to that of the values; [channel].
/// It is 0 for tables that are not constant on cells.
/// \throws ArgumentError if the table is inconsistent
[[nodiscard]] std::vector<double> cell_error(const BrdfTable& table);

/// Cell error of the albedos for light from given directions, as the integral over V of half of the changes;
/// [channel][direction].
/// \throws as cell_error()
[[nodiscard]] std::vector<std::vector<double>> albedo_cell_error(const BrdfTable& table,
                                                                 std::span<const Direction> incident);

}  // namespace lobe
