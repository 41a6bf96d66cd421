#pragma once

/// \file
/// Importance sampling.

#include "lobe/sampling/sampling.hpp"  // drawing directions by importance
