#pragma once

/// \file
/// Albedo tables for renderers.

#include "lobe/lut/lut.hpp"       // tables of albedos over angles and parameters, and how far they are off
#include "lobe/lut/lut_file.hpp"  // their files
#include "lobe/lut/lut_fit.hpp"   // polynomials and rational functions for them
