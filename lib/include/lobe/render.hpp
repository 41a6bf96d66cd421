#pragma once

/// \file
/// Pictures of materials under light.

#include "lobe/render/preview.hpp"  // spheres of materials under light
