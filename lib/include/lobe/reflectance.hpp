#pragma once

// What is asked of a reflectance, however it is known.

#include "lobe/reflectance/adjusted.hpp"         // formulas with their adjustments done
#include "lobe/reflectance/as_function.hpp"      // reflectances as functions of directions
#include "lobe/reflectance/azimuthal_modes.hpp"  // Fourier coefficients over the azimuth
#include "lobe/reflectance/composition.hpp"      // compositions of files and formulas
#include "lobe/reflectance/evaluate.hpp"         // values at pairs of directions
#include "lobe/reflectance/tabulate.hpp"         // reflectances as operators on grids
