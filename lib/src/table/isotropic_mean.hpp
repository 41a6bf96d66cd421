#pragma once

#include "lobe/table/table.hpp"

namespace lobe {

/// Mean of a general table over turns about the normal and both signs of delta_phi: its projection on isotropic
/// reflectances. Products with these, under lightings that look alike from all sides, see nothing else of it. Errors
/// are those of the table.
/// \param table on a product grid
[[nodiscard]] BrdfTable isotropic_mean(const BrdfTable& table);

}  // namespace lobe
