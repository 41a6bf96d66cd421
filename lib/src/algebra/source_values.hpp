#pragma once

#include "lobe/device/device.hpp"
#include "lobe/table/table.hpp"

namespace lobe {

/// Holds the formula that a table of values at nodes says it is made of (BrdfTable::source) against some of them: the
/// errors of compositions are measured by it, and a file may say anything. Nothing where there is no formula, several
/// of them, or averages over cells.
/// \throws ArgumentError where they differ by more than the table's error and 1e-5 of the largest of these values
void require_source_values(const Device& device, const BrdfTable& table);

}  // namespace lobe
