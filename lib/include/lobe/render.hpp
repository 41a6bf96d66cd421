#pragma once

/// \file
/// Pictures of materials under light and in scenes, and sources for shaders.

#include "lobe/render/preview.hpp"       // spheres of materials under light
#include "lobe/render/render_scene.hpp"  // scenes by path tracing
#include "lobe/render/scene.hpp"         // shapes, lights and a camera
#include "lobe/render/shader.hpp"        // materials as functions for shaders
