#pragma once

#include <cstddef>

#include "lobe/table/table.hpp"

namespace lobe {

/// Error that the quadrature leaves in the mean albedo of a channel's smooth part, on grids without cells: what the
/// mean over both directions changes by if every second azimuth between them is left out, if every second ring of V is,
/// and if every second ring of both directions is, or all but every fourth. (Errors of albedos at single rings have
/// both signs, so that their sum says far too much of the mean.) What the rings of L alone leave out, for delta parts,
/// too, comes to that.
[[nodiscard]] double mean_quadrature_error(const BrdfTable& table, std::size_t channel);

}  // namespace lobe
