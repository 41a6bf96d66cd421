#pragma once

/// \file
/// Compositions, inverses, spectra and roots.

#include "lobe/algebra/algebra.hpp"      // compositions, mixtures, adjoints
#include "lobe/algebra/inverse.hpp"      // regularised inverses
#include "lobe/algebra/pointwise.hpp"    // compositions at single directions
#include "lobe/algebra/spectrum.hpp"     // eigenvalues and what composing loses
#include "lobe/algebra/square_root.hpp"  // roots of self-compositions
