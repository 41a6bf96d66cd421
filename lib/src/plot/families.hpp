#pragma once

#include <span>
#include <string>
#include <vector>

#include "lobe/model/label.hpp"
#include "lobe/model/material.hpp"

namespace lobe {

/// What pictures show of a material.
struct DrawnMaterial {
  MaterialLabel label;
  std::vector<Term> terms;  ///< of a formula
};

/// Materials of one family, as places in the ordered list.
struct FamilyBlock {
  std::string name;
  std::size_t begin = 0;
  std::size_t end = 0;
  bool is_sweep = false;  ///< one lobe per material, of one model, with a single parameter that rises or falls
};

/// Materials ordered by family, families in order of their first material.
struct FamilyOrder {
  std::vector<std::size_t> material;  ///< place in the list -> index of the material
  std::vector<std::string> label;     ///< place -> name without the family in front
  std::vector<FamilyBlock> blocks;
};

[[nodiscard]] FamilyOrder order_by_family(std::span<const DrawnMaterial> materials);

}  // namespace lobe
