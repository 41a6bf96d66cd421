#pragma once

/// \file
/// Trees, representatives and maps of materials.

#include "lobe/cluster/clustering.hpp"  // trees, representatives and neighbours of materials
#include "lobe/cluster/embedding.hpp"   // maps of materials
