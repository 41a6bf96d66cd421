#pragma once

#include <vector>

#include "lobe/study/study.hpp"
#include "plot/families.hpp"

namespace lobe {

/// What pictures show of a study's materials, in their order.
[[nodiscard]] std::vector<DrawnMaterial> drawn_materials(const Study& study);

}  // namespace lobe
