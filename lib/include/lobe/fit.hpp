#pragma once

/// \file
/// Approximations by linear combinations and fits of parameters.

#include "lobe/fit/approximation.hpp"  // best approximations
#include "lobe/fit/fit.hpp"            // best members of families
