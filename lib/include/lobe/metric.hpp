#pragma once

/// \file
/// Scalar products, norms and distances.

#include "lobe/metric/lighting.hpp"  // what scalar products weigh
#include "lobe/metric/metric.hpp"    // products, norms, distances
#include "lobe/metric/unit.hpp"      // units of norms and products
