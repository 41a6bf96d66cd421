#pragma once

/// \file
/// Directional albedos, plausibility and repairs.

#include "lobe/energy/albedo.hpp"        // albedos
#include "lobe/energy/plausibility.hpp"  // whether a reflectance is one of nature
#include "lobe/energy/repair.hpp"        // pumping-up, normalisation, balance of energy
