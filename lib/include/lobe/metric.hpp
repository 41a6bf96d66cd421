#pragma once

/// \file
/// Scalar products, distances, approximations, fits and maps.

#include "lobe/metric/approximation.hpp"     // best approximations
#include "lobe/metric/clustering.hpp"        // trees, representatives and neighbours of materials
#include "lobe/metric/comparison.hpp"        // distances of the literature
#include "lobe/metric/embedding.hpp"         // maps of materials
#include "lobe/metric/fit.hpp"               // best members of families
#include "lobe/metric/judgement.hpp"         // distances as people judge them
#include "lobe/metric/lighting.hpp"          // what scalar products weigh
#include "lobe/metric/metric.hpp"            // products, norms, distances
#include "lobe/metric/rank_correlation.hpp"  // how alike metrics rank
#include "lobe/metric/unit.hpp"              // units of norms and products
