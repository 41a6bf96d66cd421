#pragma once

#include "lobe/render/scene.hpp"
#include "render/scene_geometry.hpp"

namespace lobe {

/// Triangles in a tree of boxes.
/// \param mesh valid
[[nodiscard]] Form mesh_form(const MeshShape& mesh);

}  // namespace lobe
