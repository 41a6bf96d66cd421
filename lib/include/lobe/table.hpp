#pragma once

/// \file
/// Reflectances as operators on a grid, as functions of directions, and of any kind.

#include "lobe/table/brdf_function.hpp"  // reflectances as functions of directions
#include "lobe/table/cell_error.hpp"     // what averages over cells may hide
#include "lobe/table/least_value.hpp"    // smallest values of tables
#include "lobe/table/reflectance.hpp"    // formulas, functions or tables
#include "lobe/table/table.hpp"          // reflectances as operators
#include "lobe/table/table_use.hpp"      // what tables are made for
