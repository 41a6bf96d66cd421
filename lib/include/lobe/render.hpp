#pragma once

/// \file
/// Pictures of materials under light, and sources for shaders.

#include "lobe/render/preview.hpp"  // spheres of materials under light
#include "lobe/render/shader.hpp"   // materials as functions for shaders
