#pragma once

/// \file
/// Albedos, plausibility, repairs, sampling and previews.

#include "lobe/energy/energy.hpp"        // albedos
#include "lobe/energy/plausibility.hpp"  // whether a reflectance is one of nature
#include "lobe/energy/preview.hpp"       // spheres of materials under light
#include "lobe/energy/repair.hpp"        // pumping-up, normalisation, balance of energy
#include "lobe/energy/sampling.hpp"      // drawing directions by importance
