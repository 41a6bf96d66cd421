#pragma once

/// \file
/// Discretised hemispheres.

#include "lobe/hemisphere/grid.hpp"  // discretised hemispheres
